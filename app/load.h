// Loading a scene with progress on the terminal, at the level of detail that the options ask for.
#pragma once

#include "app/options.h"
#include "app/progress.h"
#include "engine/gpu/gpu_scene.h"
#include "engine/scene/scene.h"

namespace binosplat {

// What a frame needs beside the scene depends on the view and is not known yet: the level's splats alone are held against the limit.
inline LevelChoice levelChoice(const RunOptions& run) {
    if (run.memory_limit_mib == 0) { return {run.lod, {}}; }
    return {run.lod, [limit_bytes = run.memory_limit_mib << 20](std::uint64_t splats, int sh_degree) {
                return splats <= limit_bytes / deviceBytesPerSplat(sh_degree);
            }};
}

inline Scene loadWithProgress(const std::string& source, const LevelChoice& level, LoadNotes& notes) {
    ProgressLine line("loading " + source);
    return loadScene(
        source, 0, &notes, [&](double share) { line.show(share); }, level);
}

}  // namespace binosplat
