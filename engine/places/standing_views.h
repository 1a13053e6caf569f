// Views of a scene from where a person could stand, spread out, to judge how much of it is seen.
#pragma once

#include "engine/geometry.h"
#include "engine/scene/scene.h"

#include <cstddef>
#include <span>
#include <vector>

namespace binosplat {

// `count` views, chosen by the splats alone. If the scene is entered (judgeStandpoint), from places with free
// space around a head, at several heights, each with the six faces of a cube, so that every direction is
// seen. Otherwise from shells around its middle, above its floor if it has one. `first`: how many views of
// the same sequence to skip, to get others than before.
std::vector<View> standingViews(const Scene& scene, std::size_t count, std::size_t first = 0);

// Views of a part of a scene, between two corners, from `count` of the eyes' different places, evenly chosen,
// or from all, each just wide enough to show all of it.
std::vector<View> viewsOnto(const glm::dvec3& low, const glm::dvec3& high, std::span<const View> from,
                            std::size_t count);

}  // namespace binosplat
