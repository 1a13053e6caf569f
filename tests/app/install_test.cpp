// Facts about an installed program: it needs nothing of the folder it was built in.
#include "tests/engine/web/web_server.h"
#include "tests/run_program.h"

#include <doctest/doctest.h>

#include <fstream>
#include <regex>

TEST_SUITE_BEGIN("install");

namespace install_test {

namespace fs = std::filesystem;
using binosplat::test::Outcome;
using binosplat::test::Workplace;

namespace {

Outcome install(const Workplace& work, const fs::path& prefix, const std::string& component = "viewer") {
    return work.runCommand("'" BINOSPLAT_CMAKE "' --install '" BINOSPLAT_BUILD "' --component " + component + " --prefix '" +
                           prefix.string() + "'");
}

const std::string kRender = "render builtin:one-splat --size 16x16 --headset ";

}  // namespace

TEST_CASE("an installed program finds its headsets, from any folder") {
    const Workplace work;
    const fs::path prefix = work.base / "prefix";
    const Outcome installed = install(work, prefix);
    INFO(installed.errors);
    REQUIRE(installed.exit_code == 0);
    for (const char* file : {"bin/binosplat", "share/binosplat/configs/headsets/quest2.toml", "share/binosplat/configs/bench/paper.toml",
                             "share/doc/binosplat/LICENSE", "share/doc/binosplat/copyright", "share/man/man1/binosplat.1",
                             "share/bash-completion/completions/binosplat"}) {
        CHECK_MESSAGE(fs::exists(prefix / file), file);
    }
    const std::string program = (prefix / "bin" / "binosplat").string();
    const Outcome found = work.runCommand("'" + program + "' " + kRender + "quest2 --out out");
    INFO(found.errors);
    CHECK(found.exit_code == 0);
    CHECK(fs::exists(work.path / "out" / "report.json"));

    const Outcome unknown = work.runCommand("'" + program + "' " + kRender + "nobody --out other");
    CHECK(unknown.exit_code == 1);
    CHECK(unknown.errors.find("quest2") != std::string::npos);
    CHECK_FALSE(fs::exists(work.path / "other"));
}

TEST_CASE("an installed program that is started by the dynamic loader finds its headsets as well") {
    const Workplace work;
    const fs::path prefix = work.base / "prefix";
    REQUIRE(install(work, prefix).exit_code == 0);
    const std::string program = (prefix / "bin" / "binosplat").string();
    const std::string loader = "$(ldd '" + program + "' | grep -o '/[^ ]*/ld-linux[^ ]*')";
    const Outcome named = work.runCommand("echo " + loader);
    REQUIRE(named.output.find("ld-linux") != std::string::npos);
    const Outcome outcome = work.runCommand(loader + " '" + program + "' " + kRender + "quest2 --out out");
    INFO(outcome.errors);
    CHECK(outcome.exit_code == 0);
    CHECK(fs::exists(work.path / "out" / "report.json"));
}

TEST_CASE("links between the installed documents lead somewhere") {
    const Workplace work;
    REQUIRE(install(work, work.base / "prefix").exit_code == 0);
    const fs::path documents = work.base / "prefix" / "share" / "doc" / "binosplat";
    const std::regex link(R"(\]\(([^)\s#]+)[^)\s]*\))");
    int links = 0;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(documents)) {
        if (entry.path().extension() != ".md") { continue; }
        std::ifstream file(entry.path(), std::ios::binary);
        const std::string text(std::istreambuf_iterator<char>(file), {});
        for (std::sregex_iterator match(text.begin(), text.end(), link); match != std::sregex_iterator{}; ++match) {
            const std::string target = (*match)[1];
            if (target.starts_with("http")) { continue; }
            CHECK_MESSAGE(fs::exists(entry.path().parent_path() / target), entry.path().string() << ": " << target);
            ++links;
        }
    }
    CHECK(links > 50);
}

