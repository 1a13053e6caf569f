// Which scene comes next: those that lie beside one another.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace binosplat {

// A file by its name; a folder by what lies in it.
bool looksLikeScene(const std::filesystem::path& path);

// Scenes in the folder of a file or folder, in the order of people (natural_order.h), or all built-in ones; hidden ones are left out, but
// `scene` is among them.
std::vector<std::string> scenesBeside(const std::string& scene);

// The scene `step` further on, and round the end.
std::string sceneBeside(const std::string& scene, int step);

}  // namespace binosplat
