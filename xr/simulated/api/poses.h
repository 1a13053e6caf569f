// Conversions between OpenXR's single-precision poses and angles and this folder's own.
#pragma once

#include "xr/simulated/compose/geometry.h"
#include "xr/simulated/openxr.h"

namespace simulated {

[[nodiscard]] Pose fromXr(const XrPosef& pose);
[[nodiscard]] XrPosef toXr(const Pose& pose);
[[nodiscard]] Fov fromXr(const XrFovf& fov);
[[nodiscard]] XrFovf toXr(const Fov& fov);

// Velocities are differences of poses a millisecond to either side: short against any motion, long against
// rounding.
constexpr XrDuration kMotionStep = 1'000'000;
struct Motion {
    XrVector3f linear_m_s, angular_rad_s;
};
[[nodiscard]] Motion motionOf(const Pose& a_step_before, const Pose& a_step_after);

// XR_ERROR_POSE_INVALID for a quaternion whose length is not 1 within a hundredth, or anything not finite.
void checkPose(const XrPosef& pose);

}  // namespace simulated
