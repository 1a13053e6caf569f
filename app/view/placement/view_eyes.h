// From the headset's eyes in the room to the eyes of a frame in the scene.
#pragma once

#include "engine/similarity.h"
#include "xr/session.h"

#include <array>

namespace binosplat {

// Makes both eyes' angles up and down equal if they differ only by rounding, so that the rows of parallel
// eyes coincide.
std::array<xr::EyeView, 2> withoutNoise(std::array<xr::EyeView, 2> views);

// Both eyes in room axes. Removes float32 noise from parallel, side-by-side eyes, so that they are exactly
// parallel: under 2 micrometres and microradians, hundredths of a pixel.
std::array<Pose, 2> roomFromEyes(const std::array<xr::EyeView, 2>& views);

// The midpoint between the eyes.
Pose roomFromHead(const std::array<Pose, 2>& room_from_eyes);

// An eye in the form that frames need.
Eye eyeInScene(const Similarity& scene_from_room, const Pose& room_from_eye, const XrFovf& fov,
               glm::uvec2 size_px);
// What a frame's picture shows, as the runtime is told: the view from `place` in the room.
xr::EyeView pictureInRoom(const Similarity& scene_from_room, const Eye& picture, const XrVector3f& place);

}  // namespace binosplat
