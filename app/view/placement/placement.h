// Where the wearer's room lies in the scene. Room axes are those of a camera that looks ahead (x right, y down, z forward), metres.
#pragma once

#include "engine/scene/procedural.h"
#include "engine/similarity.h"

namespace binosplat {

// The room's origin where the view's eye is, upright, looking that way. A room metre is 1 / metres_per_unit scene units.
Similarity startPlacement(const View& view, double metres_per_unit);
// How many times as large as it is a scene is shown, so that what is looked at is no nearer than half a metre: nearer eyes would have to
// squint, and what is nearer than the near plane is not there.
double growthToSee(const View& view, double metres_per_unit);

// What moves the wearer through the scene: each is a scene_from_room to follow `scene_from_room`.
// By `step_m` in the room.
Similarity movedBy(const Similarity& scene_from_room, const glm::dvec3& step_m);
// About the vertical through `about`, to the right where `angle_rad` is positive.
Similarity turnedBy(const Similarity& scene_from_room, double angle_rad, const glm::dvec3& about);

// The scene grows by `growth` about `about` in the room, within the bounds of heldBy; or turns there as `turn` does.
Similarity grownBy(const Similarity& scene_from_room, double growth, const glm::dvec3& about);
Similarity tiltedBy(const Similarity& scene_from_room, const glm::dquat& turn, const glm::dvec3& about);

// Two points of the scene that are held, at `from` before and at `to` now: the scene moves, turns about the vertical and grows with
// them, or turns as they do where it may be `tilted`. Points that lie above one another do not turn it about the vertical, and scale
// changes stay within 1000 in all from `scene_from_room`.
Similarity heldBy(const Similarity& scene_from_room, const std::array<glm::dvec3, 2>& from, const std::array<glm::dvec3, 2>& to,
                  bool tilted = false);
// Stands upright where `up` is up in the scene, a unit vector, with the same heading; `about`, in the room, stays where it is.
Similarity levelledAlong(const Similarity& scene_from_room, const glm::dvec3& up, const glm::dvec3& about);

// How the wearer looks ahead, level: the horizontal part of that, or straight ahead if there is none.
glm::dvec3 levelAhead(const Pose& room_from_head);

}  // namespace binosplat
