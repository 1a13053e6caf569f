// See web_program_test.txt.
#include "engine/builtin/procedural.h"
#include "engine/files/ply.h"
#include "tests/app/program_script.h"
#include "tests/engine/files/web/web_server.h"

SUITE(web_program) {

// stop: the server, from which the wall comes.
SCRIPT(web_program, "app/web_program") {
    const Workplace work;
    writePly(makeBuiltin("builtin:slanted-wall", 0), (work.path / "wall.ply").string());
    WebServer server([bytes = work.bytesOf("wall.ply")](const WebRequest& request) {
        return request.path.ends_with("/wall.ply") ? answer("200 OK", "ETag: \"1\"\r\n", bytes)
                                                   : answerFrom({{"/page", "<html></html>"}}, request);
    });
    // With a cache next to the workplace's folder.
    const std::string own = fmt::format(
        "no_proxy=127.0.0.1 XDG_CACHE_HOME='{0}/caches' XDG_CONFIG_HOME='{0}/config' ", work.base.string());
    ScriptHost host = programIn(work);
    host.run = [&](const std::string& words, const std::string& environment) {
        return work.run(words, own + environment);
    };
    host.names["SERVER"] = server.at("");
    host.verbs["stop"] = [&](const std::string&) { server.stop(); };
    runScript(host);
}

}  // SUITE(web_program)
