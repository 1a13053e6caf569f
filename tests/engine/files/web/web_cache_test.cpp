// What is kept on the disk is revalidated, not fetched again; it is used when the server is gone; it stays
// within its limit and complete, whoever uses it.
#include "tests/engine/files/web/web_runs.h"

SUITE(web_cache) {

const std::string &kPly = OnWeb::kPly, kOther = makePly(9).bytes();

// As a good server does: it answers 304 to a client that already has the version.
WebServer::Handler withVersions(std::string bytes) {
    return [held = std::move(bytes)](const WebRequest& request) {
        const std::string version =
            fmt::format("ETag: \"{}\"\r\nLast-Modified: Thu, 01 Jan 2026 00:00:00 GMT\r\n", held.size());
        const bool has_it = request.header("if-none-match") == fmt::format("\"{}\"", held.size());
        return has_it ? WebAnswer{"HTTP/1.1 304 Not Modified\r\n" + version + "\r\n"}
                      : answer("200 OK", version, held);
    };
}

struct Cached : OnWeb {
    [[nodiscard]] fs::path cache() const { return settings.cache_folder; }
    [[nodiscard]] std::size_t filesKept() const { return filesIn(cache()).size(); }
    [[nodiscard]] fs::path note() const {
        for (const std::string& name : filesIn(cache())) {
            if (name.ends_with(".json")) { return cache() / name; }
        }
        return {};
    }
};

void setAge(const fs::path& file, int hours) {
    fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::hours(hours));
}

TEST_CASE_FIXTURE(Cached, "a file that has not changed is sent once, one that has is replaced") {
    std::atomic<int> unchanged = 0;
    const WebServer server(
        [&, old = withVersions(kPly), latest = withVersions(kOther)](const WebRequest& request) {
            const WebAnswer given = request.number < 3 ? old(request) : latest(request);
            if (given.bytes.find(" 304 ") != std::string::npos) {
                CHECK(request.header("if-modified-since") == "Thu, 01 Jan 2026 00:00:00 GMT");
                ++unchanged;
            }
            return given;
        });
    for (int turn = 0; turn < 3; ++turn) {
        LoadNotes notes;
        checkSame(server.at("/a.ply"), &notes);
        CHECK(notes.stale.empty());
    }
    CHECK(these(server.asked().size(), unchanged.load(), filesKept()) == these(3, 2, 2));
    checkSameScene(loadScene(folder.write("now.ply", kOther)), loadFromWeb(server.at("/a.ply"), settings));
    CHECK(these(unchanged.load(), filesKept()) == these(2, 2));
    CHECK(bytesIn(cache()) < kOther.size() + 1000);
}

TEST_CASE_FIXTURE(Cached, "a file of which the server says no version is fetched each time") {
    const WebServer server({{"/a.ply", kPly}});
    for (int turn = 0; turn < 2; ++turn) { checkSame(server.at("/a.ply")); }
    CHECK(server.asked().size() == 2);
    // So is a file whose end the server does not announce, since it may have been cut off.
    const WebServer endless([](const WebRequest& request) {
        CHECK_FALSE(request.headers.contains("if-none-match"));
        return WebAnswer{"HTTP/1.1 200 OK\r\nETag: \"1\"\r\n\r\n" + kPly, WebAnswer::Then::kClose};
    });
    for (int turn = 0; turn < 2; ++turn) { checkSame(endless.at("/a.ply")); }
}

TEST_CASE_FIXTURE(Cached, "without its server a scene is shown as it was, and one line says so") {
    WebServer server([handle = withVersions(kPly)](const WebRequest& request) {
        return request.number == 0   ? handle(request)
               : request.number == 1 ? answer("404 Not Found")
                                     : answer("503 Service Unavailable");
    });
    const std::string address = server.at("/a.ply");
    checkSame(address);
    // If a server is there and no longer has the file, it is believed; the copy stays.
    CHECK(contains(webError(address, settings), "is not there"));
    LoadNotes busy, gone;
    checkSame(address, &busy);
    CHECK(contains(
        busy.stale,
        address + ": the server cannot serve it (it answers 503), after 4 attempts; taken as it was on 20"));
    server.stop();
    checkSame(address, &gone);
    CHECK(contains(gone.stale, address + ": cannot be reached ("));
    CHECK(contains(gone.stale, "; taken as it was on 20"));
    CHECK(std::ranges::count(gone.lines, gone.stale) == 1);
    CHECK(contains(webError(address + "?other", settings), "cannot be reached ("));
}

