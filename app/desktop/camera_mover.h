// What mouse, keys and gamepad do to the camera.
#pragma once

#include "app/desktop/orbit_camera.h"

#include <optional>

namespace binosplat {

// What is held down, by keys or a gamepad: each from -1 to 1.
struct HeldMotion {
    glm::dvec3 fly{0.0};   // right, down, forward
    glm::dvec2 turn{0.0};  // right, up
    bool fast = false;
    [[nodiscard]] bool isAny() const { return fly != glm::dvec3(0.0) || turn != glm::dvec2(0.0); }
};

// A gamepad's sticks (right and down) and triggers, each from -1 to 1; triggers rest at -1.
struct GamepadState {
    glm::dvec2 left{0.0}, right{0.0};
    double left_trigger = -1.0, right_trigger = -1.0;
    bool left_bumper = false;
};
// The left stick and the triggers (the left one down) fly, the right stick looks around.
HeldMotion motionOf(const GamepadState& pad);

// Steps of the wheel that make what is under the pointer so many times as large.
double wheelStepsOf(double enlarged);

class CameraMover {
public:
    [[nodiscard]] const OrbitCamera& camera() const { return camera_; }
    // Jumps, or goes there in a moment; any other motion ends that.
    void set(const OrbitCamera& camera) { camera_ = camera, way_.reset(), drag_ = Drag::kNone; }
    void glideTo(const OrbitCamera& camera, double within_seconds = 0.35) {
        way_ = Way{camera_, camera, within_seconds, 0.0};
    }
    [[nodiscard]] bool isGliding() const { return way_.has_value(); }

    // A drag begins at `place_px` of a picture, where `under` is seen; `focal_px` and `height_px` are the
    // picture's.
    enum class Drag { kNone, kOrbit, kPan };
    void beginDrag(Drag drag, const glm::dvec2& place_px, const glm::dvec3& under, double focal_px,
                   double height_px);
    void dragTo(const glm::dvec2& place_px);
    void endDrag() { drag_ = Drag::kNone; }
    [[nodiscard]] bool isDragging() const { return drag_ != Drag::kNone; }

    // Steps of the wheel, away from the user: towards what is under the pointer.
    void turnWheel(double steps, const glm::dvec3& under);
    // Moves by what is held, or along the way to a place, for this long.
    void pass(const HeldMotion& held, double seconds);

private:
    struct Way {
        OrbitCamera from, to;
        double whole_seconds = 0.0, seconds = 0.0;
    };
    OrbitCamera camera_;
    std::optional<Way> way_;
    Drag drag_ = Drag::kNone;
    glm::dvec2 place_px_{0.0};  // of the drag, so far
    glm::dvec3 under_{0.0};
    double depth_ = 1.0, focal_px_ = 1.0, height_px_ = 1.0;
};

}  // namespace binosplat
