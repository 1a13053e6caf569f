// What the user has set on the panel, for all scenes: kept automatically in one file of theirs, of which
// --config and the command line need not know.
#pragma once

#include "app/view/settings/view_settings.h"

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace binosplat {

// Empty if the user has no folder for it.
std::filesystem::path preferencesFile();

// Of a config's tables; and as the file has them. What only one run is about is left out: whether the panel
// is shown, its page, the tint.
using PreferenceLines = std::map<std::pair<std::string, std::string>, std::string>;  // by table and key
PreferenceLines readPreferences(const std::vector<SettingsTable>& tables);
std::string preferencesToml(const PreferenceLines& lines);

// Changes while the viewer runs.
class Preferences {
public:
    // In each frame. What there is at the first call counts as unchanged.
    void note(const ViewSettings& now, double step_seconds);
    // Those not taken yet, once nothing has changed for a second, or at once.
    [[nodiscard]] PreferenceLines takeChanges(bool at_once = false);

private:
    std::optional<ViewSettings> known_;
    PreferenceLines changes_;
    double still_s_ = 0.0;
};

// Adds them to the file. Throws Error if it cannot be written; one that cannot be read is kept as
// FILE.unread.
void keepPreferences(const PreferenceLines& changes);

}  // namespace binosplat
