// The levels of detail of a scene: each has half the splats of the one before, is thinned out from the finest, and fitted to it.
#pragma once

#include "engine/levels/thin_out.h"

#include <functional>

namespace binosplat {

struct LevelSettings {
    std::size_t levels = 2;  // at least two
    std::vector<Eye> eyes;   // from where the whole is judged
    double near = 0.2;       // scene units
    // A scene of more splats is judged by blocks of as many at most, one after the other, each as if it were alone, from as many of the
    // eyes' places. The levels with fewer splats are then thinned out from the first that is a block itself.
    std::uint64_t block_splats = 1024 * 1024;
    std::size_t block_eyes = 8;
    gpu::uint block_side_px = kJudgingSidePx;
    int block_steps = 4;
};

// Calls what it is given with parts of a scene that together are all of it, always the same ones.
using SceneParts = std::function<void(const std::function<void(Scene)>& take)>;

// The finest alone, by the same blocks, which takes no device.
void writeOneLevel(const SceneParts& parts, const LevelSettings& settings, StreamedWriter& writer, const Progress& progress = {});
// Writes them all into a writer that has cut the leaves. The parts are taken once; then one block of them is in memory at a time, or all of
// a scene of one block. The same on every run on one device. Throws what `progress` throws.
void writeSceneLevels(const Context& context, const SceneParts& parts, const LevelSettings& settings, StreamedWriter& writer,
                      const Progress& progress = {});

}  // namespace binosplat
