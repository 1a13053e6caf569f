// Loading a scene as the options ask for it, with progress on the terminal.
#pragma once

#include "app/options/options.h"
#include "app/progress.h"
#include "engine/gpu/gpu_scene.h"
#include "engine/scene/scene.h"

#include <algorithm>

namespace binosplat {

// What a frame needs beside the scene depends on the view and is not known yet: the level's splats alone are held against the limit.
inline LevelChoice levelChoice(const LoadOptions& options, std::uint64_t memory_limit_mib) {
    if (memory_limit_mib == 0) { return {options.lod, {}}; }
    return {options.lod, [limit_bytes = memory_limit_mib << 20, options](std::uint64_t splats, int sh_degree) {
                const int kept = std::min(sh_degree, static_cast<int>(options.sh_degree.value_or(kMaxShDegree)));
                return splats <= limit_bytes / deviceBytesPerSplat(kept, !options.flatten);
            }};
}

// Fewer colours, 3D Gaussians as discs, or dimmed, where the user says so; a file may itself say that its splats are to be dimmed.
inline void drawAs(const LoadOptions& options, Scene& scene, LoadNotes& notes) {
    if (options.sh_degree) { limitShDegree(scene, static_cast<int>(*options.sh_degree), notes); }
    if (options.flatten) { flatten(scene, notes); }
    if (options.antialiased) { scene.antialiased = scene.isGaussian3d(); }
}

inline Scene loadAs(const RunOptions& run, const std::string& source, std::uint64_t builtin_splats = 0) {
    LoadNotes ignored;
    Scene scene = loadScene(source, builtin_splats, nullptr, {}, levelChoice(run.load, run.memory_limit_mib));
    drawAs(run.load, scene, ignored);
    return scene;
}

inline Scene loadWithProgress(const std::string& source, const LoadOptions& options, LoadNotes& notes, std::uint64_t memory_limit_mib = 0) {
    ProgressLine line("loading " + source);
    Scene scene = loadScene(
        source, 0, &notes, [&](double share) { line.show(share); }, levelChoice(options, memory_limit_mib));
    drawAs(options, scene, notes);
    return scene;
}

}  // namespace binosplat
