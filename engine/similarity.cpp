// Moves, turns and changes of size, in float64.
#include "engine/similarity.h"

namespace binosplat {

glm::dvec3 transform(const Similarity& target_from_source, const glm::dvec3& point_source) {
    return target_from_source.scale * (target_from_source.orientation * point_source) +
           target_from_source.position;
}

Pose transform(const Similarity& target_from_source, const Pose& pose) {
    return {glm::normalize(target_from_source.orientation * pose.orientation),
            transform(target_from_source, pose.position)};
}

Similarity inverse(const Similarity& target_from_source) {
    const glm::dquat turn = glm::conjugate(target_from_source.orientation);
    return {turn, turn * target_from_source.position / -target_from_source.scale,
            1.0 / target_from_source.scale};
}

Similarity compose(const Similarity& a_from_b, const Similarity& b_from_c) {
    return {glm::normalize(a_from_b.orientation * b_from_c.orientation),
            transform(a_from_b, b_from_c.position), a_from_b.scale * b_from_c.scale};
}

}  // namespace binosplat
