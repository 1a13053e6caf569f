// The levels of detail of a scene: each has half the splats of the one before, is thinned out from the
// finest, and is fitted to it.
#pragma once

#include "engine/levels/thin_out.h"

#include <functional>

namespace binosplat {

struct LevelSettings {
    std::size_t levels = 2;  // at least two
    std::vector<Eye> eyes;   // from which the whole scene is judged
    double near = 0.2;       // scene units
    // A scene with more splats is judged in blocks of at most this many, one after another, each as if it
    // were alone, from the same number of places. Smaller levels are then thinned out from the first level
    // that is a single block.
    std::uint64_t block_splats = 1024 * 1024;
    std::size_t block_eyes = 8;
    gpu::uint block_side_px = kJudgingSidePx;
    // Levels of few splats are fitted in smaller pictures: in such they are shown.
    gpu::uint block_side_of_few_px = kJudgingSidePx / 2;
    int block_steps = 4;
    std::size_t block_errors_every = 2;  // errors of levels are measured from every other eye
};

// Calls its argument with parts that together make up the whole scene, always the same ones.
using SceneParts = std::function<void(const std::function<void(Scene)>& take)>;

// Writes only the finest level, in the same blocks; does not need a device.
void writeOneLevel(const SceneParts& parts, const LevelSettings& settings, StreamedWriter& writer,
                   const Progress& progress = {});
// Writes all levels with a writer that has cut the leaves. The parts are requested once; after that, one
// block of them is in memory at a time, or the whole scene if it is one block. The result is the same on
// every run on the same device. Throws what `progress` throws.
void writeSceneLevels(const Context& context, const SceneParts& parts, const LevelSettings& settings,
                      StreamedWriter& writer, const Progress& progress = {});

}  // namespace binosplat
