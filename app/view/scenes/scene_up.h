// Which way is up in a scene; trained scenes are often tilted.
#pragma once

#include "engine/scene/scene.h"

#include <filesystem>

namespace binosplat {

// The mean up of the cameras that the scene was trained from, if it comes with their cameras.json
// (findCameraFile). Otherwise, unless it is built in, the up of its floor (see upOfFloor), or else `usual`.
// Unit vectors in the scene's axes.
glm::dvec3 upOfScene(const Scene& scene, const std::filesystem::path& source, const glm::dvec3& usual);

// Floors and table tops face the same way: the mean of the normals within 45 degrees of `usual`, weighted by
// area and opacity, and then of those within 30, 20, 15 and 10 degrees of that mean. `usual` if there are
// none.
glm::dvec3 upOfFloor(const Scene& scene, const glm::dvec3& usual);

}  // namespace binosplat
