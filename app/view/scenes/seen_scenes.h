// What is kept of scenes that were shown: a small picture, and what they are in a few words.
#pragma once

#include "engine/picture/image.h"

#include <glm/glm.hpp>

#include <string>
#include <vector>

namespace binosplat {

inline constexpr glm::uvec2 kScenePicturePx(88, 66);

// In 8-bit RGBA, kScenePicturePx large. `key` is another one for another picture, and empty where there is none; a later picture in the
// same file takes the place of an earlier one.
struct ScenePicture {
    std::string key, file;
    std::vector<unsigned char> rgba;
};

// Its middle, made small. `view` is larger than nothing.
Image makeScenePicture(const Image& view);

// Beside the scene's settings (view_files.h): keeps them, whole or not at all. What cannot be kept is no loss.
void keepSeenScene(const std::string& scene, const Image& picture, const std::string& about);

struct SeenScene {
    ScenePicture picture;
    std::string about;  // empty: it was never shown, or changed since
};
SeenScene findSeenScene(const std::string& scene);

}  // namespace binosplat
