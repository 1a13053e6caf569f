// The makers behind procedural.h.
#pragma once

#include "engine/builtin/procedural.h"

namespace binosplat::builtin {

// SH of degree 0 that shows as `colour`: colour = 0.5 + kShBand0 * coefficient.
inline constexpr float kShBand0 = 0.28209479177387814f;  // 1 / (2 sqrt(pi))
inline glm::vec3 shFromColour(const glm::vec3& colour) { return (colour - 0.5f) / kShBand0; }

Scene makeOneSplat();
Scene makeSlantedWall();
Scene makeTwoLayers();
Scene makeStepEdge();
Scene makeFence();
Scene makeAtelier(std::uint64_t splats, const Progress& progress);
View atelierView();

}  // namespace binosplat::builtin
