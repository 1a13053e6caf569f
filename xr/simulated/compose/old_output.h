// What an earlier run left in the folder that this one writes to.
#pragma once

#include <filesystem>

namespace simulated {

inline constexpr const char* kLogName = "frames.jsonl";

// Removes the pictures of an earlier run, which a log that this runtime wrote says were here; nothing where there is no such log, and no
// file of any other name. Pictures that cannot be removed stay.
void removeOldOutput(const std::filesystem::path& folder);

}  // namespace simulated
