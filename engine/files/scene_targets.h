// The formats in which a scene can be written, chosen by the end of the file's name, and what each loses.
#pragma once

#include "engine/scene/scene.h"

#include <filesystem>
#include <string>

namespace binosplat {

struct SceneTarget {
    const char* extension;  // with its dot
    void (*write)(const Scene& scene, const std::string& path, const Progress& progress);
    // What this scene would lose in the file, for the user; one line.
    std::string (*describeLoss)(const Scene& scene);
};

// Throws Error that lists the extensions if `file` has none of them.
const SceneTarget& findSceneTarget(const std::filesystem::path& file);

}  // namespace binosplat
