// Poses, view angles and meshes in OpenXR's axes: x right, y up, z backwards (a viewer looks along -z),
// metres and radians.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace simulated {

enum Side : std::size_t { kLeft = 0, kRight = 1 };
inline constexpr std::array<Side, 2> kSides{kLeft, kRight};

// A rigid transform a_from_b: p_a = orientation * p_b + position.
struct Pose {
    glm::dquat orientation{1.0, 0.0, 0.0, 0.0};  // GLM's order: w, x, y, z
    glm::dvec3 position{0.0, 0.0, 0.0};
};

[[nodiscard]] Pose compose(const Pose& a_from_b, const Pose& b_from_c);
[[nodiscard]] Pose inverse(const Pose& a_from_b);
[[nodiscard]] glm::dvec3 transform(const Pose& a_from_b, const glm::dvec3& point_b);

// Positions linearly, orientations by the shorter great arc; share is 0 at `from` and 1 at `to`.
[[nodiscard]] Pose interpolate(const Pose& from, const Pose& to, double share);

// The pose without tilt: same position, turned about the vertical (y) only, so that it faces where `pose`
// faces. One that looks straight up or down keeps the heading of its right-hand side.
[[nodiscard]] Pose makeLevel(const Pose& pose);

// View angles in radians, XrFovf's signs: left and down are negative for a usual eye.
struct Fov {
    double left_rad = 0.0;
    double right_rad = 0.0;
    double up_rad = 0.0;
    double down_rad = 0.0;
    bool operator==(const Fov&) const = default;
};

// The part of a view within `half_angle_rad` of a direction, each way; moved as far as needed to lie in the
// view. The direction is an angle to the right of the view's axis and one above it.
[[nodiscard]] Fov makeInset(const Fov& fov, const glm::dvec2& middle_rad, double half_angle_rad);

// Where an eye sits on the head: half the eye distance to its side, its axis turned outwards by `cant_rad`.
[[nodiscard]] Pose headFromEye(Side side, double eye_distance_m, double cant_rad);

// Triangles in the plane z = -1 of an eye, as xrGetVisibilityMaskKHR gives them: counter-clockwise as the eye
// sees them.
struct Mesh {
    std::vector<glm::vec2> vertices;  // tangents: x to the right, y up
    // Three per triangle; for an outline, the vertices in order around the loop.
    std::vector<std::uint32_t> indices;
};

// The visible part is the ellipse that touches the four edges of the view in tangent space.
[[nodiscard]] Mesh makeHiddenMesh(const Fov& fov);      // what lies outside, up to the edges
[[nodiscard]] Mesh makeVisibleMesh(const Fov& fov);     // a fan about the ellipse's centre
[[nodiscard]] Mesh makeVisibleOutline(const Fov& fov);  // its border, counter-clockwise

}  // namespace simulated
