// Poses, intrinsics and eyes, in float64. Camera axes are OpenCV's: x right, y down, z forward; lengths are
// scene units.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <array>
#include <span>

namespace binosplat {

// A rigid transform target_from_source: p_target = orientation * p_source + position.
struct Pose {
    glm::dquat orientation{1.0, 0.0, 0.0, 0.0};  // w, x, y, z; unit
    glm::dvec3 position{0.0};
};

// a_from_c, from a_from_b and b_from_c.
Pose compose(const Pose& a_from_b, const Pose& b_from_c);
Pose inverse(const Pose& target_from_source);
glm::dvec3 transform(const Pose& target_from_source, const glm::dvec3& point_source);

// The pose of a camera at `eye` that looks at `look`: forward = look - eye, right = forward x up, down =
// forward x right. Throws Error if the three points do not span a view (equal points, or `up` along the line
// of sight).
Pose lookAt(const glm::dvec3& eye, const glm::dvec3& look, const glm::dvec3& up);

// A view before there is a picture: from where, at what, which way is up, and how wide.
struct View {
    glm::dvec3 eye, look, up;
    double fov_x_deg;
};

// Pixel (x, y) = (fx X/Z + cx, fy Y/Z + cy); the centre of the first pixel is (0.5, 0.5).
struct Intrinsics {
    double fx = 1.0, fy = 1.0, cx = 0.5, cy = 0.5;
};

// Signed angles from the optical axis, as in OpenXR: usually left and down are negative.
struct ViewAngles {
    double left_rad, right_rad, up_rad, down_rad;
};
Intrinsics intrinsicsFromAngles(const ViewAngles& angles, glm::uvec2 size_px);

// Square pixels, principal point in the middle.
Intrinsics intrinsicsFromFovX(double fov_x_rad, glm::uvec2 size_px);

// One eye: where it is, what it sees, how many pixels it has. Nothing assumes parallel eyes or a centred
// principal point.
struct Eye {
    Pose world_from_camera;
    Intrinsics intrinsics;
    glm::uvec2 size_px{0, 0};
    // How wide a pixel of the eye's own picture is in this one, which may have fewer pixels: splats keep the
    // low-pass of the former.
    double own_pixel_px = 1.0;
};

// True for a point, in camera space, that is in front of the eye and within its picture.
bool isInPicture(const Eye& eye, const glm::dvec3& point_camera);

enum Side : int { kLeft = 0, kRight = 1 };

// The mean of all eyes' places; for one eye exactly its own place.
glm::dvec3 middleOf(std::span<const Eye> eyes);

// Left eye at -ipd/2 and right eye at +ipd/2 along the x axis of `middle`, otherwise alike.
std::array<Eye, 2> stereoPair(const Eye& middle, double eye_distance);

}  // namespace binosplat
