// Facts about options: defaults, the command line over the config, cameras out of both, and what a bench plans and reports.
#include "app/options/options.h"
#include "app/bench/bench_plan.h"
#include "app/bench/bench_results.h"
#include "app/command_line/option_documents.h"
#include "app/load.h"
#include "app/options/camera_options.h"
#include "app/options/modes.h"
#include "app/options/option_table.h"
#include "app/options/start_view.h"
#include "app/view/settings/view_settings_table.h"
#include "engine/error.h"
#include "engine/setup/output_files.h"
#include "tests/run_program.h"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>

TEST_SUITE_BEGIN("options");

namespace options_test {

namespace fs = std::filesystem;
using namespace binosplat;
using binosplat::test::Workplace;

namespace {

const fs::path kConfigs = fs::path(BINOSPLAT_SOURCE_DIR) / "configs";

template <typename Chosen>
Chosen parse(std::vector<std::string> words) {
    std::vector<const char*> arguments{"binosplat"};
    for (const std::string& word : words) { arguments.push_back(word.c_str()); }
    return std::get<Chosen>(parseOptions(static_cast<int>(arguments.size()), arguments.data()));
}

RunOptions render(std::vector<std::string> words) {
    words.insert(words.begin(), {"render", "builtin:one-splat", "--out", "out"});
    return parse<RenderOptions>(words).run;
}

// A scene that fills the box from (-1, -2, -3) to (1, 2, 3).
Scene makeBox() {
    Scene scene;
    scene.name = "box.ply";
    for (int i = 0; i <= 100; ++i) {
        const float t = static_cast<float>(i) / 50.0f - 1.0f;
        scene.positions.emplace_back(t, 2.0f * t, 3.0f * t);
    }
    return scene;
}

BenchResult makeResult(const std::string& scene, Mode mode, std::uint64_t splats, double total_ms) {
    BenchResult result;
    result.series = std::string("s");
    result.scene = scene;
    result.mode = mode;
    result.splats = splats;
    result.size_px = {8, 8};
    result.total_ms = total_ms;
    return result;
}

template <typename Act>
std::string errorOf(Act&& act) {
    try {
        act();
    } catch (const Error& error) { return error.what(); }
    return "";
}

}  // namespace

TEST_CASE("a scene in the place of a command is viewed, any other word is a usage error") {
    const Workplace work;
    const std::string file = (work.path / "Größe 日本.ply").string();
    std::ofstream(fs::path(file)) << "not looked into";
    const auto viewed = parse<ViewOptions>({file, "--frames", "3", "--mode", "mono"});
    CHECK(viewed.scene == file);
    CHECK(viewed.frames == 3);
    CHECK(parse<ViewOptions>({work.path.string()}).scene == work.path.string());
    CHECK(parse<ViewOptions>({"builtin:no-such-scene"}).scene == "builtin:no-such-scene");
    CHECK(errorOf([&] { parse<ViewOptions>({file, "--out", "out"}); }) == "--out is given without --simulate");
    try {
        parse<ViewOptions>({file + "x"});
        FAIL("a file that is not there was taken");
    } catch (const Error& error) {
        CHECK(error.code() == ExitCode::kUsage);
        CHECK(std::string(error.what()).starts_with(file + "x is not a command; must be one of: render, "));
    }
}

TEST_CASE("defaultConfigSaysTheDefaults") {
    const RunOptions none = render({});
    const RunOptions file = render({"--config", (kConfigs / "default.toml").string()});
    CHECK(file.camera.near == none.camera.near);
    CHECK(file.camera.background == none.camera.background);
    CHECK(file.stereo == none.stereo);
    CHECK(file.metres_per_unit == none.metres_per_unit);
    CHECK(none.camera.near == 0.2);
    CHECK(none.stereo.mode == Mode::kPredicted);
}

TEST_CASE("defaultConfigIsWhatTheTableOfOptionsSays") {
    std::ifstream file(kConfigs / "default.toml", std::ios::binary);
    const std::string text(std::istreambuf_iterator<char>(file), {});
    CHECK_MESSAGE(text == documentOf("config"), "run `binosplat document config > configs/default.toml`");
    // Every key of a config is there, those without a default as comments; whoever takes out the mark has a key that is taken.
    const Workplace work;
    std::size_t keys = 0;
    std::istringstream lines(text);
    std::string table, placement;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with('[')) { table = line.substr(0, line.find(']') + 1); }
        const bool is_comment = line.starts_with("# ");
        if (table.empty() || line.starts_with('[') || line.empty()) { continue; }
        ++keys;
        CAPTURE(line);
        line = line.substr(is_comment ? 2 : 0);
        if (table == "[view]" && (line.starts_with("scene-") || line.starts_with("units-"))) {
            placement += line + "\n";
            continue;
        }
        writeText(work.path / "one.toml", table + "\n" + line + "\n");
        const auto options = parse<ViewOptions>({"view", "a", "--config", (work.path / "one.toml").string()});
        CHECK_NOTHROW(readViewSettings(options.tables, {}));
        CHECK(options.tables.empty() == (table != "[view]"));
        if (line.starts_with("mode ") || !options.tables.empty()) { CHECK(is_comment == line.starts_with("mode ")); }
    }
    CHECK(keys == runRows().size() + viewSettingsRows().size() + 3);
    writeText(work.path / "all.toml", "[view]\n" + placement);
    const auto placed = parse<ViewOptions>({"view", "a", "--config", (work.path / "all.toml").string()});
    CHECK(readViewSettings(placed.tables, {}).scene_from_room.has_value());
    CHECK(text.find("\n# mode = \"predicted\"") != std::string::npos);
}

