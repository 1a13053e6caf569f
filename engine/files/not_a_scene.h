// Files and folders that people mistake for a scene: what they are, and what to open instead.
#pragma once

#include <string>
#include <string_view>

namespace binosplat {

// Of a file, by its first bytes and its name. Empty: unknown.
[[nodiscard]] std::string describeOther(std::string_view start, const std::string& path);
// Of a folder, by the names in it. Empty: unknown.
[[nodiscard]] std::string describeOtherFolder(const std::string& folder);

}  // namespace binosplat
