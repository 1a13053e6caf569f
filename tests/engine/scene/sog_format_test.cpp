// SOG: values worked out by hand in both versions and both wrappings, and everything that does not fit.
#include "engine/picture/webp.h"
#include "tests/engine/scene/sog_scenes.h"

TEST_SUITE_BEGIN("sog_format");

namespace sog_format_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

void checkContents(const Scene& scene, const LoadNotes& notes, bool version1) {
    REQUIRE(scene.size() == 8);
    CHECK(notes.skipped_not_finite + notes.skipped_zero_rotation == 0);
    for (std::size_t i = 0; i < 8; ++i) {
        const double x = -1.0 + 2.0 * (32.0 * static_cast<double>(i) * 256.0 / 65535.0);  // in the logarithmic space
        CHECK(scene.positions[i].x == doctest::Approx(std::copysign(std::expm1(std::abs(x)), x)));
        CHECK(scene.positions[i].y == doctest::Approx(-std::expm1(2.0)));
        CHECK(scene.positions[i].z == doctest::Approx(1.0));
        // The first of three growing scales is dropped.
        CHECK(scene.scales[i].x == doctest::Approx(std::exp(-8.0 + (10.0 * static_cast<double>(i) + 1) / 32.0)));
        CHECK(scene.scales[i].y == doctest::Approx(std::exp(-8.0 + (10.0 * static_cast<double>(i) + 2) / 32.0)));
        const double byte = static_cast<double>(255 * i / 8);
        CHECK(scene.opacities[i] ==
              doctest::Approx(version1 ? 1.0 / (1.0 + std::exp(10.0 - byte * 20.0 / 255.0)) : byte / 255.0).epsilon(1e-4));
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const auto level = static_cast<double>(20 * i + channel);
            CHECK(scene.sh[12 * i + channel] == doctest::Approx(-2.0 + level / 64.0).epsilon(1e-4));
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const double red = i % 2 == 0 ? 65.0 : 1.0;
            CHECK(scene.sh[12 * i + 3 * (k + 1) + 0] == doctest::Approx(-2.0 + red / 64.0).epsilon(1e-4));
            CHECK(scene.sh[12 * i + 3 * (k + 1) + 1] == doctest::Approx(-2.0 + static_cast<double>(k) / 64.0).epsilon(1e-4));
            CHECK(scene.sh[12 * i + 3 * (k + 1) + 2] == doctest::Approx(-2.0 + 100.0 / 64.0).epsilon(1e-4));
        }
    }
    CHECK(notes.three_scales);
    CHECK(notes.median_flatness == doctest::Approx(std::exp(-1.0 / 32.0)).epsilon(1e-4));
}

}  // namespace

TEST_CASE("WebP gives back the bytes that were stored") {
    std::vector<std::uint8_t> rgba;
    for (int i = 0; i < 4 * 35; ++i) { rgba.push_back(static_cast<std::uint8_t>(i * 37 + i / 7)); }
    const std::string file = makeWebp(5, 7, rgba);
    const auto bytes = std::as_bytes(std::span(file.data(), file.size()));
    CHECK(webpSize(bytes, "x") == glm::uvec2(5, 7));
    CHECK(decodeWebp(bytes, "x").rgba == rgba);
}

TEST_CASE("a WebP picture among other chunks is found") {
    const std::vector<std::uint8_t> rgba{1, 2, 3, 4, 5, 6, 7, 8};
    const std::string plain = makeWebp(2, 1, rgba);
    const std::string chunks = "VP8X" + littleWord(10) + std::string(1, '\x10') + std::string(3, '\0') + littleWord(1, 3) +
                               littleWord(0, 3) + "ICCP" + littleWord(3) + std::string(4, 'i') + plain.substr(12);
    const std::string file = "RIFF" + littleWord(static_cast<std::uint32_t>(chunks.size() + 4)) + "WEBP" + chunks;
    CHECK(decodeWebp(std::as_bytes(std::span(file.data(), file.size())), "x").rgba == rgba);
}

