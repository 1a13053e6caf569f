// Messages about a camera that sees no splat, or that has many in front of its near plane.
#pragma once

#include "engine/geometry.h"

#include <glm/glm.hpp>

#include <span>
#include <string>

namespace binosplat {

// Says how far away the scene's nearest splat is, and in which direction: "no splat is seen from ...: the
// nearest is ...", and whether it is in front of the near plane. `origin` is the scene's.
std::string describeNearest(const Pose& world_from_camera, std::span<const glm::vec3> positions, double near,
                            const glm::dvec3& origin);

// Empty unless at least one in twenty of the splats in the picture has its centre in front of the near plane.
std::string describeCut(const Eye& eye, std::span<const glm::vec3> positions, double near);

}  // namespace binosplat
