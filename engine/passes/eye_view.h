// An eye as the passes see it.
#pragma once

#include "engine/geometry.h"
#include "shaders/shared/types.h"

namespace binosplat {

// float32, and what is left of each value beside that; `near` in scene units.
gpu::EyeView viewOf(const Eye& eye, double near);
// Likewise.
gpu::Place placeOf(const glm::dvec3& position);

}  // namespace binosplat
