// Facts about an installed program: it needs nothing of the folder it was built in.
#include "tests/engine/files/web/web_server.h"
#include "tests/run_program.h"

#include <regex>

SUITE(install) {

// A command of the shell that is expected to end well.
Outcome goCommand(const Workplace& work, const std::string& command) {
    Outcome outcome = work.runCommand(command);
    INFO(command << ": " << outcome.errors);
    REQUIRE(outcome.exit_code == 0);
    return outcome;
}

void install(const Workplace& work, const fs::path& prefix, const std::string& component) {
    goCommand(work,
              "'" BINOSPLAT_CMAKE "' --install '" BINOSPLAT_BUILD "' --component " + component + " --prefix '" + prefix.string() + "'");
}

const std::string kRender = "render builtin:one-splat --size 16x16 --headset ";

TEST_CASE("an installed program finds its headsets, from any folder and by the loader, and runs on the installed runtime" * nightly()) {
    const Workplace work;
    const fs::path prefix = work.base / "prefix";
    install(work, prefix, "viewer");
    for (const char* file : {"bin/binosplat", "share/binosplat/configs/headsets/quest2.toml", "share/binosplat/configs/bench/paper.toml",
                             "share/doc/binosplat/LICENSE", "share/doc/binosplat/copyright", "share/man/man1/binosplat.1",
                             "share/bash-completion/completions/binosplat", "share/zsh/site-functions/_binosplat",
                             "share/fish/vendor_completions.d/binosplat.fish", "share/applications/org.binosplat.viewer.desktop",
                             "share/metainfo/org.binosplat.viewer.metainfo.xml", "share/mime/packages/org.binosplat.viewer.xml",
                             "share/icons/hicolor/scalable/apps/org.binosplat.viewer.svg"}) {
        CHECK_MESSAGE(fs::exists(prefix / file), file);
    }
    const std::string program = "'" + (prefix / "bin" / "binosplat").string() + "' ";
    const std::string loader = "$(ldd " + program + " | grep -o '/[^ ]*/ld-linux[^ ]*') ";
    goCommand(work, program + kRender + "quest2 --out out");
    CHECK(work.holds("out/report.json"));
    REQUIRE(goCommand(work, "echo " + loader).output.find("ld-linux") != std::string::npos);
    goCommand(work, loader + program + kRender + "quest2 --out by-loader");
    CHECK(work.holds("by-loader/report.json"));
    const Outcome unknown = work.runCommand(program + kRender + "nobody --out other");
    CHECK(unknown.exit_code == 1);
    CHECK(unknown.errors.find("quest2") != std::string::npos);
    CHECK_FALSE(work.holds("other"));
    // Links between the documents lead somewhere.
    const std::regex link(R"(\]\(([^)\s#]+)[^)\s]*\))");
    int links = 0;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(prefix / "share" / "doc" / "binosplat")) {
        if (entry.path().extension() != ".md") { continue; }
        const std::string text = textIn(entry.path());
        for (std::sregex_iterator match(text.begin(), text.end(), link); match != std::sregex_iterator{}; ++match) {
            const std::string target = (*match)[1];
            if (target.starts_with("http")) { continue; }
            CHECK_MESSAGE(fs::exists(entry.path().parent_path() / target), entry.path().string() << ": " << target);
            ++links;
        }
    }
    CHECK(links > 50);
#ifdef BINOSPLAT_OPENXR
    const std::string view =
        "DISPLAY= WAYLAND_DISPLAY= " + program + "view builtin:one-splat --load-first --simulate --frames 30 --out seen";
    const bool has_other = fs::exists("/usr/share/openxr/1/binosplat_simulated_runtime.json");
    CHECK(work.runCommand(view).exit_code == (has_other ? 0 : 3));
    install(work, prefix, "runtime");
    // Other people's programs load the library: it brings what it can.
    const Outcome needs = work.runCommand("ldd \"$(find '" + prefix.string() + "' -name 'libbinosplat_simulated_runtime.so')\"");
    CHECK(needs.output.find("libpng") != std::string::npos);
    CHECK_MESSAGE(needs.output.find("libfmt") == std::string::npos, needs.output);
    for (const char* page : {"LICENSE", "copyright", "NOTICES.md", "openxr_runtime.md", "openxr_conformance.md", "simulated_script.md",
                             "test_your_openxr_program.md"}) {
        CHECK_MESSAGE(fs::exists(prefix / "share" / "doc" / "binosplat-simulated-runtime" / page), page);
    }
    goCommand(work, view);
    CHECK(work.holds("seen/frames.jsonl"));
#endif
}

