// Where the viewer keeps the wearer's settings, and how it saves and loads them.
#pragma once

#include "app/view/settings/view_settings.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace binosplat {

// The viewer's folder in XDG_CONFIG_HOME or ~/.config. Throws Error if neither is known.
std::filesystem::path viewFolder();

// The settings file of this scene in that folder: for a file, named by its path and size, so that another
// file in its place starts over; for a folder or an address, by its path; for builtin:NAME, by its name.
// Throws as viewFolder() does.
std::filesystem::path viewSettingsFile(const std::string& scene);
// The same without .view.toml, for other files about the scene.
std::filesystem::path viewFileStem(const std::string& scene);

// Where the wearer stood when the scene was saved, and its scale, if it was measured; both empty if it never
// was. Throws Error if the file is broken.
struct RememberedPlace {
    std::optional<Similarity> scene_from_room;
    std::optional<double> metres_per_unit;
};
RememberedPlace rememberedPlace(const std::string& scene);

// Saves the place and the scale along with the settings. Reading what was saved and applying it are separate,
// so that applying it does not read a file; settings that earlier versions saved are applied, too. Saving and
// applying return the outcome in a line; a file that cannot be read or written does not end the viewer. Files
// are written completely or not at all.
std::string saveViewSettings(const std::string& scene, const ViewSettings& settings);
struct SavedSettings {
    std::filesystem::path file;
    std::vector<SettingsTable> tables;
    std::string trouble;  // why there are no settings
};
SavedSettings readSavedSettings(const std::string& scene);
std::string takeSavedSettings(const SavedSettings& saved, ViewSettings& settings);

}  // namespace binosplat
