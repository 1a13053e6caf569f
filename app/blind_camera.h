// What to say of a camera that sees no splat.
#pragma once

#include "engine/geometry.h"

#include <glm/glm.hpp>

#include <span>
#include <string>

namespace binosplat {

// How far the nearest of the scene's splats are from the camera, and where: "no splat is seen; the nearest is ...", and whether nothing is
// drawn so near.
std::string describeNearest(const Pose& world_from_camera, std::span<const glm::vec3> positions, double near);

}  // namespace binosplat