TEST_CASE("framesThatFollowOneAnotherAreTemporalUnlessAModeIsNamed") {
    const Workplace work;
    const std::string open = (kConfigs / "default.toml").string(), named = (work.path / "named.toml").string();
    writeText(named, "mode = \"paper\"\n");
    const auto viewed = [](std::vector<std::string> words) {
        words.insert(words.begin(), {"view", "a"});
        return parse<ViewOptions>(words).run.stereo.mode;
    };
    CHECK(render({}).stereo.mode == Mode::kPredicted);
    CHECK(render({"--path", "b.csv"}).stereo.mode == Mode::kTemporal);
    CHECK(render({"--path", "b.csv", "--config", named}).stereo.mode == Mode::kPaper);
    CHECK(viewed({}) == Mode::kTemporal);
    CHECK(viewed({"--config", open}) == Mode::kTemporal);
    CHECK(viewed({"--config", named}) == Mode::kPaper);
    CHECK(viewed({"--config", named, "--mode", "predicted"}) == Mode::kPredicted);
}

TEST_CASE("commandLineWinsOverConfig") {
    const Workplace work;
    writeText(work.path / "a.toml",
              "near = 0.5\n[camera]\nsize = \"64x32\"\nheadset = \"quest2\"\n[stereo]\ncenter-roi = true\nipd = 0.07\n");
    const std::string file = (work.path / "a.toml").string();
    const RunOptions from_file = render({"--config", file});
    CHECK(from_file.camera.near == 0.5);
    CHECK(from_file.camera.size_px == glm::uvec2(64, 32));
    CHECK(from_file.camera.headset == "quest2");
    CHECK(from_file.stereo.warp.center_rois);
    CHECK(from_file.stereo.ipd_m == 0.07);
    const RunOptions both = render({"--config", file, "--near", "0.1", "--size", "8x9", "--fov-x", "90", "--ipd", "0"});
    CHECK(both.camera.near == 0.1);
    CHECK(both.camera.size_px == glm::uvec2(8, 9));
    CHECK(both.camera.fov_x_deg == 90.0);
    CHECK(both.camera.headset.empty());  // an angle and a headset contradict each other
    CHECK(both.stereo.ipd_m == 0.0);
}

TEST_CASE("aTrainingsOutputBringsTheCamerasThatViewAsksFor") {
    const Workplace work;
    const fs::path garden = work.path / "garden", cameras = garden / "cameras.json";
    fs::create_directories(garden / "point_cloud/iteration_7000");
    writeText(garden / "point_cloud/iteration_7000/point_cloud.ply", "ply\n");
    const auto with = [&](std::vector<std::string> words) {
        words.insert(words.begin(), {"render", garden.string(), "--out", "out"});
        return parse<RenderOptions>(words).run.camera;
    };
    CHECK(errorOf([&] { with({"--view", "1"}); }).find("--view is given without --cameras") == 0);
    writeText(cameras, "[]");
    CHECK(with({"--view", "1"}).cameras_file == cameras.string());
    CHECK(with({"--view", "1"}).view == 1);
    CHECK(with({}).cameras_file.empty());
    CHECK(with({"--view", "1", "--cameras", "other.json"}).cameras_file == "other.json");
    CHECK(errorOf([&] { with({"--view", "1", "--eye", "0,0,0"}); }) == "--view and --eye contradict each other, must be one of them");
    writeText(work.path / "a.toml", "headset = \"quest2\"\n");
    CHECK(with({"--view", "1", "--config", (work.path / "a.toml").string()}).headset.empty());
    writeText(work.path / "b.toml", "cameras = \"b.json\"\n");
    CHECK(with({"--view", "1", "--config", (work.path / "b.toml").string()}).cameras_file == (work.path / "b.json").string());

    const auto bench = parse<BenchOptions>({"bench", garden.string(), "--out", "out", "--view", "1"});
    CHECK(bench.run.camera.cameras_file == cameras.string());
    CHECK(bench.asked.cameras_file == cameras.string());
    CHECK(errorOf([&] { (void)parse<BenchOptions>({"bench", garden.string(), "builtin:fence", "--out", "out", "--view", "1"}); }) != "");
    // A SOG scene is no training's output, but cameras may lie in its folder as well.
    writeText(garden / "meta.json", "{}");
    CHECK(with({"--view", "1"}).cameras_file == cameras.string());
}

