// Where the viewer keeps the wearer's settings; saving and loading them.
#pragma once

#include "app/view/settings/view_settings.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace binosplat {

// The viewer's folder in XDG_CONFIG_HOME or ~/.config. Throws Error if neither is known.
std::filesystem::path viewFolder();

// The settings file of this scene in that folder: for a file, by its place and size, so that another file in
// its place starts over; for a folder or an address, by its place; for builtin:NAME, by its name. Throws as
// viewFolder() does.
std::filesystem::path viewSettingsFile(const std::string& scene);
// The same without .view.toml, for other files about the scene.
std::filesystem::path viewFileStem(const std::string& scene);

// Where the wearer stood when the scene was saved, and its measure, if it was measured; both empty if it
// never was. Throws Error if the file is broken.
struct RememberedPlace {
    std::optional<Similarity> scene_from_room;
    std::optional<double> metres_per_unit;
};
RememberedPlace rememberedPlace(const std::string& scene);

// Saves the place and the measure among the settings. Reading what was saved and taking it are separate, so
// that taking reads no file; what programs before have saved among it is taken, too. Saving and taking return
// the outcome in a line; a file that cannot be read or written does not end the viewer. Files are written as
// a whole or not at all.
std::string saveViewSettings(const std::string& scene, const ViewSettings& settings);
struct SavedSettings {
    std::filesystem::path file;
    std::vector<SettingsTable> tables;
    std::string trouble;  // why there are no settings
};
SavedSettings readSavedSettings(const std::string& scene);
std::string takeSavedSettings(const SavedSettings& saved, ViewSettings& settings);

}  // namespace binosplat
