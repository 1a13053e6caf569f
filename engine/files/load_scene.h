// Loads a scene from anywhere: a file of any format, a folder, a built-in scene.
#pragma once

#include "engine/scene/scene.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace binosplat {

// The choice among several levels of detail.
struct LevelChoice {
    std::optional<std::uint32_t> level;  // 0: the finest; an error if the scene lacks that level
    // Without `level`: true if that many splats fit. The finest level that fits is loaded, or else the
    // coarsest; without `fits`, the finest.
    std::function<bool(std::uint64_t splats, int sh_degree)> fits;
};

// Loads `source`: a file, a directory, or builtin:NAME (then `builtin_splats` sets the size, 0 for its
// default). A directory is a SOG scene, the output of a training run (its newest scene is loaded), a moving
// scene (its first frame is loaded), or contains a single scene file. Needs at most twice the scene's own
// size in host memory. Throws Error with file, place, what is wrong and what was expected.
Scene loadScene(const std::string& source, std::uint64_t builtin_splats = 0, LoadNotes* notes = nullptr,
                const Progress& progress = {}, const LevelChoice& level = {});

// The format of the scene in a file, judged by the beginning of its content; empty if unknown. Throws Error
// if that cannot be read.
std::string formatOfFile(const std::string& path);

// The same for an open file, wherever its scene's other files are.
class InputFile;
Scene loadScene(std::unique_ptr<InputFile> file, LoadNotes& notes, const Progress& progress = {},
                const LevelChoice& level = {});

}  // namespace binosplat
