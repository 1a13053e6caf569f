// .splat files: values worked out by hand, and files that are not taken for one.
#include "tests/engine/files/hostile_scenes.h"

#include <fmt/ranges.h>

SUITE(splat_format) {

const std::string kPlain = splatRow({1, 2, 3}, {0.5f, 0.25f, 0.125f}, {255, 0, 51, 204, 255, 128, 128, 128});

std::string repeat(const std::string& row, int count) {
    return fmt::format("{}", fmt::join(std::vector(count, row), ""));
}

TEST_CASE_FIXTURE(InFolder, "a .splat is read row by row, whatever its name") {
    const std::string turned =
        splatRow({-4, 5, -6}, {0.125f, 0.5f, 0.25f}, {0, 255, 102, 255, 218, 38, 128, 128});
    const auto [notes, scene] = readScene(folder.write("scene.bin", repeat(kPlain, 300) + turned));
    REQUIRE(these(scene.size(), scene.sh_degree) == these(301, 0));
    CHECK(these(scene.positions[299], scene.scales[299].x, scene.scales[299].y, scene.opacities[299],
                scene.rotations[299].w) == these(glm::vec3(1, 2, 3), doctest::Approx(0.5),
                                                 doctest::Approx(0.25), doctest::Approx(0.8),
                                                 doctest::Approx(1.0)));
    CHECK(0.5f + 0.28209479f * scene.sh[3 * 299 + 0] == doctest::Approx(1.0));
    CHECK(0.5f + 0.28209479f * scene.sh[3 * 299 + 2] == doctest::Approx(0.2));
    CHECK(these(scene.positions[300], scene.opacities[300]) == these(glm::vec3(-4, 5, -6), 1.0f));
    // The x axis is the shortest, and t_w lies along it. (w, x) = (90, -90)/128 turns about x, which leaves
    // that axis unchanged.
    const glm::vec3 normal = scene.rotations[300] * glm::vec3(0, 0, 1);
    CHECK(glm::distance(normal, glm::vec3(1, 0, 0)) < 1e-5f);
    CHECK(these(notes.three_scales, notes.median_flatness) == these(true, doctest::Approx(0.5)));
}

TEST_CASE_FIXTURE(InFolder, "rotations of length 2 are normalised, and those of length zero turn nothing") {
    const std::string none = splatRow({1, 2, 3}, {1, 1, 0.5f}, {0, 0, 0, 0, 128, 128, 128, 128}),
                      is_long = splatRow({1, 2, 3}, {1, 1, 0.5f}, {0, 0, 0, 0, 255, 0, 0, 0});
    for (const auto& [rows, expected] :
         {std::pair(repeat(none, 20), glm::quat(1.0f, 0.0f, 0.0f, 0.0f)),
          std::pair(repeat(is_long, 20), glm::normalize(glm::quat(127.0f, -128.0f, -128.0f, -128.0f)))}) {
        const auto [notes, scene] = readScene(folder.write("a.splat", rows));
        REQUIRE(scene.size() == 20);
        CHECK(std::abs(glm::dot(scene.rotations[19], expected)) == doctest::Approx(1.0));
        CHECK(notes.lines.empty());
    }
}

TEST_CASE_FIXTURE(InFolder, "a few broken splats are skipped and counted") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::string rows = repeat(kPlain, 50);
    rows += splatRow({nan, 0, 0}, {1, 1, 1}, {0, 0, 0, 0, 255, 128, 128, 128});
    rows += splatRow({0, 0, 0}, {-1, 1, 1}, {0, 0, 0, 0, 255, 128, 128, 128});
    const auto [notes, scene] = readScene(folder.write("a.splat", rows));
    CHECK(these(scene.size(), notes.skipped_not_finite) == these(50, 2));
}

TEST_CASE_FIXTURE(InFolder, "a .splat that ends within a splat says so") {
    const std::string whole = repeat(kPlain, 3);
    for (std::size_t length = 0; length < whole.size(); ++length) {
        const std::string cut = whole.substr(0, length);
        if (length % 32 == 0 && length > 0) {
            CHECK(loadError(folder, cut) == "");
        } else {
            const std::string place =
                fmt::format("data: ends in splat {}: {} bytes, expected 32 per splat", length / 32, length);
            checkError("broken.ply: " + (length > 32 ? place : ""), folder, cut);
        }
    }
}

TEST_CASE_FIXTURE(InFolder, "other files are not taken for a .splat") {
    for (const std::string& bytes :
         {std::string(64, '\0'), std::string(96, '\xff'), repeat("0123456789abcdefghijklmnopqrstuv", 40),
          repeat("{\"a\": [0.5, 0.25, 0.125, 1.0]}\n ", 40)}) {
        checkError("not a scene file", folder, bytes);
    }
}

}  // SUITE(splat_format)
