// Which scene comes next: those that lie beside one another.
#pragma once

#include <string>
#include <vector>

namespace binosplat {

// Scenes in the folder of a file or folder, by name, or all built-in ones; with `scene` among them.
std::vector<std::string> scenesBeside(const std::string& scene);

// The scene `step` further on, and round the end.
std::string sceneBeside(const std::string& scene, int step);

}  // namespace binosplat