TEST_CASE_FIXTURE(Cached, "the cache keeps its limit, and what was used last") {
    const WebServer server({{"/a.ply", kPly}, {"/b.ply", kPly}, {"/c.ply", kPly}});
    checkSame(server.at("/a.ply"));
    const fs::path first = note();
    checkSame(server.at("/b.ply"));
    CHECK(filesKept() == 4);
    for (const std::string& name : filesIn(cache())) { setAge(cache() / name, 5); }
    setAge(first, 4);
    settings.cache_bytes = 2 * (kPly.size() + 500);
    checkSame(server.at("/c.ply"));
    CHECK(filesKept() == 4);
    CHECK(bytesIn(cache()) <= settings.cache_bytes);
    CHECK(fs::exists(first));
    // A file larger than the whole cache is not taken, whether or not the server announces its size; without
    // a cache it is shown and not kept.
    const WebServer silent([](const WebRequest&) {
        return WebAnswer{"HTTP/1.1 200 OK\r\n\r\n" + kPly, WebAnswer::Then::kClose};
    });
    settings.cache_bytes = kPly.size() / 2;
    CHECK(contains(webError(server.at("/a.ply"), settings),
                   fmt::format("is {} bytes long, more than the cache's {}", kPly.size(), kPly.size() / 2)));
    CHECK(contains(webError(silent.at("/a.ply"), settings), "a larger --cache-limit takes it"));
    settings.cache_bytes = 0;
    checkSame(server.at("/a.ply"));
    CHECK(filesKept() == 0);
}

TEST_CASE_FIXTURE(Cached, "without a folder for a cache nothing stays") {
    const WebServer server({{"/a.ply", kPly}});
    settings.cache_folder.clear();
    const auto left = [] { return countSaying(filesIn(fs::temp_directory_path()), "binosplat-web-"); };
    const auto before = left();
    checkSame(server.at("/a.ply"));
    CHECK(left() == before);
    settings.cache_folder = folder.write("file", "no folder");
    CHECK_THROWS_WITH_AS((void)loadFromWeb(server.at("/a.ply"), settings),
                         doctest::Contains("expected a place to write to"), Error);
}

TEST_CASE_FIXTURE(Cached, "a broken cache is one without the file") {
    const WebServer server(withVersions(kPly));
    checkSame(server.at("/a.ply"));
    const std::string name = note().filename().string(), whole = textIn(note());
    for (const std::string& broken :
         {std::string(), std::string("{"), std::string("[]"), replaced(whole, "\"bytes\": ", "\"bytes\": 1"),
          replaced(whole, "/a.ply", "/b.ply"), replaced(whole, "\"changed_ns\": ", "\"changed_ns\": 1"),
          replaced(whole, "\"etag\": \"\\\"", "\"etag\": 7, \"x\": \"\\\"")}) {
        CAPTURE(broken);
        (void)folder.write("cache/" + name, broken);
        checkSame(server.at("/a.ply"));
    }
    // What an interrupted program left is removed after a while; what another program is fetching is not.
    for (const char* left : {"0-1-2.part", "0-1-3.part", "0.json"}) { std::ofstream(cache() / left) << "{}"; }
    setAge(cache() / "0-1-2.part", 2);
    checkSame(server.at("/a.ply"));
    CHECK(these(fs::exists(cache() / "0-1-2.part"), fs::exists(cache() / "0.json"),
                fs::exists(cache() / "0-1-3.part")) == these(false, false, true));
}

TEST_CASE_FIXTURE(Cached, "several at once use one cache, even one in which nothing may stay") {
    const WebServer server(withVersions(kPly));
    for (const std::uint64_t limit : {std::uint64_t{1} << 30, std::uint64_t{0}}) {
        settings.cache_bytes = limit;
        std::atomic<int> same = 0, thrown_out = 0;
        const auto load = [&] {
            for (int turn = 0; turn < 8; ++turn) {
                try {
                    const Scene far = loadFromWeb(server.at("/a.ply"), settings);
                    same += far.positions == scene.positions && far.sh == scene.sh;
                } catch (const Error& error) {
                    thrown_out += contains(error.what(), "is removed from the cache");
                }
            }
        };
        std::thread other(load);
        load();
        other.join();
        CHECK(same + thrown_out == 16);
        CHECK(same > 0);
        if (limit > 0) { CHECK(thrown_out == 0); }
        CHECK(filesKept() == (limit > 0 ? 2 : 0));
    }
}

}  // SUITE(web_cache)