TEST_CASE_FIXTURE(AtWork, "somebody else's program finds the installed library by CMake and renders a scene file in stereo" * nightly()) {
    const fs::path prefix = work.base / "prefix";
    install(work, prefix, "library");
    install(work, prefix, "development");
    const std::string cmake = "'" BINOSPLAT_CMAKE "' ";
    goCommand(work, cmake + "-S '" BINOSPLAT_SOURCE_DIR "/examples' -B build -DCMAKE_PREFIX_PATH='" + prefix.string() + "' && " + cmake +
                        "--build build");
    work.go("scene atelier --splats 1000 --out room.ply");
    CHECK(goCommand(work, "build/stereo room.ply 0 -1.5 0.5 0 -1.2 3").output.starts_with("1000 splats on "));
    // The program makes the same pictures.
    const std::string view = "--eye 0,-1.5,0.5 --look 0,-1.2,3 --up 0,-1,0 --fov-x 68.7549354157 --size 512x384 --ipd 0.063 ";
    work.go("render room.ply " + view + "--out same");
    CHECK(work.run("compare left.png same/left.png").output.starts_with("psnr inf\n"));
    CHECK(work.run("compare right.png same/right.png").output.starts_with("psnr inf\n"));

#ifdef BINOSPLAT_OPENXR
    // An OpenXR program with its own device and a cube, in the simulated headset; the layers print what they find.
    work.write("headset.script", "size 128 128\nframes every 10\nat 0.15 exit\n");
    const Outcome worn =
        goCommand(work, "XR_RUNTIME_JSON='" BINOSPLAT_BUILD
                        "/bin/simulated_runtime.json' SIMULATED_OPENXR_SCRIPT=headset.script SIMULATED_OPENXR_OUT=seen "
                        "SIMULATED_OPENXR_CLOCK=lockstep VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation "
                        "VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT build/openxr_program");
    CHECK(these(worn.output, worn.errors.empty()) == these("14 frames\n", true));
    CHECK(work.holds("seen/frame_000010.png"));
#endif

    // Also from a server, in a build that has the web.
    {
        const WebServer server({{"/room.ply", work.bytesOf("room.ply")}});
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
    // And by pkg-config, in C.
    const fs::path settings = prefix / goCommand(work, "cd '" + prefix.string() + "' && find . -name pkgconfig -printf %P").output;
    work.write("version.c", "#include <binosplat.h>\n#include <stdio.h>\nint main(void) { puts(bsp_version()); return 0; }\n");
    goCommand(work, "cc version.c -o version $(PKG_CONFIG_PATH='" + settings.string() + "' pkg-config --cflags --libs binosplat)");
    CHECK(goCommand(work, "LD_LIBRARY_PATH='" + settings.parent_path().string() + "' ./version").output == "0.1.0\n");
}

TEST_CASE_FIXTURE(AtWork, "packages of an untagged source say which, and those of a later commit are newer" * nightly()) {
    fs::create_directories(work.path / "app");
    fs::copy_file(BINOSPLAT_SOURCE_DIR "/app/package_version.cmake", work.path / "app" / "package_version.cmake");
    work.write("print.cmake",
               "set(CPACK_PACKAGE_VERSION 0.1.0)\ninclude(app/package_version.cmake)\n"
               "execute_process(COMMAND ${CMAKE_COMMAND} -E echo_append ${CPACK_PACKAGE_VERSION})\n");
    const auto version = [&] { return work.runCommand("GIT_CEILING_DIRECTORIES=\"$PWD/..\" '" BINOSPLAT_CMAKE "' -P print.cmake").output; };
    const auto git = [&](const std::string& arguments) {
        goCommand(work, "git -c core.hooksPath= -c commit.gpgSign=false -c user.name=test -c user.email=test " + arguments);
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
    work.write("print.cmake", work.bytesOf("print.cmake") + "\n");
    CHECK(version().ends_with(".dirty"));
}

}  // SUITE(install)