TEST_CASE("eyesLookAtTheirLensesOrWhereTheyAreSaidTo") {
    Scene scene;
    CameraFiles files;
    Headset headset;
    headset.size_px = {64, 64};
    headset.angles = {ViewAngles{-0.8, 0.6, 0.7, -0.7}, ViewAngles{-0.6, 0.8, 0.7, -0.7}};
    headset.canting_rad = 0.1;
    headset.lens_centres = {glm::dvec3(-0.1, 0.0, 1.0), glm::dvec3(0.1, 0.0, 1.0)};
    files.headset = headset;
    const auto gazes = [&](std::vector<std::string> words) {
        const RunOptions options = render(std::move(words));
        return gazesOf(makeCameras(options, files, scene), options.stereo);
    };
    CHECK(!gazes({})[kLeft]);
    CHECK(!gazes({"--gaze", "0,0,1"})[kRight]);
    const auto at_lenses = gazes({"--foveation", "15"});
    REQUIRE(at_lenses[kLeft]);
    CHECK(at_lenses[kLeft]->clear_rad == doctest::Approx(glm::radians(15.0)));
    CHECK(at_lenses[kLeft]->direction == headset.lens_centres[kLeft]);
    CHECK(at_lenses[kRight]->direction == headset.lens_centres[kRight]);
    // Ahead of the head is inwards for eyes that are turned outwards.
    const auto ahead = gazes({"--foveation", "15", "--gaze", "0,0,1"});
    CHECK(ahead[kLeft]->direction.x == doctest::Approx(std::sin(0.1)));
    CHECK(ahead[kRight]->direction.x == doctest::Approx(-std::sin(0.1)));
    // The one eye of mono looks between where both look, or where it is told to.
    const auto of_one = gazes({"--mode", "mono", "--foveation", "15"});
    REQUIRE(of_one[0]);
    CHECK_FALSE(of_one[1]);
    CHECK(std::abs(of_one[0]->direction.x) < 1e-12);
    CHECK(of_one[0]->direction.z > 1.0);
    CHECK(gazes({"--mode", "mono", "--foveation", "15", "--gaze", "1,0,2"})[0]->direction == glm::dvec3(1, 0, 2));
    CHECK(parse<BenchOptions>({"bench", "a", "--out", "b", "--foveation", "1", "--gaze", "1,0,1"}).run.stereo.gaze == glm::dvec3(1, 0, 1));
    CHECK(parse<ViewOptions>({"view", "a", "--foveation", "20"}).run.stereo.foveation_deg == 20.0);
    CHECK_THROWS_AS(parse<ViewOptions>({"view", "a", "--gaze", "0,0,1"}), Error);
    CHECK_THROWS_AS(render({"--gaze", "0,0,0"}), Error);
}

TEST_CASE("half the resolution goes with foveation, and references are left as they are") {
    const auto refusal = [](std::vector<std::string> words) -> std::string {
        const StereoOptions stereo = render(std::move(words)).stereo;
        CHECK(frameSettings({}, stereo).half_periphery == stereo.half_periphery);
        try {
            requirePeriphery(stereo);
        } catch (const Error& error) { return error.what(); }
        return "";
    };
    CHECK_FALSE(render({}).stereo.half_periphery);
    CHECK(render({"--periphery", "half"}).stereo.half_periphery);
    CHECK(refusal({"--periphery", "full"}) == "");
    CHECK(refusal({"--mode", "mono", "--periphery", "half", "--foveation", "20"}) == "");
    CHECK(refusal({"--mode", "mono", "--periphery", "half"}).find("--foveation is 0") != std::string::npos);
    for (const char* mode : {"two-pass", "shared", "reproject", "paper", "predicted", "alternate", "temporal"}) {
        CHECK(refusal({"--mode", mode, "--periphery", "half", "--foveation", "20"}) == "");
    }
    CHECK(parse<ViewOptions>({"view", "a"}).run.stereo.half_periphery);
    CHECK_FALSE(parse<ViewOptions>({"view", "a", "--periphery", "full"}).run.stereo.half_periphery);
}

TEST_CASE("splatsGoByDepthOrByDistance") {
    const Workplace work;
    writeText(work.path / "a.toml", "[stereo]\norder = \"distance\"\n");
    CHECK_FALSE(render({}).stereo.order);  // as the scene asks
    CHECK(frameSettings({}, render({}).stereo).order == Order::kDepth);
    CHECK(frameSettings({}, render({}).stereo, Order::kDistance).order == Order::kDistance);
    const RunOptions by_distance = render({"--config", (work.path / "a.toml").string()});
    CHECK(by_distance.stereo.order == Order::kDistance);
    CHECK(frameSettings({}, by_distance.stereo).order == Order::kDistance);
    CHECK(frameSettings({}, render({"--order", "depth"}).stereo, Order::kDistance).order == Order::kDepth);
    CHECK(render({"--config", (work.path / "a.toml").string(), "--order", "depth"}).stereo.order == Order::kDepth);
    CHECK(parse<ViewOptions>({"view", "a", "--order", "distance"}).run.stereo.order == Order::kDistance);
    CHECK(parse<BenchOptions>({"bench", "a", "--out", "b", "--orders"}).orders);
    CHECK_THROWS_AS(parse<BenchOptions>({"bench", "a", "--out", "b", "--orders", "--motion", "m.csv"}), Error);
}

