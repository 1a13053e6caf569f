// Parts of scenes.
#pragma once

#include "engine/scene/scene.h"

#include <cstdint>
#include <span>

namespace binosplat {

// Some splats of a scene, in that order, with all that the scene says of itself.
Scene pickSplats(const Scene& scene, std::span<const std::uint32_t> splats);

// Behind the splats of a scene those of another of the same kind, which count from the same place. It gets the higher SH degree of both.
void appendSplats(Scene& scene, const Scene& more);

}  // namespace binosplat
