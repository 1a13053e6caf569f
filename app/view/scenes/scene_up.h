// Which way is up in a scene: trained ones are often tilted.
#pragma once

#include "engine/scene/scene.h"

#include <filesystem>

namespace binosplat {

// The mean up of the cameras that the scene was trained from, if their cameras.json lies with it
// (findCameraFile). Otherwise, unless it is built in, the up of its floor, see upOfFloor; or `usual`. Unit
// vectors in the scene's axes.
glm::dvec3 upOfScene(const Scene& scene, const std::filesystem::path& source, const glm::dvec3& usual);

// Floors and table tops face one way: the mean of the normals within 45 degrees of `usual`, weighted by area
// and opacity, and then of those within 30, 20, 15 and 10 degrees of that mean. `usual` if there are none.
glm::dvec3 upOfFloor(const Scene& scene, const glm::dvec3& usual);

}  // namespace binosplat
