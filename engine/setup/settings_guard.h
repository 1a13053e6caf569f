// What TOML allows and the library that reads it does not survive.
#pragma once

#include <string>
#include <string_view>

namespace binosplat {

// Throws Error with file and line for keys of more than 64 parts, for letters outside of ASCII that are neither in quotes nor in a comment,
// for quotes that begin within a word, and for texts over several lines.
void refuseUnreadableSettings(const std::string& file, std::string_view text);

}  // namespace binosplat
