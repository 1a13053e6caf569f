// Loading a scene with progress on the terminal, and drawing it as the user wants it.
#pragma once

#include "app/options.h"
#include "app/progress.h"
#include "engine/scene/scene.h"

namespace binosplat {

// 3D Gaussians as discs, or dimmed, where the user says so; a file may itself say that its splats are to be dimmed.
inline void drawAs(const DrawOptions& options, Scene& scene, LoadNotes& notes) {
    if (options.flatten) { flatten(scene, notes); }
    if (options.antialiased) { scene.antialiased = scene.isGaussian3d(); }
}

// The same without notes.
inline Scene loadAs(const DrawOptions& options, const std::string& source, std::uint64_t builtin_splats = 0) {
    LoadNotes ignored;
    Scene scene = loadScene(source, builtin_splats);
    drawAs(options, scene, ignored);
    return scene;
}

inline Scene loadWithProgress(const DrawOptions& options, const std::string& source, LoadNotes& notes) {
    ProgressLine line("loading " + source);
    Scene scene = loadScene(source, 0, &notes, [&](double share) { line.show(share); });
    drawAs(options, scene, notes);
    return scene;
}

}  // namespace binosplat
