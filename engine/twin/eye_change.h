// From one eye's pixels to another's by unprojection, rigid motion and projection (paper, equations 3 to 5).
#pragma once

#include "engine/twin/stereo.h"

#include <cmath>

namespace binosplat::reference {

class EyeChange {
public:
    EyeChange(const Eye& target, const Eye& source)
        : target_(target.intrinsics),
          source_(source.intrinsics),
          turn_(glm::mat3_cast(glm::conjugate(target.world_from_camera.orientation) *
                               source.world_from_camera.orientation)),
          move_(glm::conjugate(target.world_from_camera.orientation) *
                (source.world_from_camera.position - target.world_from_camera.position)),
          away_(glm::length(source.world_from_camera.position)) {}

    struct Moved {
        glm::dvec2 place_px;
        double inverse_depth;
        bool in_front;  // in the target
    };
    // A point that is infinitely far (inverse depth 0) has only a direction.
    [[nodiscard]] Moved move(const glm::dvec2& place_px, double inverse_depth) const {
        const glm::dvec3 direction((place_px.x - source_.cx) / source_.fx,
                                   (place_px.y - source_.cy) / source_.fy, 1.0);
        const glm::dvec3 point = turn_ * direction + inverse_depth * move_;
        return {{target_.fx * point.x / point.z + target_.cx, target_.fy * point.y / point.z + target_.cy},
                inverse_depth / point.z,
                point.z > 0.0};
    }
    // How far a place moves in the target per unit of inverse depth in the source, if both depths are about
    // the same.
    [[nodiscard]] glm::dvec2 disparity(const glm::dvec2& place_px) const {
        return {target_.fx * move_.x + (target_.cx - place_px.x) * move_.z,
                target_.fy * move_.y + (target_.cy - place_px.y) * move_.z};
    }
    // True if every point keeps its row and its depth, except for the rounding of poses, which is greater far
    // from the origin.
    [[nodiscard]] bool keepsRows() const {
        const double rounding = 1e-12 * away_ + 1e-9 * std::abs(move_.x);
        return glm::length(turn_[0] - glm::dvec3(1, 0, 0)) + glm::length(turn_[1] - glm::dvec3(0, 1, 0)) <
                   1e-9 &&
               std::abs(move_.y) <= rounding && std::abs(move_.z) <= rounding && target_.fy == source_.fy &&
               target_.cy == source_.cy;
    }

private:
    Intrinsics target_, source_;
    glm::dmat3 turn_;
    glm::dvec3 move_;
    double away_;  // the source's distance from the origin
};

}  // namespace binosplat::reference
