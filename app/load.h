// Loading a scene as the options ask for it, from wherever it is.
#pragma once

#include "app/options/options.h"
#include "engine/scene/scene.h"

#include <cstdint>
#include <string>

namespace binosplat {

// What a frame needs beside the scene depends on the view and is not known yet: the level's splats alone are held against the limit.
LevelChoice levelChoice(const LoadOptions& options, std::uint64_t memory_limit_mib);

// SCENE of any command: a file, a folder, a built-in scene (then `builtin_splats` sets the size, 0 for its default), or an address.
// `memory_limit_mib` is of the device, 0 for none.
Scene loadAsAsked(const std::string& source, const LoadOptions& options, std::uint64_t memory_limit_mib, LoadNotes& notes,
                  const Progress& progress = {}, std::uint64_t builtin_splats = 0);

// With progress on the terminal.
Scene loadWithProgress(const std::string& source, const LoadOptions& options, LoadNotes& notes, std::uint64_t memory_limit_mib = 0);

// For commands that print no notes.
Scene loadAs(const RunOptions& run, const std::string& source, std::uint64_t builtin_splats = 0);

}  // namespace binosplat
