// The viewer's settings as TOML.
#include "app/view/view_settings.h"

#include "app/options/option_table.h"
#include "engine/error.h"
#include "engine/setup/values.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

namespace binosplat {

namespace {

constexpr double kLeastResolutionScale = 0.1, kMostResolutionScale = 2.0, kMostRefreshRate = 1000.0;

glm::dquat readRotation(const Setting& setting) {
    std::vector<double> values;
    for (const std::string& item : setting.items) {
        if (const std::optional<double> value = parseNumber(item)) { values.push_back(*value); }
    }
    const auto refuse = [&](bool wrong) { check(!wrong, "{} is {}, must be a rotation [w, x, y, z]", setting.origin, setting.text()); };
    refuse(values.size() != 4 || setting.items.size() != 4);
    const glm::dquat rotation(values[0], values[1], values[2], values[3]);
    refuse(!(glm::length(rotation) > 1e-6));
    return glm::normalize(rotation);
}

// The settings of [stereo] and [view], by key, as TOML writes their values.
std::vector<std::pair<std::string, std::string>> stereoLines(const StereoOptions& stereo) {
    RunOptions options;
    options.stereo = stereo;
    std::vector<std::pair<std::string, std::string>> lines;
    for (const OptionRow<RunOptions>& row : runRows()) {
        if (std::string_view(row.text.table) != "stereo" || (row.text.commands & kView) == 0) { continue; }
        const OptionValue value = row.field.value(options);
        const std::string text = textOf(value);
        lines.emplace_back(row.text.key, std::holds_alternative<std::string>(value) ? fmt::format("\"{}\"", text) : text);
    }
    return lines;
}

std::vector<std::pair<std::string, std::string>> viewLines(const ViewSettings& settings) {
    return {{"resolution-scale", fmt::format("{}", settings.resolution_scale)},
            {"tint", settings.tint ? "true" : "false"},
            {"panel", settings.panel ? "true" : "false"},
            {"visibility-mask", settings.visibility_mask ? "true" : "false"},
            {"tilt", settings.tilt ? "true" : "false"},
            {"refresh-rate", fmt::format("{:g}", settings.refresh_rate)},
            {"hands", settings.hands ? "true" : "false"},
            {"locomotion", settings.teleport ? "\"teleport\"" : "\"walk\""},
            {"vignette", settings.vignette ? "true" : "false"},
            {"passthrough", settings.passthrough ? "true" : "false"},
            {"quality", fmt::format("\"{}\"", kQualityNames[static_cast<std::size_t>(settings.quality)])}};
}

}  // namespace

ViewSettings readViewSettings(const std::vector<SettingsTable>& tables, ViewSettings settings) {
    Similarity placement;
    int placed = 0;
    for (const SettingsTable& table : tables) {
        for (const auto& [key, setting] : table.settings) {
            if (key == "resolution-scale") {
                settings.resolution_scale = readNumber(setting, kLeastResolutionScale, kMostResolutionScale);
            } else if (key == "tint") {
                settings.tint = readFlag(setting);
            } else if (key == "panel") {
                settings.panel = readFlag(setting);
            } else if (key == "quality") {
                const auto* const found = std::ranges::find(kQualityNames, setting.text());
                check(found != std::end(kQualityNames), "{} is {}, must be off, sharp, balanced or fast", setting.origin, setting.text());
                settings.quality = static_cast<Quality>(found - std::begin(kQualityNames));
            } else if (key == "refresh-rate") {
                settings.refresh_rate = readNumber(setting, 0.0, kMostRefreshRate);
            } else if (key == "tilt") {
                settings.tilt = readFlag(setting);
            } else if (key == "hands") {
                settings.hands = readFlag(setting);
            } else if (key == "locomotion") {
                const bool teleports = setting.text() == "teleport";
                check(teleports || setting.text() == "walk", "{} is {}, must be walk or teleport", setting.origin, setting.text());
                settings.teleport = teleports;
            } else if (key == "vignette") {
                settings.vignette = readFlag(setting);
            } else if (key == "passthrough") {
                settings.passthrough = readFlag(setting);
            } else if (key == "visibility-mask") {
                settings.visibility_mask = readFlag(setting);
            } else if (key == "scene-position") {
                placement.position = readVector(setting);
                ++placed;
            } else if (key == "scene-orientation") {
                placement.orientation = readRotation(setting);
                ++placed;
            } else if (key == "units-per-metre") {
                placement.scale = readPositive(setting);
                ++placed;
            } else {
                fail("{} is not a known key of [view]", setting.origin);
            }
        }
        check(placed == 0 || placed == 3,
              "{}: [view] places the scene in part, must have all of scene-position, scene-orientation and units-per-metre", table.origin);
    }
    if (placed == 3) { settings.scene_from_room = placement; }
    return settings;
}

std::string viewSettingsToml(const ViewSettings& settings) {
    std::string text = "# What the viewer's panel was set to, and where the wearer's room lay in the scene.\n\n[stereo]\n";
    for (const auto& [key, value] : stereoLines(settings.stereo)) { text += fmt::format("{} = {}\n", key, value); }
    text += "\n[view]\n";
    for (const auto& [key, value] : viewLines(settings)) { text += fmt::format("{} = {}\n", key, value); }
    if (settings.scene_from_room) {
        const auto& [q, p, scale] = *settings.scene_from_room;
        text += fmt::format("scene-position = [{}, {}, {}]\nscene-orientation = [{}, {}, {}, {}]\nunits-per-metre = {}\n", p.x, p.y, p.z,
                            q.w, q.x, q.y, q.z, scale);
    }
    return text;
}

std::string describeChange(const ViewSettings& before, const ViewSettings& after) {
    std::string text;
    const auto compare = [&](const auto& old_lines, const auto& new_lines) {
        for (std::size_t i = 0; i < old_lines.size(); ++i) {
            if (old_lines[i].second == new_lines[i].second) { continue; }
            text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", new_lines[i].first, new_lines[i].second);
        }
    };
    compare(stereoLines(before.stereo), stereoLines(after.stereo));
    compare(viewLines(before), viewLines(after));
    return text;
}

}  // namespace binosplat
