// Flat pictures in the room that look like more: strips that turn about their length towards the eyes, and pictures that face them.
// Room axes: x right, y down, z forward; metres.
#pragma once

#include "engine/geometry.h"

#include <optional>

namespace binosplat {

// As Layers shows a picture: seen from the side of its -z.
struct Strip {
    Pose room_from_strip;
    glm::dvec2 size_m{0.0};
};

// From `from`, where the picture's top is, to `to`, as broad as `width_m`, turned about its length towards `eye`. Empty where that has no
// answer: the ends are one, or the eye looks along it.
std::optional<Strip> stripBetween(const glm::dvec3& from, const glm::dvec3& to, double width_m, const glm::dvec3& eye);

// Faces `eye`, upright where it can be.
Strip facing(const glm::dvec3& middle, const glm::dvec2& size_m, const glm::dvec3& eye);

// Lies flat, to be seen from above.
Strip lying(const glm::dvec3& middle, double width_m);

}  // namespace binosplat
