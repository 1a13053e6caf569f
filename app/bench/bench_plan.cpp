// Reading the plan of `bench`.
#include "app/bench/bench_plan.h"

#include "app/bench/bench_results.h"
#include "app/options/modes.h"
#include "engine/error.h"
#include "engine/setup/values.h"

#include <algorithm>
#include <filesystem>
#include <ranges>
#include <set>

namespace binosplat {

namespace {

void refuseUnknown(const SettingsTable& table, const std::set<std::string>& known) {
    for (const auto& [key, setting] : table.settings) {
        check(known.contains(key), "{} is not a known key of [{}]", setting.origin, table.name);
    }
}

// Each entry of an array, checked like a single value.
template <typename Read>
auto readEach(const Setting& setting, Read&& read) {
    std::vector<decltype(read(setting))> values;
    for (const std::string& item : setting.items) { values.push_back(read(Setting{setting.origin, {item}})); }
    check(!values.empty(), "{} is empty, must hold at least one value", setting.origin);
    return values;
}

Mode readMode(const Setting& setting) {
    const std::string name = readChoice(setting, {kModeNames.begin(), kModeNames.end()});
    return static_cast<Mode>(std::ranges::find(kModeNames, name) - kModeNames.begin());
}

void readScores(const Setting& setting, BenchPlan& plan) {
    plan.psnr = plan.ssim = plan.flip = false;
    for (const std::string& score : readEach(setting, [](const Setting& one) {
             return readChoice(one, {"none", "psnr", "ssim", "flip", "lpips"});
         })) {
        plan.ssim |= score == "ssim";
        plan.flip |= score == "flip";
        plan.psnr |= score != "none";
    }
}

// The file of LPIPS weights; empty if LPIPS is not measured. The config's file counts unless its scores omit
// LPIPS, the command line's always.
std::string lpipsWeights(const SettingsTable& bench, const BenchOptions& options) {
    if (!options.lpips_weights.empty()) { return options.lpips_weights; }
    const auto scores = bench.settings.find("scores"), weights = bench.settings.find("lpips");
    const bool chosen = scores != bench.settings.end();
    const bool asked = chosen && std::ranges::count(scores->second.items, "lpips") > 0;
    if (weights == bench.settings.end()) {
        check(!asked, "{} lists lpips; name its weights with --lpips FILE or `lpips` in [bench]",
              asked ? scores->second.origin : "");
        return "";
    }
    const std::string file = readText(weights->second);
    return chosen && !asked ? "" : (std::filesystem::path(options.run.config).parent_path() / file).string();
}

// Returns the modes, which become methods.
std::vector<Mode> readBench(const SettingsTable& table, BenchPlan& plan) {
    refuseUnknown(table, {"scenes", "modes", "repeats", "warm-up", "headsets", "scores", "lpips", "twin"});
    std::vector<Mode> modes;
    for (const auto& [key, setting] : table.settings) {
        if (key == "scenes") { plan.scenes = readEach(setting, readText); }
        if (key == "modes") { modes = readEach(setting, readMode); }
        if (key == "repeats") { plan.repeats = static_cast<std::uint32_t>(readCount(setting, 1, 10000)); }
        if (key == "warm-up") { plan.warm_up = static_cast<std::uint32_t>(readCount(setting, 0, 10000)); }
        if (key == "headsets") { plan.headsets = readEach(setting, readText); }
        if (key == "scores") { readScores(setting, plan); }
        if (key == "twin") { plan.twin = readFlag(setting); }
    }
    return modes;
}

BenchSeries readSeries(const SettingsTable& table, glm::uvec2 default_size_px) {
    refuseUnknown(table, {"name", "splats", "sizes"});
    BenchSeries series{"", {0}, {default_size_px}};
    for (const auto& [key, setting] : table.settings) {
        if (key == "name") { series.name = readText(setting); }
        if (key == "sizes") { series.sizes_px = readEach(setting, readSize); }
        if (key == "splats") {
            series.splats = readEach(
                setting, [](const Setting& one) { return readCount(one, 1, std::uint64_t{1} << 31); });
        }
    }
    check(!series.name.empty(), "{}: name is missing, must be given", table.origin);
    return series;
}

BenchView readView(const SettingsTable& table, const RunOptions& base) {
    refuseUnknown(table, {"name", "scene", "size", "eye", "look", "up", "fov-x", "near", "ipd",
                          "metres-per-unit", "flatten", "antialiased"});
    Settings settings = table.settings;
    BenchView view;
    if (const auto name = settings.extract("name")) { view.name = readText(name.mapped()); }
    if (const auto scene = settings.extract("scene")) { view.scenes = readEach(scene.mapped(), readText); }
    check(!view.name.empty(), "{}: name is missing, must be given", table.origin);
    view.run = runOptions(settings, base);
    return view;
}

// The two methods that all others are compared with come first, and only once.
void addReferences(BenchPlan& plan, const RunOptions& run) {
    std::vector<BenchMethod> methods;
    for (const Mode mode : {Mode::kTwoPass, Mode::kShared}) {
        const auto there = std::ranges::find_if(plan.methods, [&](const BenchMethod& method) {
            return method.stereo.mode == mode && method.resolution == 1.0;
        });
        if (there == plan.methods.end()) { methods.push_back(plainMethod(mode, run)); }
    }
    plan.methods.insert(plan.methods.begin(), methods.begin(), methods.end());
    const bool mono = std::ranges::any_of(
        plan.methods, [](const BenchMethod& method) { return method.stereo.mode == Mode::kMono; });
    if (plan.twin && !mono) { plan.methods.push_back(plainMethod(Mode::kMono, run)); }
}

bool belongsTo(const BenchView& view, const std::string& scene) {
    return view.scenes.empty() || std::ranges::count(view.scenes, bareSceneName(scene)) > 0;
}

// Things measured twice under one name could not be told apart.
void refuseTwins(const BenchPlan& plan) {
    const auto refuse = [](const char* what, auto&& all, auto&& nameOf) {
        std::set<std::string> names;
        for (const auto& one : all) {
            check(names.insert(nameOf(one)).second, "{} {} is named twice, names must differ", what,
                  nameOf(one));
        }
    };
    refuse("scene", plan.scenes, [](const std::string& scene) { return scene; });
    refuse("headset", plan.headsets, [](const std::string& headset) { return headset; });
    refuse("series", plan.series, [](const BenchSeries& series) { return series.name; });
    for (const std::string& scene : plan.scenes) {
        refuse("view",
               plan.views | std::views::filter([&](const BenchView& view) { return belongsTo(view, scene); }),
               [](const BenchView& view) { return view.name; });
    }
    refuse("method", plan.methods, [](const BenchMethod& method) { return method.name; });
}

}  // namespace

BenchPlan planBench(const BenchOptions& options) {
    const glm::uvec2 default_size_px = options.run.camera.size_px.value_or(glm::uvec2(0));
    BenchPlan plan;
    std::vector<Mode> modes;
    SettingsTable bench;
    for (const SettingsTable& table : options.tables) {
        if (table.name == "bench") {
            bench = table;
            modes = readBench(table, plan);
        }
        if (table.name == "series") { plan.series.push_back(readSeries(table, default_size_px)); }
        if (table.name == "views") { plan.views.push_back(readView(table, options.run)); }
        if (table.name == "methods") {
            std::ranges::move(readMethods(table, options.run), std::back_inserter(plan.methods));
        }
    }
    if (modes.empty() && plan.methods.empty()) {
        modes = {Mode::kTwoPass, Mode::kShared, Mode::kReproject, Mode::kPaper, Mode::kPredicted};
    }
    std::vector<BenchMethod> plain;
    for (const Mode mode : modes) { plain.push_back(plainMethod(mode, options.run)); }
    plan.methods.insert(plan.methods.begin(), plain.begin(), plain.end());
    addReferences(plan, options.run);
    for (const BenchMethod& method : plan.methods) { requirePeriphery(method.stereo); }

    if (!options.scenes.empty()) { plan.scenes = options.scenes; }
    if (plan.scenes.empty()) {
        throw Error(ExitCode::kUsage,
                    "SCENE is required: on the command line or as `scenes` in the config's [bench]");
    }
    if (options.repeats > 0) { plan.repeats = options.repeats; }
    if (plan.series.empty()) { plan.series.push_back({"frame", {0}, {default_size_px}}); }
    if (const std::string weights = lpipsWeights(bench, options); !weights.empty()) {
        plan.lpips.emplace(weights);
        plan.psnr = true;  // --lpips needs pictures to be compared, even if the config does not
    }
    const CameraOptions& asked = options.asked;
    if (asked.size_px) {
        for (BenchSeries& series : plan.series) { series.sizes_px = {*asked.size_px}; }
    }
    if (asked.eye || asked.look || !asked.cameras_file.empty()) { plan.views.clear(); }
    if (!asked.headset.empty() || !asked.cameras_file.empty()) { plan.headsets = {""}; }
    check(plan.headsets.front().empty() || options.run.camera.cameras_file.empty(),
          "{}: [bench] has headsets and [camera] has cameras, must be one of them", options.run.config);
    refuseTwins(plan);
    return plan;
}

std::string nameIn(const BenchPlan& plan, const std::string& scene) {
    const std::string bare = bareSceneName(scene);
    const bool is_alone = std::ranges::count(plan.scenes, bare, bareSceneName) == 1;
    return is_alone ? bare : scene;
}

std::vector<DrawnViews> viewsOf(const BenchPlan& plan, const std::string& scene, const RunOptions& run) {
    std::vector<DrawnViews> drawn;
    for (const BenchView& view : plan.views) {
        if (!belongsTo(view, scene)) { continue; }
        const auto same = std::ranges::find_if(
            drawn, [&](const DrawnViews& other) { return other.run.load == view.run.load; });
        (same != drawn.end() ? *same : drawn.emplace_back(DrawnViews{view.run, {}})).views.push_back(view);
    }
    if (drawn.empty()) { drawn.push_back({run, {{"", {scene}, run}}}); }
    return drawn;
}

}  // namespace binosplat
