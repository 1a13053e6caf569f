// Pictures that must not change: the twin's of a few scenes.
#include "engine/reference/periphery.h"
#include "tests/engine/frame/frame_runs.h"
#include "tests/engine/frame/golden_files.h"

#include <algorithm>

TEST_SUITE_BEGIN("golden");

namespace golden_test {

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

ViewedScene viewOf(const Golden& golden) { return test::viewBuiltin(golden.scene, {192, 192}, golden.splats); }

}  // namespace

TEST_CASE_FIXTURE(Gpu, "the golden pictures are what twin and device render") {
    for (const Golden& golden : kGoldens) {
        const ViewedScene view = viewOf(golden);
        const Image twin = test::toImage(reference::render(view.scene, view.eye, {}));
        const Image expected = test::readGolden(golden.name, twin);
        FrameSettings settings;
        settings.mode = Mode::kMono;
        test::checkGolden(golden.name, expected, twin, "twin", kLeastDb);
        test::checkGolden(golden.name, expected, test::renderMono(context(), view.scene, view.eye, settings).picture, "device", kLeastDb);
    }
}

TEST_CASE_FIXTURE(Gpu, "the golden picture of an eye that looks aside is what twin and device make of two pictures") {
    const Golden golden{"atelier-aside", "builtin:atelier", 20000};
    const ViewedScene view = viewOf(golden);
    const Gaze gaze{{-3.0, 1.0, -2.0}, 0.0};
    const auto made = reference::renderPeriphery(view.scene, view.eye, {gaze.direction, gaze.clear_rad}, {});
    const Image twin = test::toImage(made.picture);
    const Image expected = test::readGolden(golden.name, twin);
    FrameSettings settings;
    settings.mode = Mode::kMono;
    settings.gazes[0] = gaze;
    settings.half_periphery = true;
    test::checkGolden(golden.name, expected, twin, "twin", kLeastDb);
    test::checkGolden(golden.name, expected, test::renderMono(context(), view.scene, view.eye, settings).picture, "device", kLeastDb);
    // And not the picture in full.
    CHECK(compare(expected, readPicture(test::goldenStem(kGoldens[0].name).string() + ".png")).psnrDb() < kLeastDb);
    CHECK(std::ranges::count(made.own_tiles, 0) > 20);
}

TEST_CASE("golden pictures differ from each other and from themselves shifted") {
    std::vector<Image> images;
    for (const Golden& golden : kGoldens) { images.push_back(readPicture(test::goldenStem(golden.name).string() + ".png")); }
    for (std::size_t i = 0; i < images.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) { CHECK(compare(images[i], images[j]).psnrDb() < kLeastDb); }
        Image shifted = images[i];
        std::rotate(shifted.values.begin(), shifted.values.end() - shifted.channels, shifted.values.end());
        CHECK(compare(images[i], shifted).psnrDb() < kLeastDb);
    }
}

#endif

}  // namespace golden_test
