// SOG: values worked out by hand in both versions and both wrappings, and everything that is refused.
#include "tests/engine/files/streamed_scenes.h"

SUITE(sog_format) {

void checkContents(const Scene& scene, const LoadNotes& notes, bool version1) {
    REQUIRE(these(scene.size(), notes.skipped_not_finite, notes.skipped_zero_rotation) == these(8, 0, 0));
    const auto near = [](double value) { return doctest::Approx(value).epsilon(1e-4); };
    for (int i = 0; i < 8; ++i) {
        // In logarithmic space.
        const double x = -1.0 + 2.0 * (32.0 * i * 256.0 / 65535.0);
        CHECK(these(scene.positions[i].x, scene.positions[i].y, scene.positions[i].z) ==
              these(doctest::Approx(std::copysign(std::expm1(std::abs(x)), x)),
                    doctest::Approx(-std::expm1(2.0)), doctest::Approx(1.0)));
        // The first of three growing scales is dropped.
        CHECK(these(scene.scales[i].x, scene.scales[i].y) ==
              these(doctest::Approx(std::exp(-8.0 + (10.0 * i + 1) / 32.0)),
                    doctest::Approx(std::exp(-8.0 + (10.0 * i + 2) / 32.0))));
        const double byte = 255 * i / 8;
        CHECK(scene.opacities[i] ==
              near(version1 ? 1.0 / (1.0 + std::exp(10.0 - byte * 20.0 / 255.0)) : byte / 255.0));
        const float* sh = scene.sh.data() + 12 * i;
        for (int channel = 0; channel < 3; ++channel) {
            CHECK(sh[channel] == near(-2.0 + (20 * i + channel) / 64.0));
        }
        for (int k = 0; k < 3; ++k) {
            const double red = i % 2 == 0 ? 65.0 : 1.0;
            CHECK(these(sh[3 * k + 3], sh[3 * k + 4], sh[3 * k + 5]) ==
                  these(near(-2.0 + red / 64.0), near(-2.0 + k / 64.0), near(-2.0 + 100.0 / 64.0)));
        }
    }
    CHECK(these(notes.three_scales, notes.median_flatness) == these(true, near(std::exp(-1.0 / 32.0))));
}

TEST_CASE("a WebP picture among other chunks is found, and gives back the bytes that were stored") {
    std::mt19937 random(3);
    for (const glm::uvec2 size_px : {glm::uvec2(1, 1), glm::uvec2(5, 7), glm::uvec2(192, 7)}) {
        std::vector<std::uint8_t> rgba;
        for (std::uint32_t i = 0; i < 4 * size_px.x * size_px.y; ++i) {
            rgba.push_back(static_cast<std::uint8_t>(random()));
        }
        // Colours under an alpha of zero are data, too.
        for (std::size_t i = 3; i < rgba.size(); i += 8) { rgba[i] = 0; }
        const std::string plain = makeWebp(size_px.x, size_px.y, rgba);
        const std::string chunks = "WEBPVP8X" + littleWord(10) + littleWord(0x10) +
                                   littleWord(size_px.x - 1, 3) + littleWord(size_px.y - 1, 3) + "ICCP" +
                                   littleWord(3) + std::string(4, 'i') + plain.substr(12);
        for (const std::string& file : {plain, "RIFF" + littleWord(chunks.size()) + chunks}) {
            const auto bytes = std::as_bytes(std::span(file.data(), file.size()));
            CHECK(webpSize(bytes, "x") == size_px);
            CHECK(decodeWebp(bytes, "x").rgba == rgba);
        }
    }
}

TEST_CASE_FIXTURE(InFolder, "both versions mean what their tables say, in whatever they are packed") {
    for (const int version : {1, 2}) {
        CAPTURE(version);
        const SogText files = makeSog(version);
        const std::string source = writeSogFolder(folder, "scene", files);
        const auto [notes, scene] = readScene(source);
        checkContents(scene, notes, version == 1);
        checkSameScene(scene, loadScene(source + "/meta.json"));
        for (const bool deflated : {false, true}) {
            for (const char* within : {"", "within/", ".\\within\\"}) {
                checkSameScene(scene, loadScene(folder.write("bundle", makeZip(files, deflated, within))));
            }
        }
        // As some writers make them: a byte order mark, a number with a decimal point, Windows paths.
        SogText odd = files;
        std::string& meta = odd["meta.json"];
        meta = "\xef\xbb\xbf" +
               replaced(replaced(meta, "\"q.webp\"", R"(".\\q.webp")"), "\"l.webp\"", "\"./l.webp\"");
        meta = version == 2 ? replaced(meta, "\"count\":8", "\"count\":8.0")
                            : replaced(meta, "[8,3]", "[8.0,3.0]");
        checkSameScene(scene, loadScene(writeSogFolder(folder, "odd", odd)));
        checkSameScene(scene, loadScene(folder.file("odd/meta.json")));
    }
}

TEST_CASE_FIXTURE(InFolder, "rotations name their largest component; broken splats are counted") {
    SogText files = makeSog();
    // If the third scale is the shortest, the quaternion stays as stored.
    files["s.webp"] = makeNine([](int) { return std::array{9, 9, 0, 9}; });
    const Scene scene = loadScene(writeSogFolder(folder, "scene", files));
    for (int i = 0; i < 8; ++i) {
        const glm::quat q = scene.rotations[i];
        const float stored[] = {q.w, q.x, q.y, q.z};
        for (int k = 0; k < 4; ++k) {
            CHECK(stored[k] ==
                  doctest::Approx(k == i % 4 ? 1.0 : (128.0 / 255.0 * 2 - 1) / std::sqrt(2.0)).epsilon(1e-4));
        }
    }
    files["q.webp"] = makeNine([](int i) { return std::array{128, 128, 128, i < 3 ? 251 : 252}; });
    // Even splats use entry 65.
    files["meta.json"] = replaced(files["meta.json"], "\"count\":128", "\"count\":65");
    const auto [notes, kept] = readScene(writeSogFolder(folder, "scene", files));  // splats 3, 5 and 7
    CHECK(these(kept.size(), notes.skipped_not_finite, notes.skipped_zero_rotation) == these(3, 4, 1));
}

TEST_CASE_FIXTURE(InFolder, "a key asks for antialiasing, or says that the scene is of discs") {
    LoadNotes notes;
    const auto loadWith = [&](const std::string& key) {
        SogText files = makeSog();
        files["meta.json"] = replaced(files["meta.json"], "{", "{" + key);
        return loadScene(writeSogFolder(folder, "said", files), 0, &notes);
    };
    const Scene gaussians = loadWith("");
    CHECK(these(gaussians.isGaussian3d(), gaussians.antialiased) == these(true, false));
    for (const auto& [key, asks] : {std::pair("\"antialias\":true,", true),
                                    {"\"antialias\":false,", false},
                                    {"\"model\":\"antialiased\",", true}}) {
        CHECK(loadWith(key).antialiased == asks);
    }
    // A streamed scene is antialiased if one of its chunks is.
    const std::string streamed = writeStreamed(folder, "streamed", makeLodMeta());
    CHECK_FALSE(loadScene(streamed).antialiased);
    SogText chunk = makeChunk(2);
    chunk["meta.json"] = replaced(chunk["meta.json"], "{", "{\"antialias\":true,");
    (void)writeSogFolder(folder, "streamed/a", chunk);
    CHECK(loadScene(streamed).antialiased);
    const Scene discs = loadWith("\"model\":\"2dgs\",");
    CHECK(these(discs.antialiased, discs.isGaussian3d(), notes.three_scales) == these(false, false, false));
    CHECK(these(discs.scales, discs.rotations) == these(gaussians.scales, gaussians.rotations));
}

SCRIPT(sog_format, "engine/files/sog_format") {
    const Folder folder;
    SogText files = makeSog();
    runFaults(makeSog().at("meta.json"), [&](const std::string& broken) {
        files["meta.json"] = broken;
        const std::string source = writeSogFolder(folder, "scene", files), message = loadError(source);
        if (message.empty()) {
            const auto [notes, scene] = readScene(source);
            CHECK(these(scene.size(), notes.skipped_not_finite) == these(8, 0));
        } else {
            CHECK(contains(message, "scene/"));
        }
        return message;
    });
}

TEST_CASE_FIXTURE(InFolder, "pictures of the wrong size or kind, and floods of the memory, are refused") {
    SogText files = makeSog();
    const std::vector<std::uint8_t> bytes(191 * 8, 255);
    const std::string whole = files.at("u.webp");
    const std::tuple<std::string, std::string, std::string> faults[]{
        {"q.webp", makeWebp(4, 4, std::vector<std::uint8_t>(64, 255)), "is 4 x 4, expected 3 x 3 as l.webp"},
        {"q.webp", "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n",
         "is a Git LFS pointer"},
        {"p.webp", makeWebp(191, 2, bytes), "191 pixels wide, expected 192, 512 or 960"},
        {"u.webp", "RIFF\x0c" + std::string(3, '\0') + "WEBPVP8 " + std::string(30, '\0'),
         "a lossy or moving WebP"},
        {"u.webp", "not a picture at all, but long enough", "not a WebP file"},
        {"u.webp", whole.substr(0, whole.size() - 2), "bytes of its picture"},
        {"meta.json", files.at("meta.json") + std::string(5'000'000, ' '), "meta.json: is 50"}};
    for (const auto& [name, content, message] : faults) {
        SogText broken = files;
        broken[name] = content;
        const std::string error = loadError(writeSogFolder(folder, "scene", broken));
        CHECK(contains(error, "scene/" + name));
        CHECK_MESSAGE(contains(error, message), error);
    }
    // An entry of 20 MB of blanks, packed into a few KB.
    SogText blank = files;
    blank["q.webp"] = std::string(20'000'000, ' ');
    checkError("q.webp: is 20000000 bytes long, expected at most",
               folder.write("a.sog", makeZip(blank, true)));
    // A few hundred bytes that claim to hold 16383 x 16383 pixels.
    for (const char* name : {"l.webp", "u.webp", "s.webp", "q.webp", "c.webp", "n.webp"}) {
        std::string& picture = files[name];
        picture.replace(21, 3, "\xff\xff\xff");
        picture[24] = static_cast<char>(picture[24] | 0x0f);
    }
    checkError("expected fewer than 256 per byte", writeSogFolder(folder, "scene", files));
}

TEST_CASE_FIXTURE(InFolder, "a bundle's files may come in any order, and among others") {
    const SogText files = makeSog();
    std::vector<std::pair<std::string, std::string>> entries(files.begin(), files.end());
    const Scene scene = loadScene(writeSogFolder(folder, "scene", files));
    const auto checkZip = [&](const std::string& zip) {
        checkSameScene(scene, loadScene(folder.write("a.sog", zip)));
    };
    for (int turn = 0; turn < 8; ++turn) {
        std::ranges::rotate(entries, entries.begin() + 1);
        checkZip(makeZip(entries, turn % 2 == 0));
        std::ranges::reverse(entries);
        checkZip(makeZip(entries, turn % 2 == 0, "in/a folder/"));
    }
    // The scene is where the path of meta.json is shortest.
    entries.insert(entries.begin(), {"older/meta.json", "{}"});
    entries.insert(entries.end(), {{"__MACOSX/meta.json", ""}, {"not-meta.json", ""}});
    checkZip(makeZip(entries));
    for (const auto& [missing, message] :
         {std::pair("meta.json", "files without a scene or the meta.json of one"),
          {"q.webp", "a.sog: q.webp: not in the archive"}}) {
        SogText less = files;
        less.erase(missing);
        checkError(message, folder.write("a.sog", makeZip(less)));
    }
}

}  // SUITE(sog_format)
