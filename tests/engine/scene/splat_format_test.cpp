// .splat files: values worked out by hand, and what is not taken for one.
#include "engine/scene/splat_file.h"
#include "tests/engine/scene/ply_files.h"

TEST_SUITE_BEGIN("splat_format");

namespace splat_format_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

std::string splatRow(glm::vec3 position, glm::vec3 scale, std::array<int, 4> colour, std::array<int, 4> rotation) {
    std::string row;
    for (int i = 0; i < 3; ++i) { appendTyped(row, "float", position[i], Encoding::kLittle); }
    for (int i = 0; i < 3; ++i) { appendTyped(row, "float", scale[i], Encoding::kLittle); }
    for (const int value : colour) { row.push_back(static_cast<char>(value)); }
    for (const int value : rotation) { row.push_back(static_cast<char>(value)); }
    return row;
}
const std::string kPlain = splatRow({1, 2, 3}, {0.5f, 0.25f, 0.125f}, {255, 0, 51, 204}, {255, 128, 128, 128});

std::string repeat(const std::string& row, int count) {
    std::string rows;
    for (int i = 0; i < count; ++i) { rows += row; }
    return rows;
}

}  // namespace

TEST_CASE("a .splat is read row by row, whatever its name") {
    const Folder folder;
    LoadNotes notes;
    const std::string turned = splatRow({-4, 5, -6}, {0.125f, 0.5f, 0.25f}, {0, 255, 102, 255}, {218, 38, 128, 128});
    const Scene scene = loadScene(folder.write("scene.bin", repeat(kPlain, 300) + turned), 0, &notes);
    REQUIRE(scene.size() == 301);
    CHECK(scene.positions[299] == glm::vec3(1, 2, 3));
    CHECK(scene.scales[299].x == doctest::Approx(0.5));
    CHECK(scene.scales[299].y == doctest::Approx(0.25));
    CHECK(scene.opacities[299] == doctest::Approx(0.8));
    CHECK(scene.rotations[299].w == doctest::Approx(1.0));
    CHECK(0.5f + 0.28209479f * scene.sh[3 * 299 + 0] == doctest::Approx(1.0));
    CHECK(0.5f + 0.28209479f * scene.sh[3 * 299 + 2] == doctest::Approx(0.2));
    CHECK(scene.positions[300] == glm::vec3(-4, 5, -6));
    CHECK(scene.opacities[300] == 1.0f);
    // The x axis is the shortest: t_w lies along it. (w, x) = (90, -90)/128 turns about x, which leaves that axis alone.
    const glm::vec3 normal = scene.rotations[300] * glm::vec3(0, 0, 1);
    CHECK(glm::distance(normal, glm::vec3(1, 0, 0)) < 1e-5f);
    CHECK(notes.three_scales);
    CHECK(notes.median_flatness == doctest::Approx(0.5));
    CHECK(scene.sh_degree == 0);
}

TEST_CASE("a few broken splats are skipped and counted") {
    const Folder folder;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::string broken = splatRow({nan, 0, 0}, {1, 1, 1}, {0, 0, 0, 0}, {255, 128, 128, 128});
    const std::string negative = splatRow({0, 0, 0}, {-1, 1, 1}, {0, 0, 0, 0}, {255, 128, 128, 128});
    const std::string unturned = splatRow({0, 0, 0}, {0, 1, 1}, {0, 0, 0, 0}, {128, 128, 128, 128});
    LoadNotes notes;
    const Scene scene = loadScene(folder.write("a.splat", repeat(kPlain, 50) + broken + negative + unturned), 0, &notes);
    CHECK(scene.size() == 50);
    CHECK(notes.skipped_not_finite == 2);
    CHECK(notes.skipped_zero_rotation == 1);
}

TEST_CASE("a .splat that ends within a splat says so") {
    const Folder folder;
    const std::string whole = repeat(kPlain, 3);
    for (std::size_t length = 0; length < whole.size(); ++length) {
        const std::string message = loadError(folder, whole.substr(0, length));
        if (length % 32 == 0 && length > 0) {
            CHECK(message.empty());
        } else if (length > 32) {
            CHECK(
                contains(message, fmt::format("broken.ply: data: ends in splat {}: {} bytes, expected 32 per splat", length / 32, length)));
        } else {
            CHECK(contains(message, "broken.ply: "));
        }
    }
}

TEST_CASE("other files are not taken for a .splat") {
    const Folder folder;
    CHECK(contains(loadError(folder, std::string(64, '\0')), "not a scene file"));
    CHECK(contains(loadError(folder, std::string(96, '\xff')), "not a scene file"));
    CHECK(contains(loadError(folder, repeat("0123456789abcdefghijklmnopqrstuv", 40)), "not a scene file"));
    CHECK(contains(loadError(folder, repeat("{\"a\": [0.5, 0.25, 0.125, 1.0]}\n ", 40)), "not a scene file"));
}

}  // namespace splat_format_test
