// Between OpenXR's axes (x right, y up, z backward; quaternions x, y, z, w; float) and ours (x right, y down,
// z forward; double). The only file that knows both: half a turn about x converts one into the other, for the
// room and for every device in it.
#pragma once

#include "engine/geometry.h"

#include <openxr/openxr.h>

namespace binosplat::xr {

inline glm::dvec3 fromXr(const XrVector3f& v) {
    return {static_cast<double>(v.x), -static_cast<double>(v.y), -static_cast<double>(v.z)};
}

inline Pose fromXr(const XrPosef& pose) {
    const XrQuaternionf& q = pose.orientation;
    const glm::dquat orientation(static_cast<double>(q.w), static_cast<double>(q.x),
                                 -static_cast<double>(q.y), -static_cast<double>(q.z));
    return {glm::normalize(orientation), fromXr(pose.position)};
}

inline ViewAngles fromXr(const XrFovf& fov) {
    return {static_cast<double>(fov.angleLeft), static_cast<double>(fov.angleRight),
            static_cast<double>(fov.angleUp), static_cast<double>(fov.angleDown)};
}

inline XrVector3f toXr(const glm::dvec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(-v.y), static_cast<float>(-v.z)};
}

inline XrPosef toXr(const Pose& pose) {
    const glm::dquat& q = pose.orientation;
    return {{static_cast<float>(q.x), static_cast<float>(-q.y), static_cast<float>(-q.z),
             static_cast<float>(q.w)},
            toXr(pose.position)};
}

}  // namespace binosplat::xr
