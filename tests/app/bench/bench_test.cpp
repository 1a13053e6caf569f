// Facts about `bench`: what it plans, and how it judges what it measured.
#include "app/bench/bench_results.h"
#include "app/bench/motion_results.h"
#include "app/load.h"
#include "engine/files/load_scene.h"
#include "tests/app/bench/benches.h"
#include "tests/app/scores/lpips_weights.h"

SUITE(bench) {

const fs::path kConfigs = fs::path(BINOSPLAT_SOURCE_DIR) / "configs" / "bench";

Names methodsOf(const BenchPlan& plan) {
    Names names;
    for (const BenchMethod& method : plan.methods) { names.push_back(method.name); }
    return names;
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

BenchResult withError(double total_ms, double mean_square) {
    BenchResult result = makeResult("a", Mode::kPaper, 1, total_ms);
    result.quality = {{"all", 64, mean_square, {}, {}, {}}};
    return result;
}

TEST_CASE("a level fits if its splats do, which take less memory with fewer colours and as discs") {
    const auto choose = [](const std::string& options) {
        const RunOptions run = renderOptions(options);
        return levelChoice(run.load, run.memory_limit_mib);
    };
    CHECK(!choose("--lod 1").fits);  // already the finest level
    CHECK(choose("--lod 1").level == 1u);
    const LevelChoice discs = choose("--memory-limit 3 --flatten");
    // 48 bytes per splat; with colours 140 and more.
    CHECK(these(discs.fits(65536, 0), discs.fits(65537, 0), discs.fits(65536, 1), discs.fits(65536, 3),
                discs.fits(std::uint64_t{1} << 60, 3)) == these(true, false, false, false, false));
    CHECK(!choose("--memory-limit 3").fits(65536, 0));  // 52 bytes
    CHECK(choose("--memory-limit 3 --flatten --sh-degree 0").fits(65536, 3));
}

TEST_CASE("every config of the configs folder is a plan, whose scenes the command line may replace") {
    int count = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(kConfigs)) {
        const BenchPlan plan =
            planBench(parse<BenchOptions>("bench --out out --config " + entry.path().string()));
        CHECK(!plan.scenes.empty());
        CHECK(!plan.series.empty());
        ++count;
    }
    CHECK(count > 0);
    const std::string demo = (kConfigs / "demo.toml").string();
    CHECK(planBench(parse<BenchOptions>("bench a.ply b.ply --out out --config " + demo)).scenes ==
          Names{"a.ply", "b.ply"});
    const Bench bench;
    CHECK(methodsOf(bench.plan("", "a.ply")) ==
          Names{"two-pass", "shared", "reproject", "paper", "predicted"});
    bench.checkRefused("bench --out out", 2, "SCENE");
    bench.checkRefused("bench missing.ply --out out", 1, "missing.ply");
    CHECK_FALSE(bench.holds("out"));
}

TEST_CASE("methods sweep their settings, and views draw a scene's splats in several ways") {
    const Bench bench;
    const BenchOptions options = bench.options(
        "[bench]\nscenes = [\"builtin:fence\"]\ntwin = true\nscores = [\"psnr\"]\n[stereo]\nmargin = 16\n"
        "[[methods]]\nname = \"p\"\nmode = \"predicted\"\nbudget = [0, 0.5]\ndepth = [\"mean\", "
        "\"sum\"]\ngap_px = 3\n"
        "order = \"distance\"\n"
        "[[methods]]\nname = \"letter\"\nmode = \"paper\"\nresampling = \"forward\"\nper_eye = true\n"
        "[[views]]\nname = \"whole\"\nscene = [\"a.ply\", \"b\"]\n"
        "[[views]]\nname = \"flat\"\nscene = \"b\"\nflatten = true\n"
        "[[views]]\nname = \"near\"\nscene = \"b\"\neye = [1, 2, 3]\nfov_x = 90\nnear = 0.5\n"
        "[[views]]\nname = \"dimmed\"\nscene = \"b\"\nantialiased = true\n");
    const BenchPlan plan = planBench(options);
    CHECK(methodsOf(plan) == Names{"two-pass", "shared", "p budget=0 depth=mean", "p budget=0 depth=sum",
                                   "p budget=0.5 depth=mean", "p budget=0.5 depth=sum", "letter", "mono"});
    const StereoOptions &swept = plan.methods[4].stereo, &letter = plan.methods[6].stereo;
    CHECK(these(swept.warp.budget, swept.warp.gap_px, swept.order, swept.warp.margin_px) ==
          these(0.5, 3, Order::kDistance, 16));
    for (const auto& [stereo, is_letter] : {std::pair(swept, false), std::pair(letter, true)}) {
        CHECK(these(stereo.warp.forward, stereo.per_eye) == these(is_letter, is_letter));
    }
    CHECK_FALSE(plan.methods[0].stereo.order);
    CHECK(!plan.ssim);
    const auto viewsIn = [&](const std::string& scene) {
        std::string names;
        for (const DrawnViews& drawn : viewsOf(plan, scene, options.run)) {
            names += drawn.run.load.flatten       ? "flattened:"
                     : drawn.run.load.antialiased ? "antialiased:"
                                                  : "trained:";
            for (const BenchView& view : drawn.views) { names += " " + view.name; }
            names += "; ";
        }
        return names;
    };
    CHECK(these(viewsIn("some/b"), viewsIn("/some/where/a.ply"), viewsIn("builtin:fence")) ==
          these("trained: whole near; flattened: flat; antialiased: dimmed; ", "trained: whole; ",
                "trained: ; "));
    const RunOptions near = viewsOf(plan, "b", options.run).at(0).views.at(1).run;
    CHECK(these(near.camera.near, near.camera.eye) == these(0.5, glm::dvec3(1.0, 2.0, 3.0)));
}

TEST_CASE("size, camera, headset and repeats of the command line take the place of the config's") {
    const Bench bench;
    const std::string fence = "[bench]\nscenes = [\"builtin:fence\"]\n";
    const std::string sizes = fence + "[[series]]\nname = \"a\"\nsizes = [\"64x48\", \"128x96\"]\n";
    CHECK(bench.plan(sizes).series.at(0).sizes_px == std::vector{glm::uvec2(64, 48), glm::uvec2(128, 96)});
    CHECK(bench.plan(sizes, "--size 32x16").series.at(0).sizes_px == std::vector{glm::uvec2(32, 16)});
    CHECK(these(bench.plan(fence + "repeats = 7\n").repeats,
                bench.plan(fence + "repeats = 7\n", "--repeats 3").repeats) == these(7, 3));
    // The series and views start from the config's own camera.
    const std::string camera =
        "[camera]\nsize = \"256x256\"\neye = [0, 0, -1]\n" + fence +
        "headsets = [\"quest2\", \"index\"]\n[[series]]\nname = \"a\"\nsizes = \"64x48\"\n"
        "[[series]]\nname = \"b\"\n[[views]]\nname = \"near\"\nfov_x = 90\n";
    const BenchPlan plan = bench.plan(camera);
    CHECK(these(plan.series.at(0).sizes_px, plan.series.at(1).sizes_px, plan.views.size(), plan.headsets) ==
          these(std::vector{glm::uvec2(64, 48)}, std::vector{glm::uvec2(256, 256)}, 1,
                Names{"quest2", "index"}));
    CHECK(these(bench.plan(camera, "--eye 1,1,1").views.empty(),
                bench.plan(camera, "--headset vive").headsets) == these(true, Names{""}));
}

TEST_CASE_FIXTURE(Bench, "LPIPS is a score where its weights are given; otherwise nobody reads them") {
    writeFloats(path / "w.bin", makeLpipsWeights(9));
    const std::string head = "[bench]\nscenes = [\"builtin:fence\"]\n", weights = (path / "w.bin").string();
    const BenchPlan alone = plan(head + "scores = [\"lpips\"]\nlpips = \"w.bin\"\n");
    CHECK(these(alone.lpips.has_value(), alone.psnr, alone.ssim, alone.flip) ==
          these(true, true, false, false));
    CHECK(these(plan(head + "lpips = \"w.bin\"\n").lpips.has_value(), plan(head).lpips.has_value()) ==
          these(true, false));
    CHECK_FALSE(plan(head + "scores = [\"psnr\"]\nlpips = \"none.bin\"\n").lpips.has_value());
    const BenchPlan none = plan(head + "scores = [\"none\"]\n", "--lpips " + weights);
    CHECK(these(none.lpips.has_value(), none.psnr) == these(true, true));
    CHECK(contains(planError(head, "--lpips none.bin"), "none.bin: cannot be read"));
    CHECK(contains(planError(head + "lpips = \"none.bin\"\n"), "none.bin: cannot be read"));
    CHECK(contains(planError(head + "scores = [\"ssim\", \"lpips\"]\n"),
                   "b.toml:3: scores lists lpips; name its weights with --lpips FILE or `lpips` in [bench]"));
    CHECK(contains(planError(head, "--lpips " + (path / "b.toml").string()),
                   "b.toml: has 35 bytes, must have the 2898944"));
}

TEST_CASE_FIXTURE(Bench, "one name for two things, and a wrong config, are refused with file and line") {
    const std::string scene = "[bench]\nscenes = [\"builtin:fence\", \"b.ply\"]\n";
    for (const auto& [toml, error] : std::vector<std::pair<std::string, std::string>>{
             {"[bench]\nscenes = [\"a\", \"a\"]\n", "scene a is named twice, names must differ"},
             {scene + "headsets = [\"index\", \"index\"]\n",
              "headset index is named twice, names must differ"},
             {scene + "[[series]]\nname = \"s\"\n[[series]]\nname = \"s\"\n",
              "series s is named twice, names must differ"},
             {scene +
                  "[[methods]]\nname = \"m\"\nmode = \"paper\"\n[[methods]]\nname = \"m\"\nmode = \"mono\"\n",
              "method m is named twice, names must differ"},
             {scene + "[[views]]\nname = \"v\"\n[[views]]\nname = \"v\"\nscene = \"b.ply\"\n",
              "view v is named twice, names must differ"},
             {"[bench]\nrepeats = 0\n", "b.toml:2: repeats is 0, must be a whole number from 1"},
             {"[[series]]\nsizes = [\"8x8\"]\n", "b.toml:1: name is missing"}}) {
        CHECK_MESSAGE(contains(planError(toml), error), toml);
    }
    CHECK(planError(scene + "[[views]]\nname = \"v\"\nscene = \"builtin:fence\"\n"
                            "[[views]]\nname = \"v\"\nscene = \"b.ply\"\n") == "");
}

TEST_CASE("scenes have their own names, or their paths where those are equal") {
    BenchPlan plan;
    plan.scenes = {"a/x.ply", "b/x.ply", "c/y/", "builtin:fence"};
    CHECK(these(nameIn(plan, "a/x.ply"), nameIn(plan, "c/y/"), nameIn(plan, "builtin:fence")) ==
          these("a/x.ply", "y", "builtin:fence"));
    plan.views = {{"whole", {"y"}, {}}};
    CHECK(viewsOf(plan, "c/y/", {}).at(0).views.at(0).name == "whole");
}

TEST_CASE("ratios compare modes at the same point only, by the medians of frames that took turns") {
    CHECK(these(median({3.0}), median({5.0, 1.0, 3.0}), median({4.0, 1.0, 3.0, 100.0})) ==
          these(3.0, 3.0, 3.5));
    std::vector<BenchResult> results{
        makeResult("a", Mode::kTwoPass, 1, 4.0), makeResult("a", Mode::kShared, 1, 2.0),
        makeResult("a", Mode::kShared, 2, 3.0), makeResult("b,c", Mode::kMono, 1, 3.0),
        makeResult("a", Mode::kShared, 1, 5.0)};
    results[4].backbone = "3DGS";  // the same scene as discs is a separate point
    compareModes(results);
    CHECK(!results[4].ratio_to_two_pass.has_value());
    CHECK(these(results[1].ratio_to_two_pass, results[0].ratio_to_shared) == these(0.5, 2.0));
    CHECK(!results[2].ratio_to_two_pass.has_value());
    CHECK(!results[3].ratio_to_shared.has_value());
    CHECK(contains(benchCsv({"GPU", "", results}), "\"b,c\""));
    // A slowdown that hits two neighbouring runs alike changes no ratio.
    results[0].frame_ms = {4.0, 8.0, 4.0};
    results[1].frame_ms = {3.0, 6.0, 1.0};
    compareModes(results);
    CHECK(results[1].ratio_to_two_pass == 0.75);
}

TEST_CASE("the passes of both eyes add up, and passes to stages") {
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
    CHECK(stagesOf(Mode::kPredicted, passes) == NamedTimes{{"cull+sort", 3.0},
                                                           {"dominant", 12.0},
                                                           {"reprojection", 272.0},
                                                           {"ROI choice", 224.0},
                                                           {"patch", 512.0}});
    CHECK(stagesOf(Mode::kShared, {passes.back()}) == NamedTimes{{"affiliated", 512.0}});
    const PassTimes at_once{{{Role::kBoth, FrameStage::kSplat, "rasterize"}, 9.0}};
    CHECK(stagesOf(Mode::kShared, at_once) == NamedTimes{{"both eyes", 9.0}});
    CHECK(stagesOf(Mode::kTemporal, at_once) == NamedTimes{{"patch", 9.0}});
    CHECK(byPass({passes[0], passes[3], passes[9]}) == NamedTimes{{"cull", 1.0}, {"rasterize", 520.0}});
}

TEST_CASE("what moving a tile costs is told in pairs of shared's affiliated eye, or of both eyes at once") {
    BenchResult predicted = makeResult("a", Mode::kPredicted, 1, 9.0),
                shared = makeResult("a", Mode::kShared, 1, 10.0);
    predicted.pass_ms = {{{Role::kAffiliated, FrameStage::kWarp, "reproject"}, 1.0},
                         {{Role::kAffiliated, FrameStage::kChoose, "newcomers"}, 5.0},
                         {{Role::kAffiliated, FrameStage::kWarp, "resample"}, 2.0}};
    predicted.counters = {{"tiles_weighed_as_reprojected", 300}};
    shared.pass_ms = {{{Role::kDominant, FrameStage::kSplat, "rasterize"}, 7.0},
                      {{Role::kAffiliated, FrameStage::kSplat, "project"}, 1.5},
                      {{Role::kAffiliated, FrameStage::kSplat, "rasterize"}, 2.5}};
    shared.counters = {{"tile_pairs_left", 9000}, {"tile_pairs_right", 8000}};
    // 10 us per tile and 0.5 us per pair.
    std::vector<BenchResult> results{predicted, shared};
    compareModes(results);
    CHECK(these(results[0].move_cost.value(), results[1].move_cost.has_value()) ==
          these(doctest::Approx(20.0), false));
    results[1].pass_ms = {{{Role::kBoth, FrameStage::kSplat, "rasterize"}, 17.0}};  // 1 us a pair
    compareModes(results);
    CHECK(results[0].move_cost.value() == doctest::Approx(10.0));
    results[0].counters["tiles_weighed_as_reprojected"] = 0;
    compareModes(results);
    CHECK_FALSE(results[0].move_cost.has_value());
}

TEST_CASE("the front holds what is worth its time, and what is no number is not called equal") {
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
    CHECK(contains(svg, "Pareto front"));
    CHECK_FALSE(contains(svg, "inf"));
    CHECK(contains(benchJson({"GPU", "", results}), "\"psnr_db\": null"));
    CHECK(std::isnan(psnrOf(std::nan(""))));
    CHECK(psnrOf(0.0) > 1e300);
    CHECK_FALSE(contains(benchTable({"GPU", "", {withError(1.0, std::nan(""))}}), "equal"));
}

TEST_CASE("a table that is wider than a terminal is several, each with its methods and no wider") {
    const std::string whole = benchTable({"GPU", "", {withError(1.0, 0.5)}}),
                      parts = benchTable({"GPU", "", {withError(1.0, 0.5)}}, 100);
    const auto wordsOf = [](const std::string& text) {
        const std::vector<std::string> words = wordsIn(text);
        return std::multiset<std::string>(words.begin(), words.end());
    };
    const std::multiset<std::string> in_whole = wordsOf(whole), in_parts = wordsOf(parts);
    std::vector<std::string> lost;
    std::ranges::set_difference(in_whole, in_parts, std::back_inserter(lost));
    CHECK(fmt::format("{}", fmt::join(lost, " ")) == "");
    CHECK(in_parts.count("method") > in_whole.count("method"));
    MotionFrame frame;
    frame.point = frame.method = "predicted";
    frame.mean_square = {0.1, 0.2};
    frame.moved_square = 0.3;
    frame.bounded = BoundedTiles{9, 1};
    for (const std::string& line : linesIn(parts + motionTable({"GPU", "", "walk.csv", {frame}}, 100))) {
        CHECK_MESSAGE(line.size() <= 100, line);
    }
}

TEST_CASE("of an error an eye sees each tile's share, and notices it from a hundredth of the contrast on") {
    const glm::uvec2 size_px(32, 16);  // two tiles
    const Image full{size_px, 4, std::vector<float>(4 * 512, 0.5f)};
    Image picture = full;
    // Sums of squares per tile: 0.1024 and 0.0064.
    for (std::size_t i = 0; i < 512; ++i) { picture.values[4 * i] += i % 32 < 16 ? 0.02f : 0.005f; }
    const SeenScores seen = measureSeen(full, picture, std::array{0.5, 1.0});
    CHECK(seen.mean_square == doctest::Approx((0.5 * 0.1024 + 0.0064) / (3 * 512)).epsilon(1e-4));
    CHECK(these(seen.psnrDb(), seen.noticed) ==
          these(doctest::Approx(10.0 * std::log10(3 * 512 / 0.0576)).epsilon(1e-4), 0.5));
    CHECK(measureSeen(full, full, std::array{0.5, 1.0}).noticed == 0.0);
    // The score appears in the tables and has its own panel in the plot.
    BenchResult result = withError(1.0, 0.01);
    CHECK_FALSE(contains(benchPlot({"GPU", "", {result}}), "of what the eye sees"));
    result.seen = seen;
    CHECK(contains(benchPlot({"GPU", "", {result}}), "of what the eye sees"));
    CHECK(contains(benchTable({"GPU", "", {result}}), "an error of 44.26 dB, and notices it in 50.00 %"));
    CHECK(contains(benchJson({"GPU", "", {result}}), "\"noticed\": 0.5"));
    CHECK(contains(benchCsv({"GPU", "", {result}}), ",44.2597,0.5,"));
}

TEST_CASE("tiles that were not rendered are far under a bound if they are more than 2 dB under it") {
    // Three by two tiles; those on the right and at the bottom stick out, so one row of two is whole.
    const glm::uvec2 size_px(40, 24);
    const auto squareOf = [](double psnr_db) { return static_cast<float>(std::pow(10.0, -0.1 * psnr_db)); };
    const std::vector<float> squares{squareOf(26.01), squareOf(25.99)};
    const auto find = [&](const std::vector<std::uint32_t>& kinds, double bound_db) {
        const BoundedTiles found = findBoundedTiles(squares, kinds, size_px, bound_db);
        return std::pair(found.kept, found.under);
    };
    using Counts = std::pair<std::uint64_t, std::uint64_t>;
    CHECK(these(find({0, 0, 0, 0, 0, 0}, 28.0), find({0, 0, 3, 3, 3, 3}, 29.0),
                find({0, 0, 0, 0, 0, 0}, 27.9)) == these(Counts(2, 1), Counts(2, 2), Counts(2, 0)));
    CHECK(find({0, 3, 0, 0, 0, 0}, 28.0) == Counts(1, 0));  // the second one is rendered
    CHECK(find({}, 28.0) == Counts(0, 0));                  // a full render
    BoundedTiles both{2, 1};
    both += {6, 1};
    CHECK(both.underShare() == 0.25);
    CHECK(BoundedTiles().underShare() == 0.0);
}

TEST_CASE("plots of few or bad points stay finite") {
    BenchResult result = makeResult("a&b", Mode::kShared, 1, 0.0);
    result.pass_ms = {{{Role::kNone, FrameStage::kSort, "cull"}, 0.0}};
    for (const double ms : {0.0, 1.0, 2.5}) {
        result.total_ms = ms;
        const std::string svg = benchPlot({"GPU", "", {result}});
        CHECK_FALSE(contains(svg, "nan"));
        CHECK_FALSE(contains(svg, "inf"));
        CHECK(contains(svg, "a&amp;b"));
    }
}

}  // SUITE(bench)
