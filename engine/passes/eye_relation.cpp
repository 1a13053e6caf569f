// Pixel maps between two eyes, exact where the eyes agree.
#include "engine/passes/eye_relation.h"

#include <cmath>

namespace binosplat {
namespace {

// Axes that are this close, and positions relative to their length, differ by the rounding of the poses
// alone.
constexpr double kSameDirection = 1e-9, kSamePlace = 1e-12;

glm::dmat3 matrixOf(const Intrinsics& k) { return glm::dmat3(k.fx, 0, 0, 0, k.fy, 0, k.cx, k.cy, 1); }

bool areParallel(const Eye& a, const Eye& b) {
    const glm::dmat3 axes_a = glm::mat3_cast(a.world_from_camera.orientation),
                     axes_b = glm::mat3_cast(b.world_from_camera.orientation);
    return glm::length(axes_a[0] - axes_b[0]) + glm::length(axes_a[1] - axes_b[1]) +
               glm::length(axes_a[2] - axes_b[2]) <
           kSameDirection;
}

// Target pixels from source pixels (paper, equations 3 to 5, with the pixel's inverse depth in place of its
// depth).
gpu::PixelMap mapPixels(const Eye& target, const Eye& source) {
    const Pose target_from_source = compose(inverse(target.world_from_camera), source.world_from_camera);
    const Intrinsics &k = target.intrinsics, &l = source.intrinsics;
    glm::dmat3 excess;
    if (areParallel(target, source)) {
        // K' K^-1 less the identity: exactly 0 wherever the intrinsics agree, so that rows stay rows if fy
        // and cy do.
        const double x = k.fx / l.fx, y = k.fy / l.fy;
        excess = glm::dmat3(x - 1, 0, 0, 0, y - 1, 0, k.cx - x * l.cx, k.cy - y * l.cy, 0);
    } else {
        excess = matrixOf(k) * glm::mat3_cast(target_from_source.orientation) * glm::inverse(matrixOf(l)) -
                 glm::dmat3(1.0);
    }
    // Eyes that are side by side differ only along x, up to the rounding of their positions and axes.
    glm::dvec3 move = target_from_source.position;
    const double rounding =
        kSamePlace * glm::length(source.world_from_camera.position) + kSameDirection * std::abs(move.x);
    for (int i = 1; i < 3; ++i) {
        if (std::abs(move[i]) <= rounding) { move[i] = 0.0; }
    }
    const auto row = [&](int i) { return glm::vec3(excess[0][i], excess[1][i], excess[2][i]); };
    return {row(0), row(1), row(2), glm::vec3(matrixOf(k) * move)};
}

bool keepsDepths(const gpu::PixelMap& map) { return map.excess_z == glm::vec3(0.0f) && map.shift.z == 0.0f; }
bool keepsRows(const gpu::PixelMap& map) {
    return keepsDepths(map) && map.excess_y == glm::vec3(0.0f) && map.shift.y == 0.0f;
}

}  // namespace

EyeRelation relate(const Eye& dominant, const Eye& affiliated) {
    EyeRelation relation{mapPixels(affiliated, dominant), mapPixels(dominant, affiliated)};
    const gpu::PixelMap &there = relation.target_from_source, &back = relation.source_from_target;
    relation.same_depths = keepsDepths(there) && keepsDepths(back);
    relation.rectified = keepsRows(there) && keepsRows(back);
    return relation;
}

}  // namespace binosplat
