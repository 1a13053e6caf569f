// Moves from the lens's centre to the gaze and back, without a jump.
#include "app/view/wearer/gaze_follower.h"

#include <algorithm>

namespace binosplat {

std::array<std::optional<Gaze>, 2> GazeFollower::update(const std::optional<glm::dvec3>& gaze_room,
                                                        const std::array<Pose, 2>& room_from_eyes,
                                                        double lens_clear_rad, double step_seconds) {
    if (gaze_room) {
        lost_seconds_ = 0.0;
        share_ = std::min(share_ + step_seconds / kFindSeconds, 1.0);
    } else {
        lost_seconds_ += step_seconds;
        if (lost_seconds_ > kHoldSeconds) { share_ = std::max(share_ - step_seconds / kLoseSeconds, 0.0); }
        if (share_ == 0.0) { *this = {}; }
    }
    const double seen_clear_rad = std::min(kSeenClearRadians, lens_clear_rad);
    std::array<std::optional<Gaze>, 2> gazes;
    for (std::size_t side = 0; side < 2; ++side) {
        // The target is assumed to be far away, so that both eyes turn in the same way.
        if (gaze_room) {
            last_[side] = glm::normalize(glm::conjugate(room_from_eyes[side].orientation) * *gaze_room);
        }
        gazes[side] = Gaze{glm::mix(glm::dvec3(0.0, 0.0, 1.0), last_[side], share_),
                           glm::mix(lens_clear_rad, seen_clear_rad, share_)};
        // The mix vanishes halfway to a gaze straight behind the eye.
        if (!(glm::length(gazes[side]->direction) > 1e-6)) { gazes[side]->direction = {0.0, 0.0, 1.0}; }
    }
    return gazes;
}

}  // namespace binosplat
