// Orbiting, panning, flying.
#include "app/desktop/orbit_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace binosplat {

namespace {

constexpr double kSteepestRad = 0.4999 * std::numbers::pi;
const glm::dvec3 kAhead(0.0, 0.0, 1.0);

}  // namespace

OrbitCamera::OrbitCamera(const View& view)
    : position_(view.eye), distance_(glm::distance(view.eye, view.look)) {
    const Pose looking = lookAt(view.eye, view.look, view.up);
    const glm::dvec3 up = glm::normalize(view.up), forward = looking.orientation * kAhead;
    pitch_rad_ =
        std::clamp(std::asin(std::clamp(glm::dot(forward, up), -1.0, 1.0)), -kSteepestRad, kSteepestRad);
    // Upright: the camera's right is level.
    const glm::dvec3 right = looking.orientation * glm::dvec3(1.0, 0.0, 0.0);
    scene_from_level_ = lookAt(glm::dvec3(0.0), glm::cross(up, right), up).orientation;
}

glm::dquat OrbitCamera::orientation() const {
    return glm::normalize(scene_from_level_ * glm::angleAxis(heading_rad_, glm::dvec3(0.0, 1.0, 0.0)) *
                          glm::angleAxis(pitch_rad_, glm::dvec3(1.0, 0.0, 0.0)));
}

Pose OrbitCamera::pose() const { return {orientation(), position_}; }

glm::dvec3 OrbitCamera::centre() const { return position_ + distance_ * (orientation() * kAhead); }

glm::dvec3 OrbitCamera::up() const { return scene_from_level_ * glm::dvec3(0.0, -1.0, 0.0); }

void OrbitCamera::orbit(const glm::dvec3& pivot, double right_rad, double up_rad) {
    const glm::dvec3 pivot_camera = glm::conjugate(orientation()) * (pivot - position_);
    heading_rad_ = std::remainder(heading_rad_ + right_rad, 2.0 * std::numbers::pi);
    pitch_rad_ = std::clamp(pitch_rad_ + up_rad, -kSteepestRad, kSteepestRad);
    position_ = pivot - orientation() * pivot_camera;
}

void OrbitCamera::pan(const glm::dvec2& pixels, double depth, double focal_px) {
    fly(glm::dvec3(-depth / focal_px * pixels, 0.0));
}

void OrbitCamera::approach(const glm::dvec3& point, double share) {
    position_ = point + share * (position_ - point);
    distance_ *= share;
}

OrbitCamera OrbitCamera::centredOn(const glm::dvec3& point) const {
    OrbitCamera there = *this;
    there.distance_ = glm::distance(position_, point);
    there.position_ = point - there.distance_ * (orientation() * kAhead);
    return there;
}

OrbitCamera OrbitCamera::framing(const glm::dvec3& middle, double radius, double angle_rad) const {
    OrbitCamera there = *this;
    there.distance_ = radius / std::sin(0.5 * angle_rad);
    there.position_ = middle - there.distance_ * (orientation() * kAhead);
    return there;
}

OrbitCamera OrbitCamera::between(const OrbitCamera& from, const OrbitCamera& to, double share) {
    OrbitCamera camera = to;
    // In the heading of `to`: viewpoints have level axes of their own.
    const glm::dvec3 ahead = glm::conjugate(to.scene_from_level_) * (from.orientation() * kAhead);
    const double heading = std::atan2(ahead.x, ahead.z);
    camera.heading_rad_ = heading + share * std::remainder(to.heading_rad_ - heading, 2.0 * std::numbers::pi);
    camera.pitch_rad_ = glm::mix(from.pitch_rad_, to.pitch_rad_, share);
    camera.position_ = glm::mix(from.position_, to.position_, share);
    camera.distance_ = glm::mix(from.distance_, to.distance_, share);
    return camera;
}

}  // namespace binosplat
