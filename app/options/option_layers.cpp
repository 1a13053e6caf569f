// Merging the command line with the config file.
#include "app/options/option_layers.h"

#include "app/options/option_table.h"
#include "engine/error.h"

#include <utility>

namespace binosplat {

namespace {

// Each of these pairs contradicts itself about the camera.
constexpr std::pair<const char*, const char*> kContradictions[] = {
    {"cameras", "headset"}, {"cameras", "eye"},   {"cameras", "look"},
    {"cameras", "up"},      {"cameras", "fov-x"}, {"headset", "fov-x"},
};

void refuseContradictions(const Settings& layer, ExitCode code) {
    for (const auto& [a, b] : kContradictions) {
        if (!layer.contains(a) || !layer.contains(b)) { continue; }
        throw Error(code, fmt::format("{} and {} contradict each other, must be one of them",
                                      layer.at(a).origin, layer.at(b).origin));
    }
}

}  // namespace

RunOptions runOptions(const Settings& settings, const RunOptions& options) {
    return readRows(runRows(), settings, options);
}

Settings configLayer(const std::filesystem::path& config, const std::vector<SettingsTable>& tables,
                     const std::set<std::string>& foreign) {
    Settings layer;
    for (const SettingsTable& table : tables) {
        if (foreign.contains(table.name)) { continue; }
        check(table.name.empty() || table.name == "camera" || table.name == "stereo" ||
                  table.name == "scene" || table.name == "run",
              "{}: [{}] is not a known table, must be [camera], [stereo], [scene] or [run]", table.origin,
              table.name);
        for (const auto& [key, setting] : table.settings) {
            const OptionRow<RunOptions>* row = findRunRow(key);
            check(row != nullptr,
                  "{} is not a known key, must be the name of an option of `binosplat render` without its "
                  "dashes",
                  setting.origin);
            check(table.name.empty() || table.name == row->text.table,
                  "{} is in [{}], must be in [{}] or at the top", setting.origin, table.name,
                  row->text.table);
            check(!layer.contains(key), "{} is set twice, must be set once (also {})", setting.origin,
                  layer.contains(key) ? layer.at(key).origin : "");
            Setting resolved = setting;
            const bool is_path =
                row->field.is_file || (key == "headset" && setting.text().ends_with(".toml"));
            if (is_path && resolved.items.size() == 1) {
                resolved.items[0] = (config.parent_path() / resolved.items[0]).string();
            }
            layer.emplace(key, resolved);
        }
    }
    refuseContradictions(layer, ExitCode::kBadInput);
    return layer;
}

Settings mergeLayers(const Settings& command_line, const Settings& config) {
    refuseContradictions(command_line, ExitCode::kUsage);
    Settings merged = config;
    for (const auto& [a, b] : kContradictions) {
        if (command_line.contains(a)) { merged.erase(b); }
        if (command_line.contains(b)) { merged.erase(a); }
    }
    for (const auto& [key, setting] : command_line) { merged.insert_or_assign(key, setting); }
    if (!merged.contains("cameras") && command_line.contains("view")) {
        throw Error(
            ExitCode::kUsage,
            "--view is given without --cameras, and there is no cameras.json beside SCENE or in its folder");
    }
    return merged;
}

}  // namespace binosplat
