// Settings as text, with where they come from, so that the same code checks the command line and TOML files.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace binosplat {

// One value as it was written. `origin` is its name in messages: "--size" or "default.toml:12: size".
struct Setting {
    std::string origin;
    std::vector<std::string> items;  // one entry, or those of a TOML array

    [[nodiscard]] std::string text() const;  // the entries, joined by commas
};

// By key; '_' in a TOML key reads as '-', so that `fov_x` and `fov-x` are one key.
using Settings = std::map<std::string, Setting>;

// One [table] or one element of a [[table]], in the order of the file; `name` is "" at the top.
struct SettingsTable {
    std::string name;
    std::string origin;  // "default.toml:12"
    Settings settings;
};

// Reads a TOML file of plain values, arrays of plain values, [tables] and [[tables]], no deeper.
// Throws Error with file, line and what was expected.
std::vector<SettingsTable> readSettingsFile(const std::filesystem::path& path);

}  // namespace binosplat
