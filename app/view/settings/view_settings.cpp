// The viewer's settings as TOML.
#include "app/view/settings/view_settings.h"

#include "app/options/option_table.h"
#include "app/view/settings/view_settings_table.h"
#include "engine/error.h"
#include "engine/setup/values.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

namespace binosplat {

namespace {

glm::dquat readRotation(const Setting& setting) {
    std::vector<double> values;
    for (const std::string& item : setting.items) {
        if (const std::optional<double> value = parseNumber(item)) { values.push_back(*value); }
    }
    const auto refuse = [&](bool wrong) {
        check(!wrong, "{} is {}, must be a rotation [w, x, y, z]", setting.origin, setting.text());
    };
    refuse(values.size() != 4 || setting.items.size() != 4);
    const glm::dquat rotation(values[0], values[1], values[2], values[3]);
    refuse(!(glm::length(rotation) > 1e-6));
    return glm::normalize(rotation);
}

template <typename Owner>
SettingLine lineOf(const OptionRow<Owner>& row, const Owner& owner) {
    const OptionValue value = row.field.value(owner);
    const std::string text = textOf(value);
    return {row.text.table, row.text.key,
            std::holds_alternative<std::string>(value) ? fmt::format("\"{}\"", text) : text};
}

std::string placeLines(const ViewSettings& settings) {
    std::string text;
    if (settings.scene_from_room) {
        const auto& [q, p, scale] = *settings.scene_from_room;
        text += fmt::format(
            "scene-position = [{}, {}, {}]\nscene-orientation = [{}, {}, {}, {}]\nunits-per-metre = {}\n",
            p.x, p.y, p.z, q.w, q.x, q.y, q.z, scale);
    }
    if (settings.metres_per_unit) {
        text += fmt::format("metres-per-unit = {}\n", *settings.metres_per_unit);
    }
    return text;
}

}  // namespace

std::span<const OptionRow<ViewSettings>> viewSettingsRows() {
    using S = ViewSettings;
    const auto row = [](const char* key, const char* value, const char* help, OptionField<S> field) {
        return OptionRow<S>{{key, "view", kView, value, help}, std::move(field)};
    };
    static const std::vector<OptionRow<S>> rows{
        row("resolution-scale", "FACTOR",
            "resolution, as a share of what the headset recommends, in each direction",
            field::number<&S::resolution_scale>(0.1, 2.0)),
        row("tint", "", "tint tiles by how they were made", field::flag<&S::tint>()),
        row("panel", "", "show the panel at the start", field::flag<&S::panel>()),
        row("submit-depth", "",
            "give the runtime the pictures' depth, so that it can correct them for late head motion",
            field::flag<&S::submit_depth>()),
        row("visibility-mask", "", "ask the runtime what the lenses hide",
            field::flag<&S::visibility_mask>()),
        row("eye-tracking", "", "with foveation: follow the gaze, if the headset tracks it",
            field::flag<&S::eye_tracking>()),
        row("foveated-inset", "",
            "with foveation: if the runtime accepts a sharp inset over a coarse picture, give it both",
            field::flag<&S::foveated_inset>()),
        row("tilt", "", "allow two hands to tilt the scene", field::flag<&S::tilt>()),
        row("refresh-rate", "HZ", "one of the headset's rates; 0: the runtime's choice",
            field::number<&S::refresh_rate>(0.0, 1000.0)),
        row("hands", "", "draw hands, or the controllers that they hold", field::flag<&S::hands>()),
        row("locomotion", "KIND", "what the left stick does",
            field::named<&S::teleport>({"walk", "teleport"})),
        row("turn", "KIND", "how the right stick turns: 30 degrees at a time, or smoothly",
            field::named<&S::smooth_turn>({"snap", "smooth"})),
        row("follow-ground", "", "keep the wearer on the scene's ground", field::flag<&S::follow_ground>()),
        row("backdrop", "COLOUR", "colour behind the scene; as-set: what --background says",
            field::named<&S::backdrop>({"as-set", "black", "grey", "white"})),
        row("panel-page", "PAGE",
            "the page that the panel opens with; time: only for a scene that moves; help: only in a headset",
            field::named<&S::page>({"view", "scenes", "method", "time", "help"})),
        row("first-steps", "WHEN",
            "explain three gestures at the start; once: only the first time; with --simulate: never, unless "
            "this is set",
            field::named<&S::first_steps>({"once", "always", "never"})),
        row("vignette", "", "darken the edge of the view while a stick moves the wearer",
            field::flag<&S::vignette>()),
        row("passthrough", "", "show the room behind the scene, if the headset can",
            field::flag<&S::passthrough>()),
        row("quality", "PRESET", "how the frame rate is held; see headset.md",
            field::named<&S::quality>({std::begin(kQualityNames), std::end(kQualityNames)})),
        row("picture-both-eyes", "", "saved pictures show both eyes, side by side",
            field::flag<&S::picture_both_eyes>()),
        row("window-stereo", "KIND",
            "in a window without a headset: one eye's picture, or how both are shown",
            field::named<&S::window_stereo>(
                {"mono", "side-by-side", "cross-eyed", "top-bottom", "anaglyph"})),
        row("window-eyes", "SHARE",
            "in a window: distance between the eyes, as a share of the distance to the screen plane",
            field::number<&S::window_eyes>(0.0, 0.2)),
        row("window-plane", "FACTOR",
            "in a window: distance to the screen plane, as a multiple of that to the point that you orbit",
            field::number<&S::window_plane>(0.1, 10.0)),
        row("window-smooth", "CHOICE",
            "in a window: once nothing changes, each pixel is the mean of four; auto: if a picture takes "
            "less than a second",
            field::named<&S::window_smooth>({"auto", "off", "on"})),
    };
    return rows;
}

const OptionRow<ViewSettings>* findViewRow(std::string_view key) {
    const auto found = std::ranges::find(viewSettingsRows(), key,
                                         [](const auto& row) { return std::string_view(row.text.key); });
    return found == viewSettingsRows().end() ? nullptr : &*found;
}

ViewSettings readViewSettings(const std::vector<SettingsTable>& tables, ViewSettings settings) {
    Similarity placement;
    int placed = 0;
    for (const SettingsTable& table : tables) {
        for (const auto& [key, setting] : table.settings) {
            if (const OptionRow<ViewSettings>* row = findViewRow(key); row != nullptr) {
                row->field.read(setting, settings);
                continue;
            }
            ++placed;
            if (key == "scene-position") {
                placement.position = readVector(setting);
            } else if (key == "scene-orientation") {
                placement.orientation = readRotation(setting);
            } else if (key == "units-per-metre") {
                placement.scale = readPositive(setting);
            } else if (key == "metres-per-unit") {
                --placed;
                settings.metres_per_unit = readPositive(setting);
            } else {
                fail("{} is not a known key of [view]", setting.origin);
            }
        }
        check(placed == 0 || placed == 3,
              "{}: [view] places the scene only in part, must have all of scene-position, scene-orientation "
              "and units-per-metre",
              table.origin);
    }
    if (placed == 3) { settings.scene_from_room = placement; }
    return settings;
}

std::vector<SettingLine> settingLines(const ViewSettings& settings) {
    RunOptions options;
    options.stereo = settings.stereo;
    std::vector<SettingLine> lines;
    for (const OptionRow<RunOptions>& row : runRows()) {
        if (std::string_view(row.text.table) != "stereo" || (row.text.commands & kView) == 0) { continue; }
        // Half resolution goes with foveation: other commands refuse it alone.
        if (std::string_view(row.text.key) == "periphery" && settings.stereo.foveation_deg == 0.0) {
            continue;
        }
        lines.push_back(lineOf(row, options));
    }
    for (const OptionRow<ViewSettings>& row : viewSettingsRows()) { lines.push_back(lineOf(row, settings)); }
    return lines;
}

std::string viewSettingsToml(const ViewSettings& settings) {
    std::string text =
        "# What the viewer's panel was set to, and where the wearer's room lay in the scene.\n";
    const char* table = "";
    for (const SettingLine& line : settingLines(settings)) {
        if (line.value.empty()) { continue; }  // left to the scene
        if (std::string_view(std::exchange(table, line.table)) != line.table) {
            text += fmt::format("\n[{}]\n", line.table);
        }
        text += fmt::format("{} = {}\n", line.key, line.value);
    }
    return text + placeLines(settings);
}

std::string scenePlaceToml(const ViewSettings& settings) {
    return "# Where the wearer's room lay in the scene.\n\n[view]\n" + placeLines(settings);
}

std::string describeChange(const ViewSettings& before, const ViewSettings& after) {
    std::string text;
    if (before == after) { return text; }  // as in nearly every frame
    const std::vector<SettingLine> lines_before = settingLines(before);
    for (const SettingLine& line : settingLines(after)) {
        if (std::ranges::find(lines_before, line) != lines_before.end()) { continue; }
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", line.key, line.value);
    }
    return text;
}

}  // namespace binosplat
