// Pictures that must not change, kept as PNG files in golden/. Where one differs, what was expected, what came and ten times the difference
// are left in the build folder. BINOSPLAT_WRITE_GOLDENS=1 makes the files anew from the twin.
#pragma once

#include "engine/picture/image_io.h"
#include "engine/picture/metrics.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace binosplat::test {

inline std::filesystem::path goldenStem(const std::string& name) {
    return std::filesystem::path(BINOSPLAT_SOURCE_DIR) / "tests/golden" / name;
}

// The file, which is written first where that is wanted.
inline Image readGolden(const std::string& name, const Image& twin) {
    const char* write = std::getenv("BINOSPLAT_WRITE_GOLDENS");
    if (write != nullptr && std::string(write) == "1") { writePicture(goldenStem(name), PictureKind::kDisplay, twin); }
    return readPicture(goldenStem(name).string() + ".png");
}

inline Image differenceOf(const Image& a, const Image& b) {
    Image image{a.size_px, 3, {}};
    for (std::size_t i = 0; i < image.pixelCount(); ++i) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            image.values.push_back(10.0f * std::abs(a.values[i * static_cast<std::size_t>(a.channels) + channel] -
                                                    b.values[i * static_cast<std::size_t>(b.channels) + channel]));
        }
    }
    return image;
}

inline void checkGolden(const std::string& name, const Image& expected, const Image& actual, const char* made_by, double least_db) {
    CAPTURE(name);
    CAPTURE(made_by);
    const double db = compare(expected, actual).psnrDb();
    CHECK(db >= least_db);
    if (db >= least_db) { return; }
    const std::filesystem::path folder = std::filesystem::path(BINOSPLAT_OUTPUT_DIR) / "golden";
    std::filesystem::create_directories(folder);
    for (const auto& [suffix, image] :
         {std::pair("_expected", expected), std::pair("_actual", actual), std::pair("_difference", differenceOf(expected, actual))}) {
        const auto files = writePicture(folder / (name + "_" + made_by + suffix), PictureKind::kDisplay, image);
        MESSAGE("look at " << files.front().string());
    }
}

}  // namespace binosplat::test