TEST_CASE("theLevelOfDetailIsAnOptionOfEveryCommandThatReadsAScene") {
    const Workplace work;
    writeText(work.path / "a.toml", "[scene]\nlod = 3\n");
    const std::string file = (work.path / "a.toml").string();
    CHECK(!render({}).load.lod);
    CHECK(render({"--lod", "2"}).load.lod == 2u);
    CHECK(render({"--config", file}).load.lod == 3u);
    CHECK(render({"--config", file, "--lod", "0"}).load.lod == 0u);
    CHECK(parse<BenchOptions>({"bench", "a", "--out", "b", "--lod", "1"}).run.load.lod == 1u);
    CHECK(parse<ViewOptions>({"view", "a", "--lod", "1"}).run.load.lod == 1u);
    CHECK(parse<InfoOptions>({"info", "a", "--lod", "1"}).load.lod == 1u);
    CHECK(parse<ConvertOptions>({"convert", "a", "b.ply", "--lod", "1"}).load.lod == 1u);
    CHECK(!parse<InfoOptions>({"info", "a"}).load.lod);
    CHECK_THROWS_AS(render({"--lod", "-1"}), Error);
    CHECK_THROWS_AS(render({"--lod", "0.5"}), Error);
}

TEST_CASE("howGaussiansAreDrawnIsAnOptionOfEveryCommandThatReadsAScene") {
    const Workplace work;
    writeText(work.path / "a.toml", "[scene]\nflatten = true\nantialiased = true\n");
    CHECK_FALSE(render({}).load.flatten);
    CHECK_FALSE(render({}).load.antialiased);
    CHECK(render({"--flatten"}).load.flatten);
    CHECK(render({"--antialiased"}).load.antialiased);
    const RunOptions from_file = render({"--config", (work.path / "a.toml").string()});
    CHECK(from_file.load.flatten);
    CHECK(from_file.load.antialiased);
    CHECK(parse<InfoOptions>({"info", "a", "--flatten"}).load.flatten);
    CHECK(parse<ConvertOptions>({"convert", "a", "b.ply", "--flatten"}).load.flatten);
    CHECK(parse<ViewOptions>({"view", "a", "--flatten"}).run.load.flatten);
    CHECK_FALSE(parse<ViewOptions>({"view", "a", "--center-roi"}).run.load.flatten);
}

TEST_CASE("coloursMayBeLimited") {
    CHECK(!render({}).load.sh_degree);
    CHECK(render({"--sh-degree", "1"}).load.sh_degree == 1u);
    CHECK_THROWS_AS(render({"--sh-degree", "4"}), Error);
    // 48 bytes a splat of degree 0 instead of 140 and more.
    CHECK(levelChoice(render({"--sh-degree", "0", "--flatten"}).load, 3).fits(65536, 3));
    CHECK(!levelChoice(render({"--flatten"}).load, 3).fits(65536, 3));
}

TEST_CASE("aLevelFitsIfItsSplatsDo") {
    const auto choose = [](const RunOptions& run) { return levelChoice(run.load, run.memory_limit_mib); };
    CHECK(!choose(render({"--lod", "1"})).fits);  // as fine as there is
    CHECK(choose(render({"--lod", "1"})).level == 1u);
    const LevelChoice choice = choose(render({"--memory-limit", "3", "--flatten"}));
    CHECK(choice.fits(65536, 0));  // discs of 48 bytes
    CHECK(!choice.fits(65537, 0));
    CHECK(!choice.fits(65536, 1));
    CHECK(!levelChoice({}, 3).fits(65536, 0));  // of 52 bytes
    CHECK(!choice.fits(std::uint64_t{1} << 60, 3));
}

TEST_CASE("aSceneWhoseYIsUpIsSeenUprightAndFromItsFront") {
    Scene scene = makeBox();
    const View trained = startView(scene, {60.0}).view;
    scene.y_up = true;
    const View upright = startView(scene, {60.0}).view;
    CHECK(trained.up == glm::dvec3(0.0, -1.0, 0.0));
    CHECK(upright.up == glm::dvec3(0.0, 1.0, 0.0));
    CHECK(upright.look == trained.look);
    CHECK(upright.eye.z - upright.look.z == doctest::Approx(trained.look.z - trained.eye.z));
    CHECK(upright.eye.z > upright.look.z);
}

TEST_CASE("aSceneOfOneSplatIsSeenFromWhereItIsWhole") {
    Scene scene;
    scene.name = "one.ply";
    scene.positions = {glm::vec3(1.0f, 2.0f, 3.0f)};
    CHECK(startView(scene, {60.0}).view.eye.z == doctest::Approx(2.0));
    scene.scales = {glm::vec2(0.1f, 4.0f)};
    CHECK(startView(scene, {60.0}).view.eye.z == doctest::Approx(3.0 - 24.0));
}

TEST_CASE("vectorsMayBeginWithAMinus") {
    CHECK(render({"--eye", "-1,0,0"}).camera.eye == glm::dvec3(-1.0, 0.0, 0.0));
    CHECK(render({"--eye", "-.5,0,1e-3"}).camera.eye == glm::dvec3(-0.5, 0.0, 1e-3));
    CHECK(render({"--eye=-1,-2,-3"}).camera.eye == glm::dvec3(-1.0, -2.0, -3.0));
}

TEST_CASE("eyesStandHalfTheirDistanceFromTheMiddle") {
    RunOptions options = render({"--eye", "1,2,3", "--look", "1,2,5", "--ipd", "0.08", "--size", "200x100", "--fov-x", "90"});
    options.metres_per_unit = 2.0;
    const Cameras cameras = makeCameras(options, {}, makeBox());
    CHECK(cameras.eye_distance == doctest::Approx(0.04));
    // Up is -y by default, so camera x is world x here.
    CHECK(glm::length(cameras.eyes[kLeft].world_from_camera.position - glm::dvec3(0.98, 2.0, 3.0)) < 1e-12);
    CHECK(glm::length(cameras.eyes[kRight].world_from_camera.position - glm::dvec3(1.02, 2.0, 3.0)) < 1e-12);
    CHECK(cameras.middle.intrinsics.fx == doctest::Approx(100.0));
    CHECK(cameras.middle.intrinsics.fy == doctest::Approx(100.0));
    CHECK(cameras.middle.intrinsics.cx == 100.0);
    CHECK(cameras.middle.intrinsics.cy == 50.0);
}

