// The next scene, among those in the same folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace binosplat {

// Judges a file by its name, a folder by its contents.
bool looksLikeScene(const std::filesystem::path& path);

// Scenes in the folder of a file or folder, in natural order (natural_order.h), or all built-in ones; without
// hidden ones, but including `scene`.
std::vector<std::string> scenesBeside(const std::string& scene);

// The first scene in a folder that is not itself a scene. Empty if `scene` is a file, is itself a scene, or
// contains none.
std::string firstSceneIn(const std::string& scene);

// The scene that is `step` scenes further on, wrapping around.
std::string sceneBeside(const std::string& scene, int step);

}  // namespace binosplat
