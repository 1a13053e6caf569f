// What `bench` measures.
#include "app/bench_plan.h"

#include "engine/error.h"
#include "engine/setup/values.h"

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

std::string readMode(const Setting& setting) {
    return readChoice(setting, {"mono", "two-pass", "shared", "reproject", "paper", "predicted"});
}

void readBench(const SettingsTable& table, BenchPlan& plan) {
    refuseUnknown(table, {"scenes", "modes", "repeats", "warm-up"});
    for (const auto& [key, setting] : table.settings) {
        if (key == "scenes") { plan.scenes = readEach(setting, readText); }
        if (key == "modes") { plan.modes = readEach(setting, readMode); }
        if (key == "repeats") { plan.repeats = static_cast<std::uint32_t>(readCount(setting, 1, 10000)); }
        if (key == "warm-up") { plan.warm_up = static_cast<std::uint32_t>(readCount(setting, 0, 10000)); }
    }
}

BenchSeries readSeries(const SettingsTable& table, glm::uvec2 default_size_px) {
    refuseUnknown(table, {"name", "splats", "sizes"});
    BenchSeries series{"", {0}, {default_size_px}};
    for (const auto& [key, setting] : table.settings) {
        if (key == "name") { series.name = readText(setting); }
        if (key == "sizes") { series.sizes_px = readEach(setting, readSize); }
        if (key == "splats") {
            series.splats = readEach(setting, [](const Setting& one) { return readCount(one, 1, std::uint64_t{1} << 31); });
        }
    }
    check(!series.name.empty(), "{}: name is missing, must be given", table.origin);
    return series;
}

}  // namespace

BenchPlan planBench(const BenchOptions& options) {
    const glm::uvec2 default_size_px = options.run.camera.size_px.value_or(glm::uvec2(1024));
    BenchPlan plan;
    for (const SettingsTable& table : options.tables) {
        if (table.name == "bench") { readBench(table, plan); }
        if (table.name == "series") { plan.series.push_back(readSeries(table, default_size_px)); }
    }
    if (!options.scenes.empty()) { plan.scenes = options.scenes; }
    if (plan.scenes.empty()) {
        throw Error(ExitCode::kUsage, "SCENE is required: on the command line or as `scenes` in the config's [bench]");
    }
    if (plan.series.empty()) { plan.series.push_back({"frame", {0}, {default_size_px}}); }
    return plan;
}

}  // namespace binosplat
