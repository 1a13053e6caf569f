// Loading a scene with progress on the terminal.
#pragma once

#include "app/progress.h"
#include "engine/scene/scene.h"

namespace binosplat {

inline Scene loadWithProgress(const std::string& source, std::uint64_t builtin_splats, LoadNotes& notes) {
    ProgressLine line("loading " + source);
    return loadScene(source, builtin_splats, &notes, [&](double share) { line.show(share); });
}

}  // namespace binosplat
