// PlayCanvas compressed PLY: values worked out by hand, a real file, and headers that do not fit.
#include "engine/scene/compressed_ply.h"
#include "tests/engine/scene/ply_files.h"
#include "tests/shared_data.h"

TEST_SUITE_BEGIN("compressed_ply_format");

namespace compressed_ply_format_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

constexpr const char* kBounds[] = {"min_x",       "min_y",       "min_z",       "max_x",       "max_y",       "max_z",
                                   "min_scale_x", "min_scale_y", "min_scale_z", "max_scale_x", "max_scale_y", "max_scale_z",
                                   "min_r",       "min_g",       "min_b",       "max_r",       "max_g",       "max_b"};

// `splats` times the same words; chunk i has its positions from i to i + 1 on x.
std::string compressed(std::size_t splats, std::uint32_t position, std::uint32_t rotation, std::uint32_t scale, std::uint32_t colour,
                       bool with_colour_bounds = true, const std::vector<int>& rest = {}) {
    const std::size_t chunks = (splats + 255) / 256;
    PlyText ply;
    ply.header_before = fmt::format("element chunk {}\n", chunks);
    for (int i = 0; i < (with_colour_bounds ? 18 : 12); ++i) { ply.header_before += fmt::format("property float {}\n", kBounds[i]); }
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
        const double x = static_cast<double>(chunk);
        const double bounds[] = {x, -2, 4, x + 1, 2, 8, -6, -5, -4, -2, -1, 0, -0.5, 0, 0, 1.5, 1, 2};
        for (int i = 0; i < (with_colour_bounds ? 18 : 12); ++i) { appendTyped(ply.data_before, "float", bounds[i], Encoding::kLittle); }
    }
    const auto column = [&](const char* name, std::uint32_t word) {
        ply.columns.push_back({name, "uint", std::vector<double>(splats, word)});
    };
    column("packed_position", position);
    column("packed_rotation", rotation);
    column("packed_scale", scale);
    column("packed_color", colour);
    if (!rest.empty()) {
        ply.header_after = fmt::format("element sh {}\n", splats);
        for (std::size_t i = 0; i < rest.size(); ++i) { ply.header_after += fmt::format("property uchar f_rest_{}\n", i); }
        for (std::size_t splat = 0; splat < splats; ++splat) {
            for (const int level : rest) { ply.data_after.push_back(static_cast<char>(level)); }
        }
    }
    return ply.bytes();
}

constexpr std::uint32_t kAllOnes = 0xffffffffu;
constexpr std::uint32_t kMiddle = 512u << 20 | 512u << 10 | 512u;  // components of 0.5/1023 sqrt(2), w the largest

}  // namespace

TEST_CASE("words lie between the bounds of their chunk") {
    const Folder folder;
    LoadNotes notes;
    // x: all of 11 bits; y: none of 10; z: all of 11.
    const std::string bytes = compressed(257, 0x7ffu << 21 | 0x7ffu, kMiddle, 0u, 0xff0080ffu);
    const Scene scene = loadScene(folder.write("a.ply", bytes), 0, &notes);
    REQUIRE(scene.size() == 257);
    CHECK(scene.positions[0] == glm::vec3(1.0f, -2.0f, 8.0f));
    CHECK(scene.positions[255] == glm::vec3(1.0f, -2.0f, 8.0f));
    CHECK(scene.positions[256] == glm::vec3(2.0f, -2.0f, 8.0f));
    // Scales exp(-6), exp(-5), exp(-4): the first is dropped, the two others follow it.
    CHECK(scene.scales[0].x == doctest::Approx(std::exp(-5.0)));
    CHECK(scene.scales[0].y == doctest::Approx(std::exp(-4.0)));
    CHECK(scene.opacities[0] == 1.0f);
    // Colour between bounds: r all of -0.5 to 1.5, g none of 0 to 1, b 128/255 of 0 to 2.
    CHECK(0.5f + 0.28209479f * scene.sh[0] == doctest::Approx(1.5));
    CHECK(0.5f + 0.28209479f * scene.sh[1] == doctest::Approx(0.0));
    CHECK(0.5f + 0.28209479f * scene.sh[2] == doctest::Approx(256.0 / 255.0));
    CHECK(notes.three_scales);
    CHECK(notes.median_flatness == doctest::Approx(std::exp(-1.0)));
    CHECK(notes.sh_degree_in_file == 0);
}

TEST_CASE("rotation words name their largest component") {
    const Folder folder;
    for (std::uint32_t largest = 0; largest < 4; ++largest) {
        // Scales -2, -1, -4 at their bounds keep z the shortest, so that the quaternion is the stored one.
        const std::string bytes = compressed(1, 0u, largest << 30 | kMiddle, 0x7ffu << 21 | 0x3ffu << 11, kAllOnes);
        const Scene scene = loadScene(folder.write("a.ply", bytes));
        const glm::quat q = scene.rotations[0];
        const float stored[] = {q.w, q.x, q.y, q.z};
        for (std::uint32_t i = 0; i < 4; ++i) {
            CHECK(stored[i] == doctest::Approx(i == largest ? 1.0 : 0.5 / 1023 * std::sqrt(2.0)).epsilon(1e-4));
        }
    }
}

TEST_CASE("colours without bounds are from 0 to 1; zero opacity stays zero") {
    const Folder folder;
    const Scene scene = loadScene(folder.write("a.ply", compressed(2, 0u, kMiddle, 0u, 0xff008000u, false)));
    CHECK(0.5f + 0.28209479f * scene.sh[0] == doctest::Approx(1.0));
    CHECK(0.5f + 0.28209479f * scene.sh[1] == doctest::Approx(0.0));
    CHECK(0.5f + 0.28209479f * scene.sh[2] == doctest::Approx(128.0 / 255.0));
    CHECK(scene.opacities[0] == 0.0f);
}

