// The methods that a bench compares, and sweeps over their settings.
#include "app/bench/bench_methods.h"

#include "app/options/option_table.h"
#include "engine/error.h"
#include "engine/setup/values.h"

namespace binosplat {

namespace {

bool isMethodKey(const std::string& key) {
    const OptionRow<RunOptions>* row = findRunRow(key);
    return key == "name" || key == "resolution" || key == "frame-time" ||
           (row != nullptr && (row->text.commands & kMethods) != 0);
}

// A method under construction: its name so far, and one value for each key.
struct Combination {
    std::string name;
    Settings settings;
};

// Combines every combination so far with every entry of one more key.
std::vector<Combination> extend(const std::vector<Combination>& combinations, const std::string& key,
                                const Setting& setting) {
    std::vector<Combination> extended;
    for (const Combination& combination : combinations) {
        for (const std::string& item : setting.items) {
            Combination& one = extended.emplace_back(combination);
            one.settings[key] = Setting{setting.origin, {item}};
            if (setting.items.size() > 1) {
                one.name += key == "resolution" ? "@" + item : fmt::format(" {}={}", key, item);
            }
        }
    }
    return extended;
}

}  // namespace

std::vector<BenchMethod> readMethods(const SettingsTable& table, const RunOptions& base) {
    for (const char* key : {"name", "mode"}) {
        check(table.settings.contains(key), "{}: {} is missing, must be given", table.origin, key);
    }
    std::vector<Combination> combinations{{readText(table.settings.at("name")), {}}};
    for (const auto& [key, setting] : table.settings) {
        check(isMethodKey(key), "{} is not a known key of [methods]", setting.origin);
        check(!setting.items.empty(), "{} is empty, must hold at least one value", setting.origin);
        if (key != "name") { combinations = extend(combinations, key, setting); }
    }
    std::vector<BenchMethod> methods;
    for (Combination& one : combinations) {
        const auto resolution = one.settings.extract("resolution"),
                   frame_time = one.settings.extract("frame-time");
        BenchMethod& method = methods.emplace_back(one.name, runOptions(one.settings, base).stereo);
        if (resolution) { method.resolution = readNumber(resolution.mapped(), 0.1, 1.0); }
        if (frame_time) { method.frame_time = readFrameTime(frame_time.mapped()); }
    }
    return methods;
}

BenchMethod plainMethod(Mode mode, const RunOptions& base) {
    BenchMethod method{std::string(nameOf(mode)), base.stereo};
    method.stereo.mode = mode;
    return method;
}

}  // namespace binosplat
