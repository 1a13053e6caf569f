// The joints of a hand that holds a controller at its grip pose, by XR_EXT_hand_tracking's names and axes.
#pragma once

#include "xr/simulated/compose/geometry.h"

#include <array>

namespace simulated {

struct HandJoint {
    Pose stage_from_joint;  // -z towards the fingertips, y out of the back of the hand
    double radius_m = 0.0;
};

inline constexpr std::size_t kHandJoints = 26;

// Curls go from 0, straight, to 1, closed: one for the index finger, one for the other three; the thumb
// stays.
[[nodiscard]] std::array<HandJoint, kHandJoints> makeHandJoints(Side side, const Pose& stage_from_grip,
                                                                double index_curl, double others_curl);

}  // namespace simulated
