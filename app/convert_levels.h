// `binosplat convert SCENE FOLDER/lod-meta.json`: a scene with levels of detail, as a streamed SOG scene.
#pragma once

#include "app/options/options.h"
#include "engine/scene/scene.h"

#include <functional>

namespace binosplat {

// What became of it.
struct WrittenLevels {
    std::uint64_t splats = 0;
    Scene sample;  // a sample, at most as large as a chunk
};

// `load` gives the scene. A PLY file with more splats than a block of writeSceneLevels is instead read in
// parts, twice, unless the options ask for fewer of its splats.
WrittenLevels writeLevels(const ConvertOptions& options, const std::function<Scene()>& load,
                          LoadNotes& notes);

}  // namespace binosplat
