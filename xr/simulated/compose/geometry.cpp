// Poses and meshes; everything here is a pure function.
#include "xr/simulated/compose/geometry.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace simulated {

namespace {

// Enough corners for a polygon to differ from the ellipse by less than a pixel out of 4096: 1 - cos(pi / 64)
// is 0.0012 of the radius; a multiple of 4, so that each corner of the view has its own quarter.
constexpr std::uint32_t kOutlineCorners = 64;

struct Span {
    double low, high;
};

Span makeSpan(double middle, double half, const Span& whole) {
    if (whole.high - whole.low <= 2.0 * half) { return whole; }
    const double nearest = std::clamp(middle, whole.low + half, whole.high - half);
    // Must not be outside by a rounding error.
    return {std::max(nearest - half, whole.low), std::min(nearest + half, whole.high)};
}

std::vector<glm::vec2> ellipse(const Fov& fov) {
    const double left = std::tan(fov.left_rad), right = std::tan(fov.right_rad), up = std::tan(fov.up_rad),
                 down = std::tan(fov.down_rad);
    std::vector<glm::vec2> corners;
    for (std::uint32_t i = 0; i < kOutlineCorners; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kOutlineCorners;
        corners.emplace_back(
            static_cast<float>(0.5 * (left + right) + 0.5 * (right - left) * std::cos(angle)),
            static_cast<float>(0.5 * (down + up) + 0.5 * (up - down) * std::sin(angle)));
    }
    return corners;
}

}  // namespace

Pose compose(const Pose& a_from_b, const Pose& b_from_c) {
    return {glm::normalize(a_from_b.orientation * b_from_c.orientation),
            transform(a_from_b, b_from_c.position)};
}

Pose inverse(const Pose& a_from_b) {
    const glm::dquat turned_back = glm::conjugate(a_from_b.orientation);
    return {turned_back, -(turned_back * a_from_b.position)};
}

glm::dvec3 transform(const Pose& a_from_b, const glm::dvec3& point_b) {
    return a_from_b.orientation * point_b + a_from_b.position;
}

Pose interpolate(const Pose& from, const Pose& to, double share) {
    return {glm::normalize(glm::slerp(from.orientation, to.orientation, share)),
            glm::mix(from.position, to.position, share)};
}

Pose makeLevel(const Pose& pose) {
    const glm::dvec3 forward = pose.orientation * glm::dvec3(0.0, 0.0, -1.0);
    const glm::dvec3 right = pose.orientation * glm::dvec3(1.0, 0.0, 0.0);
    // A turn by `heading` takes -z to (-sin, 0, -cos) and x to (cos, 0, -sin).
    const bool is_vertical = std::hypot(forward.x, forward.z) < 1e-6;
    const double heading = is_vertical ? std::atan2(-right.z, right.x) : std::atan2(-forward.x, -forward.z);
    return {glm::angleAxis(heading, glm::dvec3(0.0, 1.0, 0.0)), pose.position};
}

Fov makeInset(const Fov& fov, const glm::dvec2& middle_rad, double half_angle_rad) {
    const Span across = makeSpan(middle_rad.x, half_angle_rad, {fov.left_rad, fov.right_rad});
    const Span upright = makeSpan(middle_rad.y, half_angle_rad, {fov.down_rad, fov.up_rad});
    return {across.low, across.high, upright.high, upright.low};
}

Pose headFromEye(Side side, double eye_distance_m, double cant_rad) {
    const double outwards = side == kLeft ? -1.0 : 1.0;
    // A positive turn about y looks to the left.
    return {glm::angleAxis(-outwards * cant_rad, glm::dvec3(0.0, 1.0, 0.0)),
            {outwards * 0.5 * eye_distance_m, 0.0, 0.0}};
}

Mesh makeHiddenMesh(const Fov& fov) {
    Mesh mesh{ellipse(fov), {}};
    const auto left = static_cast<float>(std::tan(fov.left_rad)),
               right = static_cast<float>(std::tan(fov.right_rad));
    const auto up = static_cast<float>(std::tan(fov.up_rad)),
               down = static_cast<float>(std::tan(fov.down_rad));
    // In the order in which the ellipse passes them, a fan from each corner of the view to its quarter.
    mesh.vertices.insert(mesh.vertices.end(), {{right, up}, {left, up}, {left, down}, {right, down}});
    for (std::uint32_t i = 0; i < kOutlineCorners; ++i) {
        const std::uint32_t quarter = i / (kOutlineCorners / 4);
        mesh.indices.insert(mesh.indices.end(), {kOutlineCorners + quarter, (i + 1) % kOutlineCorners, i});
    }
    return mesh;
}

Mesh makeVisibleMesh(const Fov& fov) {
    Mesh mesh{ellipse(fov), {}};
    // Opposite corners have the centre between them.
    mesh.vertices.push_back(0.5f * (mesh.vertices[0] + mesh.vertices[kOutlineCorners / 2]));
    for (std::uint32_t i = 0; i < kOutlineCorners; ++i) {
        mesh.indices.insert(mesh.indices.end(), {kOutlineCorners, i, (i + 1) % kOutlineCorners});
    }
    return mesh;
}

Mesh makeVisibleOutline(const Fov& fov) {
    Mesh mesh{ellipse(fov), {}};
    for (std::uint32_t i = 0; i < kOutlineCorners; ++i) { mesh.indices.push_back(i); }
    return mesh;
}

}  // namespace simulated
