// Scenes of every format at web addresses: they equal those on the disk, and nothing is requested that they
// do not need.
#include "engine/address.h"
#include "tests/engine/files/gltf_files.h"
#include "tests/engine/files/hostile_scenes.h"
#include "tests/engine/files/ksplat_files.h"
#include "tests/engine/files/streamed_scenes.h"
#include "tests/engine/files/web/web_runs.h"

#include <ranges>

SUITE(web_scene) {

struct Served : InFolder {
    const WebSettings settings = webSettings(folder);

    void checkSame(const Scene& local, const std::string& address) const {
        const Scene far = loadFromWeb(address, settings);
        checkSameScene(local, far);
        CHECK(far.name == address);
        CHECK(local.size() > 0);
    }
};

std::vector<std::string> sorted(std::vector<std::string> names) {
    std::ranges::sort(names);
    return names;
}

SCRIPT(web_scene, "engine/files/web/web_scene") {
    ScriptHost host{[](const std::string& words, const std::string&) {
        const Outcome outcome = tried([&] {
            const std::size_t bar = std::min(words.find(" |"), words.size());
            const Address address = parseAddress(words.substr(0, bar));
            return bar < words.size()
                       ? addressOf(address, words.substr(std::min(bar + 3, words.size()))) + "\n"
                       : fmt::format("{}\n{}\n{}\n", address.text, address.folder, address.server);
        });
        CHECK_FALSE(contains(outcome.errors, "sec@ret"));
        return outcome;
    }};
    const auto addVerb = [&](const char* verb, const auto& holds) {
        host.verbs[verb] = [=](const std::string& line) {
            for (const std::string& word : wordsIn(line)) { CHECK_MESSAGE(holds(word), word); }
        };
    };
    addVerb("open", isOpenOnTheWay);
    addVerb("closed", std::not_fn(isOpenOnTheWay));
    addVerb("address", isAddress);
    addVerb("other", std::not_fn(isAddress));
    addVerb("private", isPrivateAddress);
    addVerb("public", std::not_fn(isPrivateAddress));
    addVerb("nobody", std::not_fn(parseIp));
    CHECK(!parseIp(""));
    runScript(host);
}

TEST_CASE_FIXTURE(Served, "a scene at an address is the same as on the disk, whatever its format") {
    WebPages files{{"/a.ply", makePly(9, true).bytes()},
                   {"/packed.ply", makeCompressedPly()},
                   {"/a.splat", makeSplatFile()},
                   {"/a.ksplat", KsplatText().bytes()},
                   {"/a.spz", gzip(makeSpz(3).bytes())}};
    files["/a.glb"] = makeGltf().glb();
#ifdef BINOSPLAT_SOG
    files["/a.sog"] = makeZip(makeSog());
#endif
    const WebServer server(files);
    for (const auto& file : files) {
        CAPTURE(file.first);
        checkSame(loadScene(folder.write("scene", file.second)), server.at(file.first));
    }
    CHECK(server.asked().size() == files.size());
}

TEST_CASE_FIXTURE(Served, "what a scene names beside it is fetched from beside it, or is in its archive") {
    const std::string gltf = makeGltf().json(R"(,"uri":"parts/a%20b.bin")"), binary = makeGltf().binary();
    const Scene local = loadScene(folder.write("a.glb", makeGltf().glb()));
    WebPages files{{"/in/a.gltf", gltf},
                   {"/in/parts/a%20b.bin", binary},
                   {"/in/a.gltf.gz", gzip(gltf)},
                   {"/a.gltf.gz", gzip(gltf)}};
#ifdef BINOSPLAT_SOG
    files["/a.zip"] = makeZip(SogText{{"in/a.gltf", gltf}, {"in/parts/a b.bin", binary}});
    files["/b.zip"] = makeZip(SogText{{"in/a.gltf", gltf}, {"a b.bin", binary}});
    SogText sog = makeSog();
    files["/in.zip"] = makeZip(SogText{{"in/a.sog", makeZip(sog)}});
    files["/sog/meta.gz"] = gzip(sog["meta.json"]);
    for (const auto& [name, bytes] : sog) { files["/sog/" + name] = bytes; }
#endif
    const WebServer server(files);
    checkSame(local, server.at("/in/a.gltf"));
    CHECK(server.asked() == std::vector<std::string>{"/in/a.gltf", "/in/parts/a%20b.bin"});
    checkSameScene(local, loadFromWeb(server.at("/in/a.gltf.gz"), settings));
    CHECK_THROWS_WITH_AS((void)loadFromWeb(server.at("/a.gltf.gz"), settings),
                         doctest::Contains("/parts/a%20b.bin: is not there"), Error);
#ifdef BINOSPLAT_SOG
    checkSameScene(local, loadFromWeb(server.at("/a.zip"), settings));
    CHECK(contains(webError(server.at("/b.zip"), settings), "b.zip: in/parts/a b.bin: not in the archive"));
    const Scene of_sog = loadScene(folder.write("a.sog", makeZip(sog)));
    for (const char* path : {"/in.zip", "/sog/meta.gz"}) {
        checkSameScene(of_sog, loadFromWeb(server.at(path), settings));
    }
#endif
}

#ifdef BINOSPLAT_SOG
TEST_CASE_FIXTURE(Served, "the pictures of a SOG scene are fetched from beside its meta.json, each once") {
    for (const int version : {1, 2}) {
        const std::string path = writeSogFolder(folder, "sog", makeSog(version));
        WebPages files = filesOf(path, "/of/");
        files["/of/meta.json?key=1"] = files["/of/meta.json"];
        files.erase("/of/meta.json");
        const WebServer server(files);
        checkSameScene(loadScene(path), loadFromWeb(server.at("/of/meta.json?key=1"), settings));
        const auto all = std::views::keys(files);
        CHECK(sorted(server.asked()) == std::vector<std::string>(all.begin(), all.end()));
        CHECK(server.connectionCount() <= settings.fetch.at_once);
    }
}

TEST_CASE_FIXTURE(Served, "a meta.json that names files elsewhere is refused before they are asked for") {
    for (const char* name : {"../l.webp", "http://127.0.0.1/l.webp", "/etc/passwd", "a/l.webp"}) {
        CAPTURE(name);
        const WebServer server(
            {{"/meta.json", replaced(makeSog()["meta.json"], "\"l.webp\"", fmt::format("\"{}\"", name))}});
        CHECK(contains(webError(server.at("/meta.json"), settings), "names a file that is not beside it"));
        CHECK(server.asked().size() == 1);
    }
}

TEST_CASE_FIXTURE(Served, "of a streamed scene the files of one level are fetched, and no others") {
    const std::string path = writeStreamed(folder, "scene", replaced(makeLodMeta(), "a/meta.json", "a.sog"));
    (void)folder.write("scene/a.sog", makeZip(makeChunk(2)));
    for (const std::uint32_t level : {0u, 1u}) {
        const WebServer server(filesOf(path, "/s/"));
        LoadNotes local, far;
        const Scene scene = loadFromWeb(server.at("/s/lod-meta.json"), settings, &far, {level, {}});
        checkSameScene(loadScene(path, 0, &local, {}, {level, {}}), scene);
        CHECK(local.level_splats == far.level_splats);
        std::vector<std::string> asked = sorted(server.asked());
        CHECK(these(std::ranges::adjacent_find(asked), std::ranges::count(asked, "/s/a.sog")) ==
              these(asked.end(), (level == 0 ? 1 : 0)));
        for (const std::string& name : asked) {
            CAPTURE(name);
            const bool expected =
                level == 0 ? name == "/s/a.sog" || name.starts_with("/s/b/") : name.starts_with("/s/c/");
            CHECK((expected || name.starts_with("/s/env/") || name == "/s/lod-meta.json"));
        }
        fs::remove_all(folder.file("cache"));
    }
    // Nothing of a level that cannot fit is fetched.
    const WebServer server(filesOf(path, "/s/"));
    const auto fits = [](std::uint64_t splats, int) { return splats < 16; };
    CHECK(loadFromWeb(server.at("/s/lod-meta.json"), settings, nullptr, {std::nullopt, fits}).size() == 16);
    for (const std::string& name : server.asked()) { CHECK_FALSE(name.starts_with("/s/a")); }
    // Without its environment, the scene is shown all the same.
    fs::remove_all(folder.file("scene/env"));
    const WebServer without(filesOf(path, "/s/"));
    LoadNotes notes;
    CHECK(loadFromWeb(without.at("/s/lod-meta.json"), settings, &notes, {1, {}}).size() == 8);
    CHECK(countSaying(notes.lines, "is shown without its environment: " + without.at("/s/env/meta.json")) ==
          1);
}
#endif

}  // SUITE(web_scene)