TEST_CASE("a program of somebody else finds the installed engine by CMake and renders a scene file in stereo") {
    const Workplace work;
    const fs::path prefix = work.base / "prefix";
    REQUIRE(install(work, prefix, "engine").exit_code == 0);
    const std::string cmake = "'" BINOSPLAT_CMAKE "' ";
    const Outcome built = work.runCommand(cmake + "-S '" BINOSPLAT_SOURCE_DIR "/tests/packages/engine' -B build -DCMAKE_PREFIX_PATH='" +
                                          prefix.string() + "' && " + cmake + "--build build");
    INFO(built.errors);
    REQUIRE(built.exit_code == 0);

    REQUIRE(work.run("scene atelier --splats 1000 --out room.ply").exit_code == 0);
    const Outcome rendered = work.runCommand("build/stereo room.ply 0 -1.5 0.5 0 -1.2 3");
    INFO(rendered.errors);
    REQUIRE(rendered.exit_code == 0);
    CHECK(rendered.output.starts_with("1000 splats on "));
    // The program makes the same pictures.
    const std::string view = "--eye 0,-1.5,0.5 --look 0,-1.2,3 --up 0,-1,0 --fov-x 68.7549354157 --size 512x384 --ipd 0.063 ";
    REQUIRE(work.run("render room.ply " + view + "--out same").exit_code == 0);
    CHECK(work.run("compare left.png same/left.png").output.starts_with("psnr inf\n"));
    CHECK(work.run("compare right.png same/right.png").output.starts_with("psnr inf\n"));

    // Also from a server, in a build that has the web.
    {
        std::ifstream file(work.path / "room.ply", std::ios::binary);
        const std::string bytes(std::istreambuf_iterator<char>(file), {});
        const binosplat::test::WebServer server({{"/room.ply", bytes}});
        const Outcome fetched = work.runCommand(
            fmt::format("mkdir far && cd far && no_proxy=127.0.0.1 XDG_CACHE_HOME='{}' ../build/stereo {} 0 -1.5 0.5 0 -1.2 3",
                        (work.base / "caches").string(), server.at("/room.ply")));
        INFO(fetched.errors);
#ifdef BINOSPLAT_WEB_TESTS
        REQUIRE(fetched.exit_code == 0);
        CHECK(work.runCommand("cmp left.png far/left.png && cmp right.png far/right.png").exit_code == 0);
#else
        CHECK(fetched.exit_code == 1);
        CHECK(fetched.errors.find("network") != std::string::npos);
#endif
    }

    const Outcome refused = work.runCommand("build/stereo nothing.ply");
    CHECK(refused.exit_code == 1);
    CHECK(refused.errors.starts_with("stereo: nothing.ply"));
    // Nothing but what the header declares.
    const Outcome symbols = work.runCommand("nm -D --defined-only -C \"$(find '" + prefix.string() + "' -name 'libbinosplat_engine.so')\"");
    CHECK(symbols.output.find("binosplat::engine::Renderer::load(") != std::string::npos);
    CHECK(symbols.output.find("binosplat::StereoFrame::") == std::string::npos);
}

#ifdef BINOSPLAT_OPENXR
TEST_CASE("an installed viewer runs on the installed simulated runtime") {
    const Workplace work;
    const fs::path prefix = work.base / "prefix";
    REQUIRE(install(work, prefix).exit_code == 0);
    const std::string view = "DISPLAY= WAYLAND_DISPLAY= '" + (prefix / "bin" / "binosplat").string() +
                             "' view builtin:one-splat --load-first --simulate --frames 30 --out seen";
    const Outcome without = work.runCommand(view);
    CHECK(without.exit_code == (fs::exists("/usr/share/openxr/1/binosplat_simulated_runtime.json") ? 0 : 3));
    REQUIRE(install(work, prefix, "runtime").exit_code == 0);
    // Other people's programs load the library: it brings what it can.
    const Outcome needs = work.runCommand("ldd \"$(find '" + prefix.string() + "' -name 'libbinosplat_simulated_runtime.so')\"");
    CHECK(needs.output.find("libpng") != std::string::npos);
    CHECK_MESSAGE(needs.output.find("libfmt") == std::string::npos, needs.output);
    for (const char* page : {"LICENSE", "copyright", "NOTICES.md", "openxr_runtime.md", "openxr_conformance.md", "simulated_script.md",
                             "test_your_openxr_program.md"}) {
        CHECK_MESSAGE(fs::exists(prefix / "share" / "doc" / "binosplat-simulated-runtime" / page), page);
    }
    const Outcome shown = work.runCommand(view);
    INFO(shown.errors);
    CHECK(shown.exit_code == 0);
    CHECK(fs::exists(work.path / "seen" / "frames.jsonl"));
}
#endif