TEST_CASE("both versions mean what their tables say, in a directory, a bundle, and by their meta.json") {
    const Folder folder;
    for (const int version : {1, 2}) {
        CAPTURE(version);
        const SogText files = makeSog(version);
        const std::string source = writeSogFolder(folder, "scene", files);
        LoadNotes notes;
        const Scene scene = loadScene(source, 0, &notes);
        checkContents(scene, notes, version == 1);
        checkSameScene(scene, loadScene(source + "/meta.json"));
        for (const bool deflated : {false, true}) {
            checkSameScene(scene, loadScene(folder.write("bundle.sog", makeZip(files, deflated))));
            checkSameScene(scene, loadScene(folder.write("bundle.bin", makeZip(files, deflated, "within/"))));
        }
    }
}

TEST_CASE("rotations name their largest component") {
    const Folder folder;
    SogText files = makeSog();
    // Scales with the third the shortest keep the quaternion as it is stored.
    std::vector<std::uint8_t> scales(36, 9);
    for (std::size_t i = 2; i < 36; i += 4) { scales[i] = 0; }
    files["s.webp"] = makeWebp(3, 3, scales);
    const Scene scene = loadScene(writeSogFolder(folder, "scene", files));
    for (std::size_t i = 0; i < 8; ++i) {
        const glm::quat q = scene.rotations[i];
        const float stored[] = {q.w, q.x, q.y, q.z};
        for (std::size_t k = 0; k < 4; ++k) {
            CHECK(stored[k] == doctest::Approx(k == i % 4 ? 1.0 : (128.0 / 255.0 * 2 - 1) / std::sqrt(2.0)).epsilon(1e-4));
        }
    }
}

TEST_CASE("splats that use what is not there are skipped and counted") {
    const Folder folder;
    SogText files = makeSog();
    std::vector<std::uint8_t> quats(36, 128);
    for (std::size_t i = 0; i < 9; ++i) { quats[4 * i + 3] = i < 3 ? 251 : 252; }
    files["q.webp"] = makeWebp(3, 3, quats);
    files["meta.json"] = replaced(files["meta.json"], "\"count\":128", "\"count\":65");  // even splats use entry 65
    LoadNotes notes;
    const Scene scene = loadScene(writeSogFolder(folder, "scene", files), 0, &notes);
    CHECK(scene.size() == 3);  // 3, 5, 7
    CHECK(notes.skipped_not_finite == 4);
    CHECK(notes.skipped_zero_rotation == 1);
}

TEST_CASE("a key asks for antialiasing, by the name of old writers or of new ones") {
    const Folder folder;
    const auto antialiased = [&](const std::string& key) {
        SogText files = makeSog();
        files["meta.json"] = replaced(files["meta.json"], "{", "{" + key);
        return loadScene(writeSogFolder(folder, "said", files)).antialiased;
    };
    CHECK_FALSE(antialiased(""));
    CHECK(antialiased("\"antialias\":true,"));
    CHECK_FALSE(antialiased("\"antialias\":false,"));
    CHECK(antialiased("\"model\":\"antialiased\","));
    CHECK_FALSE(antialiased("\"model\":\"2dgs\","));
}

TEST_CASE("a scene that says that it is 2DGS is of discs") {
    const Folder folder;
    SogText files = makeSog();
    const Scene gaussians = loadScene(writeSogFolder(folder, "scene", files));
    files["meta.json"] = replaced(files["meta.json"], "{", "{\"model\":\"2dgs\",");
    LoadNotes notes;
    const Scene discs = loadScene(writeSogFolder(folder, "scene", files), 0, &notes);
    CHECK(gaussians.isGaussian3d());
    CHECK_FALSE(discs.isGaussian3d());
    CHECK_FALSE(notes.three_scales);
    CHECK(discs.scales == gaussians.scales);
    CHECK(discs.rotations == gaussians.rotations);
}

TEST_CASE("a Git LFS pointer in place of a picture is named as what it is") {
    const Folder folder;
    SogText files = makeSog();
    files["q.webp"] = "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n";
    CHECK(contains(loadError(writeSogFolder(folder, "pointer", files)), "q.webp: is a Git LFS pointer"));
}

