// Views of a scene from where a person could stand, spread out, for judging what of it is seen.
#pragma once

#include "engine/geometry.h"
#include "engine/scene/scene.h"

#include <cstddef>
#include <span>
#include <vector>

namespace binosplat {

// `count` of them, by the splats alone. A scene that is entered (judgeStandpoint): from places with free space about a head, at several
// heights, from each the six faces of a cube, so that every direction is seen. Anything else: from shells about its middle, above its floor
// if it has one. `first`: how many to leave out of the same sequence, for views unlike others.
std::vector<View> standingViews(const Scene& scene, std::size_t count, std::size_t first = 0);

// A part of a scene between two corners as it is seen from `count` of the eyes' different places, evenly chosen, or from all: as narrow as
// shows it whole.
std::vector<View> viewsOnto(const glm::dvec3& low, const glm::dvec3& high, std::span<const View> from, std::size_t count);

}  // namespace binosplat
