// Files and folders that people take for a scene: what they are, and what to open instead.
#pragma once

#include <string>
#include <string_view>

namespace binosplat {

// Of a file, by its first bytes and its name. Empty: nothing is known of it.
[[nodiscard]] std::string describeOther(std::string_view start, const std::string& path);
// Of a folder, by the names in it. Empty: nothing is known of it.
[[nodiscard]] std::string describeOtherFolder(const std::string& folder);

}  // namespace binosplat
