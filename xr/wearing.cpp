// Tells whether the headset is worn, by its presence sensor or by movement.
#include "xr/wearing.h"

#include <algorithm>
#include <cmath>

namespace binosplat::xr {

namespace {

// Even the head of someone who looks at one thing moves this far in a second or two; a headset on a desk does
// not, apart from tracking errors.
constexpr double kMovedMetres = 0.02, kMovedRadians = 0.05;
// When a headset that has been still for this long moves, it counts as worn only this much later.
constexpr double kDeskSeconds = 3.0, kLiftSeconds = 2.0;

double angleBetween(const glm::dquat& a, const glm::dquat& b) {
    return 2.0 * std::acos(std::min(std::abs(glm::dot(a, b)), 1.0));
}

}  // namespace

bool Wearing::begins(bool is_focused, const Pose& room_from_head, double step_seconds) {
    if (has_begun_ || !is_focused) { return false; }
    if (is_present_) { return has_begun_ = *is_present_; }
    if (!first_) { first_ = room_from_head; }
    const bool has_moved = glm::distance(first_->position, room_from_head.position) > kMovedMetres ||
                           angleBetween(first_->orientation, room_from_head.orientation) > kMovedRadians;
    if (has_moved || lifted_seconds_ > 0.0) {
        lifted_seconds_ += step_seconds;
        has_begun_ = rested_seconds_ < kDeskSeconds || lifted_seconds_ >= kLiftSeconds;
    } else {
        rested_seconds_ += step_seconds;
    }
    return has_begun_;
}

bool Wearing::isElsewhere(const Pose& room_from_head) {
    const glm::dvec3 ahead = room_from_head.orientation * glm::dvec3(0.0, 0.0, 1.0);
    const bool is_level = std::hypot(ahead.x, ahead.z) > 0.1;
    return glm::length(room_from_head.position) > kElsewhereMetres ||
           (is_level && std::abs(std::atan2(ahead.x, ahead.z)) > kElsewhereRadians);
}

}  // namespace binosplat::xr
