// Speeds, and the ends of motions.
#include "app/desktop/camera_mover.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace binosplat {

namespace {

constexpr double kShareOfStep = 0.85;
constexpr double kTurnRadPerSecond = 1.2, kFlyDistancesPerSecond = 0.6, kFaster = 4.0;
constexpr double kStickRests = 0.15;

double stick(double value) { return std::abs(value) < kStickRests ? 0.0 : value; }

}  // namespace

double wheelStepsOf(double enlarged) { return -std::log(enlarged) / std::log(kShareOfStep); }

HeldMotion motionOf(const GamepadState& pad) {
    return {{stick(pad.left.x), stick(0.5 * (pad.left_trigger - pad.right_trigger)), -stick(pad.left.y)},
            {stick(pad.right.x), -stick(pad.right.y)},
            pad.left_bumper};
}

void CameraMover::beginDrag(Drag drag, const glm::dvec2& place_px, const glm::dvec3& under, double focal_px,
                            double height_px) {
    way_.reset();
    drag_ = drag;
    place_px_ = place_px;
    under_ = under;
    depth_ = transform(inverse(camera_.pose()), under).z;
    focal_px_ = focal_px;
    height_px_ = height_px;
}

void CameraMover::dragTo(const glm::dvec2& place_px) {
    const glm::dvec2 step_px = place_px - place_px_;
    place_px_ = place_px;
    // The content in front follows the mouse: from top to bottom it turns by half a turn.
    if (drag_ == Drag::kOrbit) {
        camera_.orbit(under_, std::numbers::pi * step_px.x / height_px_,
                      -std::numbers::pi * step_px.y / height_px_);
    }
    if (drag_ == Drag::kPan) { camera_.pan(step_px, depth_, focal_px_); }
}

void CameraMover::turnWheel(double steps, const glm::dvec3& under) {
    way_.reset();
    camera_.approach(under, std::pow(kShareOfStep, steps));
}

void CameraMover::pass(const HeldMotion& held, double seconds) {
    if (held.isAny()) {
        way_.reset();
        const double fast = held.fast ? kFaster : 1.0;
        camera_.turn(seconds * kTurnRadPerSecond * held.turn.x, seconds * kTurnRadPerSecond * held.turn.y);
        camera_.fly(seconds * kFlyDistancesPerSecond * fast * camera_.distance() * held.fly);
    }
    if (!way_) { return; }
    way_->seconds += seconds;
    const double share = std::min(way_->seconds / way_->whole_seconds, 1.0);
    camera_ = OrbitCamera::between(way_->from, way_->to, share * share * (3.0 - 2.0 * share));
    if (share == 1.0) { way_.reset(); }
}

}  // namespace binosplat
