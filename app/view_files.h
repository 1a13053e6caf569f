// Where the viewer keeps what the wearer sets, and what becomes of it.
#pragma once

#include "app/view_settings.h"

#include <filesystem>
#include <string>

namespace binosplat {

// SCENE.view.toml in the working directory, of a file, a folder or builtin:NAME.
std::filesystem::path viewSettingsFile(const std::string& scene);

// Both say in a line how it went; a file that cannot be read or written is no reason to leave the headset.
std::string saveViewSettings(const std::filesystem::path& file, const ViewSettings& settings);
std::string loadViewSettings(const std::filesystem::path& file, ViewSettings& settings);

}  // namespace binosplat
