// Facts about an installed program; see install_test.txt.
#include "tests/app/document_links.h"
#include "tests/app/program_script.h"
#include "tests/engine/files/web/web_server.h"

SUITE(install) {

// The example draws a scene from a server just as it draws the file.
void checkFetched(const Workplace& work, const std::string& scene) {
    const WebServer server(WebPages{{"/" + scene, work.bytesOf(scene)}});
    const Outcome fetched =
        work.runCommand(fmt::format("mkdir far && cd far && no_proxy=127.0.0.1 XDG_CACHE_HOME='{}' "
                                    "../build/stereo {} 0 -1.5 0.5 0 -1.2 3",
                                    (work.base / "caches").string(), server.at("/" + scene)));
    INFO(fetched.errors);
#ifdef BINOSPLAT_WEB_TESTS
    REQUIRE(fetched.exit_code == 0);
    CHECK(work.runCommand("cmp left.png far/left.png && cmp right.png far/right.png").exit_code == 0);
#else
    CHECK(fetched.exit_code == 1);
    CHECK(contains(fetched.errors, "network"));
#endif
}

SCRIPT(install, "app/install") {
    const Workplace work;
    ScriptHost host = programIn(work);
    const std::string prefix = (work.base / "prefix").string(),
                      install = "'" BINOSPLAT_CMAKE "' --install '" BINOSPLAT_BUILD "' ";
    host.names.merge(
        std::map<std::string, std::string>{{"CMAKE", BINOSPLAT_CMAKE},
                                           {"BUILD", BINOSPLAT_BUILD},
                                           {"PREFIX", prefix},
                                           {"INSTALL", install + "--prefix " + prefix + " --component"}});
    const bool twice = fs::exists("/usr/share/openxr/1/binosplat_simulated_runtime.json");
    if (host.features.contains("openxr")) { host.features.insert(twice ? "openxr-twice" : "openxr-alone"); }
    host.verbs["links"] = [](const std::string& folder) { checkLinks(documentsIn(folder)); };
    host.verbs["fetch"] = [&](const std::string& scene) { checkFetched(work, scene); };
    runScript(host);
}

}  // SUITE(install)