TEST_CASE("aFileIsFramedWhole") {
    const Scene scene = makeBox();
    const Cameras cameras = makeCameras(render({}), {}, scene);
    const Intrinsics& k = cameras.middle.intrinsics;
    for (const glm::vec3& p : scene.positions) {
        const glm::dvec3 c = transform(inverse(cameras.middle.world_from_camera), glm::dvec3(p));
        CHECK(c.z > 0.2);
        CHECK(std::abs(k.fx * c.x / c.z) < 512.0);
        CHECK(std::abs(k.fy * c.y / c.z) < 512.0);
    }
    CHECK_NOTHROW(makeCameras(render({}), {}, Scene{}));
}

TEST_CASE("bash completes files for the options that take one, names for those that are one of a few, and nothing for others") {
    struct Completed {
        std::string command, key, choices;
        bool is_file;
    };
    const std::string bash = documentOf("bash");
    const auto holds = [](const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; };
    for (const Completed& option :
         {Completed{"render", "path", "", true}, Completed{"bench", "motion", "", true}, Completed{"render", "out", "", true},
          Completed{"bench", "photos", "", true}, Completed{"compare", "lpips", "", true}, Completed{"scene", "out", "", true},
          Completed{"render", "cameras", "", true}, Completed{"view", "config", "", true}, Completed{"view", "shaders", "", true},
          Completed{"view", "simulate", "", true}, Completed{"render", "rate", "", false}, Completed{"render", "headset", "", false},
          Completed{"render", "path-axes", "openxr unity", false}, Completed{"view", "dominant", "left right", false}}) {
        const auto& [command, key, choices, is_file] = option;
        CAPTURE(command);
        CAPTURE(key);
        const std::string words = !choices.empty() ? fmt::format("COMPREPLY=($(compgen -W \"{}\" -- \"$word\"));", choices)
                                  : is_file        ? "COMPREPLY=($(compgen -f -- \"$word\"));"
                                                   : "";
        CHECK(holds(bash, fmt::format("        {}:--{}) {} return ;;\n", command, key, words)));
    }
}

TEST_CASE("everyBenchConfigReads") {
    int count = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(kConfigs / "bench")) {
        const BenchPlan plan = planBench(parse<BenchOptions>({"bench", "--out", "out", "--config", entry.path().string()}));
        CHECK(!plan.scenes.empty());
        CHECK(!plan.series.empty());
        ++count;
    }
    CHECK(count > 0);
    const BenchPlan named = planBench(
        parse<BenchOptions>({"bench", "a.ply", "b.ply", "--out", "out", "--config", (kConfigs / "bench" / "demo.toml").string()}));
    CHECK(named.scenes == std::vector<std::string>{"a.ply", "b.ply"});
}

TEST_CASE("medianIsTheMiddleOrTheMeanOfTwo") {
    CHECK(median({3.0}) == 3.0);
    CHECK(median({5.0, 1.0, 3.0}) == 3.0);
    CHECK(median({4.0, 1.0, 3.0, 100.0}) == 3.5);
}

TEST_CASE("ratiosCompareModesAtTheSamePointOnly") {
    std::vector<BenchResult> results{makeResult("a", Mode::kTwoPass, 1, 4.0), makeResult("a", Mode::kShared, 1, 2.0),
                                     makeResult("a", Mode::kShared, 2, 3.0), makeResult("b,c", Mode::kMono, 1, 3.0),
                                     makeResult("a", Mode::kShared, 1, 5.0)};
    results[4].backbone = "3DGS";  // the same scene as discs is another point
    compareModes(results);
    CHECK(!results[4].ratio_to_two_pass.has_value());
    CHECK(results[1].ratio_to_two_pass == 0.5);
    CHECK(results[0].ratio_to_shared == 2.0);
    CHECK(!results[2].ratio_to_two_pass.has_value());
    CHECK(!results[3].ratio_to_shared.has_value());
    CHECK(benchCsv({"GPU", "", results}).find("\"b,c\"") != std::string::npos);
    // Frames that took turns are compared with their neighbours: what slows both for a while changes no ratio.
    results[0].frame_ms = {4.0, 8.0, 4.0};
    results[1].frame_ms = {3.0, 6.0, 1.0};
    compareModes(results);
    CHECK(results[1].ratio_to_two_pass == 0.75);
}

TEST_CASE("passesOfBothEyesAddUp") {
    BenchResult result;
    result.pass_ms = {{{Role::kBoth, FrameStage::kSort, "cull"}, 1.0},
                      {{Role::kDominant, FrameStage::kSplat, "project"}, 2.0},
                      {{Role::kAffiliated, FrameStage::kSplat, "project"}, 3.0}};
    CHECK(byPass(result.pass_ms) == NamedTimes{{"cull", 1.0}, {"project", 5.0}});
}

