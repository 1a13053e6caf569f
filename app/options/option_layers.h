// Merging the command line with the config file.
#pragma once

#include "engine/setup/settings.h"

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace binosplat {

// The settings in a config file, each in its own table or at the top. Tables named in `foreign` are skipped.
// Throws Error with file and line for an unknown table or key. Paths in the file are relative to the file.
Settings configLayer(const std::filesystem::path& config, const std::vector<SettingsTable>& tables,
                     const std::set<std::string>& foreign);

// Settings on the command line win; those in the config that contradict them (say, a camera file and an eye)
// are dropped. Two contradictory settings in the same layer are an Error: kUsage on the command line,
// kBadInput in a config.
Settings mergeLayers(const Settings& command_line, const Settings& config);

}  // namespace binosplat
