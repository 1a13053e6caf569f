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

TEST_CASE("an address begins with http or https; a name in its folder cannot lead out of it") {
    for (const char* open : {"http://a/b.ply", "HTTP://127.example/b.ply", "http://localhost.example",
                             "http://128.0.0.1/b.ply", "http://[::2]/b.ply"}) {
        CHECK_MESSAGE(isOpenOnTheWay(open), open);
    }
    for (const char* closed : {"https://a/b.ply", "http://localhost/b.ply", "http://LocalHost:8000/b.ply",
                               "http://127.0.0.1:80?a", "http://[::1]:8000/b.ply", "b.ply"}) {
        CHECK_MESSAGE(!isOpenOnTheWay(closed), closed);
    }
    for (const char* address : {"http://a/b.ply", "HTTPS://a"}) { CHECK(isAddress(address)); }
    for (const char* other :
         {"file:///etc/passwd", "ftp://a/b", "http:/a", "a/http://b", "builtin:fence", "https"}) {
        CHECK_FALSE(isAddress(other));
    }
    const Address address = parseAddress("https://server:81/a b/c/meta.json?key=1&x#top");
    CHECK(these(address.text, address.folder, address.server) ==
          these("https://server:81/a%20b/c/meta.json?key=1&x", "https://server:81/a%20b/c/",
                "https://server:81"));
    CHECK(addressOf(address, "") == address.text);
    CHECK(addressOf(address, "0/50% ä?#.webp") == "https://server:81/a%20b/c/0/50%25%20%C3%A4%3F%23.webp");
    CHECK(parseAddress("http://server").folder == "http://server/");
    CHECK(parseAddress("http://server?a/b").text == "http://server/?a/b");
    for (const char* name : {"../a", "a/../b", "/a", "a//b", ".", "a/"}) {
        CAPTURE(name);
        CHECK_THROWS_AS((void)addressOf(address, name), Error);
    }
    const auto parse = [](const std::string& text) { (void)parseAddress(text); };
    CHECK_THROWS_WITH_AS(parse("http:///a.ply"),
                         "http:///a.ply: names no server, expected https://SERVER/FILE", Error);
    for (const std::string rest : {"server/a.ply", "server/a@b.ply?c", "server"}) {
        const std::string host = rest.substr(0, rest.find('/'));
        CHECK_THROWS_WITH_AS(
            parse("https://me:sec@ret@" + rest),
            ("https://...@" + rest + ": names a user, expected an address that anybody may read").c_str(),
            Error);
    }
    CHECK(parseAddress("https://server/a@b/c.ply").server == "https://server");
    CHECK_THROWS_WITH_AS(parse("https://server/" + std::string(5000, 'a')),
                         doctest::Contains("at most 4096 bytes"), Error);
}

TEST_CASE("machines of this network are told from those of the public web") {
    for (const std::string& ip : wordsIn("127.0.0.1 10.1.2.3 172.16.0.1 172.31.255.255 192.168.0.1 "
                                         "169.254.169.254 100.64.0.1 0.0.0.0 ::1 :: fe80::1 febf::1 "
                                         "fc00::1 fd12:3456::1 ::ffff:10.0.0.1 ::ffff:a00:1 ::10.0.0.1 "
                                         "::7f00:1 64:ff9b::10.0.0.1 64:ff9b::a9fe:a9fe "
                                         "64:ff9b:1::c0a8:1 64:ff9b:1:2:3:4:10.0.0.1 2002:7f00:1:: "
                                         "2002:a00:1:2:3:4:5:6 0:0:0:0:0:0:0:1 fe80::1%eth0")) {
        CHECK_MESSAGE(isPrivateAddress(ip), ip);
    }
    for (const char* ip : {"8.8.8.8", "172.15.0.1", "172.32.0.1", "192.169.0.1", "169.253.0.1", "100.128.0.1",
                           "2606:4700::1", "fec0::1", "fb00::1", "::ffff:8.8.8.8", "::ffff:808:808",
                           "64:ff9b::808:808", "64:ff9b:1::8.8.8.8", "64:ff9c::a00:1", "64:ff9b:2::a00:1",
                           "2002:808:808::a00:1", "2003:a00:1::", "example.org", "10.example.org"}) {
        CHECK_FALSE_MESSAGE(isPrivateAddress(ip), ip);
    }
    CHECK(!parseIp(""));
    for (const std::string& none :
         wordsIn(": ::: 1 1.2.3 1.2.3.4.5 1.2.3.256 1.2.3. 1.2.3.4. a.b.c.d 1:2:3:4:5:6:7 1:2:3:4:5:6:7:8:9 "
                 "1:2:3:4:5:6:7:8:: 1::2::3 :1:2:3:4:5:6:7 1:2:3:4:5:6:7: 12345:: g:: 1.2.3.4:: "
                 "1:2:3:4:5:6:7:1.2.3.4 -1:: 1::+2")) {
        CHECK_MESSAGE(!parseIp(none), none);
    }
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
