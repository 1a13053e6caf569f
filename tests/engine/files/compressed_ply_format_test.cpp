// PlayCanvas compressed PLY: values worked out by hand, a real file, and headers that do not fit their data.
#include "tests/engine/files/hostile_scenes.h"
#include "tests/shared_data.h"

SUITE(compressed_ply_format) {

double shown(const Scene& scene, std::size_t at) { return 0.5 + 0.28209479 * scene.sh[at]; }

TEST_CASE_FIXTURE(InFolder, "words lie between the bounds of their chunk") {
    // x: all 11 bits set; y: none of 10; z: all of 11.
    const CompressedPly packed{.splats = 257, .position = 0x7ffu << 21 | 0x7ffu, .colour = 0xff0080ffu};
    const auto [notes, scene] = readScene(folder.write("a.ply", packed.bytes()));
    REQUIRE(scene.size() == 257);
    CHECK(these(scene.positions[0], scene.positions[255], scene.positions[256]) ==
          these(glm::vec3(1.0f, -2.0f, 8.0f), glm::vec3(1.0f, -2.0f, 8.0f), glm::vec3(2.0f, -2.0f, 8.0f)));
    // Scales exp(-6), exp(-5), exp(-4): the first is dropped, and the other two follow.
    CHECK(these(scene.scales[0].x, scene.scales[0].y, scene.opacities[0]) ==
          these(doctest::Approx(std::exp(-5.0)), doctest::Approx(std::exp(-4.0)), 1.0f));
    // Colours between bounds: r is the maximum of -0.5 to 1.5, g the minimum of 0 to 1, b 128/255 of 0 to 2.
    CHECK(these(shown(scene, 0), shown(scene, 1), shown(scene, 2)) ==
          these(doctest::Approx(1.5), doctest::Approx(0.0), doctest::Approx(256.0 / 255.0)));
    CHECK(these(notes.three_scales, notes.median_flatness, notes.sh_degree_in_file) ==
          these(true, doctest::Approx(std::exp(-1.0)), 0));

    // Colours without bounds go from 0 to 1; an opacity of zero stays zero.
    const Scene plain = loadScene(
        folder.write("a.ply", CompressedPly{.colour = 0xff008000u, .has_colour_bounds = false}.bytes()));
    CHECK(these(shown(plain, 0), shown(plain, 1), shown(plain, 2)) ==
          these(doctest::Approx(1.0), doctest::Approx(0.0), doctest::Approx(128.0 / 255.0)));
    CHECK(plain.opacities[0] == 0.0f);
}

TEST_CASE_FIXTURE(InFolder, "rotation words name their largest component") {
    for (std::uint32_t largest = 0; largest < 4; ++largest) {
        // With scales of -2, -1 and -4, z stays the shortest, so the quaternion is the stored one.
        const CompressedPly packed{.rotation = largest << 30 | CompressedPly().rotation,
                                   .scale = 0x7ffu << 21 | 0x3ffu << 11};
        const glm::quat q = loadScene(folder.write("a.ply", packed.bytes())).rotations[0];
        const float stored[] = {q.w, q.x, q.y, q.z};
        for (std::uint32_t i = 0; i < 4; ++i) {
            CHECK(stored[i] ==
                  doctest::Approx(i == largest ? 1.0 : 0.5 / 1023 * std::sqrt(2.0)).epsilon(1e-4));
        }
    }
}

TEST_CASE_FIXTURE(InFolder, "SH bytes stand for the middle of their interval within -4 to 4") {
    std::vector<int> rest(24, 0);
    rest[1] = 255, rest[8] = 64, rest[23] = 200;  // red of coefficient 2, green of 1, blue of 8
    const Scene scene = loadScene(folder.write("a.ply", CompressedPly{.splats = 3, .rest = rest}.bytes()));
    REQUIRE(scene.sh_degree == 2);
    const float* sh = scene.sh.data() + 2 * 27;
    CHECK(these(sh[3 * 1 + 0], sh[3 * 2 + 0], sh[3 * 1 + 1], sh[3 * 8 + 2]) ==
          these(-4.0f, 4.0f, 8.0f * (64.5f / 256.0f - 0.5f), 8.0f * (200.5f / 256.0f - 0.5f)));
}

TEST_CASE("a real compressed PLY gives the values another decoder gave" * needsSharedData()) {
    const auto data = sharedData();
    if (!data) { return; }
    const auto [notes, scene] = readScene((*data / "guitar/guitar.compressed.ply").string());
    REQUIRE(scene.size() == 90854);
    CHECK(notes.skipped_not_finite + notes.skipped_zero_rotation == 0);
    CHECK(glm::distance(scene.positions[300], {-0.4802096f, -4.1130406f, -0.0136646f}) < 1e-6f);
    const auto [least, most] = std::minmax(scene.scales[300].x, scene.scales[300].y);
    CHECK(these(least, most, scene.opacities[300], shown(scene, 3 * 300)) ==
          these(doctest::Approx(0.0022113659), doctest::Approx(0.0109744594), doctest::Approx(0.9450980),
                doctest::Approx(0.0945961)));
    CHECK(glm::distance(scene.positions[90853], {0.4553929f, -0.6415753f, 0.7538047f}) < 1e-6f);
    CHECK(notes.median_flatness == between(0.0, 1.0));
}

SCRIPT(compressed_ply_format, "engine/files/compressed_ply_format") {
    const Folder folder;
    runFaults(CompressedPly{.splats = 300, .rest = std::vector<int>(9, 1)}.bytes(),
              [&](const std::string& broken) { return loadError(folder, broken); });
}

TEST_CASE_FIXTURE(InFolder, "a comment asks for antialiasing here, too; absurd counts are refused") {
    const std::string good = CompressedPly{.splats = 300, .rest = std::vector<int>(9, 1)}.bytes();
    CHECK_FALSE(loadScene(folder.write("plain.ply", good)).antialiased);
    const std::string said = replaced(good, "comment made for a test", "comment SplatRenderMode: mip");
    CHECK(loadScene(folder.write("said.ply", said)).antialiased);
    std::string many = replaced(good, "element chunk 2", "element chunk 72057594037927936");
    many = replaced(replaced(many, "element vertex 300", "element vertex 18446744073709551615"),
                    "element sh 300", "element sh 18446744073709551615");
    checkError("bytes are left for 72057594037927936 chunks", folder, many);
}

TEST_CASE_FIXTURE(InFolder, "chunks with bounds that are no numbers lose their splats alone") {
    std::string bytes = CompressedPly{.splats = 257}.bytes();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(bytes.data() + bytes.find("end_header\n") + 11, &nan, sizeof(nan));
    const auto [notes, scene] = readScene(folder.write("a.ply", bytes));
    CHECK(these(scene.size(), notes.skipped_not_finite) == these(1, 256));
}

}  // SUITE(compressed_ply_format)