TEST_CASE("stagesAddUpPasses") {
    const PassTimes passes{{{Role::kBoth, FrameStage::kSort, "cull"}, 1.0},
                           {{Role::kBoth, FrameStage::kSort, "sort_depth"}, 2.0},
                           {{Role::kDominant, FrameStage::kSplat, "project"}, 4.0},
                           {{Role::kDominant, FrameStage::kSplat, "rasterize"}, 8.0},
                           {{Role::kAffiliated, FrameStage::kWarp, "reproject"}, 16.0},
                           {{Role::kAffiliated, FrameStage::kChoose, "weigh"}, 32.0},
                           {{Role::kAffiliated, FrameStage::kChoose, "newcomers"}, 64.0},
                           {{Role::kAffiliated, FrameStage::kChoose, "select"}, 128.0},
                           {{Role::kAffiliated, FrameStage::kWarp, "resample"}, 256.0},
                           {{Role::kAffiliated, FrameStage::kSplat, "rasterize"}, 512.0}};
    CHECK(stagesOf(Mode::kPredicted, passes) ==
          NamedTimes{{"cull+sort", 3.0}, {"dominant", 12.0}, {"reprojection", 272.0}, {"ROI choice", 224.0}, {"patch", 512.0}});
    CHECK(stagesOf(Mode::kShared, {{{Role::kAffiliated, FrameStage::kSplat, "rasterize"}, 1.0}}) == NamedTimes{{"affiliated", 1.0}});
}

TEST_CASE("what moving a tile costs is told in pairs of shared's affiliated eye") {
    BenchResult predicted = makeResult("a", Mode::kPredicted, 1, 9.0), shared = makeResult("a", Mode::kShared, 1, 10.0);
    predicted.pass_ms = {{{Role::kAffiliated, FrameStage::kWarp, "reproject"}, 1.0},
                         {{Role::kAffiliated, FrameStage::kChoose, "newcomers"}, 5.0},
                         {{Role::kAffiliated, FrameStage::kWarp, "resample"}, 2.0}};
    predicted.counters = {{"tiles_weighed_as_moved", 300}};
    shared.pass_ms = {{{Role::kDominant, FrameStage::kSplat, "rasterize"}, 7.0},
                      {{Role::kAffiliated, FrameStage::kSplat, "project"}, 1.5},
                      {{Role::kAffiliated, FrameStage::kSplat, "rasterize"}, 2.5}};
    shared.counters = {{"tile_pairs_left", 9000}, {"tile_pairs_right", 8000}};
    // 10 us a tile, 0.5 us a pair.
    std::vector<BenchResult> results{predicted, shared};
    compareModes(results);
    CHECK(results[0].move_cost.value() == doctest::Approx(20.0));
    CHECK_FALSE(results[1].move_cost.has_value());
    results[0].counters["tiles_weighed_as_moved"] = 0;
    compareModes(results);
    CHECK_FALSE(results[0].move_cost.has_value());
}

TEST_CASE("theFrontHoldsWhatIsWorthItsTime") {
    const auto withError = [](double total_ms, double mean_square) {
        BenchResult result = makeResult("a", Mode::kPaper, 1, total_ms);
        result.quality = {{"all", 64, mean_square, {}, {}, {}}};
        return result;
    };
    std::vector<BenchResult> results{makeResult("a", Mode::kTwoPass, 1, 9.0),
                                     makeResult("a", Mode::kShared, 1, 8.0),
                                     makeResult("a", Mode::kMono, 1, 1.0),
                                     withError(4.0, 0.1),
                                     withError(5.0, 0.1),
                                     withError(6.0, 0.01),
                                     withError(8.5, 0.0)};
    markFront(results);
    std::vector<bool> front;
    for (const BenchResult& result : results) { front.push_back(result.on_front); }
    CHECK(front == std::vector<bool>{false, true, false, true, false, true, false});
    const std::string svg = benchPlot({"GPU", "", results});
    CHECK(svg.find("Pareto front") != std::string::npos);
    CHECK(svg.find("inf") == std::string::npos);
    CHECK(benchJson({"GPU", "", results}).find("\"psnr_db\": null") != std::string::npos);
}

TEST_CASE("methodsSweepTheirSettings") {
    const Workplace work;
    writeText(work.path / "a.toml",
              "[bench]\nscenes = [\"builtin:fence\"]\ntwin = true\nscores = [\"psnr\"]\n[stereo]\nmargin = 16\n"
              "[[methods]]\nname = \"p\"\nmode = \"predicted\"\nbudget = [0, 0.5]\ndepth = [\"mean\", \"sum\"]\ngap_px = 3\norder = "
              "\"distance\"\n"
              "[[views]]\nname = \"near\"\nscene = \"a.ply\"\neye = [1, 2, 3]\nfov_x = 90\nnear = 0.5\n");
    const BenchOptions options = parse<BenchOptions>({"bench", "--out", "out", "--config", (work.path / "a.toml").string()});
    const BenchPlan plan = planBench(options);
    std::vector<std::string> names;
    for (const BenchMethod& method : plan.methods) { names.push_back(method.name); }
    CHECK(names == std::vector<std::string>{"two-pass", "shared", "p budget=0 depth=mean", "p budget=0 depth=sum",
                                            "p budget=0.5 depth=mean", "p budget=0.5 depth=sum", "mono"});
    CHECK(plan.methods[4].stereo.warp.budget == 0.5);
    CHECK(plan.methods[4].stereo.warp.gap_px == 3);
    CHECK(plan.methods[4].stereo.order == Order::kDistance);
    CHECK_FALSE(plan.methods[0].stereo.order);
    CHECK(plan.methods[4].stereo.warp.margin_px == 16);
    CHECK(!plan.ssim);
    const std::vector<DrawnViews> drawn = viewsOf(plan, "/some/where/a.ply", options.run);
    REQUIRE(drawn.size() == 1);
    REQUIRE(drawn[0].views.size() == 1);
    const BenchView& view = drawn[0].views[0];
    CHECK(view.name == "near");
    CHECK(view.run.camera.near == 0.5);
    CHECK(view.run.camera.eye == glm::dvec3(1.0, 2.0, 3.0));
    CHECK(viewsOf(plan, "builtin:fence", options.run).at(0).views.at(0).name.empty());
}

