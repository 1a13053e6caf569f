// Commands whose SCENE is an address, run as a program.
#include "engine/scene/ply.h"
#include "engine/scene/procedural.h"
#include "tests/engine/scene/spz_files.h"
#include "tests/run_program.h"
#include "tests/xr/simulated/installed.h"
#ifdef BINOSPLAT_SOG
#include "tests/engine/scene/streamed_scenes.h"
#endif
#include "tests/engine/web/web_runs.h"

#include <array>
#include <csignal>
#include <cstdio>
#include <optional>

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

// key.pem and own.pem, a certificate of the loopback address that nobody vouches for.
void makeCertificate(const Workplace& work) {
    const std::string make =
        "openssl req -x509 -newkey rsa:2048 -nodes -keyout key.pem -out own.pem -subj /CN=localhost "
        "-addext subjectAltName=DNS:localhost,IP:127.0.0.1";
    REQUIRE(work.runCommand(make).exit_code == 0);
}

// A program that runs beside the test, for at most a minute.
class Beside {
public:
    Beside(const Workplace& work, const std::string& command)
        : told_(::popen(fmt::format("cd '{}' && echo $$ && exec timeout --foreground 60 {}", work.path.string(), command).c_str(), "r")) {
        REQUIRE(told_ != nullptr);
        pid_ = std::stoi(lineWith("").value());
    }
    Beside(const Beside&) = delete;
    Beside& operator=(const Beside&) = delete;
    ~Beside() {
        end();
        ::pclose(told_);
    }

    // The next line of what it prints that has `part` in it; none at its end.
    std::optional<std::string> lineWith(const std::string& part) {
        std::array<char, 1024> line{};
        while (std::fgets(line.data(), static_cast<int>(line.size()), told_) != nullptr) {
            if (contains(line.data(), part)) { return line.data(); }
        }
        return std::nullopt;
    }
    void end() const { ::kill(pid_, SIGTERM); }

private:
    std::FILE* told_;
    pid_t pid_ = 0;
};

// What a program of its own may listen on: free a moment ago.
int freePort() {
    const WebServer server(std::map<std::string, std::string>{});
    const std::string address = server.at("");
    return std::stoi(address.substr(address.rfind(':') + 1));
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
    makeCertificate(work);
    // It ends after the second connection.
    Beside server(work, "openssl s_server -accept 127.0.0.1:0 -key key.pem -cert own.pem -WWW -naccept 2 2> /dev/null");
    const std::string listens = server.lineWith("ACCEPT ").value();
    const std::string port = listens.substr(listens.rfind(':') + 1, listens.find('\n') - listens.rfind(':') - 1);
    const std::string address = fmt::format("https://127.0.0.1:{}/wall.ply", port);
    const Outcome refused = runWith(work, "info " + address);
    CHECK(refused.exit_code == 1);
    CHECK(contains(refused.errors, address + ": the server's certificate is not valid ("));
    // As one of an authority that the user trusts it is taken.
    const Outcome trusted = work.run(
        "info " + address, fmt::format("no_proxy=127.0.0.1 XDG_CACHE_HOME='{}' SSL_CERT_FILE=own.pem", (work.base / "caches").string()));
    INFO(trusted.errors);
    CHECK(trusted.exit_code == 0);
}

#ifdef BINOSPLAT_SOG
TEST_CASE("a server with HTTP/2 sends all files of a scene over one connection") {
    if (!isInstalled("openssl", "openssl") || !isInstalled("nghttpd", "nghttp2-server")) { return; }
    const Workplace work;
    const Folder folder;
    const std::filesystem::path scene = writeSogFolder(folder, "sog", makeSog());
    makeCertificate(work);
    const int port = freePort();
    Beside server(work, fmt::format("nghttpd -v -a 127.0.0.1 -d '{}' {} key.pem own.pem 2> /dev/null", folder.file("sog"), port));
    REQUIRE(server.lineWith("listen 127.0.0.1"));
    const std::string address = fmt::format("https://127.0.0.1:{}/meta.json", port);
    const Outcome far = work.run(
        "info " + address, fmt::format("no_proxy=127.0.0.1 XDG_CACHE_HOME='{}' SSL_CERT_FILE=own.pem", (work.base / "caches").string()));
    INFO(far.errors);
    CHECK(far.exit_code == 0);
    const std::string near = work.run("info '" + scene.string() + "'").output;
    CHECK(far.output.substr(far.output.find('\n')) == near.substr(near.find('\n')));
    server.end();
    std::size_t asked = 0;
    while (const auto line = server.lineWith(":path: ")) {
        ++asked;
        CHECK_MESSAGE(line->starts_with("[id=1]"), *line);  // the first connection
    }
    CHECK(asked == makeSog().size());
}
#endif

}  // namespace web_program_test
