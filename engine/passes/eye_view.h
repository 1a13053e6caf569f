// An eye as the passes see it.
#pragma once

#include "engine/geometry.h"
#include "shaders/shared/types.h"

namespace binosplat {

// In float32, with the remainder of each value; `near` is in scene units.
gpu::EyeView viewOf(const Eye& eye, double near);
// The same for a place.
gpu::Place placeOf(const glm::dvec3& position);

}  // namespace binosplat
