// Facts about image files: what is written comes back, and a failed write leaves nothing.
#include "engine/error.h"
#include "engine/picture/image_io.h"
#include "engine/picture/netpbm.h"

#include <doctest/doctest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

namespace fs = std::filesystem;
using namespace binosplat;

namespace {

// A folder that goes away with the test.
struct Folder {
    fs::path path = fs::temp_directory_path() / fmt::format("binosplat_picture_{}", getpid());
    Folder() { fs::create_directories(path); }
    ~Folder() { fs::remove_all(path); }
};

// Every value differs from its neighbours, some lie outside 0 to 1.
Image makeRamp(glm::uvec2 size_px, int channels) {
    Image image{size_px, channels, {}};
    image.values.resize(image.pixelCount() * static_cast<std::size_t>(channels));
    for (std::size_t i = 0; i < image.values.size(); ++i) { image.values[i] = static_cast<float>(i) * 0.37f - 1.0f; }
    return image;
}

// Eighths are exact in float32, and 255 of them per unit are not: rounding shows.
Image makeDisplay(glm::uvec2 size_px) {
    Image image{size_px, 4, {}};
    for (std::size_t i = 0; i < image.pixelCount() * 4; ++i) { image.values.push_back(static_cast<float>(i % 9) / 8.0f); }
    return image;
}

}  // namespace

TEST_CASE("quantizeClampsAndRoundsToNearest") {
    CHECK(quantize(-1.0f) == 0);
    CHECK(quantize(0.0f) == 0);
    CHECK(quantize(0.4f / 255.0f) == 0);
    CHECK(quantize(0.6f / 255.0f) == 1);
    CHECK(quantize(254.4f / 255.0f) == 254);
    CHECK(quantize(254.6f / 255.0f) == 255);
    CHECK(quantize(1.0f) == 255);
    CHECK(quantize(std::numeric_limits<float>::infinity()) == 255);
    CHECK(quantize(std::numeric_limits<float>::quiet_NaN()) == 0);
}

TEST_CASE("pfmRoundTripKeepsEveryBit") {
    const Folder folder;
    for (int channels : {1, 3}) {
        const Image image = makeRamp({5, 3}, channels);
        writePfm(folder.path / "a.pfm", image);
        const Image back = readPicture(folder.path / "a.pfm");
        CHECK(back.size_px == image.size_px);
        CHECK(back.channels == channels);
        CHECK(back.values == image.values);
    }
}

TEST_CASE("pnmRoundTripIsTheQuantizedPicture") {
    const Folder folder;
    for (int channels : {1, 3}) {
        const Image image = selectChannels(makeDisplay({7, 2}), 0, channels);
        writePnm(folder.path / "a.ppm", image);
        const Image back = readPicture(folder.path / "a.ppm");
        REQUIRE(back.values.size() == image.values.size());
        CHECK(back.channels == channels);
        for (std::size_t i = 0; i < back.values.size(); ++i) {
            CHECK(back.values[i] == static_cast<float>(quantize(image.values[i])) / 255.0f);
        }
    }
}

TEST_CASE("floatPictureRoundTripKeepsEveryBit") {
    const Folder folder;
    for (int channels : {1, 3, 4}) {
        const Image image = makeRamp({17, 33}, channels);
        const auto files = writePicture(folder.path / "a.b", PictureKind::kFloat, image);
        REQUIRE(!files.empty());
        CHECK(files.front() == folder.path / (std::string("a.b") + extensionOf(PictureKind::kFloat)));
        const Image back = readPicture(files.front());
        CHECK(back.size_px == image.size_px);
        if (files.size() == 2) {
            CHECK(back.values == selectChannels(image, 0, 3).values);
            CHECK(readPicture(files.back()).values == selectChannels(image, 3, 1).values);
        } else {
            CHECK(back.values == image.values);
        }
    }
}

TEST_CASE("displayPictureIsOpaqueRgb") {
    const Folder folder;
    const Image image = makeDisplay({16, 9});
    const auto files = writePicture(folder.path / "a", PictureKind::kDisplay, image);
    REQUIRE(files.size() == 1);
    const Image back = readPicture(files.front());
    const Image rgb = selectChannels(image, 0, 3);
    REQUIRE(back.channels == 3);
    for (std::size_t i = 0; i < rgb.values.size(); ++i) { CHECK(std::lround(back.values[i] * 255.0f) == quantize(rgb.values[i])); }
}

TEST_CASE("failedWriteLeavesNothing") {
    const Folder folder;
    const Image image = makeRamp({4, 4}, 4);
    CHECK_THROWS_AS(writePicture(folder.path / "missing" / "a", PictureKind::kFloat, image), Error);
    CHECK_THROWS_AS(writePicture(folder.path / "missing" / "a", PictureKind::kDisplay, image), Error);
    CHECK_THROWS_AS(writePicture(folder.path / "a", PictureKind::kFloat, Image{{4, 4}, 4, {1.0f}}), Error);
    CHECK(fs::is_empty(folder.path));
}

TEST_CASE("truncatedAndForeignFilesAreErrors") {
    const Folder folder;
    writePfm(folder.path / "a.pfm", makeRamp({8, 8}, 3));
    fs::resize_file(folder.path / "a.pfm", fs::file_size(folder.path / "a.pfm") - 1);
    CHECK_THROWS_AS(readPicture(folder.path / "a.pfm"), Error);
    std::ofstream(folder.path / "b.pfm") << "not an image";
    CHECK_THROWS_AS(readPicture(folder.path / "b.pfm"), Error);
    std::ofstream(folder.path / "huge.ppm") << "P6\n4000000000 4000000000\n255\nx";
    CHECK_THROWS_AS(readPicture(folder.path / "huge.ppm"), Error);
    CHECK_THROWS_AS(readPicture(folder.path / "none.exr"), Error);
}
