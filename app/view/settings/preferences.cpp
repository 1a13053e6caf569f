// Stores the keys that were changed, as a config.
#include "app/view/settings/preferences.h"

#include "app/options/option_table.h"
#include "app/view/settings/view_settings_table.h"
#include "engine/error.h"
#include "engine/platform.h"
#include "engine/setup/output_files.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace binosplat {

namespace {

constexpr double kStillSeconds = 1.0;
constexpr std::array kOfOneRun{std::string_view("panel"), std::string_view("panel-page"),
                               std::string_view("tint")};

bool isPreference(const SettingLine& line) {
    return std::ranges::find(kOfOneRun, line.key) == kOfOneRun.end();
}

}  // namespace

std::filesystem::path preferencesFile() {
    const std::filesystem::path folder = userConfigFolder();
    return folder.empty() ? folder : folder / "binosplat" / "preferences.toml";
}

PreferenceLines readPreferences(const std::vector<SettingsTable>& tables) {
    // Read and written again, so that values are checked and have their quotes.
    ViewSettings settings;
    RunOptions run;
    PreferenceLines lines;
    for (const SettingsTable& table : tables) {
        for (const auto& [key, setting] : table.settings) {
            const OptionRow<ViewSettings>* const of_view = table.name == "view" ? findViewRow(key) : nullptr;
            const OptionRow<RunOptions>* const of_stereo = table.name == "stereo" ? findRunRow(key) : nullptr;
            check(of_view != nullptr || of_stereo != nullptr, "{} is not a known preference", setting.origin);
            of_view != nullptr ? of_view->field.read(setting, settings) : of_stereo->field.read(setting, run);
            lines[{table.name, key}];
        }
    }
    settings.stereo = run.stereo;
    // Half resolution in the periphery is among the lines only if there is foveation.
    if (settings.stereo.foveation_deg == 0.0) { settings.stereo.foveation_deg = 1.0; }
    for (const SettingLine& line : settingLines(settings)) {
        const auto found = lines.find({line.table, line.key});
        if (found != lines.end()) { found->second = line.value; }
    }
    if (const auto found = lines.find({"stereo", "foveation"});
        found != lines.end() && run.stereo.foveation_deg == 0.0) {
        found->second = "0";
    }
    return lines;
}

std::string preferencesToml(const PreferenceLines& lines) {
    std::string text =
        "# What was set on the viewer's panel, which writes this file; values in a --config file take "
        "precedence.\n";
    std::string table;
    for (const auto& [place, value] : lines) {
        if (value.empty()) { continue; }
        if (place.first != table) { text += fmt::format("\n[{}]\n", table = place.first); }
        text += fmt::format("{} = {}\n", place.second, value);
    }
    return text;
}

void Preferences::note(const ViewSettings& now, double step_seconds) {
    still_s_ += step_seconds;
    if (!known_) { known_ = now; }
    if (*known_ == now) { return; }
    const std::vector<SettingLine> before = settingLines(*known_);
    for (const SettingLine& line : settingLines(now)) {
        if (isPreference(line) && std::ranges::find(before, line) == before.end()) {
            changes_[{line.table, line.key}] = line.value;
        }
    }
    known_ = now;
    still_s_ = 0.0;
}

PreferenceLines Preferences::takeChanges(bool at_once) {
    return at_once || still_s_ >= kStillSeconds ? std::exchange(changes_, {}) : PreferenceLines();
}

void keepPreferences(const PreferenceLines& changes) {
    const std::filesystem::path file = preferencesFile();
    check(!file.empty(), "preferences cannot be kept: neither XDG_CONFIG_HOME nor HOME is set");
    PreferenceLines lines;
    std::error_code ignored;
    try {
        if (std::filesystem::exists(file, ignored)) { lines = readPreferences(readSettingsFile(file)); }
    } catch (const Error&) {  // has been reported at the start
        std::filesystem::rename(file, file.string() + ".unread", ignored);
    }
    for (const auto& [place, value] : changes) { lines[place] = value; }
    OutputFiles files(file.parent_path());
    writeText(files.staging() / file.filename(), preferencesToml(lines));
    files.publish();
}

}  // namespace binosplat
