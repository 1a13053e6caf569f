// The levels of detail of a scene: each has half the splats of the one before, is thinned out from the finest, and fitted to it.
#pragma once

#include "engine/levels/thin_out.h"

namespace binosplat {

struct LevelSettings {
    std::size_t levels = 2;  // at least two
    std::vector<Eye> eyes;   // from where the whole is judged
    double near = 0.2;       // scene units
    // A scene of more splats is judged by blocks of as many at most, one after the other, each as if it were alone, from as many of the
    // eyes' places. The levels with fewer splats are then thinned out from the first that is a block itself.
    std::uint64_t block_splats = 1024 * 1024;
    std::size_t block_eyes = 8;
    gpu::uint block_side_px = 512;
    int block_steps = 8;
};

// Writes them all. The scene is given up as soon as its blocks lie on the disk: from then on one of them is in memory. The same on every
// run on one device. Throws what `progress` throws.
void writeSceneLevels(const Context& context, Scene scene, const LevelSettings& settings, StreamedWriter& writer,
                      const Progress& progress = {});

}  // namespace binosplat
