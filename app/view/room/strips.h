// Flat pictures in the room that look solid: strips that turn about their length towards the eyes, and
// pictures that face them. Room axes: x right, y down, z forward; metres.
#pragma once

#include "engine/geometry.h"

#include <optional>

namespace binosplat {

// As Layers shows a picture: visible from its -z side.
struct Strip {
    Pose room_from_strip;
    glm::dvec2 size_m{0.0};
};

// From `from`, the picture's top, to `to`, `width_m` wide, turned about its length towards `eye`. Empty if
// that is undefined: the ends coincide, or the eye looks along it.
std::optional<Strip> stripBetween(const glm::dvec3& from, const glm::dvec3& to, double width_m,
                                  const glm::dvec3& eye);

// Faces `eye`, upright if possible.
Strip facing(const glm::dvec3& middle, const glm::dvec2& size_m, const glm::dvec3& eye);

// Lies flat, to be seen from above.
Strip lying(const glm::dvec3& middle, double width_m);

}  // namespace binosplat
