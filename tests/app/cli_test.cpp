// Facts about the program as its user meets it: exit codes, one line for each error, and nothing left behind.
#include "engine/picture/image_io.h"
#include "engine/picture/join.h"
#include "tests/run_program.h"

SUITE(cli) {

const fs::path kSource = BINOSPLAT_SOURCE_DIR;
const std::string kNoDriver = "VK_DRIVER_FILES=/nonexistent/none.json VK_ICD_FILENAMES=/nonexistent/none.json";

nlohmann::json reportOf(const Workplace& work, const std::string& folder) {
    return nlohmann::json::parse(work.bytesOf(folder + "/report.json"));
}

TEST_CASE_FIXTURE(AtWork, "errors end the program with one line and the code of their kind, and leave nothing behind") {
    // A command line that is not understood, a value, a scene.
    work.checkRefused("render builtin:one-splat --out out --bogus", 2, "--bogus");
    work.checkRefused("render builtin:one-splat --out out --near 0", 1, "--near is 0, must be a number from 1e-06 to 1000000");
    work.checkRefused("render builtin:one-splat --out out --mode mono --periphery half", 1, "--periphery is half, but --foveation is 0");
    work.checkRefused("render missing.ply --out out", 1, "missing.ply");
    work.checkRefused("info missing.ply", 1, "missing.ply");
    work.checkRefused("render builtin:nothing --out out", 1, "builtin:nothing");
    // No usable device.
    work.checkRefused("render builtin:one-splat --out out/below", 3, "install", kNoDriver);
    work.checkRefused("render builtin:one-splat --out out --device nobody-has-this", 3, "nobody-has-this");
    work.checkRefused("stability --out out --device nobody-has-this", 3, "nobody-has-this");
    work.checkRefused("kernels", 3, "Vulkan", kNoDriver);
    work.checkRefused("kernels --device nobody", 3, "nobody");
    for (const char* filter : {"'('", "nothing"}) { work.checkRefused(fmt::format("kernels --filter {}", filter), 1, "--filter is "); }
#ifdef BINOSPLAT_OPENXR
    // What can be known before there is a headset comes first.
    const std::string no_runtime = "DISPLAY= WAYLAND_DISPLAY= XR_RUNTIME_JSON=/nonexistent/runtime.json";
    work.checkRefused("", 3, "OpenXR", no_runtime);
    work.checkRefused("view builtin:one-splat --desktop", 3, "there is no display", no_runtime);
    work.checkRefused("view builtin:one-splat", 3, "OpenXR", no_runtime);
    work.checkRefused("view builtin:one-splat --cameras missing.json", 1, "missing.json", no_runtime);
#endif
    CHECK(work.isEmpty());
    work.write("text.ply", "this is no scene\n");
    work.write("cut.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 10\nproperty float x\n");
    work.checkRefused("render text.ply --out out", 1, "text.ply");
    work.checkRefused("info cut.ply", 1, "cut.ply");
    // Without a driver: had the run come to rendering, the exit code would be 3.
    work.write("file", "keep me");
    work.checkRefused("render builtin:one-splat --out file", 1, "file: cannot be used as output directory", kNoDriver);
    work.checkRefused("render builtin:one-splat --out file/below", 1, "file/below: cannot be used as output directory", kNoDriver);
    work.checkRefused("bench builtin:one-splat --out file", 1, "file: cannot be used as output directory", kNoDriver);
    work.checkRefused("scene one-splat --out nowhere/a.ply", 1, "nowhere");
    work.checkRefused("scene one-splat --out a.txt", 1, ".ply");
    CHECK(work.run("info builtin:one-splat >/dev/full").exit_code == 1);
    CHECK(work.bytesOf("file") == "keep me");
    CHECK(work.files() == std::set<std::string>{"cut.ply", "file", "text.ply"});
}

TEST_CASE_FIXTURE(AtWork, "pipes, folders and endless files are refused at once") {
    REQUIRE(work.runCommand("mkfifo pipe.toml && mkdir folder.toml && truncate -s 100M long.toml").exit_code == 0);
    std::vector<std::string> commands{"render builtin:one-splat --out out --config ", "render builtin:one-splat --out out --cameras ",
                                      "render builtin:one-splat --out out --headset ./", "bench builtin:one-splat --out out --motion "};
#ifdef BINOSPLAT_OPENXR
    commands.push_back("view builtin:one-splat --frames 1 --out out --simulate ");
#endif
    for (const std::string& command : commands) {
        const bool is_recorded = command.ends_with("--cameras ") || command.ends_with("--motion ");
        work.checkRefused(command + "pipe.toml", 1, "pipe.toml");
        work.checkRefused(command + "folder.toml", 1, "folder.toml");
        work.checkRefused(command + "long.toml", 1, is_recorded ? "longer than 16 MiB" : "longer than 4 MiB");
    }
    fs::rename(work.path / "pipe.toml", work.path / "p.ppm");
    work.checkRefused("compare p.ppm p.ppm", 1, "not a regular file");
    CHECK_FALSE(work.holds("out"));
}

TEST_CASE_FIXTURE(AtWork, "what two hints say of a file is said once in its notes, and goes from file to file") {
    std::string ply = "ply\nformat ascii 1.0\ncomment SplatRenderMode: mip\nelement vertex 1\n";
    for (const char* name :
         {"x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"}) {
        ply += fmt::format("property float {}\n", name);
    }
    work.write("a.ply", ply + "end_header\n0 0 3 0 0 0 0.9 0.01 0.02 0.03 1 0 0 0\n");
    for (const std::string command : {"info a.ply", "render a.ply --mode mono --size 8x8 --out out", "convert a.ply b.ply"}) {
        const std::string output = work.go(command).output;
        const std::size_t first = output.find("activations applied");
        CHECK(first != std::string::npos);
        CHECK(output.find("activations applied", first + 1) == std::string::npos);
    }
    CHECK(reportOf(work, "out")["options"]["antialiased"] == true);
    work.go("convert b.ply c.spz");
    work.go("convert c.spz d.ply");
    for (const std::string file : {"a.ply", "b.ply", "c.spz", "d.ply"}) {
        CAPTURE(file);
        CHECK(work.run("info " + file).output.find("3D Gaussians, antialiased") != std::string::npos);
        CHECK(work.run("info " + file + " --flatten").output.find("antialiased") == std::string::npos);
    }
}

TEST_CASE_FIXTURE(AtWork, "of a camera that sees no splat one line says so, and where the nearest is") {
    const auto checkSaid = [&](const std::string& arguments, const std::string& part) {
        const Outcome outcome = work.go("render builtin:one-splat --size 16x8 --out out --eye 0,0,0 " + arguments);
        INFO(outcome.errors);
        CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
        CHECK(outcome.errors.find(part) != std::string::npos);
        CHECK(work.holds("out/report.json"));
        fs::remove_all(work.path / "out");
    };
    // The splat is at 0,0,2.
    for (const std::string mode : {"shared", "paper", "predicted"}) {
        checkSaid("--look 0,0,-1 --mode " + mode,
                  "binosplat: builtin:one-splat: no splat is seen from 0,0,0: the nearest is 2 scene units away, 180 degrees");
    }
    checkSaid("--look 0,0,1 --mode mono --near 3", "0 degrees off the middle of the picture; nothing nearer than 3 is drawn (near)");
    // Of several it says how many are too near.
    const Outcome cut = work.go("render builtin:two-layers --size 16x8 --out out --eye 0,0,0 --look 0,0,1 --mode mono --near 3");
    CHECK(cut.errors == "binosplat: builtin:two-layers: 1 of the 2 splats in the picture are nearer than 3 (near) and are cut off\n");
    fs::remove_all(work.path / "out");
    work.write("poses.csv", "0,0,0,0,0,0,0,1\n1,0,0,-9,0,0,0,1\n2,0,0,-10,0,0,0,1\n");
    checkSaid("--look 0,0,1 --mode mono --path poses.csv",
              "builtin:one-splat: frame 1, the first of 2 of 3: no splat is seen from 0,0,9: the nearest is 7 scene units away");
}

TEST_CASE_FIXTURE(AtWork, "render writes its files and nothing else") {
    const std::string float_extension = extensionOf(PictureKind::kFloat), display_extension = extensionOf(PictureKind::kDisplay);
    for (const std::string mode : {"mono", "two-pass", "shared", "reproject", "paper", "predicted"}) {
        const std::string command = fmt::format("render builtin:one-splat --size 40x24 --out a/{0} --mode {0}", mode);
        CHECK(work.go(command, "BINOSPLAT_VALIDATION=1").errors.empty());
        const fs::path folder = work.path / "a" / mode;
        using Names = std::vector<std::string>;
        for (const std::string& name : mode == "mono" ? Names{"mono"} : Names{"left", "right"}) {
            const Image picture = readPicture(folder / (name + float_extension));
            const Image display = readPicture(folder / (name + display_extension));
            CHECK(picture.size_px == glm::uvec2(40, 24));
            CHECK(display.channels == 3);
            // The middle of the disc: opacity 0.8 and colour (0.9, 0.6, 0.3), a little less beside its centre.
            const std::size_t middle = 12 * 40 + 20;
            CHECK(picture.values[middle * static_cast<std::size_t>(picture.channels)] == doctest::Approx(0.72).epsilon(0.05));
            CHECK(display.values[middle * 3] == doctest::Approx(0.72).epsilon(0.05));
        }
        CHECK(fs::exists(folder / ("roi" + display_extension)) == (mode != "mono"));
        const Image depth = readPicture(folder / ("dominant_depth" + float_extension));
        CHECK(these(depth.channels, depth.size_px) == these(1, glm::uvec2(40, 24)));
        const nlohmann::json report = reportOf(work, "a/" + mode);
        for (const char* key : {"device", "options", "gpu_ms", "gpu_total_ms", "counters", "peak_gpu_bytes", "left_out"}) {
            CHECK(report.contains(key));
        }
        CHECK(these(report["options"]["mode"], report["options"]["size"], report["options"]["gap-px"]) == these(mode, "40x24", 2));
        CHECK(report["counters"].contains("tiles_patched") == (mode == "reproject" || mode == "paper" || mode == "predicted"));
        CHECK(report["gpu_ms"].size() >= 7);
        if (mode == "reproject") { CHECK(report["counters"]["tiles_patched"] == 0); }
        for (const std::string& name : work.files()) { CHECK(name.find("/.") == std::string::npos); }
    }
    const auto eye = [&](const char* name) { return readPicture(work.path / "a" / "shared" / (name + display_extension)); };
    for (const std::string layout : {"sbs", "tb"}) {
        work.go("render builtin:one-splat --size 40x24 --mode shared --out both --layout " + layout);
        const Image both = readPicture(work.path / "both" / ("stereo" + display_extension));
        CHECK(both.size_px == (layout == "sbs" ? glm::uvec2(80, 24) : glm::uvec2(40, 48)));
        CHECK(both.values == (layout == "sbs" ? besideOneAnother : aboveOneAnother)(eye("left"), eye("right")).values);
    }
    CHECK_FALSE(fs::exists(work.path / "both" / ("left" + display_extension)));
}

TEST_CASE_FIXTURE(AtWork, "the default mode is predicted, and the budget is a share of the work") {
    const auto tilesPatched = [&](const std::string& options) {
        work.go("render builtin:step-edge --size 64x64 --out a " + options, "BINOSPLAT_VALIDATION=1");
        return reportOf(work, "a")["counters"]["tiles_patched"].get<int>();
    };
    CHECK(tilesPatched("") == 3);  // a fifth of what 16 tiles of like cost take
    CHECK(reportOf(work, "a")["options"]["mode"] == "predicted");
    CHECK(tilesPatched("--budget 0") == 0);
    CHECK(tilesPatched("--budget 0 --move-cost 100000") == 16);  // all are cheaper to render
    CHECK(tilesPatched("--mode paper --depth sum --resampling forward --per-eye --dominant right") > 0);
    CHECK(tilesPatched("--mode paper --center-roi --edge-bounds tight --dominant right --depth mean") > 0);
}

TEST_CASE_FIXTURE(AtWork, "BINOSPLAT_DATA names the folder that holds configs, and the program knows nothing of that of its sources") {
    const fs::path headsets = work.base / "data" / "configs" / "headsets";
    fs::create_directories(headsets);
    fs::copy_file(kSource / "configs" / "headsets" / "index.toml", headsets / "mine.toml");
    const std::string render = "render builtin:one-splat --mode mono --size 16x16 --out out --headset mine";
    work.checkRefused(render, 1, "mine.toml");
    work.go(render, fmt::format("BINOSPLAT_DATA='{}'", (work.base / "data").string()));
    const std::string program = textIn(BINOSPLAT_PROGRAM);
    REQUIRE(program.size() > 1'000'000);
    CHECK(program.find((kSource / "shaders").string()) == std::string::npos);
}

TEST_CASE_FIXTURE(AtWork, "every command has a help") {
    for (const char* command : {"", "render ", "bench ", "view ", "info ", "scene ", "convert ", "compare "}) {
        CHECK(!work.go(fmt::format("{}--help", command)).output.empty());
    }
}

TEST_CASE_FIXTURE(AtWork, "kernels that a filter fits are built and listed") {
    CHECK(work.go("kernels --filter '^present .*s=1'").output.starts_with("present kHalfColours=1\n1 kernels on "));
}

TEST_CASE_FIXTURE(AtWork, "every kernel, one for each variant of every shader, is built and listed" * nightly()) {
    work.go("kernels --out k");
    const auto listed = nlohmann::json::parse(work.bytesOf("k/kernels.json"));
    CHECK_FALSE(listed.at("device").get<std::string>().empty());
    std::set<std::string> shaders, files;
    std::set<std::pair<std::string, std::string>> variants;
    for (const auto& kernel : listed.at("kernels")) {
        shaders.insert(kernel.at("shader").get<std::string>());
        variants.emplace(kernel.at("shader").get<std::string>(), kernel.at("constants").dump());
        CHECK(kernel.at("statistics").is_object());
    }
    CHECK(variants.size() == listed.at("kernels").size());
    for (const auto& entry : fs::recursive_directory_iterator(kSource / "shaders")) {
        if (entry.path().extension() == ".comp") { files.insert(entry.path().stem().string()); }
    }
    CHECK(shaders == files);
}

}  // SUITE(cli)
