// Pictures that must not change: the twin's of a few scenes, kept as PNG files in golden/. Where one differs, what was expected, what
// came and ten times the difference are left in the build folder. BINOSPLAT_WRITE_GOLDENS=1 makes the files anew from the twin.
#include "engine/picture/image_io.h"
#include "engine/picture/metrics.h"
#include "tests/frame_runs.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

TEST_SUITE_BEGIN("golden");

#ifndef BINOSPLAT_HAS_PNG

TEST_CASE("golden pictures") { MESSAGE("skipped: built without PNG, golden pictures are PNG files"); }

#else

using namespace binosplat;
using test::Gpu;
using test::ViewedScene;

namespace {

constexpr double kLeastDb = 50.0;  // 8 bits alone leave 59

struct Golden {
    const char* name;
    const char* scene;
    std::uint64_t splats;
};
constexpr Golden kGoldens[] = {{"atelier", "builtin:atelier", 20000},
                               {"fence", "builtin:fence", 0},
                               {"slanted-wall", "builtin:slanted-wall", 0},
                               {"step-edge", "builtin:step-edge", 0}};

std::filesystem::path goldenStem(const Golden& golden) {
    return std::filesystem::path(BINOSPLAT_SOURCE_DIR) / "tests/golden" / golden.name;
}

Image differenceOf(const Image& a, const Image& b) {
    Image image{a.size_px, 3, {}};
    for (std::size_t i = 0; i < image.pixelCount(); ++i) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            image.values.push_back(10.0f * std::abs(a.values[i * static_cast<std::size_t>(a.channels) + channel] -
                                                    b.values[i * static_cast<std::size_t>(b.channels) + channel]));
        }
    }
    return image;
}

void checkGolden(const Golden& golden, const Image& expected, const Image& actual, const char* made_by) {
    CAPTURE(golden.name);
    CAPTURE(made_by);
    const double db = compare(expected, actual).psnrDb();
    CHECK(db >= kLeastDb);
    if (db >= kLeastDb) { return; }
    const std::filesystem::path folder = std::filesystem::path(BINOSPLAT_OUTPUT_DIR) / "golden";
    std::filesystem::create_directories(folder);
    for (const auto& [suffix, image] :
         {std::pair("_expected", expected), std::pair("_actual", actual), std::pair("_difference", differenceOf(expected, actual))}) {
        const auto files = writePicture(folder / (golden.name + std::string("_") + made_by + suffix), PictureKind::kDisplay, image);
        MESSAGE("look at " << files.front().string());
    }
}

ViewedScene viewOf(const Golden& golden) { return test::viewBuiltin(golden.scene, {192, 192}, golden.splats); }

}  // namespace

TEST_CASE_FIXTURE(Gpu, "the golden pictures are what twin and device render") {
    const char* write = std::getenv("BINOSPLAT_WRITE_GOLDENS");
    for (const Golden& golden : kGoldens) {
        const ViewedScene view = viewOf(golden);
        const Image twin = test::toImage(reference::render(view.scene, view.eye, {}));
        if (write != nullptr && std::string(write) == "1") { writePicture(goldenStem(golden), PictureKind::kDisplay, twin); }
        const Image expected = readPicture(goldenStem(golden).string() + ".png");
        FrameSettings settings;
        settings.mode = Mode::kMono;
        checkGolden(golden, expected, twin, "twin");
        checkGolden(golden, expected, test::renderMono(context(), view.scene, view.eye, settings).picture, "device");
    }
}

TEST_CASE("golden pictures differ from each other and from themselves shifted") {
    std::vector<Image> images;
    for (const Golden& golden : kGoldens) { images.push_back(readPicture(goldenStem(golden).string() + ".png")); }
    for (std::size_t i = 0; i < images.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) { CHECK(compare(images[i], images[j]).psnrDb() < kLeastDb); }
        Image shifted = images[i];
        std::rotate(shifted.values.begin(), shifted.values.end() - shifted.channels, shifted.values.end());
        CHECK(compare(images[i], shifted).psnrDb() < kLeastDb);
    }
}

#endif
