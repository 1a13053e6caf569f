// Packed scenes: in gzip, or alone in a zip archive.
#include "engine/files/packed_scene.h"
#include "tests/engine/files/gltf_files.h"
#include "tests/engine/files/sog_scenes.h"
#include "tests/engine/files/spz_files.h"

SUITE(packed_scene) {

TEST_CASE_FIXTURE(InFolder, "a scene within gzip is the scene itself, in one stream or several") {
    const std::string ply = makePly(9).bytes();
    const Scene plain = loadScene(folder.write("plain.ply", ply));
    for (const std::string& packed : {gzip(ply), gzip(ply.substr(0, 100)) + gzip(ply.substr(100)),
                                      gzip(ply) + gzip(""), gzip(ply) + std::string(100'000, '\0')}) {
        const auto [notes, scene] = readScene(folder.write("a.ply.gz", packed));
        checkSameScene(plain, scene);
        CHECK(these(scene.name, notes.lines.empty(), formatOfFile(scene.name)) ==
              these(folder.file("a.ply.gz"), true, formatOfFile(plain.name)));
        checkProgress(3, [&, &path = scene.name](const Progress& progress) {
            (void)loadScene(path, 0, nullptr, progress);
        });
    }
    for (const auto& [bytes, message] :
         {std::pair(gzip(ply).substr(0, 300), "b.gz: ends within its gzip stream"),
          {gzip(ply) + "more", "b.gz: broken gzip stream"},
          {gzip(gzip(ply)), "b.gz: is packed twice"},
          {gzip(std::string(5'000'000, ' ')), "expected at most 256 times as many as packed"},
          {gzip("no scene"), "b.gz: not a scene file of a known format"}}) {
        checkError(message, folder.write("b.gz", bytes));
    }
}

TEST_CASE_FIXTURE(InFolder, "only the first 64 KiB of what is packed tell its format") {
    PlyText large = makePly();
    std::mt19937 random(1);
    large.resize(8000);
    for (Column& column : large.columns) {
        for (double& value : column.values) { value = static_cast<double>(random()) / 4e9; }
    }
    const std::string ply = large.bytes(), whole = gzip(ply), cut = whole.substr(0, whole.size() / 2);
    REQUIRE(cut.size() > 3 * 65536);
    fs::create_directory(folder.file("in"));
    const std::string format = formatOfFile(folder.write("in/a.ply", ply));
    CHECK(formatOfFile(folder.write("a.ply.gz", cut)) == format);
    CHECK(formatOfFile(folder.write(
              "a.ply.gz", gzip(ply.substr(0, 100)) + gzip(ply.substr(100)).substr(0, cut.size()))) == format);
#ifdef BINOSPLAT_SOG
    for (const bool deflated : {false, true}) {
        std::string broken = makeZip(SogText{{"a.ply", ply}}, deflated);
        broken[cut.size()] ^= 1;
        checkError("a.zip: a.ply: cannot be read", folder.write("a.zip", broken));
        CHECK(formatOfFile(folder.file("a.zip")) == format);
    }
#endif
    for (int i = 0; i < 70; ++i) { (void)folder.write(fmt::format("in/{}.jpg", i), "a photograph"); }
    (void)folder.write("in/dataset.tar.gz", whole);
    (void)folder.write("in/notes.bak", ply);
    CHECK(loadScene(folder.file("in")).size() == 8000);
    (void)folder.write("in/b.ply.gz", cut);
    checkError("is a directory", folder.file("in"));
    fs::rename(folder.file("in/a.ply"), folder.file("in/1"));
    checkError("is a directory", folder.file("in"));
    fs::remove(folder.file("in/1"));
    checkError("b.ply.gz: ends within its gzip stream", folder.file("in"));
}

TEST_CASE_FIXTURE(InFolder, "a scene is not unpacked into more room than there is, and leaves nothing") {
    std::string noise(40 << 20, ' ');
    std::mt19937 random(1);
    for (std::size_t i = 0; i < noise.size(); i += 64) { noise[i] = static_cast<char>(random()); }
    constexpr std::uint64_t kMib = std::uint64_t{1} << 20;
    const auto unpackInto = [&](const std::string& name, std::vector<std::uint64_t> room) {
        std::size_t looks = 0;
        fs::path used;
        const Unpacking how{.space = [&](const fs::path& place) {
            used = place;
            CHECK(fs::is_empty(place) == (looks == 0));
            return room.at(looks++);
        }};
        const std::string error =
            errorOf([&] { (void)unpackScene(std::make_unique<InputFile>(folder.file(name)), {}, how); });
        CHECK(looks == room.size());
        CHECK_FALSE(fs::exists(used));
        return error;
    };
    const auto said = [](std::uint64_t needed, std::uint64_t room) {
        return fmt::format("needs at least {} bytes unpacked, but only {} are free in ", needed, room);
    };
    (void)folder.write("a.gz", deflated(noise, MAX_WBITS + 16, 1));
    CHECK(unpackInto("a.gz", {100 * kMib, 100 * kMib, 100 * kMib}).empty());
    CHECK(contains(unpackInto("a.gz", {100 * kMib, 3 * kMib}), "a.gz: " + said(20 * kMib, 19 * kMib)));
    CHECK(contains(unpackInto("a.gz", {kMib / 2}), said(kMib, kMib / 2)));
#ifdef BINOSPLAT_SOG
    (void)folder.write("a.zip", makeZip(SogText{{"a.ply", noise}}, true));
    CHECK(unpackInto("a.zip", {40 * kMib, 24 * kMib, 8 * kMib}).empty());
    CHECK(contains(unpackInto("a.zip", {39 * kMib}), "a.zip: a.ply: " + said(40 * kMib, 39 * kMib)));
    CHECK(contains(unpackInto("a.zip", {40 * kMib, 24 * kMib, 0}), said(33 * kMib, 32 * kMib)));
#endif
}

#ifdef BINOSPLAT_SOG
TEST_CASE_FIXTURE(InFolder, "a zip archive of one scene is that scene, any other is told in a line") {
    using Entries = std::vector<std::pair<std::string, std::string>>;
    const auto zip = [](const Entries& entries, bool deflated = false) { return makeZip(entries, deflated); };
    const std::string ply = makePly(9).bytes(), sog = makeZip(makeSog()), spz = gzip(makeSpz(3).bytes());
    const Scene plain = loadScene(folder.write("plain.ply", ply));
    for (const bool deflated : {false, true}) {
        for (const Entries& entries : {Entries{{"garden.ply", ply}},
                                       Entries{{"a/", ""}, {"a/Garden.PLY", ply}, {"a/cameras.json", "[]"}},
                                       Entries{{"without an extension", ply}},
                                       Entries{{"__MACOSX/._a.ply", "x"}, {".b.ply", ""}, {"a.ply", ply}}}) {
            const Scene scene = loadScene(folder.write("a.zip", zip(entries, deflated)));
            checkSameScene(plain, scene);
            CHECK(scene.name.starts_with(folder.file("a.zip") + ": "));
        }
    }
    for (const auto& [name, bytes] : Entries{{"a.sog", sog}, {"a.spz", spz}}) {
        checkSameScene(loadScene(folder.write(name, bytes)),
                       loadScene(folder.write("a.zip", zip({{"in/" + name, bytes}}))));
    }
    std::string secret = zip({{"a.ply", ply}});
    for (const auto& [header, flags] : {std::pair("PK\x03\x04", 6u), std::pair("PK\x01\x02", 8u)}) {
        secret[secret.find(header) + flags] = 1;
    }
    std::string broken = zip({{"a.ply", ply}});
    broken[broken.find("ply\n") + 300] ^= 1;
    const std::pair<std::string, std::string> faults[]{
        {zip({{"a.ply", ply}, {"b.spz", spz}}),
         "b.zip: a zip archive with 2 scenes (a.ply, b.spz), expected one: unpack it and choose"},
        {zip({{"1.ply", ply}, {"2.ply", ply}, {"3.ply", ply}, {"4.ply", ply}}),
         "with 4 scenes (1.ply, 2.ply, 3.ply, ...)"},
        {zip({{"a.txt", "x"}, {"b.txt", "y"}}),
         "b.zip: a zip archive of 2 files without a scene or the meta.json of one"},
        {zip({}), "b.zip: a zip archive of 0 files without a scene"},
        {zip({{"a/meta.json", "{}"}, {"lod-meta.json", "{}"}}),
         "b.zip: a streamed SOG scene in a zip archive, expected it unpacked"},
        {secret, "b.zip: a.ply: is encrypted and asks for a password, expected an archive without one"},
        {broken, "b.zip: a.ply: cannot be read"},
        {zip({{"a.ply", ply}}).substr(0, 500), "b.zip: not a whole zip archive"},
        {zip({{"a.ply.gz", gzip(ply)}}), "b.zip: is packed twice"},
        {zip({{"a.ply", std::string(5'000'000, ' ')}}, true),
         "expected at most 256 times as many as packed"}};
    for (const auto& [bytes, message] : faults) { checkError(message, folder.write("b.zip", bytes)); }
}

TEST_CASE_FIXTURE(InFolder, "what a scene in a zip archive names beside it is in that archive") {
    const std::string gltf = makeGltf().json(R"(,"uri":"parts/a%20b.bin")"), binary = makeGltf().binary();
    const Scene whole = loadScene(folder.write("a.glb", makeGltf().glb()));
    for (const char* prefix : {"", "in/", "in\\"}) {
        for (const char* part : {"parts/a b.bin", "parts\\a b.bin"}) {
            const std::string zip = makeZip(SogText{{"a.gltf", gltf}, {part, binary}}, true, prefix);
            checkSameScene(whole, loadScene(folder.write("a.zip", zip)));
        }
    }
    (void)folder.write("a.bin", binary);  // next to the archive, not in it
    const std::string beside = makeGltf().json(R"(,"uri":"a.bin")");
    const auto zipOf = [&](const SogText& files) { return folder.write("a.zip", makeZip(files, true)); };
    checkError("a.zip: in/a.bin: not in the archive", zipOf({{"in/a.gltf", beside}, {"a.bin", binary}}));
    checkError(fmt::format("{} bytes", binary.size() - 1),
               zipOf({{"a.gltf", beside}, {"a.bin", binary.substr(1)}}));
    // A file that is named again and again, as in a hostile scene, is not unpacked endlessly.
    const auto naming = [&](int times) {
        std::string uri = R"(,"uri":"a.bin")";
        for (int i = 1; i < times; ++i) { uri += R"(},{"byteLength":4,"uri":"a.bin")"; }
        return zipOf({{"a.gltf", makeGltf().json(uri)}, {"a.bin", binary + std::string(300'000, '\0')}});
    };
    CHECK(loadError(naming(1)) == "");
    checkError("a.zip: the files that it names are longer than", naming(4));
}
#endif

}  // SUITE(packed_scene)
