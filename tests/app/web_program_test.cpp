// Commands whose SCENE is a web address, run as a program.
#include "engine/builtin/procedural.h"
#include "engine/files/ply.h"
#include "engine/picture/image_io.h"
#include "tests/engine/files/web/web_runs.h"
#include "tests/run_program.h"

SUITE(web_program) {

// With a cache next to the workplace's folder.
std::string environmentOf(const Workplace& work) {
    return fmt::format("no_proxy=127.0.0.1 XDG_CACHE_HOME='{0}/caches' XDG_CONFIG_HOME='{0}/config'",
                       work.base.string());
}

TEST_CASE_FIXTURE(AtWork, "commands take an address, and the user's cache keeps what --cache-limit lets it") {
    writePly(makeBuiltin("builtin:slanted-wall", 0), (work.path / "wall.ply").string());
    const auto done = [&](const std::string& arguments) {
        const Outcome outcome = work.go(arguments, environmentOf(work));
        CHECK(outcome.errors.empty());
        return outcome.output;
    };
    const std::string camera = " --mode mono --size 64x64 --eye=0,0,-1 --look=0,0,1",
                      near = done("info wall.ply");
    const std::string picture = std::string("/mono") + extensionOf(PictureKind::kDisplay);
    done("render wall.ply --out near" + camera);
    done("convert wall.ply near.spz");
    WebServer server([bytes = work.bytesOf("wall.ply")](const WebRequest&) {
        return answer("200 OK", "ETag: \"1\"\r\n", bytes);
    });
    const std::string address = server.at("/wall.ply");
    CHECK(replaced(done("info " + address + " --cache-limit 0"), address, "wall.ply") == near);
    // Another machine's, from where it comes by others.
    const std::string of_others = "http://scenes.example/wall.ply";
    const Outcome by_proxy = work.go("info " + of_others + " --cache-limit 0",
                                     environmentOf(work) + " http_proxy=" + server.at(""));
    const std::string note =
        "note               " + of_others +
        ": came by http, so others on the way could read and change it; https is safer\n";
    CHECK(replaced(by_proxy.output, of_others, "wall.ply") == near + note);
    CHECK(filesIn(work.base / "caches/binosplat/web").empty());
    done("render " + address + " --out far" + camera);
    CHECK(filesIn(work.base / "caches/binosplat/web").size() == 2);
    CHECK(these(work.bytesOf("far" + picture).empty(), work.bytesOf("far" + picture)) ==
          these(false, work.bytesOf("near" + picture)));
    done("convert " + address + " far.spz");
    CHECK(work.bytesOf("far.spz") == work.bytesOf("near.spz"));
    work.write("one.toml", "[bench]\nmodes = [\"mono\"]\nscores = [\"none\"]\nwarm-up = 0\nrepeats = 1\n");
    CHECK(contains(done("bench " + address + " --out bench --config one.toml --size 64x64"), "wall.ply"));
#ifdef BINOSPLAT_OPENXR
    // Also without a command, as for a file.
    work.go(address + " --simulate --frames 2 --load-first --mode mono --hide-panel --hide-hands --out seen",
            environmentOf(work));
#endif
    server.stop();
    CHECK(contains(done("info " + address), address + ": cannot be reached ("));
}

TEST_CASE_FIXTURE(AtWork, "what is wrong with an address is one line, and nothing is left") {
    const WebServer server({{"/page", std::string("<html></html>")}});
    const std::string missing = server.at("/none.ply"), page = server.at("/page");
    work.checkRefused("render " + missing + " --out out", 1, "binosplat: " + missing, environmentOf(work));
    work.checkRefused("info " + page, 1, "binosplat: " + page, environmentOf(work));
    work.checkRefused("convert https:///a a.ply", 1, "binosplat: https:///a", environmentOf(work));
    CHECK(work.isEmpty());
}

}  // SUITE(web_program)