TEST_CASE("SH bytes stand for the middle of their interval within -4 to 4") {
    const Folder folder;
    std::vector<int> rest(24, 0);
    rest[1] = 255, rest[8] = 64, rest[23] = 200;  // red of coefficient 2, green of 1, blue of 8
    LoadNotes notes;
    const Scene scene = loadScene(folder.write("a.ply", compressed(3, 0u, kMiddle, 0u, kAllOnes, true, rest)), 0, &notes);
    REQUIRE(scene.sh_degree == 2);
    const float* sh = scene.sh.data() + 2 * 27;
    CHECK(sh[3 * 1 + 0] == -4.0f);
    CHECK(sh[3 * 2 + 0] == 4.0f);
    CHECK(sh[3 * 1 + 1] == 8.0f * (64.5f / 256.0f - 0.5f));
    CHECK(sh[3 * 8 + 2] == 8.0f * (200.5f / 256.0f - 0.5f));
}

TEST_CASE("a real compressed PLY gives the values another decoder gave" * needsSharedData()) {
    const auto data = sharedData();
    if (!data) { return; }
    LoadNotes notes;
    const Scene scene = loadScene((*data / "guitar/guitar.compressed.ply").string(), 0, &notes);
    REQUIRE(scene.size() == 90854);
    CHECK(notes.skipped_not_finite + notes.skipped_zero_rotation == 0);
    CHECK(glm::distance(scene.positions[300], {-0.4802096f, -4.1130406f, -0.0136646f}) < 1e-6f);
    CHECK(std::min(scene.scales[300].x, scene.scales[300].y) == doctest::Approx(0.0022113659));
    CHECK(std::max(scene.scales[300].x, scene.scales[300].y) == doctest::Approx(0.0109744594));
    CHECK(scene.opacities[300] == doctest::Approx(0.9450980));
    CHECK(0.5f + 0.28209479f * scene.sh[3 * 300] == doctest::Approx(0.0945961));
    CHECK(glm::distance(scene.positions[90853], {0.4553929f, -0.6415753f, 0.7538047f}) < 1e-6f);
    CHECK(notes.median_flatness > 0.0);
    CHECK(notes.median_flatness < 1.0);
}

TEST_CASE("a comment asks for antialiasing here, too") {
    const Folder folder;
    const std::string plain = compressed(2, 0, 0, 0, 0);
    CHECK_FALSE(loadScene(folder.write("plain.ply", plain)).antialiased);
    const std::string said = replaced(plain, "comment made for a test", "comment SplatRenderMode: mip");
    CHECK(loadScene(folder.write("said.ply", said)).antialiased);
}

TEST_CASE("headers and counts that do not fit are named") {
    const Folder folder;
    const std::string good = compressed(300, 0u, kMiddle, 0u, kAllOnes, true, std::vector<int>(9, 1));
    CHECK(loadError(folder, good).empty());
    const auto errorWith = [&](const std::string& from, const std::string& to) {
        const std::string message = loadError(folder, replaced(good, from, to));
        CHECK(contains(message, "broken.ply: "));
        CHECK(message.find('\n') == std::string::npos);
        return message;
    };
    CHECK(contains(errorWith("element chunk 2", "element chunk 3"), "3 chunks for 300 splats"));
    CHECK(contains(errorWith("element chunk 2", "element chunks 2"), "expected chunk, vertex and perhaps sh"));
    CHECK(contains(errorWith("element sh 300", "element sh 299"), "299 rows of element sh for 300 splats"));
    CHECK(contains(errorWith("property uchar f_rest_8\n", ""), "has 8 properties"));
    CHECK(contains(errorWith("uchar f_rest_8", "float f_rest_8"), "expected uchar"));
    CHECK(contains(errorWith("float min_x", "double min_x"), "expected float"));
    CHECK(contains(errorWith("float min_x", "float max_x"), "max_x of element chunk twice"));
    CHECK(contains(errorWith("float min_x", "float other"), "no property min_x"));
    CHECK(contains(errorWith("property float min_x", "property list uchar float min_x"), "is a list"));
    CHECK(contains(errorWith("uint packed_scale", "int packed_scale"), "expected uint"));
    CHECK(contains(errorWith("binary_little_endian", "ascii"), "expected binary_little_endian"));
    std::string many = replaced(good, "element chunk 2", "element chunk 72057594037927936");
    many = replaced(replaced(many, "element vertex 300", "element vertex 18446744073709551615"), "element sh 300",
                    "element sh 18446744073709551615");
    CHECK(contains(loadError(folder, many), "bytes are left for 72057594037927936 chunks"));
}

TEST_CASE("a compressed PLY cut off at any byte is an error") {
    const Folder folder;
    const std::string whole = compressed(2, 0u, kMiddle, 0u, kAllOnes, true, std::vector<int>(9, 1));
    for (std::size_t length = 0; length < whole.size(); ++length) {
        const std::string message = loadError(folder, whole.substr(0, length));
        CHECK_MESSAGE(contains(message, "broken.ply: "), length, " bytes: ", message);
    }
}

TEST_CASE("chunks with bounds that are no numbers lose their splats alone") {
    const Folder folder;
    std::string bytes = compressed(257, 0u, kMiddle, 0u, kAllOnes);
    const std::size_t data = bytes.find("end_header\n") + 11;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(bytes.data() + data, &nan, sizeof(nan));
    LoadNotes notes;
    CHECK(loadScene(folder.write("a.ply", bytes), 0, &notes).size() == 1);
    CHECK(notes.skipped_not_finite == 256);
}

}  // namespace compressed_ply_format_test
