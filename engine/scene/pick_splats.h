// A part of a scene.
#pragma once

#include "engine/scene/scene.h"

#include <cstdint>
#include <span>

namespace binosplat {

// Some splats of a scene, in that order, with all that the scene says of itself.
Scene pickSplats(const Scene& scene, std::span<const std::uint32_t> splats);

}  // namespace binosplat
