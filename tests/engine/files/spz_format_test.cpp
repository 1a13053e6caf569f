// SPZ: values computed by hand, what survives writing and reading back, and what is refused.
#include "engine/files/spz.h"
#include "engine/twin/harmonics.h"
#include "tests/engine/files/spz_files.h"
#include "tests/engine/scene/scene_measures.h"

SUITE(spz_format) {

Scene loadBytes(const Folder& folder, const std::string& bytes, LoadNotes* notes = nullptr) {
    return loadScene(folder.write("scene.bin", bytes), 0, notes);
}

SpzText makeVersion4(int flags = 0) {
    SpzText spz = makeSpz(3);
    spz.version = 4, spz.flags = flags;
    return spz;
}

TEST_CASE_FIXTURE(InFolder, "both versions give what their bytes mean, in axes right, down, forward") {
    for (const std::uint32_t version : {2u, 3u}) {
        CAPTURE(version);
        LoadNotes notes;
        const Scene scene = loadBytes(folder, gzip(makeSpz(version).bytes()), &notes);
        REQUIRE(these(scene.size(), scene.sh_degree) == these(2, 1));
        // 8 fractional bits; y and z turned
        CHECK(scene.positions ==
              std::vector<glm::vec3>{{1.0f, 2.0f, -0.5f}, {0.0f, -1.0f / 256.0f, 1.0f / 256.0f}});
        CHECK(these(scene.opacities[0], scene.opacities[1], scene.sh[0], scene.sh[1], scene.sh[2]) ==
              these(1.0f, doctest::Approx(0.2), doctest::Approx(-0.5 / 0.15), doctest::Approx(0.5 / 0.15),
                    doctest::Approx((128.0 / 255.0 - 0.5) / 0.15)));
        // Scales exp(0), exp(1), exp(-8); then exp(-10), exp(5.9375), exp(0): z and x are dropped.
        CHECK(these(scene.scales[0].x, scene.scales[0].y, scene.scales[1].x, scene.scales[1].y) ==
              these(doctest::Approx(1.0), doctest::Approx(std::exp(1.0)), doctest::Approx(std::exp(5.9375)),
                    doctest::Approx(1.0)));
        for (int i = 0; i < 9; ++i) {  // y and z change sign, x does not
            const float stored = static_cast<float>(i) / 32.0f;
            CHECK(scene.sh[3 + i] == (i < 6 ? 0.0f - stored : stored));
        }
        CHECK(std::abs(scene.rotations[0].w) == doctest::Approx(1.0).epsilon(1e-4));
        // The normal of the second splat is its own x axis, rotated.
        const glm::vec3 normal = scene.rotations[1] * glm::vec3(0, 0, 1);
        const float x = version == 2 ? 1.0f : -256.0f / 511.0f * 0.70710678f;
        const glm::vec3 stored_axis =
            glm::normalize(version == 2 ? glm::quat(0, 1, 0, 0) : glm::quat(0, x, 0, std::sqrt(1 - x * x))) *
            glm::vec3(1, 0, 0);
        const glm::vec3 expected(stored_axis.x, -stored_axis.y, -stored_axis.z);
        CHECK(std::abs(glm::dot(normal, expected)) == doctest::Approx(1.0).epsilon(1e-4));
        CHECK(notes.three_scales);
    }
}

TEST_CASE_FIXTURE(InFolder, "every version is read without gzip, with extensions, whatever follows") {
    const std::string after = "and whatever follows";
    for (const std::uint32_t version : {2u, 3u}) {
        const std::string bytes = makeSpz(version).bytes();
        checkSameScene(loadBytes(folder, gzip(bytes)), loadBytes(folder, bytes));
        checkSameScene(loadBytes(folder, gzip(bytes)), loadBytes(folder, bytes + after));
    }
    const Scene scene = loadBytes(folder, gzip(makeSpz(3).bytes()));
    checkSameScene(scene, loadBytes(folder, makeSpzContainer(makeVersion4())));
    checkSameScene(scene, loadBytes(folder, makeSpzContainer(makeVersion4()) + after));
    SpzText spz = makeVersion4(2);
    checkSameScene(scene, loadBytes(folder, makeSpzContainer(spz, "records of an extension")));
    spz.sh_degree = 0, spz.sh.clear();
    CHECK(loadBytes(folder, makeSpzContainer(spz)).positions == scene.positions);
    spz = makeSpz(3);
    spz.sh_degree = 4, spz.flags = 3;
    spz.sh.assign(2 * 72, 130);
    LoadNotes notes;
    const Scene larger = loadBytes(folder, gzip(spz.bytes() + "records of an extension"), &notes);
    CHECK(these(larger.sh_degree, larger.antialiased) == these(3, true));
    REQUIRE_FALSE(notes.lines.empty());
    CHECK(contains(notes.lines.back(), "degree 4"));
}

TEST_CASE_FIXTURE(InFolder, "the axes that an extension names are honoured: places, ellipsoids and colours") {
    // Right, left, down, up, front and back, in axes that point right, down and front.
    const std::map<char, glm::dvec3> directions{{'R', {1, 0, 0}},  {'L', {-1, 0, 0}}, {'D', {0, 1, 0}},
                                                {'U', {0, -1, 0}}, {'F', {0, 0, 1}},  {'B', {0, 0, -1}}};
    const std::string names[] = {"",    "LDB", "RDB", "LUB", "RUB", "LDF", "RDF", "LUF", "RUF",
                                 "LBD", "RBD", "LBU", "RBU", "LFD", "RFD", "LFU", "RFU"};
    SpzText spz = makeVersion4(2);
    spz.sh_degree = 3;
    spz.sh.clear();
    for (int i = 0; i < 90; ++i) { spz.sh.push_back(128 + (i * 37 % 100) - 50); }
    spz.rotations = {0x12, 0x7a, 0x55, 0xc3, 0xf1, 0x02, 0xa8, 0x41};
    // As stored: RDF changes nothing.
    const Scene stored = loadBytes(folder, makeSpzContainer(spz, spzAxesRecord(6)));
    CHECK(stored.positions[0] == glm::vec3(1.0f, -2.0f, 0.5f));
    const glm::dvec3 direction = glm::normalize(glm::dvec3(0.3, -0.5, 0.8));
    for (int system = 1; system <= 16; ++system) {
        const std::string& name = names[system];
        CAPTURE(name);
        const glm::dmat3 ours_from_file(directions.at(name[0]), directions.at(name[1]),
                                        directions.at(name[2]));
        LoadNotes notes;
        const Scene scene = loadBytes(
            folder, makeSpzContainer(spz, spzRecord(7, "someone else's") + spzAxesRecord(system)), &notes);
        CHECK(contains(notes.axes, "-handed (named by the file)"));
        CHECK(scene.vertical_axis == 1);
        CHECK(contains(notes.axes, glm::determinant(ours_from_file) > 0.0 ? "right-handed" : "left-handed"));
        for (std::size_t i = 0; i < 2; ++i) {
            CHECK(glm::distance(glm::dvec3(scene.positions[i]),
                                ours_from_file * glm::dvec3(stored.positions[i])) < 1e-6);
            const glm::dmat3 expected =
                ours_from_file * covarianceOf(stored, i) * glm::transpose(ours_from_file);
            const glm::dvec3 scales(stored.scales[i], stored.thicknesses[i]);
            CHECK(largest(expected - covarianceOf(scene, i)) < 1e-5 * glm::dot(scales, scales));
            const glm::dvec3 before = reference::evaluateHarmonics(stored.sh.data() + 48 * i, 3, direction),
                             after = reference::evaluateHarmonics(scene.sh.data() + 48 * i, 3,
                                                                  ours_from_file * direction);
            CHECK(glm::distance(before, after) < 1e-5);
        }
    }
}

TEST_CASE_FIXTURE(InFolder, "files that name no axes, or unknown ones, are right, up, back") {
    SpzText spz = makeSpz(3);
    LoadNotes notes;
    const Scene usual = loadBytes(folder, gzip(spz.bytes()), &notes);
    CHECK(notes.axes == "x right, y up, z back; right-handed (SPZ's own: the file names none)");
    CHECK(usual.vertical_axis == -1);
    spz.flags = 2;
    checkSameScene(usual, loadBytes(folder, gzip(spz.bytes() + spzAxesRecord(4))));
    CHECK(loadBytes(folder, gzip(spz.bytes() + spzAxesRecord(6))).positions[0] ==
          glm::vec3(1.0f, -2.0f, 0.5f));
    spz.version = 4;
    for (const std::string& records :
         {std::string(), spzAxesRecord(0), spzAxesRecord(4), spzRecord(0xadbe0003u, "abc"),
          spzAxesRecord(6).substr(0, 10), spzRecord(0xadbe0003u, "").substr(0, 4) + std::string(8, '\xff')}) {
        checkSameScene(usual, loadBytes(folder, makeSpzContainer(spz, records), &notes));
        CHECK(notes.lines.empty());
    }
    checkSameScene(usual, loadBytes(folder, makeSpzContainer(spz, spzAxesRecord(17)), &notes));
    checkSays(notes.lines,
              "names axes 17, which are not known; taken as x right, y up, z back; right-handed");
    (void)loadBytes(folder, makeSpzContainer(spz, spzAxesRecord(16)), &notes);
    CHECK(notes.axes == "x right, y front, z up; right-handed (named by the file)");
    spz.flags = 0;  // without the flag, these are not records
    checkSameScene(usual, loadBytes(folder, makeSpzContainer(spz, spzAxesRecord(6))));
}

TEST_CASE_FIXTURE(InFolder, "writing and reading back keeps every attribute within its quantum") {
    const auto again = [&](const Scene& scene) {
        writeSpz(scene, folder.file("a.spz"));
        CHECK(folder.fileCount() == 1);
        return loadScene(folder.file("a.spz"));
    };
    for (const int degree : {0, 1, 2, 3}) {
        const Scene scene = randomScene(degree, 5000, false, 0.99f), back = again(scene);
        REQUIRE(these(back.size(), back.sh_degree) == these(scene.size(), degree));
        float position = 0.0f, scale = 0.0f, opacity = 0.0f, turn = 0.0f;
        for (std::size_t i = 0; i < scene.size(); ++i) {
            position = std::max(position, glm::distance(scene.positions[i], back.positions[i]));
            const glm::vec2 grown = glm::abs(glm::log(scene.scales[i] / back.scales[i]));
            scale = std::max({scale, grown.x, grown.y});
            opacity = std::max(opacity, std::abs(scene.opacities[i] - back.opacities[i]));
            turn = std::max(turn, 1.0f - std::abs(glm::dot(scene.rotations[i], back.rotations[i])));
        }
        CHECK(position < 1.5f / 65536.0f);  // half a step of 2^-16 along each axis
        CHECK(scale < 0.5f / 16.0f + 1e-4f);
        CHECK(opacity < 0.5f / 255.0f + 1e-5f);
        CHECK(turn < 3e-6f);  // half a step of 1/(511 sqrt(2)) in three components
        const auto [colour, sh] = shDifferences(scene, back);
        CHECK(colour < 0.5f / 255.0f / 0.15f + 1e-4f);
        CHECK(sh <= 0.5f / 128.0f + 1e-5f);
        // What was read does not change when it is written again, except that if two rotation components are
        // almost equal in size, the other may be the one not stored.
        const Scene second = again(back);
        CHECK(these(second.positions, second.scales, second.opacities, second.sh) ==
              these(back.positions, back.scales, back.opacities, back.sh));
    }
    CHECK(again({}).size() == 0);
    for (const bool antialiased : {false, true}) {
        Scene gaussians = randomScene(0, 10, true);
        gaussians.antialiased = antialiased;
        CHECK(again(gaussians).antialiased == antialiased);
    }
}

TEST_CASE_FIXTURE(InFolder, "large scenes get fewer fractional bits, and those beyond the format none") {
    Scene scene = randomScene(0, 2);
    scene.positions[0] = {100000.0f + 1.0f / 64.0f, 0.0f, 0.0f};  // with 6 fractional bits
    writeSpz(scene, folder.file("a.spz"));
    CHECK(loadScene(folder.file("a.spz")).positions[0] == scene.positions[0]);
    scene.positions[0].x = 1e9f;
    CHECK_THROWS_AS(writeSpz(scene, folder.file("b.spz")), Error);
    CHECK(folder.fileCount() == 1);
}

TEST_CASE_FIXTURE(InFolder, "whoever waits for a large scene hears how much is unpacked, and may stop it") {
    constexpr std::uint32_t kSplats = 300'000;
    SpzText spz;
    spz.splats = kSplats;
    // A stream that compresses too well is refused.
    for (std::uint32_t i = 0; i < 3 * kSplats; ++i) {
        spz.positions.push_back(static_cast<int>(i * 2654435761u >> 8));
    }
    spz.alphas.assign(kSplats, 200);
    spz.rotations.assign(4 * kSplats, 200);
    spz.colours = spz.scales = std::vector<int>(3 * kSplats, 128);
    SpzText later = spz;
    later.version = 4;
    for (const std::string& bytes : {gzip(spz.bytes()), spz.bytes(), makeSpzContainer(later)}) {
        bool hears_of_unpacking = false;
        checkProgress(4, [&](const Progress& progress) {
            const Scene scene = loadScene(folder.write("scene.bin", bytes), 0, nullptr, [&](double share) {
                hears_of_unpacking = hears_of_unpacking || (share > 0.0 && share < 0.5);
                progress(share);
            });
            REQUIRE(scene.size() == kSplats);
        });
        CHECK(hears_of_unpacking);
    }
}

SCRIPT(spz_format, "engine/files/spz_format") {
    const Folder folder;
    runFaults(makeSpz(3).bytes(), [&](const std::string& broken) {
        const std::string message = loadError(folder, gzip(broken));
        CHECK(contains(message, "broken.ply: "));
        return message;
    });
}

TEST_CASE_FIXTURE(InFolder, "an SPZ that does not fit is named") {
    SpzText spz = makeSpz(3);
    checkError("SPZ version 5 without gzip, expected 2 or 3, or 4 without gzip", folder,
               makeSpzContainer(makeSpz(5)));
    checkError("header: ends after 4 bytes", folder, gzip("NGSP"));
    checkError("not a scene file", folder, gzip("something else in gzip"));
    const std::string packed = gzip(spz.bytes());
    for (std::size_t at = 10; at < packed.size(); ++at) {  // some bytes of gzip's own header have no meaning
        std::string changed = packed;
        changed[at] = static_cast<char>(changed[at] ^ 0x10);
        checkError("broken.ply: ", folder, changed);  // by the checksum, if nothing else
    }
    // Streams made to fill the memory.
    spz.splats = 200'000;
    checkError("expected fewer than 256 per byte", folder,
               gzip(spz.bytes() + std::string(5'800'000, '\x7f')));
    checkError("and more behind the last splat", folder,
               gzip(makeSpz(3).bytes() + std::string(5'800'000, '\0')));
}

TEST_CASE_FIXTURE(InFolder, "a container that does not fit is named") {
    const std::string good = makeSpzContainer(makeVersion4()), most(4, '\xff');
    const std::tuple<std::size_t, std::string, const char*> faults[]{
        {15, "\5", "5 streams, expected 6"},
        {15, "\xff", "255 streams"},
        {16, "\x1f", "the table of streams is at byte 31"},
        {16, most, "the table of streams is at byte 4294967295"},
        {8, "\3", "stream 0: 18 bytes, expected 27"},
        {8, most, "expected fewer than 256 per byte"},
        {32, most + "\xff\xff\xff\x7f", "bytes are left of 9223372036854775807"},
        {32 + 96, "xxxx", "stream 0: broken"}};
    for (const auto& [at, bytes, message] : faults) {
        std::string broken = good;
        checkError(message, folder, broken.replace(at, bytes.size(), bytes));
    }
}

}  // SUITE(spz_format)
