// Leftovers of an earlier run in this one's output folder.
#pragma once

#include "xr/simulated/script/script.h"

#include <filesystem>
#include <string>

namespace simulated {

inline constexpr const char* kLogName = "frames.jsonl";

// "frame_000012.png"
[[nodiscard]] std::string namePicture(std::uint64_t frame);

// Removes the log of an earlier run and the pictures that it names, finished or not, and no other file.
// Throws std::runtime_error, and removes nothing, if a file that a run with these pictures would write, the
// log or a picture, exists but is not from an earlier run.
void removeOldOutput(const std::filesystem::path& folder, bool writes_pictures, const FrameChoice& frames);

}  // namespace simulated
