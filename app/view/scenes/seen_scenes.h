// Records of scenes that were shown: a small picture, and a short description.
#pragma once

#include "engine/picture/image.h"

#include <glm/glm.hpp>

#include <string>
#include <vector>

namespace binosplat {

inline constexpr glm::uvec2 kScenePicturePx(88, 66);

// In 8-bit RGBA, kScenePicturePx large. `key` differs for each picture, and is empty if there is none; a
// later picture in the same file replaces an earlier one.
struct ScenePicture {
    std::string key, file;
    std::vector<unsigned char> rgba;
};

// The middle of `view`, which must not be empty, scaled down.
Image makeScenePicture(const Image& view);

// Saves them beside the scene's settings (view_files.h), all or nothing. Failures are ignored.
void keepSeenScene(const std::string& scene, const Image& picture, const std::string& about);

struct SeenScene {
    ScenePicture picture;
    std::string about;  // empty: it was never shown, or has changed since
};
SeenScene findSeenScene(const std::string& scene);

}  // namespace binosplat
