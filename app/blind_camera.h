// A message about a camera that sees no splat.
#pragma once

#include "engine/geometry.h"

#include <glm/glm.hpp>

#include <span>
#include <string>

namespace binosplat {

// Tells how far away the scene's nearest splat is, and in which direction: "no splat is seen from ...: the nearest is ...", and whether it
// is before the near plane.
std::string describeNearest(const Pose& world_from_camera, std::span<const glm::vec3> positions, double near);

}  // namespace binosplat
