// Parts of scenes.
#pragma once

#include "engine/scene/scene.h"

#include <cstdint>
#include <span>

namespace binosplat {

// Some splats of a scene, in that order, with all the scene's other properties.
Scene pickSplats(const Scene& scene, std::span<const std::uint32_t> splats);

// Appends the splats of another scene of the same kind, which are relative to the same origin. The result has
// the higher SH degree of the two.
void appendSplats(Scene& scene, const Scene& more);

}  // namespace binosplat
