// Facts about the program as its user meets it: exit codes, one line for each error, and nothing left behind.
#include "engine/picture/image_io.h"
#include "tests/engine/picture/lpips_weights.h"
#include "tests/engine/scene/gltf_files.h"
#include "tests/run_program.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <fstream>
#include <utility>

TEST_SUITE_BEGIN("cli");

namespace cli_test {

namespace fs = std::filesystem;
using namespace binosplat;
using namespace binosplat::test;

namespace {

// The error is one line that holds `part`.
void checkRefused(const Outcome& outcome, int exit_code, const std::string& part) {
    INFO("stderr: " << outcome.errors);
    CHECK(outcome.exit_code == exit_code);
    CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
    CHECK(outcome.errors.starts_with("binosplat: "));
    CHECK(outcome.errors.find(part) != std::string::npos);
}

void write(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

const std::string kNoDriver = "VK_DRIVER_FILES=/nonexistent/none.json VK_ICD_FILENAMES=/nonexistent/none.json";

}  // namespace

TEST_CASE("usageErrorsExitWithTwo") {
    const Workplace work;
    checkRefused(work.run(""), 2, "subcommand");
    checkRefused(work.run("frobnicate"), 2,
                 "frobnicate is not a command; must be one of: render, bench, view, info, scene, convert, compare");
    checkRefused(work.run("render"), 2, "SCENE");
    checkRefused(work.run("render builtin:one-splat"), 2, "--out");
    checkRefused(work.run("render builtin:one-splat --out out --bogus"), 2, "--bogus");
    checkRefused(work.run("render builtin:one-splat --out out --near"), 2, "--near");
    checkRefused(work.run("render builtin:one-splat --out out --view 1"), 2, "--cameras");
    checkRefused(work.run("render builtin:one-splat --out out --headset quest2 --fov-x 60"), 2, "--headset and --fov-x");
    checkRefused(work.run("render builtin:one-splat --out out --cameras c.json --eye 0,0,0"), 2, "--cameras and --eye");
    checkRefused(work.run("bench --out out"), 2, "SCENE");
    checkRefused(work.run("stability"), 2, "--out");
    checkRefused(work.run("bench builtin:one-splat --out out --photos p"), 2, "--cameras");
    checkRefused(work.run("bench builtin:one-splat --out out --every 2"), 2, "--motion or --photos");
    checkRefused(work.run("bench builtin:one-splat --out out --motion m.csv --lpips w.bin"), 2, "--motion and --lpips");
    checkRefused(work.run("bench builtin:one-splat --out out --motion m.csv --cameras c.json --photos p"), 2, "--motion and --photos");
    CHECK(work.isEmpty());
}

TEST_CASE("badValuesExitWithOneAndSayTheRange") {
    const Workplace work;
    const std::string render = "render builtin:one-splat --out out ";
    for (const char* size : {"0x0", "70000x70000", "16385x1", "0x16", "-1x5", "12", "axb", "1x2x3", "99999999999999999999x1"}) {
        checkRefused(work.run(render + "--size " + size), 1,
                     "--size is " + std::string(size) + ", must be WIDTHxHEIGHT with 1 to 16384 pixels per side");
    }
    checkRefused(work.run(render + "--eye 1,2"), 1, "--eye is 1,2, must be three finite numbers");
    checkRefused(work.run(render + "--eye 1,2,nan"), 1, "three finite numbers");
    checkRefused(work.run(render + "--eye 1,2,3,4"), 1, "three finite numbers");
    checkRefused(work.run(render + "--eye 0,0,0 --look 0,0,0"), 1, "span a view");
    checkRefused(work.run(render + "--up 0,0,1 --eye 0,0,0 --look 0,0,1"), 1, "span a view");
    checkRefused(work.run(render + "--fov-x 180"), 1, "--fov-x is 180, must be a number from 0.1 to 179");
    checkRefused(work.run(render + "--near 0"), 1, "--near is 0, must be a number from 1e-06 to 1000000");
    checkRefused(work.run(render + "--near inf"), 1, "--near is inf");
    checkRefused(work.run(render + "--background 0,0,2"), 1, "--background is 0,0,2");
    checkRefused(work.run(render + "--ipd -1"), 1, "--ipd is -1");
    checkRefused(work.run(render + "--budget 1.5"), 1, "--budget is 1.5, must be a number from 0 to 1");
    checkRefused(work.run(render + "--margin 1.5"), 1, "--margin is 1.5");
    checkRefused(work.run(render + "--dominant middle"), 1, "--dominant is middle, must be left or right");
    checkRefused(work.run(render + "--depth median"), 1, "--depth is median, must be sum, mean or inverse");
    checkRefused(work.run(render + "--order index"), 1, "--order is index, must be depth or distance");
    checkRefused(work.run(render + "--mode fast"), 1, "--mode is fast, must be mono");
    checkRefused(work.run(render + "--gap-px 65"), 1, "--gap-px is 65, must be a whole number from 0 to 64");
    checkRefused(work.run(render + "--resampling nearest"), 1, "--resampling is nearest, must be cubic or forward");
    checkRefused(work.run(render + "--edge-samples 0"), 1, "--edge-samples is 0, must be a whole number from 1");
    checkRefused(work.run(render + "--edge-bounds loose"), 1, "--edge-bounds is loose, must be paper or tight");
    checkRefused(work.run(render + "--hole-error nan"), 1, "--hole-error is nan, must be a number from 0 to 8");
    checkRefused(work.run(render + "--newcomer-error -1"), 1, "--newcomer-error is -1, must be a number from 0 to 8");
    checkRefused(work.run(render + "--foveation 91"), 1, "--foveation is 91, must be a number from 0 to 90");
    checkRefused(work.run(render + "--periphery quarter"), 1, "--periphery is quarter, must be full or half");
    checkRefused(work.run(render + "--mode mono --periphery half"), 1, "--periphery is half, but --foveation is 0, must be the angle");
    checkRefused(work.run(render + "--mode temporal --periphery half"), 1, "--periphery is half, but --foveation is 0, must be the angle");
    checkRefused(work.run(render + "--gaze 0,0,0"), 1, "--gaze is 0,0,0, must be a direction x,y,z, not 0,0,0");
    checkRefused(work.run(render + "--headset nobody"), 1, "nobody.toml: not found");
    CHECK(work.isEmpty());
}

TEST_CASE("badScenesExitWithOne") {
    const Workplace work;
    checkRefused(work.run("render missing.ply --out out"), 1, "missing.ply");
    checkRefused(work.run("info missing.ply"), 1, "missing.ply");
    checkRefused(work.run("render builtin:nothing --out out"), 1, "builtin:nothing");
    checkRefused(work.run("bench missing.ply --out out"), 1, "missing.ply");
    CHECK(work.isEmpty());
    write(work.path / "text.ply", "this is no scene\n");
    write(work.path / "cut.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 10\nproperty float x\n");
    checkRefused(work.run("render text.ply --out out"), 1, "text.ply");
    checkRefused(work.run("info cut.ply"), 1, "cut.ply");
    CHECK(!fs::exists(work.path / "out"));
}

TEST_CASE("unusableOutputIsRefusedBeforeRendering") {
    const Workplace work;
    write(work.path / "file", "keep me");
    // No driver: had the run come to rendering, the exit code would be 3.
    checkRefused(work.run("render builtin:one-splat --out file", kNoDriver), 1, "file: cannot be used as output directory");
    checkRefused(work.run("render builtin:one-splat --out file/below", kNoDriver), 1, "file/below: cannot be used as output directory");
    checkRefused(work.run("bench builtin:one-splat --out file", kNoDriver), 1, "file: cannot be used as output directory");
    checkRefused(work.run("scene one-splat --out nowhere/a.ply"), 1, "nowhere");
    checkRefused(work.run("scene one-splat --out a.txt"), 1, ".ply");
    CHECK(fs::file_size(work.path / "file") == 7);
}

TEST_CASE("withoutADeviceTheExitCodeIsThree") {
    const Workplace work;
    const Outcome outcome = work.run("render builtin:one-splat --out out/below", kNoDriver);
    checkRefused(outcome, 3, "install");
    checkRefused(work.run("render builtin:one-splat --out out --device nobody-has-this"), 3, "nobody-has-this");
    checkRefused(work.run("stability --out out --device nobody-has-this"), 3, "nobody-has-this");
    CHECK(work.isEmpty());
}

#ifdef BINOSPLAT_OPENXR
TEST_CASE("viewSaysWhatIsMissing") {
    const Workplace work;
    checkRefused(work.run("view builtin:one-splat", "XR_RUNTIME_JSON=/nonexistent/runtime.json"), 3, "OpenXR");
    // What can be known before there is a headset.
    checkRefused(work.run("view builtin:one-splat --cameras missing.json", "XR_RUNTIME_JSON=/nonexistent/runtime.json"), 1, "missing.json");
    checkRefused(work.run("view builtin:one-splat --view 1"), 2, "--view is given without --cameras");
}
#endif

TEST_CASE("configErrorsNameFileAndLine") {
    const Workplace work;
    const auto refuse = [&](const std::string& text, const std::string& part) {
        write(work.path / "a.toml", text);
        checkRefused(work.run("render builtin:one-splat --out out --config a.toml"), 1, part);
    };
    refuse("[camera]\n\nnear = 0\n", "a.toml:3: near is 0, must be a number from 1e-06 to 1000000");
    refuse("size = \"0x5\"\n", "a.toml:1: size is 0x5, must be WIDTHxHEIGHT with 1 to 16384");
    refuse("[camera]\neye = [1, 2]\n", "a.toml:2: eye is 1,2, must be three");
    refuse("[stereo]\nmargin = -1\n", "a.toml:2: margin is -1");
    refuse("[stereo]\ncenter-roi = 1\n", "a.toml:2: center-roi is 1, must be true or false");
    refuse("[stereo]\ngap_px = 1.5\n", "a.toml:2: gap_px is 1.5, must be a whole number from 0 to 64");
    refuse("[stereo]\nedge_bounds = 3\n", "a.toml:2: edge_bounds is 3, must be paper or tight");
    refuse("[stereo]\nmargins = 1\n", "a.toml:2: margins is not a known key");
    refuse("[stereo]\nnear = 1\n", "a.toml:2: near stands in [stereo], must stand in [camera]");
    refuse("[stereoo]\nmargin = 1\n", "a.toml:1: [stereoo] is not a known table");
    refuse("near = 1\n[camera]\nnear = 2\n", "near is set twice");
    refuse("[camera]\nnear = \n", "a.toml:2: ");
    refuse("[camera]\nheadset = \"quest2\"\nfov_x = 60\n", "contradict");
    checkRefused(work.run("render builtin:one-splat --out out --config none.toml"), 1, "none.toml");
    CHECK(!fs::exists(work.path / "out"));
}

TEST_CASE("pipesFoldersAndEndlessFilesAreRefusedAtOnce") {
    const Workplace work;
    REQUIRE(work.runCommand("mkfifo pipe.toml && mkdir folder.toml && truncate -s 100M long.toml").exit_code == 0);
    std::vector<std::string> commands{"render builtin:one-splat --out out --config ", "render builtin:one-splat --out out --cameras ",
                                      "render builtin:one-splat --out out --headset ./", "bench builtin:one-splat --out out --config ",
                                      "bench builtin:one-splat --out out --motion "};
#ifdef BINOSPLAT_OPENXR
    commands.insert(commands.end(), {"view builtin:one-splat --config ", "view builtin:one-splat --frames 1 --out out --simulate "});
#endif
    for (const std::string& command : commands) {
        const bool is_recorded = command.ends_with("--cameras ") || command.ends_with("--motion ");
        for (const char* file : {"pipe.toml", "folder.toml", "long.toml"}) {
            INFO(command << file);
            const Outcome outcome = work.run(command + file);
            checkRefused(outcome, 1, std::string(file) == "long.toml" ? (is_recorded ? "longer than 16 MiB" : "longer than 4 MiB") : file);
        }
    }
    checkRefused(work.runCommand("mv pipe.toml p.ppm && timeout 60 '" BINOSPLAT_PROGRAM "' compare p.ppm p.ppm"), 1, "not a regular file");
    CHECK(!fs::exists(work.path / "out"));
}

TEST_CASE("badCameraFilesNameCameraAndKey") {
    const Workplace work;
    const auto refuse = [&](const std::string& text, const std::string& part) {
        write(work.path / "c.json", text);
        checkRefused(work.run("render builtin:one-splat --out out --cameras c.json"), 1, part);
    };
    refuse("[{", "c.json: byte");
    refuse("{}", "c.json: holds no cameras");
    refuse("[]", "c.json: holds no cameras");
    refuse("[3]", "c.json: camera 0");
    refuse(R"([{"width": 8}])", "c.json: camera 0: height is missing");
    const std::string start = R"([{"width": 8, "height": 8, "fx": 8, "fy": 8, "position": [0,0,0], )";
    refuse(start + R"("rotation": [[1,0,0],[0,1,0]]}])", "rotation");
    refuse(start + R"("rotation": [[1,0,0],[0,1,0],[0,0,-1]]}])", "must be a rotation");
    refuse(start + R"("rotation": [[2,0,0],[0,1,0],[0,0,1]]}])", "must be a rotation");
    write(work.path / "c.json", start + R"("rotation": [[1,0,0],[0,1,0],[0,0,1]]}])");
    checkRefused(work.run("render builtin:one-splat --out out --cameras c.json --view 1"), 1, "--view is 1, must be 0 to 0");
    CHECK(!fs::exists(work.path / "out"));
}

TEST_CASE("aSceneCanBeWrittenAndDescribed") {
    const Workplace work;
    CHECK(work.run("scene one-splat --out one.ply").exit_code == 0);
    const Outcome info = work.run("info one.ply");
    CHECK(info.exit_code == 0);
    CHECK(info.errors.empty());
    CHECK(info.output.find("splats             1\n") != std::string::npos);
    CHECK(info.output.find("\nstart              0,0,0.8 looking at 0,0,2, outside: 1.2 units from the middle") != std::string::npos);
    CHECK(work.run("info one.ply >/dev/full").exit_code == 1);
}

TEST_CASE("aFrameOfASceneThatMovesCanBeWritten") {
    const Workplace work;
    CHECK(work.run("scene clockwork --splats 2000 --out first.ply").exit_code == 0);
    CHECK(work.run("scene clockwork --splats 2000 --frame 70 --out later.ply").exit_code == 0);
    CHECK(work.run("scene clockwork --splats 2000 --frame 120 --out again.ply").exit_code == 0);
    CHECK(work.runCommand("cmp first.ply later.ply").exit_code == 1);
    CHECK(work.runCommand("cmp first.ply again.ply").exit_code == 0);
    // Splats of opacity 0 are written and read like others.
    CHECK(work.run("info later.ply").output.find("splats             2000\n") != std::string::npos);
    checkRefused(work.run("scene fence --frame 1 --out fence.ply"), 1,
                 "builtin:fence: frame 1 asked for, expected 0: this scene does not move");
}

TEST_CASE("whatTwoHintsSayOfAFileIsSaidOnceInItsNotes") {
    const Workplace work;
    std::string ply = "ply\nformat ascii 1.0\ncomment SplatRenderMode: mip\nelement vertex 1\n";
    for (const char* name :
         {"x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"}) {
        ply += std::string("property float ") + name + "\n";
    }
    write(work.path / "a.ply", ply + "end_header\n0 0 3 0 0 0 0.9 0.01 0.02 0.03 1 0 0 0\n");
    for (const std::string command : {"info a.ply", "render a.ply --mode mono --size 8x8 --out out", "convert a.ply b.ply"}) {
        const Outcome outcome = work.run(command);
        CHECK(outcome.exit_code == 0);
        const std::size_t first = outcome.output.find("activations applied");
        CHECK(first != std::string::npos);
        CHECK(outcome.output.find("activations applied", first + 1) == std::string::npos);
    }
    // The flag goes from file to file, and into the options as used.
    REQUIRE(work.run("convert b.ply c.spz").exit_code == 0);
    REQUIRE(work.run("convert c.spz d.ply").exit_code == 0);
    for (const std::string file : {"a.ply", "b.ply", "c.spz", "d.ply"}) {
        CAPTURE(file);
        CHECK(work.run("info " + file).output.find("3D Gaussians, antialiased") != std::string::npos);
        CHECK(work.run("info " + file + " --flatten").output.find("antialiased") == std::string::npos);
    }
    CHECK(nlohmann::json::parse(std::ifstream(work.path / "out/report.json"))["options"]["antialiased"] == true);
}

TEST_CASE("aTrainingsOutputIsRenderedFromItsOwnCameras") {
    const Workplace work;
    fs::create_directories(work.path / "garden/point_cloud/iteration_30000");
    REQUIRE(work.run("scene one-splat --out garden/point_cloud/iteration_30000/point_cloud.ply").exit_code == 0);
    write(work.path / "garden/cameras.json", R"([
        {"width": 8, "height": 8, "fx": 8, "fy": 8, "position": [0, 0, 0], "rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]},
        {"width": 16, "height": 8, "fx": 8, "fy": 8, "position": [0, 0, 1], "rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}])");
    const Outcome outcome = work.run("render garden --mode mono --view 1 --out out");
    INFO(outcome.errors);
    REQUIRE(outcome.exit_code == 0);
    CHECK(outcome.errors.empty());
    CHECK(outcome.output.find("note: garden: a training's output") != std::string::npos);
    const nlohmann::json report = nlohmann::json::parse(std::ifstream(work.path / "out/report.json"));
    CHECK(report["options"]["size"] == "16x8");
    CHECK(report["options"]["view"] == 1);
    CHECK(report["options"]["cameras"] == "garden/cameras.json");
}

#ifdef BINOSPLAT_GLTF
TEST_CASE("aGltfSaysInWhichOrderItsSplatsAreBlendedUnlessTheUserDoes") {
    const Workplace work;
    for (const std::string method : {"cameraDistance", "zDepth"}) {
        GltfText gltf = makeGltf(9);
        gltf.extension = R"({"kernel":"ellipse","colorSpace":"srgb_rec709_display","sortingMethod":")" + method + "\"}";
        write(work.path / "a.glb", gltf.glb());
        const auto usedOrder = [&](const std::string& option) {
            const Outcome outcome = work.run("render a.glb --mode mono --size 16x8 --out out " + option);
            INFO(outcome.errors);
            CHECK(outcome.exit_code == 0);
            return nlohmann::json::parse(std::ifstream(work.path / "out/report.json"))["options"]["order"].get<std::string>();
        };
        CHECK(usedOrder("") == (method == "zDepth" ? "depth" : "distance"));
        CHECK(usedOrder("--order depth") == "depth");
        CHECK(usedOrder("--order distance") == "distance");
    }
}
#endif

TEST_CASE("aCameraThatSeesNoSplatIsSaidToInOneLine") {
    const Workplace work;
    const auto refusesNothing = [&](const std::string& arguments, const std::string& part) {
        const Outcome outcome = work.run("render " + arguments + " --size 16x8 --out out");
        INFO(outcome.errors);
        CHECK(outcome.exit_code == 0);
        CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == (part.empty() ? 0 : 1));
        CHECK(outcome.errors.find(part) != std::string::npos);
        CHECK(fs::exists(work.path / "out/report.json"));
        fs::remove_all(work.path / "out");
    };
    // The splat is at 0,0,2.
    for (const std::string mode : {"mono", "two-pass", "shared", "reproject", "paper", "predicted"}) {
        refusesNothing("builtin:one-splat --eye 0,0,0 --look 0,0,-1 --mode " + mode,
                       "binosplat: builtin:one-splat: no splat is seen from 0,0,0: the nearest is 2 scene units away, 180 degrees");
    }
    for (const std::string mode : {"mono", "predicted"}) {
        refusesNothing("builtin:one-splat --eye 0,0,0 --look 0,0,1 --mode " + mode, "");
    }
    refusesNothing("builtin:one-splat --eye 0,0,0 --look 0,0,1 --mode mono --near 3",
                   "0 degrees off the middle of the picture; nothing nearer than 3 is drawn (near)");
    write(work.path / "poses.csv", "0,0,0,0,0,0,0,1\n1,0,0,-9,0,0,0,1\n2,0,0,-10,0,0,0,1\n");
    refusesNothing("builtin:one-splat --eye 0,0,0 --look 0,0,1 --mode mono --path poses.csv",
                   "builtin:one-splat: frame 1, the first of 2 of 3: no splat is seen from 0,0,9: the nearest is 7 scene units away");
}

TEST_CASE("renderWritesItsFilesAndNothingElse") {
    const Workplace work;
    const std::string float_extension = extensionOf(PictureKind::kFloat), display_extension = extensionOf(PictureKind::kDisplay);
    for (const std::string mode : {"mono", "two-pass", "shared", "reproject", "paper", "predicted"}) {
        const Outcome outcome =
            work.run("render builtin:one-splat --size 40x24 --out a/" + mode + " --mode " + mode, "BINOSPLAT_VALIDATION=1");
        INFO(outcome.errors);
        REQUIRE(outcome.exit_code == 0);
        CHECK(outcome.errors.empty());
        const fs::path folder = work.path / "a" / mode;
        const std::vector<std::string> names =
            mode == "mono" ? std::vector<std::string>{"mono"} : std::vector<std::string>{"left", "right"};
        for (const std::string& name : names) {
            const Image picture = readPicture(folder / (name + float_extension));
            CHECK(picture.size_px == glm::uvec2(40, 24));
            const Image display = readPicture(folder / (name + display_extension));
            CHECK(display.channels == 3);
            // The middle of the disc: opacity 0.8 and colour (0.9, 0.6, 0.3), a little less beside its centre.
            const std::size_t middle = 12 * 40 + 20;
            CHECK(picture.values[middle * static_cast<std::size_t>(picture.channels)] == doctest::Approx(0.72).epsilon(0.05));
            CHECK(display.values[middle * 3] == doctest::Approx(0.72).epsilon(0.05));
        }
        CHECK(fs::exists(folder / ("roi" + display_extension)) == (mode != "mono"));
        const Image depth = readPicture(folder / ("dominant_depth" + float_extension));
        CHECK(depth.channels == 1);
        CHECK(depth.size_px == glm::uvec2(40, 24));
        const nlohmann::json report = nlohmann::json::parse(std::ifstream(folder / "report.json"));
        for (const char* key : {"device", "options", "gpu_ms", "gpu_total_ms", "counters", "peak_gpu_bytes", "left_out"}) {
            CHECK(report.contains(key));
        }
        CHECK(report["options"]["mode"] == mode);
        CHECK(report["options"]["size"] == "40x24");
        CHECK(report["options"]["gap-px"] == 2);
        CHECK(report["counters"].contains("tiles_patched") == (mode == "reproject" || mode == "paper" || mode == "predicted"));
        CHECK(report["gpu_ms"].size() >= 7);
        for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
            CHECK(!entry.path().filename().string().starts_with("."));
        }
    }
}

TEST_CASE("theDefaultModeIsPredictedAndTheBudgetIsAShareOfTheWork") {
    const Workplace work;
    const auto tilesPatched = [&](const std::string& options) {
        const Outcome outcome = work.run("render builtin:step-edge --size 64x64 --out a " + options, "BINOSPLAT_VALIDATION=1");
        INFO(outcome.errors);
        REQUIRE(outcome.exit_code == 0);
        const nlohmann::json report = nlohmann::json::parse(std::ifstream(work.path / "a" / "report.json"));
        return std::pair(report["options"]["mode"].get<std::string>(), report["counters"]["tiles_patched"].get<int>());
    };
    CHECK(tilesPatched("") == std::pair<std::string, int>("predicted", 3));  // a fifth of what 16 tiles of like cost take
    CHECK(tilesPatched("--budget 0").second == 0);
    CHECK(tilesPatched("--budget 0 --move-cost 100000").second == 16);  // all are cheaper to render
    CHECK(tilesPatched("--mode reproject").second == 0);
    CHECK(tilesPatched("--mode paper --depth sum --resampling forward --per-eye --dominant right").second > 0);
    CHECK(tilesPatched("--mode paper --center-roi --edge-bounds tight --dominant right --depth mean").second > 0);
}

TEST_CASE("benchWritesTableJsonCsvAndPlot") {
    const Workplace work;
    write(work.path / "b.toml", "[bench]\nrepeats = 2\nwarm-up = 0\n[[series]]\nname = \"pixels\"\nsizes = [\"16x16\", \"32x32\"]\n");
    const Outcome outcome = work.run("bench builtin:one-splat --out out --config b.toml");
    INFO(outcome.errors);
    REQUIRE(outcome.exit_code == 0);
    CHECK(outcome.output.find("rasterize") != std::string::npos);
    const nlohmann::json bench = nlohmann::json::parse(std::ifstream(work.path / "out" / "bench.json"));
    REQUIRE(bench["results"].size() == 10);
    CHECK(bench["results"][0]["ratio_to_two_pass"] == 1.0);
    CHECK(bench["results"][0]["frames"] == 2);
    CHECK(bench["results"][0]["backbone"] == "2DGS");
    CHECK(outcome.output.find("splats (2DGS)") != std::string::npos);
    CHECK(fs::exists(work.path / "out" / "bench.csv"));
    CHECK(fs::exists(work.path / "out" / "bench.svg"));
    CHECK(std::distance(fs::directory_iterator(work.path / "out"), {}) == 3);
    write(work.path / "b.toml", "[bench]\nrepeats = 0\n");
    checkRefused(work.run("bench builtin:one-splat --out out --config b.toml"), 1, "b.toml:2: repeats is 0, must be a whole number from 1");
    write(work.path / "b.toml", "[[series]]\nsizes = [\"8x8\"]\n");
    checkRefused(work.run("bench builtin:one-splat --out out --config b.toml"), 1, "b.toml:1: name is missing");
}

TEST_CASE("benchComparesMethodsByOriginOfPixels") {
    const Workplace work;
    write(work.path / "b.toml",
          "[bench]\nrepeats = 1\nwarm-up = 0\ntwin = true\n[[methods]]\nname = \"half\"\nmode = \"predicted\"\nbudget = 0.5\n"
          "[[series]]\nname = \"s\"\nsizes = [\"96x96\"]\n");
    const Outcome outcome = work.run("bench builtin:step-edge --out out --config b.toml");
    INFO(outcome.errors);
    REQUIRE(outcome.exit_code == 0);
    const nlohmann::json results = nlohmann::json::parse(std::ifstream(work.path / "out" / "bench.json"))["results"];
    REQUIRE(results.size() == 5);
    CHECK(results[1]["mode"] == "shared");
    // Which of the two is faster is up to the clock; the faster one has no error and nothing beats it.
    CHECK((results[0]["on_front"] == true || results[1]["on_front"] == true));
    CHECK(!results[1].contains("affiliated_against_full"));
    CHECK(results[2]["method"] == "half");
    const nlohmann::json& quality = results[2]["affiliated_against_full"];
    CHECK(quality["all"]["pixels"] == 96 * 96);
    CHECK(quality["all"]["psnr_db"] > 25.0);
    CHECK(quality["all"]["ssim"] > 0.8);
    CHECK(!quality["all"].contains("lpips"));  // nobody gave its weights
    CHECK(quality["patched"]["mean_square"] < 1e-6);
    CHECK(results[2]["stage_ms"].contains("patch"));
    CHECK(results[3].contains("ratio_to_twin"));
    CHECK(results[4]["mode"] == "twin");
}

TEST_CASE("benchHasLpipsWhereItsWeightsAreGiven") {
    const Workplace work;
    const auto benchWith = [&](const std::string& keys, const std::string& arguments) {
        write(work.path / "b.toml", "[bench]\nmodes = [\"reproject\"]\nrepeats = 1\nwarm-up = 0\n" + keys);
        return work.run("bench builtin:slanted-wall --size 48x48 --out out --config b.toml " + arguments);
    };
    const auto qualityOf = [&](const Outcome& outcome) {
        INFO(outcome.errors);
        REQUIRE(outcome.exit_code == 0);
        return nlohmann::json::parse(std::ifstream(work.path / "out" / "bench.json"))["results"][2]["affiliated_against_full"];
    };
    const auto headOf = [&] {
        std::string head;
        std::getline(std::ifstream(work.path / "out" / "bench.csv") >> std::ws, head);
        return head;
    };
    checkRefused(benchWith("", "--lpips none.bin"), 1, "none.bin: cannot be read");
    checkRefused(benchWith("lpips = \"none.bin\"\n", ""), 1, "none.bin: cannot be read");
    checkRefused(benchWith("scores = [\"ssim\", \"lpips\"]\n", ""), 1,
                 "b.toml:5: scores lists lpips; name its weights with --lpips FILE or `lpips` in [bench]");
    checkRefused(benchWith("", "--lpips b.toml"), 1, "b.toml: has 54 bytes, must have the 2898944");
    CHECK(!fs::exists(work.path / "out"));

    // Nor are they read where nobody asks for the score.
    Outcome outcome = benchWith("scores = [\"psnr\"]\nlpips = \"none.bin\"\n", "");
    CHECK(!qualityOf(outcome)["all"].contains("lpips"));
    CHECK(headOf().find("lpips") == std::string::npos);
    CHECK(outcome.output.find("LPIPS") == std::string::npos);

    writeFloats(work.path / "w.bin", makeLpipsWeights(9));
    outcome = benchWith("scores = [\"lpips\"]\nlpips = \"w.bin\"\n", "");
    const nlohmann::json quality = qualityOf(outcome);
    CHECK(quality["all"]["lpips"] > 0.0);
    CHECK(!quality["all"].contains("ssim"));
    CHECK(!quality["reprojected"].contains("lpips"));
    CHECK(headOf().find(",all lpips,") != std::string::npos);
    CHECK(outcome.output.find("LPIPS") != std::string::npos);
    CHECK(qualityOf(benchWith("scores = [\"none\"]\n", "--lpips w.bin"))["all"]["lpips"] == quality["all"]["lpips"]);
    // Too small for the network: the other scores are there.
    outcome = work.run("bench builtin:slanted-wall --size 16x48 --out out --config b.toml --lpips w.bin");
    CHECK(!qualityOf(outcome)["all"].contains("lpips"));
    CHECK(qualityOf(outcome)["all"].contains("psnr_db"));
}

TEST_CASE("benchPlaysHeadMotion") {
    const Workplace work;
    write(work.path / "m.csv", "time_s,x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n0.1,0.01,0,0,0,0,0,1\n0.2,0.02,0,0,0,0,0,1\n");
    const Outcome outcome = work.run("bench builtin:step-edge --size 48x48 --motion m.csv --every 2 --out out");
    INFO(outcome.errors);
    REQUIRE(outcome.exit_code == 0);
    const nlohmann::json results = nlohmann::json::parse(std::ifstream(work.path / "out" / "motion.json"))["results"];
    REQUIRE(results.size() == 5);
    CHECK(results[0]["frames"] == 2);
    CHECK(results[0]["full_change"]["p99"] > 0.0);
    CHECK(results[4]["mode"] == "predicted");
    CHECK(results[4]["flicker"]["median"] > 0.0);
    CHECK(results[4]["psnr_db"]["run"] > 20.0);
    CHECK(results[4]["psnr_db"]["worst"] <= results[4]["psnr_db"]["run"]);
    CHECK(results[4]["work_rendered"]["median"] < 1.0);
    CHECK(results[1]["work_rendered"]["median"] == 1.0);
    // The dominant eye has no error, the other one has.
    std::ifstream csv(work.path / "out" / "motion.csv");
    std::string header, row;
    std::getline(csv, header);
    CHECK(header.ends_with("psnr_left_db,psnr_right_db,mse_left,mse_right,flicker_left,flicker_right,work_rendered,pixels_warped"));
    while (std::getline(csv, row) && row.find(",predicted,") == std::string::npos) {}
    std::vector<std::string> cells;
    std::istringstream split(row);
    for (std::string cell; std::getline(split, cell, ',');) { cells.push_back(cell); }
    REQUIRE(cells.size() >= static_cast<std::size_t>(std::count(header.begin(), header.end(), ',')) + 1);
    CHECK(std::stod(cells[cells.size() - 6]) == 0.0);
    CHECK(std::stod(cells[cells.size() - 5]) > 0.0);
    CHECK(std::stod(cells.back()) > 0.0);
    CHECK(fs::exists(work.path / "out" / "motion.svg"));
    checkRefused(work.run("bench builtin:one-splat --motion none.csv --out out"), 1, "none.csv");
    REQUIRE(
        work.run("bench builtin:one-splat --size 16x16 --motion m.csv --from 0.1 --seconds 0.1 --rate 40 --every 3 --out part").exit_code ==
        0);
    CHECK(nlohmann::json::parse(std::ifstream(work.path / "part" / "motion.json"))["results"][0]["frames"] == 2);
    checkRefused(work.run("bench builtin:one-splat --rate 40 --out out"), 2, "--rate is given without --motion");
}

TEST_CASE("benchComparesWithPhotographs") {
    const Workplace work;
    write(
        work.path / "c.json",
        R"([{"img_name": "a", "width": 48, "height": 40, "fx": 48, "fy": 48, "position": [0,0,0], "rotation": [[1,0,0],[0,1,0],[0,0,1]]}])");
    // The photograph is the scene itself, seen by one eye in the middle.
    REQUIRE(work.run("render builtin:step-edge --cameras c.json --mode mono --out photo").exit_code == 0);
    const std::string extension = extensionOf(PictureKind::kDisplay);
    fs::create_directory(work.path / "photos");
    fs::rename(work.path / "photo" / ("mono" + extension), work.path / "photos" / ("a" + extension));
    const Outcome outcome = work.run("bench builtin:step-edge --cameras c.json --photos photos --out out");
    INFO(outcome.errors);
    REQUIRE(outcome.exit_code == 0);
    const nlohmann::json results = nlohmann::json::parse(std::ifstream(work.path / "out" / "photos.json"))["results"];
    REQUIRE(results.size() == 5);
    CHECK(results[1]["method"] == "shared");
    CHECK(results[1]["psnr_db_to_photo"] > 50.0);  // 8 bits
    CHECK(results[1]["psnr_db_lost"] == 0.0);
    CHECK(results[2]["psnr_db_lost"] > 0.0);
    CHECK(!results[2].contains("lpips_to_photo"));
    writeFloats(work.path / "w.bin", makeLpipsWeights(9));
    REQUIRE(work.run("bench builtin:step-edge --cameras c.json --photos photos --out out --lpips w.bin").exit_code == 0);
    const nlohmann::json with_lpips = nlohmann::json::parse(std::ifstream(work.path / "out" / "photos.json"))["results"];
    CHECK(with_lpips[1]["lpips_lost"] == 0.0);
    CHECK(with_lpips[2]["lpips_to_photo"] > with_lpips[1]["lpips_to_photo"]);
    fs::remove_all(work.path / "photos");
    checkRefused(work.run("bench builtin:step-edge --cameras c.json --photos photos --out out"), 1, "photos/a");
}

TEST_CASE("helpExitsWithZero") {
    const Workplace work;
    for (const char* command :
         {"--help", "render --help", "bench --help", "view --help", "info --help", "scene --help", "convert --help", "compare --help"}) {
        const Outcome outcome = work.run(command);
        CHECK(outcome.exit_code == 0);
        CHECK(!outcome.output.empty());
    }
}

}  // namespace cli_test
