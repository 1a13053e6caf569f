// Converts poses, computes velocities from two poses, and checks poses that an application gives.
#include "xr/simulated/api/poses.h"

#include <cmath>

#include "xr/simulated/api/answer.h"

namespace simulated {

Pose fromXr(const XrPosef& pose) {
    const auto& [x, y, z, w] = pose.orientation;
    return {glm::normalize(glm::dquat(w, x, y, z)), {pose.position.x, pose.position.y, pose.position.z}};
}

XrPosef toXr(const Pose& pose) {
    const glm::quat orientation(pose.orientation);
    const glm::vec3 position(pose.position);
    return {{orientation.x, orientation.y, orientation.z, orientation.w},
            {position.x, position.y, position.z}};
}

Fov fromXr(const XrFovf& fov) { return {fov.angleLeft, fov.angleRight, fov.angleUp, fov.angleDown}; }

XrFovf toXr(const Fov& fov) {
    return {static_cast<float>(fov.left_rad), static_cast<float>(fov.right_rad),
            static_cast<float>(fov.up_rad), static_cast<float>(fov.down_rad)};
}

Motion motionOf(const Pose& a_step_before, const Pose& a_step_after) {
    constexpr double kSeconds = 2e-9 * kMotionStep;
    const glm::vec3 linear((a_step_after.position - a_step_before.position) / kSeconds);
    glm::dquat turn = a_step_after.orientation * glm::conjugate(a_step_before.orientation);
    if (turn.w < 0) { turn = -turn; }
    // For small turns, the vector part is half the angle along the axis.
    const glm::vec3 angular(glm::dvec3(turn.x, turn.y, turn.z) * (2 / kSeconds));
    return {{linear.x, linear.y, linear.z}, {angular.x, angular.y, angular.z}};
}

void checkPose(const XrPosef& pose) {
    const auto& [x, y, z, w] = pose.orientation;
    const float length = std::sqrt(x * x + y * y + z * z + w * w);
    // Written so that NaN fails, too.
    require(std::abs(length - 1) < 0.01f, XR_ERROR_POSE_INVALID, "the quaternion ", x, " ", y, " ", z, " ", w,
            " is not of length 1");
    require(
        std::isfinite(pose.position.x) && std::isfinite(pose.position.y) && std::isfinite(pose.position.z),
        XR_ERROR_POSE_INVALID, "the position ", pose.position.x, " ", pose.position.y, " ", pose.position.z,
        " is not finite");
}

}  // namespace simulated
