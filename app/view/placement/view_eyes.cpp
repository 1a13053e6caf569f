// Eyes in the scene.
#include "app/view/placement/view_eyes.h"

#include "xr/convert.h"

#include <cmath>

namespace binosplat {

namespace {

constexpr double kNoise = 2e-6;  // metres and radians

}  // namespace

std::array<Pose, 2> roomFromEyes(const std::array<xr::EyeView, 2>& views) {
    std::array<Pose, 2> eyes{xr::fromXr(views[kLeft].pose), xr::fromXr(views[kRight].pose)};
    // The difference's length is twice the sine of a quarter of the angle between them.
    const double alike = glm::dot(eyes[kLeft].orientation, eyes[kRight].orientation);
    const glm::dquat right = alike < 0.0 ? -eyes[kRight].orientation : eyes[kRight].orientation;
    if (glm::length(right - eyes[kLeft].orientation) > 0.5 * kNoise) { return eyes; }
    eyes[kRight].orientation = eyes[kLeft].orientation;
    const glm::dvec3 shift =
        glm::conjugate(eyes[kLeft].orientation) * (eyes[kRight].position - eyes[kLeft].position);
    if (std::abs(shift.y) > kNoise || std::abs(shift.z) > kNoise) { return eyes; }
    eyes[kRight].position = transform(eyes[kLeft], {shift.x, 0.0, 0.0});
    return eyes;
}

std::array<xr::EyeView, 2> withoutNoise(std::array<xr::EyeView, 2> views) {
    const XrFovf& left = views[kLeft].fov;
    XrFovf& right = views[kRight].fov;
    const auto isAlike = [](float a, float b) { return std::abs(a - b) < static_cast<float>(kNoise); };
    if (isAlike(left.angleUp, right.angleUp) && isAlike(left.angleDown, right.angleDown)) {
        right.angleUp = left.angleUp;
        right.angleDown = left.angleDown;
    }
    return views;
}

Pose roomFromHead(const std::array<Pose, 2>& room_from_eyes) {
    const auto& [left, right] = room_from_eyes;
    return {glm::slerp(left.orientation, right.orientation, 0.5), 0.5 * (left.position + right.position)};
}

Eye eyeInScene(const Similarity& scene_from_room, const Pose& room_from_eye, const XrFovf& fov,
               glm::uvec2 size_px) {
    return {transform(scene_from_room, room_from_eye), intrinsicsFromAngles(xr::fromXr(fov), size_px),
            size_px};
}

xr::EyeView pictureInRoom(const Similarity& scene_from_room, const Eye& picture, const XrVector3f& place) {
    const Pose room_from_eye{
        glm::normalize(glm::conjugate(scene_from_room.orientation) * picture.world_from_camera.orientation),
        {}};
    xr::EyeView view{xr::toXr(room_from_eye), {}};
    view.pose.position = place;
    const Intrinsics& k = picture.intrinsics;
    const glm::dvec2 size(picture.size_px);
    const auto angle = [](double px, double focal_px) {
        return static_cast<float>(std::atan(px / focal_px));
    };
    view.fov = {angle(-k.cx, k.fx), angle(size.x - k.cx, k.fx), angle(k.cy, k.fy),
                angle(k.cy - size.y, k.fy)};
    return view;
}

}  // namespace binosplat
