// The camera of a window: upright, moving around a centre straight ahead of it. Axes of the camera: x right,
// y down, z forward.
#pragma once

#include "engine/geometry.h"

namespace binosplat {

class OrbitCamera {
public:
    OrbitCamera() = default;
    // At the view's eye, upright along its up, with the centre at what it looks at.
    explicit OrbitCamera(const View& view);

    [[nodiscard]] Pose pose() const;  // scene_from_camera
    [[nodiscard]] const glm::dvec3& position() const { return position_; }
    [[nodiscard]] double distance() const { return distance_; }  // of the centre
    [[nodiscard]] glm::dvec3 centre() const;
    [[nodiscard]] glm::dvec3 up() const;

    // Turns about a point, which stays where it is in the picture; never beyond straight up or down.
    void orbit(const glm::dvec3& pivot, double right_rad, double up_rad);
    // Turns on the spot.
    void turn(double right_rad, double up_rad) { orbit(position_, right_rad, up_rad); }
    // Moves without turning: content at `depth` moves by `pixels` in a picture with this focal length.
    void pan(const glm::dvec2& pixels, double depth, double focal_px);
    // Moves by a step along the camera's axes.
    void fly(const glm::dvec3& step) { position_ += orientation() * step; }
    // Moves towards a point, which stays where it is in the picture, until `share` of the distance is left.
    void approach(const glm::dvec3& point, double share);

    // The same direction, with this point in the middle of the picture at its current distance.
    [[nodiscard]] OrbitCamera centredOn(const glm::dvec3& point) const;
    // The same direction, with a whole sphere in a picture of this angle.
    [[nodiscard]] OrbitCamera framing(const glm::dvec3& middle, double radius, double angle_rad) const;
    // An interpolation between the two, along the shorter way.
    static OrbitCamera between(const OrbitCamera& from, const OrbitCamera& to, double share);

    bool operator==(const OrbitCamera&) const = default;

private:
    [[nodiscard]] glm::dquat orientation() const;

    // Its y axis is down in the scene, its z axis is heading 0.
    glm::dquat scene_from_level_{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 position_{0.0};
    double heading_rad_ = 0.0, pitch_rad_ = 0.0;  // to the right, and upwards
    double distance_ = 1.0;
};

}  // namespace binosplat
