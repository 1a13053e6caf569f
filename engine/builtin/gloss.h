// Mirror-like shine that changes with the direction, as SH of degree 3.
#pragma once

#include <glm/glm.hpp>

#include <array>

namespace binosplat::builtin {

// The 16 real SH at a unit direction, in the order and with the signs used in 3DGS and 2DGS training.
std::array<float, 16> evaluateSh(const glm::vec3& direction);

// SH over viewing directions (from the eye to the splat) of the reflection, in a mirror with this normal, of
// a bright window ahead, a warm lamp and a pale ceiling; display-encoded, to be added to the surface's own
// colour.
std::array<glm::vec3, 16> projectGloss(const glm::vec3& point, const glm::vec3& normal,
                                       const glm::vec3& window, const glm::vec3& lamp);

}  // namespace binosplat::builtin