TEST_CASE("a null in front of a codebook continues its row") {
    const Folder folder;
    SogText files = makeSog();
    files["meta.json"] = replaced(files["meta.json"], "[-8,", "[null,");
    LoadNotes notes;
    const Scene scene = loadScene(writeSogFolder(folder, "scene", files), 0, &notes);
    CHECK(scene.size() == 8);
    CHECK(notes.skipped_not_finite == 0);
}

TEST_CASE("a meta.json that does not fit is named with its key") {
    const Folder folder;
    const SogText good = makeSog();
    const auto errorWith = [&](const std::string& from, const std::string& to) {
        SogText files = good;
        files["meta.json"] = replaced(files["meta.json"], from, to);
        const std::string message = loadError(writeSogFolder(folder, "scene", files));
        CHECK(contains(message, "scene/"));
        CHECK(message.find('\n') == std::string::npos);
        return message;
    };
    CHECK(contains(errorWith("{\"version\"", "\"version\""), "meta.json: not JSON"));
    CHECK(contains(errorWith("\"version\":2", "\"version\":3"), "version: is 3, expected 1 or 2"));
    CHECK(contains(errorWith("\"count\":8", "\"count\":-8"), "count: is -8, expected a whole number"));
    CHECK(contains(errorWith("\"count\":8", "\"count\":8.5"), "count: is 8.5, expected a whole number"));
    CHECK(contains(errorWith("\"count\":8", "\"count\":\"8\""), "count: is string"));
    CHECK(contains(errorWith("\"count\":8", "\"count\":10"), "has 9 pixels, expected one for each of 10 splats"));
    CHECK(contains(errorWith("\"count\":8", "\"count\":9223372036854775808"), "has 9 pixels"));
    CHECK(contains(errorWith("\"count\":8", "\"count\":1e19"), "count: is 1e+19"));
    CHECK(contains(errorWith("\"mins\":[-1,-2,0]", "\"mins\":[-1,-2]"), "means.mins: has 2 entries, expected 3"));
    CHECK(contains(errorWith("\"mins\":[-1,-2,0]", "\"mins\":[-1,-2,\"0\"]"), "means.mins[2]: is string"));
    CHECK(contains(errorWith("\"mins\":[-1,-2,0]", "\"mins\":[-1,-2,1e200]"), "expected a float32 number"));
    CHECK(contains(errorWith("\"mins\":[-1,-2,0]", "\"mins\":[-1,-2,1e999]"), "not JSON"));
    CHECK(contains(errorWith("\"quats\":{\"files\":[\"q.webp\"]}", "\"quats\":[]"), "quats: is array, expected an object"));
    CHECK(contains(errorWith("\"quats\":", "\"quat\":"), "has no quats"));
    CHECK(contains(errorWith("\"codebook\":[-8,", "\"codebook\":[-8,1,"), "has 257 entries, expected 1 to 256"));
    CHECK(contains(errorWith("\"bands\":1", "\"bands\":4"), "shN.bands: is 4"));
    CHECK(contains(errorWith("\"bands\":1", "\"bands\":2"), "is 192 pixels wide"));
    CHECK(contains(errorWith("\"count\":128", "\"count\":129"), "room for 128 entries"));
    CHECK(contains(errorWith("q.webp", "absent.webp"), "absent.webp: no such file"));
    for (const char* path : {"../q.webp", "/etc/passwd", "", "..", "a\\\\b", "sub/q.webp", "q.webp\\u0000"}) {
        CHECK(contains(errorWith("q.webp", path), "expected a plain file name"));
    }
    CHECK(contains(errorWith("q.webp", "meta.json"), "not a WebP file"));
}