TEST_CASE("sizeAndRepeatsOfTheCommandLineTakeThePlaceOfTheConfigs") {
    const Workplace work;
    const std::string config = (work.path / "a.toml").string();
    writeText(config, "[bench]\nscenes = [\"builtin:fence\"]\n[[series]]\nname = \"a\"\nsizes = [\"64x48\", \"128x96\"]\n");
    const auto sizesOf = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {"bench", "--out", "out", "--config", config});
        return planBench(parse<BenchOptions>(arguments)).series.at(0).sizes_px;
    };
    CHECK(sizesOf({}) == std::vector{glm::uvec2(64, 48), glm::uvec2(128, 96)});
    CHECK(sizesOf({"--size", "32x16"}) == std::vector{glm::uvec2(32, 16)});
    writeText(config, "[bench]\nscenes = [\"builtin:fence\"]\nrepeats = 7\n");
    CHECK(planBench(parse<BenchOptions>({"bench", "--out", "out", "--config", config})).repeats == 7);
    CHECK(planBench(parse<BenchOptions>({"bench", "--out", "out", "--config", config, "--repeats", "3"})).repeats == 3);
    // A config's own camera is what its series and views start from.
    writeText(config,
              "[camera]\nsize = \"256x256\"\neye = [0, 0, -1]\n[bench]\nscenes = [\"builtin:fence\"]\nheadsets = [\"quest2\", \"index\"]\n"
              "[[series]]\nname = \"a\"\nsizes = \"64x48\"\n[[series]]\nname = \"b\"\n[[views]]\nname = \"near\"\nfov_x = 90\n");
    const auto planOf = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {"bench", "--out", "out", "--config", config});
        return planBench(parse<BenchOptions>(arguments));
    };
    CHECK(sizesOf({}) == std::vector{glm::uvec2(64, 48)});
    CHECK(planOf({}).series.at(1).sizes_px == std::vector{glm::uvec2(256, 256)});
    CHECK(planOf({}).views.size() == 1);
    CHECK(planOf({"--eye", "1,1,1"}).views.empty());
    CHECK(planOf({}).headsets == std::vector<std::string>{"quest2", "index"});
    CHECK(planOf({"--headset", "vive"}).headsets == std::vector<std::string>{""});
}

TEST_CASE("what a bench would measure twice under one name is refused") {
    const Workplace work;
    const auto messageOf = [&](const std::string& toml) {
        writeText(work.path / "a.toml", toml);
        return errorOf([&] { planBench(parse<BenchOptions>({"bench", "--out", "out", "--config", (work.path / "a.toml").string()})); });
    };
    const std::string scene = "[bench]\nscenes = [\"builtin:fence\", \"b.ply\"]\n";
    CHECK(messageOf("[bench]\nscenes = [\"a\", \"a\"]\n") == "scene a is named twice, names must differ");
    CHECK(messageOf(scene + "headsets = [\"index\", \"index\"]\n") == "headset index is named twice, names must differ");
    CHECK(messageOf(scene + "[[series]]\nname = \"s\"\n[[series]]\nname = \"s\"\n") == "series s is named twice, names must differ");
    CHECK(messageOf(scene + "[[methods]]\nname = \"m\"\nmode = \"paper\"\n[[methods]]\nname = \"m\"\nmode = \"mono\"\n") ==
          "method m is named twice, names must differ");
    CHECK(messageOf(scene + "[[views]]\nname = \"v\"\n[[views]]\nname = \"v\"\nscene = \"b.ply\"\n") ==
          "view v is named twice, names must differ");
    CHECK(messageOf(scene + "[[views]]\nname = \"v\"\nscene = \"builtin:fence\"\n[[views]]\nname = \"v\"\nscene = \"b.ply\"\n") == "");
}

TEST_CASE("scenes have their own names, or their paths where those are equal") {
    BenchPlan plan;
    plan.scenes = {"a/x.ply", "b/x.ply", "c/y/", "builtin:fence"};
    CHECK(nameIn(plan, "a/x.ply") == "a/x.ply");
    CHECK(nameIn(plan, "c/y/") == "y");
    CHECK(nameIn(plan, "builtin:fence") == "builtin:fence");
    plan.views = {{"whole", {"y"}, {}}};
    CHECK(viewsOf(plan, "c/y/", {}).at(0).views.at(0).name == "whole");
}