TEST_CASE("packages of an untagged source say which, and those of a later commit are newer") {
    const Workplace work;
    fs::create_directories(work.path / "app");
    fs::copy_file(BINOSPLAT_SOURCE_DIR "/app/package_version.cmake", work.path / "app" / "package_version.cmake");
    std::ofstream(work.path / "print.cmake") << "set(CPACK_PACKAGE_VERSION 0.1.0)\ninclude(app/package_version.cmake)\n"
                                                "execute_process(COMMAND ${CMAKE_COMMAND} -E echo_append ${CPACK_PACKAGE_VERSION})\n";
    const auto version = [&] { return work.runCommand("GIT_CEILING_DIRECTORIES=\"$PWD/..\" '" BINOSPLAT_CMAKE "' -P print.cmake").output; };
    const auto git = [&](const std::string& arguments) {
        const Outcome done =
            work.runCommand("git -c core.hooksPath= -c commit.gpgSign=false -c user.name=test -c user.email=test " + arguments);
        INFO(done.errors);
        REQUIRE(done.exit_code == 0);
    };
    const auto isOlder = [&](const std::string& first, const std::string& second) {
        return work.runCommand("dpkg --validate-version '" + first + "' && dpkg --compare-versions '" + first + "' lt '" + second + "'")
                   .exit_code == 0;
    };
    CHECK(version() == "0.1.0");  // no checkout
    git("init -q");
    git("add -A");
    git("commit -q -m first");
    const std::string first = version();
    CHECK(first.starts_with("0.1.0~git1."));
    CHECK(isOlder(first, "0.1.0"));
    git("commit -q --allow-empty -m second");
    const std::string second = version();
    CHECK(isOlder(first, second));
    git("tag v0.1.0");
    CHECK(version() == "0.1.0");
    git("commit -q --allow-empty -m third");
    CHECK(version().starts_with("0.1.0+git3."));
    CHECK(isOlder("0.1.0", version()));
    std::ofstream(work.path / "print.cmake", std::ios::app) << "\n";
    CHECK(version().ends_with(".dirty"));
}

TEST_CASE("BINOSPLAT_DATA names the folder that holds configs") {
    const Workplace work;
    const fs::path headsets = work.base / "data" / "configs" / "headsets";
    fs::create_directories(headsets);
    fs::copy_file(fs::path(BINOSPLAT_SOURCE_DIR) / "configs" / "headsets" / "index.toml", headsets / "mine.toml");
    CHECK(work.run(kRender + "mine --out out").exit_code == 1);
    const Outcome chosen = work.run(kRender + "mine --out out", "BINOSPLAT_DATA='" + (work.base / "data").string() + "'");
    INFO(chosen.errors);
    CHECK(chosen.exit_code == 0);
}

TEST_CASE("the program knows nothing of the folder whose sources it was built from") {
    std::ifstream file(BINOSPLAT_PROGRAM, std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(file), {});
    REQUIRE(bytes.size() > 1'000'000);
    CHECK(bytes.find(BINOSPLAT_SOURCE_DIR "/shaders") == std::string::npos);
}

TEST_CASE("docs/options.md is what the program says of its options") {
    const Workplace work;
    const Outcome made = work.run("document markdown");
    CHECK(made.exit_code == 0);
    std::ifstream file(fs::path(BINOSPLAT_SOURCE_DIR) / "docs" / "options.md", std::ios::binary);
    CHECK_MESSAGE(made.output == std::string(std::istreambuf_iterator<char>(file), {}),
                  "run `binosplat document markdown > docs/options.md`");
}

TEST_CASE("bash completes commands, options and the values of choices") {
    const Workplace work;
    const auto complete = [&](const std::string& words, int word) {
        return work
            .runCommand("'" BINOSPLAT_PROGRAM "' document bash > c && bash -c 'source ./c; COMP_WORDS=(" + words +
                        "); COMP_CWORD=" + std::to_string(word) + "; _binosplat; echo \"${COMPREPLY[*]}\"'")
            .output;
    };
    CHECK(complete("binosplat re", 1) == "render\n");
    CHECK(complete("binosplat render --mode pre", 3) == "predicted\n");
    CHECK(complete("binosplat compare --lp", 2) == "--lpips\n");
    // Files where an option takes one, and only there.
    std::ofstream(work.path / "poses.csv") << "x";
    CHECK(complete("binosplat render --path pos", 3) == "poses.csv\n");
    CHECK(complete("binosplat bench --motion pos", 3) == "poses.csv\n");
    CHECK(complete("binosplat render --rate pos", 3) == "\n");
}

TEST_CASE("the man page has every command and no line that groff complains about") {
    const Workplace work;
    REQUIRE(work.run("document man").exit_code == 0);
    const Outcome formatted =
        work.runCommand("'" BINOSPLAT_PROGRAM "' document man > page && { ! command -v groff >/dev/null || groff -man -Tascii -ww page; }");
    CHECK(formatted.exit_code == 0);
    CHECK(formatted.errors.empty());
    CHECK(work.run("document page").exit_code == 2);
}

}  // namespace install_test