TEST_CASE("pictures of the wrong size or kind are named") {
    const Folder folder;
    const auto errorWith = [&](const std::string& name, const std::string& bytes) {
        SogText files = makeSog();
        files[name] = bytes;
        const std::string message = loadError(writeSogFolder(folder, "scene", files));
        CHECK(contains(message, "scene/" + name));
        CHECK(message.find('\n') == std::string::npos);
        return message;
    };
    CHECK(contains(errorWith("q.webp", makeWebp(4, 4, std::vector<std::uint8_t>(64, 255))), "is 4 x 4, expected 3 x 3 as l.webp"));
    CHECK(contains(errorWith("p.webp", makeWebp(191, 2, std::vector<std::uint8_t>(191 * 8, 255))),
                   "191 pixels wide, expected 192, 512 or 960"));
    CHECK(contains(errorWith("u.webp", "RIFF\x0c" + std::string(3, '\0') + "WEBPVP8 " + std::string(30, '\0')), "a lossy or moving WebP"));
    CHECK(contains(errorWith("u.webp", "not a picture at all, but long enough"), "not a WebP file"));
    const std::string whole = makeSog().at("u.webp");
    CHECK(contains(errorWith("u.webp", whole.substr(0, whole.size() - 2)), "bytes of its picture"));
}

TEST_CASE("pictures and archives that are there to fill the memory are refused") {
    const Folder folder;
    // 16383 x 16383 pixels stated in a few hundred bytes.
    SogText files = makeSog();
    for (const char* name : {"l.webp", "u.webp", "s.webp", "q.webp", "c.webp", "n.webp"}) {
        std::string& bytes = files[name];
        bytes[21] = static_cast<char>(0xff), bytes[22] = static_cast<char>(0xff), bytes[23] = static_cast<char>(0xff);
        bytes[24] = static_cast<char>(bytes[24] | 0x0f);
    }
    CHECK(contains(loadError(writeSogFolder(folder, "scene", files)), "expected fewer than 256 per byte"));
    // An entry of 20 MB of blanks in a few KB.
    files = makeSog();
    files["q.webp"] = std::string(20'000'000, ' ');
    CHECK(contains(loadError(folder.write("a.sog", makeZip(files, true))), "q.webp: is 20000000 bytes long, expected at most"));
    files = makeSog();
    files["meta.json"] += std::string(5'000'000, ' ');
    CHECK(contains(loadError(writeSogFolder(folder, "scene", files)), "meta.json: is 50"));
}

TEST_CASE("a bundle's files may come in any order, and among others") {
    const Folder folder;
    const SogText files = makeSog();
    std::vector<std::pair<std::string, std::string>> entries(files.begin(), files.end());
    const Scene scene = loadScene(writeSogFolder(folder, "scene", files));
    for (int turn = 0; turn < 8; ++turn) {
        std::ranges::rotate(entries, entries.begin() + 1);
        checkSameScene(scene, loadScene(folder.write("a.sog", makeZip(entries, turn % 2 == 0))));
        std::ranges::reverse(entries);
        checkSameScene(scene, loadScene(folder.write("a.sog", makeZip(entries, turn % 2 == 0, "in/a folder/"))));
    }
    // The scene is where the path of meta.json is shortest.
    entries.insert(entries.begin(), {"older/meta.json", "{}"});
    entries.emplace_back("__MACOSX/meta.json", "");
    entries.emplace_back("not-meta.json", "");
    checkSameScene(scene, loadScene(folder.write("a.sog", makeZip(entries))));
}

TEST_CASE("archives that are not whole are refused") {
    const Folder folder;
    const SogText files = makeSog();
    SogText less = files;
    less.erase("meta.json");
    CHECK(contains(loadError(folder.write("a.sog", makeZip(less))), "a.sog: a zip archive without a meta.json"));
    less = files;
    less.erase("q.webp");
    CHECK(contains(loadError(folder.write("a.sog", makeZip(less))), "a.sog: q.webp: not in the archive"));
    std::string changed = makeZip(files);
    changed[changed.find("RIFF") + 40] ^= 1;  // the checksum no longer fits
    CHECK(contains(loadError(folder.write("a.sog", changed)), "cannot be read"));
    CHECK(contains(loadError(folder.write("a.sog", std::string("PK\x03\x04") + std::string(100, 'x'))), "not a whole zip archive"));
    CHECK(contains(loadError(folder.file(".")), "is a directory"));
}

}  // namespace sog_format_test
