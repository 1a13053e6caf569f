// Merging the command line with the config file.
#pragma once

#include "engine/setup/settings.h"

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace binosplat {

// The settings of a config file, known keys only, each in its own table or at the top. Tables named in
// `foreign` are skipped. Throws Error with file and line for an unknown table or key. Paths in the file are
// relative to the file.
Settings configLayer(const std::filesystem::path& config, const std::vector<SettingsTable>& tables,
                     const std::set<std::string>& foreign);

// Settings of the command line win; those of the config that contradict one (say, a camera file and an eye)
// are dropped. Two settings of one layer that contradict each other are an Error: kUsage on the command line,
// kBadInput in a config.
Settings mergeLayers(const Settings& command_line, const Settings& config);

}  // namespace binosplat
