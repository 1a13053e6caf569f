// Servers that are busy, break off, lie, redirect or disappear: the scene loads anyway, or one plain line
// says why not and nothing is left behind.
#include "tests/engine/files/gltf_files.h"
#include "tests/engine/files/web/web_runs.h"

SUITE(web_fetch) {

const std::string& kPly = OnWeb::kPly;

WebAnswer cutAfter(std::size_t bytes, WebAnswer::Then then = WebAnswer::Then::kClose) {
    WebAnswer whole = answer("200 OK", "", kPly);
    whole.bytes.resize(whole.bytes.size() - kPly.size() + bytes);
    whole.then = then;
    return whole;
}

// Part of a file of version "1".
WebAnswer partOf(const std::string& whole, std::size_t from, std::size_t end, const std::string& total,
                 const std::string& etag = "\"1\"") {
    return answer("206 Partial Content",
                  fmt::format("ETag: {}\r\nContent-Range: bytes {}-{}/{}\r\n", etag, from, end - 1, total),
                  whole.substr(from, end - from));
}

// Like a server that does not know the file's length, or states a different one.
WebAnswer withLength(const std::string& header, const std::string& body) {
    return {fmt::format("HTTP/1.1 200 OK\r\n{}\r\n{}", header, body), WebAnswer::Then::kClose};
}

void takeLittle(WebSettings& settings) { settings.fetch.most_bytes = kPly.size() - 1; }
void takeAll(WebSettings&) {}

// The error when a server gives every request this answer; afterwards the cache must be empty.
std::string errorOf(const WebAnswer& given, std::size_t attempts = 1,
                    void (*change)(WebSettings&) = takeAll) {
    const Folder folder;
    const WebServer server([given](const WebRequest&) { return given; });
    WebSettings settings = webSettings(folder);
    change(settings);
    std::string message = webError(server.at("/a.ply"), settings);
    CHECK(server.asked().size() == attempts);
    CHECK(filesIn(folder.file("cache")).empty());
    return message.substr(std::min(message.size(), server.at("/a.ply: ").size()));
}

TEST_CASE_FIXTURE(OnWeb, "a file that broke off goes on where it ended, if it is still the same") {
    const std::size_t half = kPly.size() / 2;
    const auto rest = [&](std::size_t from, const char* etag) {
        return partOf(kPly, from, kPly.size(), std::to_string(kPly.size()), etag);
    };
    const auto whole = [](const char* headers) { return answer("200 OK", headers, kPly); };
    // The rest, without its last byte.
    const WebAnswer shorter = answer(
        "206 Partial Content",
        fmt::format("ETag: \"1\"\r\nContent-Range: bytes {}-{}/{}\r\n", half, kPly.size() - 1, kPly.size()),
        kPly.substr(half, kPly.size() - 1 - half));
    using Asked = std::vector<std::string>;
    const std::string asks = fmt::format("bytes={}- \"1\"", half);
    const std::pair<WebAnswer, Asked> breaks[]{
        // After the first half; then the whole file is sent. What was requested follows.
        {rest(half, "\"1\""), {" ", asks}},
        // A server that sends the whole file, of this version or another.
        {whole("ETag: \"1\"\r\n"), {" ", asks}},
        {whole("ETag: \"2\"\r\n"), {" ", asks}},
        // If what is sent is not the rest, or belongs to another version, the whole file is requested.
        {rest(half, "\"2\""), {" ", asks, " "}},
        {rest(half + 1, "\"1\""), {" ", asks, " "}},
        {rest(0, "\"1\""), {" ", asks, " "}},
        {answer("206 Partial Content", "ETag: \"1\"\r\n", kPly.substr(half)), {" ", asks, " "}},
        {answer("206 Partial Content", "ETag: \"1\"\r\nContent-Range: bytes */9\r\n", "x"), {" ", asks, " "}},
        {answer("416 Range Not Satisfiable"), {" ", asks, " "}},
        // A rest that is too short is one more break; a busy server's answer is never continued.
        {shorter, {" ", asks, fmt::format("bytes={}- \"1\"", kPly.size() - 1)}},
        {answer("503 Service Unavailable", "", "busy"), {" ", asks, asks}},
        {{"HTTP/1.1 200 OK\r\nContent-", WebAnswer::Then::kClose}, {" ", asks, asks}},
        // Parts are put together only with a version that guarantees every byte to be the same.
        {whole(""), {" ", " "}}};
    for (const auto& [next, expected] : breaks) {
        CAPTURE(next.bytes.substr(0, 120));
        Asked asked;
        WebAnswer first = cutAfter(half);
        const std::string etag = expected.at(1) == " " ? "W/\"1\"" : "\"1\"";
        first.bytes.insert(first.bytes.find("\r\n") + 2, fmt::format("ETag: {}\r\n", etag));
        const WebServer server([&, &second = next](const WebRequest& request) {
            asked.push_back(request.header("range") + " " + request.header("if-range"));
            return request.number == 0 ? first : request.number == 1 ? second : whole("ETag: \"3\"\r\n");
        });
        checkSame(server, expected.size());
        CHECK(asked == expected);
        CHECK(filesIn(folder.file("cache")).size() == 2);
    }
}

TEST_CASE_FIXTURE(OnWeb, "a file of unknown length goes on only to the length that the rest tells") {
    const std::string chunk = fmt::format("{:x}\r\n{}", kPly.size(), kPly.substr(0, 300)),
                      total = std::to_string(kPly.size());
    const WebAnswer cut{"HTTP/1.1 200 OK\r\nETag: \"1\"\r\nTransfer-Encoding: chunked\r\n\r\n" + chunk,
                        WebAnswer::Then::kClose};
    for (const auto& [second, requests] : {std::pair(partOf(kPly, 300, kPly.size(), total), 2u),
                                           {partOf(kPly, 300, 500, total), 3u},
                                           {partOf(kPly, 300, 500, "*"), 3u}}) {
        const WebServer server([&, &rest = second](const WebRequest& request) {
            if (request.number < 2) { return request.number == 0 ? cut : rest; }
            return request.headers.contains("range") ? partOf(kPly, 500, kPly.size(), total)
                                                     : answer("200 OK", "ETag: \"1\"\r\n", kPly);
        });
        checkSame(server, requests);
    }
}

TEST_CASE_FIXTURE(OnWeb, "a large file may break off more often than attempts are made") {
    constexpr std::size_t kPiece = 1 << 20;
    std::string large(7 * kPiece / 2, ' ');
    std::mt19937 random(1);
    for (char& letter : large) { letter = static_cast<char>(random()); }
    const WebServer server([&](const WebRequest& request) {
        const std::string range = request.header("range");
        const std::size_t from = range.empty() ? 0 : std::stoul(range.substr(6));
        return WebAnswer{
            fmt::format(
                "HTTP/1.1 {}\r\nContent-Length: {}\r\nETag: \"1\"\r\nContent-Range: bytes {}-{}/{}\r\n\r\n{}",
                from > 0 ? "206 Partial Content" : "200 OK", large.size() - from, from, large.size() - 1,
                large.size(), large.substr(from, kPiece)),
            WebAnswer::Then::kClose};
    });
    settings.fetch.attempts = 2;
    const std::vector<std::byte> got = WebFiles(server.at("/a"), settings).open("")->readWhole(large.size());
    CHECK(std::ranges::equal(got, std::as_bytes(std::span(large))));
    CHECK(server.asked().size() == 4);
}

TEST_CASE("a server that is busy or cuts off is asked again, and a few attempts are enough") {
    for (const WebAnswer& given :
         {answer("429 Too Many Requests", "Retry-After: 0\r\n"),
          answer("500 Internal Server Error", "", "sorry"), cutAfter(0), cutAfter(kPly.size() - 1),
          WebAnswer{"HTTP/1.1 200 OK\r\nContent-", WebAnswer::Then::kClose}}) {
        CHECK(contains(errorOf(given, 4), "after 4 attempts"));
    }
    CHECK(errorOf(answer("503 Service Unavailable"), 4) ==
          "the server cannot serve it (it answers 503), after 4 attempts; try again later");
    CHECK(errorOf(cutAfter(100), 4) ==
          fmt::format("was cut off after 100 of {} bytes, after 4 attempts; try again later", kPly.size()));
    CHECK(errorOf(WebAnswer{"", WebAnswer::Then::kClose}, 4).starts_with("the server hangs up ("));
    // If a server asks to wait an hour, there is no second request.
    CHECK(errorOf(answer("429 Too Many Requests", "Retry-After: 3600\r\n")) ==
          "the server asks to wait 3600 s; try again then");
}

TEST_CASE_FIXTURE(OnWeb, "a file that is not there, not for everybody, empty or no scene is refused") {
    CHECK(errorOf(answer("404 Not Found", "", "<html>")) ==
          "is not there (the server answers 404), expected the address of a scene file");
    CHECK(errorOf(answer("403 Forbidden")) ==
          "may not be read (the server answers 403), expected an address that anybody may read");
    CHECK(errorOf(answer("204 No Content")).starts_with("cannot be fetched (the server answers 204)"));
    CHECK(errorOf(answer("304 Not Modified")).starts_with("cannot be fetched (the server answers 304)"));
    // Whatever comes with the answer, and however much of it.
    CHECK(errorOf(answer("404 Not Found", "", std::string(1 << 20, 'x'))).starts_with("is not there"));
    CHECK(errorOf({"hello\r\n\r\n", WebAnswer::Then::kClose}).starts_with("cannot be fetched ("));
    const WebServer server({{"/empty", ""}, {"/page", "<!DOCTYPE html><html><body>A scene!</body></html>"}});
    CHECK(contains(webError(server.at("/empty"), settings), "is empty, expected a scene file"));
    CHECK(contains(webError(server.at("/page"), settings), "a web page (HTML), not a splat scene"));
}

TEST_CASE_FIXTURE(OnWeb, "what a server says of a file's length is not believed") {
    // Longer than the file: cut off.
    CHECK(errorOf(withLength(fmt::format("Content-Length: {}\r\n", kPly.size() + 1), kPly), 4)
              .starts_with(fmt::format("was cut off after {} of {} bytes", kPly.size(), kPly.size() + 1)));
    // Longer than any disk: not even started.
    CHECK(errorOf(withLength("Content-Length: 9000000000000000000\r\n", kPly))
              .starts_with("is 9000000000000000000 bytes long, expected at most"));
    // More than is allowed.
    const std::string chunked = "Transfer-Encoding: chunked\r\n",
                      chunk = fmt::format("{:x}\r\n{}\r\n0\r\n\r\n", kPly.size(), kPly);
    const std::string most = fmt::format("{} bytes, which is the most that is taken", kPly.size() - 1);
    CHECK(errorOf(withLength("", kPly), 1, takeLittle) == "is longer than " + most);
    CHECK(errorOf(withLength(chunked, chunk), 1, takeLittle) == "is longer than " + most);
    // Chunks that break off do not end the file.
    CHECK(errorOf(withLength(chunked, chunk.substr(0, chunk.find('\n') + 1 + 300)), 4)
              .starts_with("was cut off after 300 bytes"));

    // Shorter: the scene ends early, whatever the cause.
    const WebServer server([](const WebRequest&) {
        return withLength(fmt::format("Content-Length: {}\r\n", kPly.size() - 9), kPly);
    });
    CHECK(contains(webError(server.at("/a.ply"), settings), "a.ply: "));

    // With unknown length, the scene loads all the same.
    for (const WebAnswer& given :
         {withLength("", kPly), withLength("Content-Length: 99999999999999999999999\r\n", kPly),
          withLength(chunked, chunk)}) {
        const WebServer other([given](const WebRequest&) { return given; });
        checkSame(other, 1);
    }
}

TEST_CASE_FIXTURE(OnWeb, "redirects are followed on the web, and never to a file") {
    const auto leadTo = [](const std::string& place) {
        return answer("302 Found", "Location: " + place + "\r\n");
    };
    const WebServer end({{"/in/a.ply", kPly}});
    const WebServer server(
        [&](const WebRequest& request) { return leadTo(request.path == "/1" ? "/2" : end.at("/in/a.ply")); });
    checkSame(server.at("/1"));
    CHECK(server.asked() == std::vector<std::string>{"/1", "/2"});
    for (const char* place : {"file://" BINOSPLAT_SOURCE_DIR "/README.md", "file:///etc/passwd",
                              "ftp://127.0.0.1/a", "gopher://127.0.0.1/"}) {
        CAPTURE(std::string(place));
        CHECK(errorOf(leadTo(place)) ==
              "redirects to an address that may not be followed, expected one of http or https, and of https "
              "after https");
    }
    CHECK(errorOf(leadTo("/a.ply"), 6) == "redirects more than 5 times, expected a file");
    CHECK_FALSE(contains(errorOf(leadTo("http://me:secret@127.0.0.1/a.ply")), "secret"));
}

TEST_CASE_FIXTURE(OnWeb, "no redirect leads from the public web to a machine of this network") {
    const WebServer server([&](const WebRequest& request) {
        return request.path == "/1" ? answer("302 Found", "Location: /a.ply\r\n")
                                    : answer("200 OK", "", kPly);
    });
    for (const auto& [first_is_private, second_is_private] :
         {std::pair(false, false), {true, false}, {true, true}, {false, true}}) {
        settings.fetch.is_private = [&first = first_is_private, &second = second_is_private,
                                     servers = 0](const std::string& ip) mutable {
            CHECK(ip == "127.0.0.1");
            return servers++ == 0 ? first : second;
        };
        const std::string message = webError(server.at("/1"), settings);
        if (first_is_private || !second_is_private) {
            CHECK(message == "");
        } else {
            CHECK(contains(message,
                           "leads from the public web to 127.0.0.1, which is on a private network, expected "
                           "a public server"));
        }
    }
    CHECK(server.asked() == std::vector<std::string>{"/1", "/a.ply", "/1", "/a.ply", "/1", "/a.ply", "/1"});
}

TEST_CASE_FIXTURE(OnWeb, "a scene that began on the public web stays there, in all attempts and files") {
    const WebServer server([&](const WebRequest& request) {
        if (request.number == 0) { return answer("503 Service Unavailable"); }
        return answer("200 OK", "", makeGltf().json(R"(,"uri":"a.bin")"));
    });
    for (const auto& [address, requests] : {std::pair("/a.ply", 1u), std::pair("/a.gltf", 2u)}) {
        settings.fetch.is_private = [servers = 0](const std::string&) mutable { return servers++ > 0; };
        CHECK_THROWS_WITH_AS((void)loadFromWeb(server.at(address), settings),
                             doctest::Contains("leads from the public web to 127.0.0.1"), Error);
        CHECK(server.asked().size() == requests);
    }
}

TEST_CASE_FIXTURE(OnWeb, "through a proxy, servers are judged by their own addresses") {
    std::string target;
    const WebServer proxy([&](const WebRequest& request) {
        return request.path.ends_with("/1") ? answer("302 Found", "Location: " + target + "\r\n")
                                            : answer("200 OK", "", kPly);
    });
    const auto fetch = [&](const std::string& first, const std::string& second) {
        fs::remove_all(settings.cache_folder);
        target = fmt::format("http://{}/a.ply", second);
        setEnvironment("http_proxy", proxy.at(""));
        const std::string message = webError(fmt::format("http://{}/1", first), settings);
        setEnvironment("http_proxy", "");
        return message;
    };
    for (const auto& [first, second] : {std::pair("scenes.example", "other.example"),
                                        {"8.8.8.8", "other.example"},
                                        {"10.0.0.1", "10.0.0.2"},
                                        {"localhost", "[fe80::1]"}}) {
        CHECK(fetch(first, second) == "");
    }
    CHECK(proxy.asked().size() == 8);
    for (const std::string within : {"10.0.0.1", "169.254.169.254", "[::1]", "[64:ff9b::a00:1]", "localhost",
                                     "LOCALHOST.", "a.localhost:99", "0xa.1", "167772161", "10.1:8080"}) {
        CHECK_MESSAGE(contains(fetch("scenes.example", within), "leads from the public web to "), within);
        CHECK(proxy.asked().back() == "http://scenes.example/1");
    }
}

TEST_CASE_FIXTURE(OnWeb, "a body that is packed on its way is unpacked, and never resumed") {
    for (const auto& [encoding, window_bits] : {std::pair("gzip", MAX_WBITS + 16),
                                                {"x-gzip", MAX_WBITS + 16},
                                                {"deflate", MAX_WBITS},
                                                {"deflate", -MAX_WBITS}}) {
        const std::string packed = deflated(kPly, window_bits);
        const WebServer server([&, &name = encoding](const WebRequest& request) {
            CHECK(these(request.header("accept-encoding"), request.header("range").empty()) ==
                  these("identity", true));
            WebAnswer given =
                answer("200 OK", fmt::format("ETag: \"1\"\r\nContent-Encoding: {}\r\n", name), packed);
            if (request.number == 0) {
                given = {given.bytes.substr(0, given.bytes.size() - 20), WebAnswer::Then::kClose};
            }
            return given;
        });
        LoadNotes notes;
        checkSame(server, 2, &notes);
        // It comes from this machine.
        CHECK(countSaying(notes.lines, "came by http, so others") == 0);
    }
    std::string broken = deflated(kPly, MAX_WBITS + 16);
    broken[broken.size() - 6] ^= 1;  // of the checksum, at the end of the whole file
    CHECK(errorOf(answer("200 OK", "Content-Encoding: gzip\r\n", broken)).starts_with("cannot be fetched ("));
}

TEST_CASE_FIXTURE(OnWeb, "a body that is not packed as the server says is taken as it comes") {
    settings.fetch.attempts = 2;
    for (const char* encoding : {"aws-chunked", "UTF-8", "gzip", "gzip, unknown"}) {
        CAPTURE(encoding);
        const std::string header = fmt::format("Content-Encoding: {}\r\n", encoding);
        const WebServer server([&](const WebRequest& request) {
            WebAnswer given = answer("200 OK", header + "ETag: \"1\"\r\n", kPly);
            if (request.number == 2) {
                CHECK(request.header("range") == "bytes=300-");
                return answer(
                    "206 Partial Content",
                    header + fmt::format("ETag: \"1\"\r\nContent-Range: bytes 300-{0}/{0}\r\n", kPly.size()),
                    kPly.substr(300));
            }
            if (request.number == 1) {
                given = {given.bytes.substr(0, given.bytes.size() - kPly.size() + 300),
                         WebAnswer::Then::kClose};
            }
            return given;
        });
        checkSame(server, 3);
    }
    CHECK(errorOf(answer("404 Not Found", "Content-Encoding: unknown\r\n", "no such page"), 2)
              .starts_with("is not there"));
    CHECK(errorOf(answer("200 OK", "Content-Encoding: unknown\r\n", kPly), 2, takeLittle) ==
          fmt::format("is {} bytes long, expected at most {}", kPly.size(), kPly.size() - 1));
}

TEST_CASE("a server that falls silent is given up") {
    const auto impatient = [](WebSettings& settings) {
        settings.fetch.patience = std::chrono::milliseconds(100);
        settings.fetch.attempts = 2;
    };
    for (const std::size_t bytes : {0, 200}) {
        CHECK(errorOf(cutAfter(bytes, WebAnswer::Then::kHang), 2, impatient) ==
              fmt::format("the server has fallen silent after {} bytes, after 2 attempts; try again later",
                          bytes));
    }
    CHECK(errorOf({"", WebAnswer::Then::kHang}, 2, impatient)
              .starts_with("the server has fallen silent after 0 bytes"));
}

TEST_CASE_FIXTURE(OnWeb, "a server that vanishes in the middle of a file, or was never there, is named") {
    std::function<void()> vanish;
    WebServer server([&](const WebRequest&) {
        vanish();
        return cutAfter(100);
    });
    vanish = [&] { server.refuse(); };
    CHECK(contains(webError(server.at("/a.ply"), settings), "cannot be reached ("));
    CHECK(contains(webError(server.at("/a.ply"), settings), "look at the network and at the address"));
    CHECK(server.asked().size() == 1);
    CHECK(filesIn(folder.file("cache")).empty());
}

TEST_CASE_FIXTURE(OnWeb, "who waits for a file may give up at any time") {
    const WebServer server([](const WebRequest&) { return cutAfter(100, WebAnswer::Then::kHang); });
    struct Enough {};
    int told = 0;
    const auto giveUp = [&](double share) {
        CHECK(share == within(0.0, 0.7));
        if (++told == 3) { throw Enough(); }
    };
    CHECK_THROWS_AS((void)loadFromWeb(server.at("/a.ply"), settings, nullptr, {}, giveUp), Enough);
    CHECK(filesIn(folder.file("cache")).empty());
}

}  // SUITE(web_fetch)