TEST_CASE("a flag may be switched off by what stands after its =") {
    CHECK(render({"--center-roi"}).stereo.warp.center_rois);
    CHECK_FALSE(render({"--center-roi=false"}).stereo.warp.center_rois);
    CHECK_THROWS_WITH_AS(render({"--center-roi=often"}), "--center-roi is often, must be true or false", Error);
}

TEST_CASE("a picture that holds what is no number is not called equal") {
    CHECK(std::isnan(psnrOf(std::nan(""))));
    CHECK(psnrOf(0.0) > 1e300);
    BenchResult result = makeResult("a", Mode::kPaper, 1, 1.0);
    result.quality = {{"all", 64, std::nan(""), {}, {}, {}}};
    CHECK(benchTable({"GPU", "", {result}}).find("equal") == std::string::npos);
}

TEST_CASE("of an error an eye sees each tile's share, and notices it from a hundredth of the contrast on") {
    const glm::uvec2 size_px(32, 16);  // two tiles
    const Image full{size_px, 4, std::vector<float>(4 * 512, 0.5f)};
    Image picture = full;
    for (std::size_t i = 0; i < 512; ++i) { picture.values[4 * i] += i % 32 < 16 ? 0.02f : 0.005f; }  // squares of 0.1024 and 0.0064 a tile
    const SeenScores seen = measureSeen(full, picture, std::array{0.5, 1.0});
    CHECK(seen.mean_square == doctest::Approx((0.5 * 0.1024 + 0.0064) / (3 * 512)).epsilon(1e-4));
    CHECK(seen.psnrDb() == doctest::Approx(10.0 * std::log10(3 * 512 / 0.0576)).epsilon(1e-4));
    CHECK(seen.noticed == 0.5);
    CHECK(measureSeen(full, full, std::array{0.5, 1.0}).noticed == 0.0);
    // It stands in the tables, and has a panel of its own in the plot.
    BenchResult result = makeResult("a", Mode::kMono, 1, 1.0);
    result.quality = {{"all", 512, 0.01, {}, {}, {}}};
    CHECK(benchPlot({"GPU", "", {result}}).find("of what the eye sees") == std::string::npos);
    result.seen = seen;
    CHECK(benchPlot({"GPU", "", {result}}).find("of what the eye sees") != std::string::npos);
    CHECK(benchTable({"GPU", "", {result}}).find("an error of 44.26 dB, and notices it in 50.00 %") != std::string::npos);
    CHECK(benchJson({"GPU", "", {result}}).find("\"noticed\": 0.5") != std::string::npos);
    CHECK(benchCsv({"GPU", "", {result}}).find(",44.2597,0.5,") != std::string::npos);
}

TEST_CASE("aMethodMayBeThePaperToTheLetterAndViewsMayDrawAScenesSplatsInSeveralWays") {
    const Workplace work;
    writeText(work.path / "a.toml",
              "[[methods]]\nname = \"letter\"\nmode = \"paper\"\ndepth = \"sum\"\nresampling = \"forward\"\nper_eye = true\n"
              "[[methods]]\nname = \"ours\"\nmode = \"paper\"\n"
              "[[views]]\nname = \"whole\"\nscene = [\"a.ply\", \"b\"]\n"
              "[[views]]\nname = \"flat\"\nscene = \"b\"\nflatten = true\n"
              "[[views]]\nname = \"near\"\nscene = \"b\"\nnear = 0.5\n"
              "[[views]]\nname = \"dimmed\"\nscene = \"b\"\nantialiased = true\n");
    const BenchOptions options = parse<BenchOptions>({"bench", "b", "--out", "out", "--config", (work.path / "a.toml").string()});
    const BenchPlan plan = planBench(options);
    REQUIRE(plan.methods.size() == 4);
    CHECK(plan.methods[2].stereo.warp.forward);
    CHECK(plan.methods[2].stereo.per_eye);
    CHECK_FALSE(plan.methods[3].stereo.warp.forward);
    CHECK_FALSE(plan.methods[3].stereo.per_eye);
    const auto namesOf = [&](const std::string& scene) {
        std::string names;
        for (const DrawnViews& drawn : viewsOf(plan, scene, options.run)) {
            names += drawn.run.load.flatten ? "flattened:" : drawn.run.load.antialiased ? "antialiased:" : "trained:";
            for (const BenchView& view : drawn.views) { names += " " + view.name; }
            names += "; ";
        }
        return names;
    };
    CHECK(namesOf("some/b") == "trained: whole near; flattened: flat; antialiased: dimmed; ");
    CHECK(namesOf("a.ply") == "trained: whole; ");
}

TEST_CASE("plotsOfFewOrBadPointsStayFinite") {
    BenchResult result = makeResult("a&b", Mode::kShared, 1, 0.0);
    result.pass_ms = {{{Role::kNone, FrameStage::kSort, "cull"}, 0.0}};
    for (const double ms : {0.0, 1.0, 2.5}) {
        result.total_ms = ms;
        const std::string svg = benchPlot({"GPU", "", {result}});
        CHECK(svg.find("nan") == std::string::npos);
        CHECK(svg.find("inf") == std::string::npos);
        CHECK(svg.find("a&amp;b") != std::string::npos);
    }
}

}  // namespace options_test
