// Where the viewer keeps what the wearer sets, and what becomes of it.
#pragma once

#include "app/view/settings/view_settings.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace binosplat {

// Of the user's configuration (XDG_CONFIG_HOME, or ~/.config). Throws Error where there is no such folder.
std::filesystem::path viewFolder();

// A file of the user's configuration folder (XDG_CONFIG_HOME, or ~/.config) for this scene alone: of a file by its place and its size, so
// that another one in its place begins anew; of a folder by its place, of builtin:NAME by its name. Throws Error where there is no such
// folder.
std::filesystem::path viewSettingsFile(const std::string& scene);
// The same without .view.toml, for what else is kept of the scene.
std::filesystem::path viewFileStem(const std::string& scene);

// Where the wearer stood when the scene's settings were saved; empty where they never were. Throws Error where the file is broken.
std::optional<Similarity> rememberedPlacement(const std::string& scene);

// What was saved is read apart from being taken, which reads no file. Saving and taking say in a line how it went; a file that cannot be
// read or written is no reason to leave the headset. What is written is whole or not there.
std::string saveViewSettings(const std::string& scene, const ViewSettings& settings);
struct SavedSettings {
    std::filesystem::path file;
    std::vector<SettingsTable> tables;
    std::string trouble;  // why there are none
};
SavedSettings readSavedSettings(const std::string& scene);
std::string takeSavedSettings(const SavedSettings& saved, ViewSettings& settings);

}  // namespace binosplat
