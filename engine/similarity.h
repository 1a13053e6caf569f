// Similarities (translation, rotation and uniform scale), in float64.
#pragma once

#include "engine/geometry.h"

namespace binosplat {

// A similarity target_from_source: p_target = scale * (orientation * p_source) + position.
struct Similarity {
    glm::dquat orientation{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 position{0.0};
    double scale = 1.0;
    bool operator==(const Similarity&) const = default;
};

glm::dvec3 transform(const Similarity& target_from_source, const glm::dvec3& point_source);
// The pose of something that is at `pose` in the source.
Pose transform(const Similarity& target_from_source, const Pose& pose);
Similarity inverse(const Similarity& target_from_source);
// a_from_c from a_from_b and b_from_c.
Similarity compose(const Similarity& a_from_b, const Similarity& b_from_c);

}  // namespace binosplat
