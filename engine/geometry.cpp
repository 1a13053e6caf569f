// Poses and intrinsics; the only place where a rotation is built from directions.
#include "engine/geometry.h"

#include "engine/error.h"

#include <cmath>

namespace binosplat {

Pose compose(const Pose& a_from_b, const Pose& b_from_c) {
    return {glm::normalize(a_from_b.orientation * b_from_c.orientation),
            transform(a_from_b, b_from_c.position)};
}

Pose inverse(const Pose& target_from_source) {
    const glm::dquat source_from_target = glm::conjugate(target_from_source.orientation);
    return {source_from_target, -(source_from_target * target_from_source.position)};
}

glm::dvec3 transform(const Pose& target_from_source, const glm::dvec3& point_source) {
    return target_from_source.orientation * point_source + target_from_source.position;
}

Pose lookAt(const glm::dvec3& eye, const glm::dvec3& look, const glm::dvec3& up) {
    const glm::dvec3 forward = look - eye;
    const glm::dvec3 right = glm::cross(forward, up);
    const double sine = glm::length(right) / (glm::length(forward) * glm::length(up));
    check(sine > 1e-9,
          "camera: --eye, --look and --up must span a view: look may not equal eye, and up may not lie along "
          "the line of sight");
    const glm::dvec3 down = glm::cross(forward, right);
    const glm::dmat3 world_from_camera(glm::normalize(right), glm::normalize(down), glm::normalize(forward));
    return {glm::normalize(glm::quat_cast(world_from_camera)), eye};
}

Intrinsics intrinsicsFromAngles(const ViewAngles& angles, glm::uvec2 size_px) {
    const double left = std::tan(angles.left_rad), right = std::tan(angles.right_rad);
    const double up = std::tan(angles.up_rad), down = std::tan(angles.down_rad);
    const double fx = size_px.x / (right - left), fy = size_px.y / (up - down);
    return {fx, fy, -fx * left, fy * up};
}

Intrinsics intrinsicsFromFovX(double fov_x_rad, glm::uvec2 size_px) {
    const double f = 0.5 * size_px.x / std::tan(0.5 * fov_x_rad);
    return {f, f, 0.5 * size_px.x, 0.5 * size_px.y};
}

bool isInPicture(const Eye& eye, const glm::dvec3& point_camera) {
    const glm::dvec3& p = point_camera;
    const double u = eye.intrinsics.fx * p.x / p.z + eye.intrinsics.cx,
                 v = eye.intrinsics.fy * p.y / p.z + eye.intrinsics.cy;
    return p.z > 0.0 && u >= 0.0 && v >= 0.0 && u < eye.size_px.x && v < eye.size_px.y;
}

glm::dvec3 middleOf(std::span<const Eye> eyes) {
    glm::dvec3 sum(0.0);
    for (const Eye& eye : eyes) { sum += eye.world_from_camera.position; }
    return sum / static_cast<double>(eyes.size());
}

std::array<Eye, 2> stereoPair(const Eye& middle, double eye_distance) {
    std::array<Eye, 2> eyes{middle, middle};
    eyes[kLeft].world_from_camera.position =
        transform(middle.world_from_camera, {-0.5 * eye_distance, 0.0, 0.0});
    eyes[kRight].world_from_camera.position =
        transform(middle.world_from_camera, {0.5 * eye_distance, 0.0, 0.0});
    return eyes;
}

}  // namespace binosplat
