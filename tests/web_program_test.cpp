// Commands whose SCENE is an address, run as a program.
#include "engine/scene/ply.h"
#include "engine/scene/procedural.h"
#include "tests/installed.h"
#include "tests/run_program.h"
#include "tests/spz_files.h"
#include "tests/web_runs.h"

#include <array>
#include <cstdio>

TEST_SUITE_BEGIN("web_program");

namespace web_program_test {

namespace fs = std::filesystem;
using namespace binosplat;
using namespace binosplat::test;

namespace {

#ifdef BINOSPLAT_HAS_PNG
constexpr const char* kPicture = "mono.png";
#else
constexpr const char* kPicture = "mono.ppm";
#endif

// With a cache in the folder of the test.
Outcome runWith(const Workplace& work, const std::string& arguments) {
    return work.run(arguments, fmt::format("no_proxy=127.0.0.1 XDG_CACHE_HOME='{}' BINOSPLAT_PIPELINE_CACHE=0 LP_NUM_THREADS=0 {}",
                                           (work.base / "caches").string(), "XDG_CONFIG_HOME='" + (work.base / "config").string() + "'"));
}

std::string servedWall(const Workplace& work) {
    const std::string file = (work.path / "wall.ply").string();
    writePly(makeBuiltin("builtin:slanted-wall", 0), file);
    return textOf(file);
}

}  // namespace

TEST_CASE("render, bench, info, convert and view take an address") {
    const Workplace work;
    const WebServer server({{"/wall.ply", servedWall(work)}});
    const std::string address = server.at("/wall.ply"), camera = " --mode mono --size 64x64 --eye=0,0,-1 --look=0,0,1";
    const auto done = [&](const std::string& arguments) {
        const Outcome outcome = runWith(work, arguments);
        INFO(arguments);
        INFO(outcome.errors);
        CHECK(outcome.exit_code == 0);
        CHECK(outcome.errors.empty());
        return outcome.output;
    };
    done("render " + address + " --out far" + camera);
    done("render wall.ply --out near" + camera);
    const auto picture = [&](const char* folder) { return textOf((work.path / folder / kPicture).string()); };
    CHECK_FALSE(picture("far").empty());
    CHECK(picture("far") == picture("near"));
    CHECK(replaced(done("info " + address), address, "wall.ply") == done("info wall.ply"));
    done("convert " + address + " far.spz");
    done("convert wall.ply near.spz");
    CHECK(textOf((work.path / "far.spz").string()) == textOf((work.path / "near.spz").string()));
    CHECK(contains(done("bench " + address + " --out bench --repeats 1 --mode mono --size 64x64"), "wall.ply"));
#ifdef BINOSPLAT_OPENXR
    // Also by itself, as a file is.
    const Outcome seen = runWith(work, address + " --simulate --frames 2 --load-first --mode mono --hide-panel --hide-hands --out seen");
    INFO(seen.errors);
    CHECK(seen.exit_code == 0);
#endif
}

TEST_CASE("what is wrong with an address is one line, and nothing is left") {
    const Workplace work;
    const WebServer server({{"/wall.ply", servedWall(work)}, {"/page", "<html></html>"}});
    fs::remove(work.path / "wall.ply");
    for (const std::string& scene :
         {server.at("/none.ply"), server.at("/page"), std::string("http://127.0.0.1:1/a.ply"), std::string("https:///a")}) {
        for (const std::string& command : {"render " + scene + " --out out", "info " + scene, "convert " + scene + " a.ply"}) {
            CAPTURE(command);
            const Outcome outcome = runWith(work, command);
            CHECK(outcome.exit_code == 1);
            CHECK(outcome.errors.starts_with("binosplat: " + scene));
            CHECK(std::ranges::count(outcome.errors, '\n') == 1);
            CHECK(work.isEmpty());
        }
    }
}

TEST_CASE("the cache of the user keeps what --cache-limit lets it") {
    const Workplace work;
    const auto wall =
        std::make_unique<WebServer>([bytes = servedWall(work)](const WebRequest&) { return answer("200 OK", "ETag: \"1\"\r\n", bytes); });
    const std::string address = wall->at("/wall.ply");
    const fs::path cache = work.base / "caches/binosplat/web";
    CHECK(runWith(work, "info " + address + " --cache-limit 0").exit_code == 0);
    CHECK(filesIn(cache).empty());
    CHECK(runWith(work, "info " + address).exit_code == 0);
    CHECK(filesIn(cache).size() == 2);
    wall->stop();
    const Outcome outcome = runWith(work, "info " + address);
    CHECK(outcome.exit_code == 0);
    CHECK(contains(outcome.output, address + ": cannot be reached ("));
}

TEST_CASE("a server whose certificate is not valid is refused") {
    if (!isInstalled("openssl", "openssl")) { return; }
    const Workplace work;
    (void)servedWall(work);
    const std::string make =
        "openssl req -x509 -newkey rsa:2048 -nodes -keyout key.pem -out own.pem -subj /CN=localhost "
        "-addext subjectAltName=DNS:localhost,IP:127.0.0.1";
    REQUIRE(work.runCommand(make).exit_code == 0);
    // It ends after the second connection.
    const std::string serve = fmt::format(
        "cd '{}' && exec timeout 60 openssl s_server -accept 127.0.0.1:0 -key key.pem -cert own.pem -WWW -naccept 2 2> /dev/null",
        work.path.string());
    std::FILE* const told = ::popen(serve.c_str(), "r");
    REQUIRE(told != nullptr);
    std::array<char, 256> line{};
    std::string port;
    while (port.empty() && std::fgets(line.data(), static_cast<int>(line.size()), told) != nullptr) {
        const std::string text = line.data();
        if (text.starts_with("ACCEPT ")) { port = text.substr(text.rfind(':') + 1, text.find('\n') - text.rfind(':') - 1); }
    }
    const std::string address = fmt::format("https://127.0.0.1:{}/wall.ply", port);
    const Outcome refused = runWith(work, "info " + address);
    CHECK(refused.exit_code == 1);
    CHECK(contains(refused.errors, address + ": the server's certificate is not valid ("));
    // As one of an authority that the user trusts it is taken.
    const Outcome trusted = work.run(
        "info " + address, fmt::format("no_proxy=127.0.0.1 XDG_CACHE_HOME='{}' SSL_CERT_FILE=own.pem", (work.base / "caches").string()));
    INFO(trusted.errors);
    CHECK(trusted.exit_code == 0);
    ::pclose(told);
}

}  // namespace web_program_test
