// Where the wearer's room is in the scene. Room axes are those of a camera looking ahead (x right, y down, z
// forward), in metres.
#pragma once

#include "engine/geometry.h"
#include "engine/similarity.h"

namespace binosplat {

// The room's origin where the view's eye is, upright, looking that way. A room metre is 1 / metres_per_unit
// scene units.
Similarity startPlacement(const View& view, double metres_per_unit);
// The factor by which a scene is enlarged so that what the view looks at is at least half a metre away: at
// less, the eyes would have to squint, and what is nearer than the near plane is not drawn.
double growthToSee(const View& view, double metres_per_unit);

// These move the wearer through the scene: each returns the scene_from_room that follows `scene_from_room`.
// By `step_m` in the room.
Similarity movedBy(const Similarity& scene_from_room, const glm::dvec3& step_m);
// About the vertical axis through `about`, to the right if `angle_rad` is positive.
Similarity turnedBy(const Similarity& scene_from_room, double angle_rad, const glm::dvec3& about);

// The scene grows by `growth` about `about` in the room, within the bounds of heldBy; or is turned there by
// `turn`.
Similarity grownBy(const Similarity& scene_from_room, double growth, const glm::dvec3& about);
Similarity tiltedBy(const Similarity& scene_from_room, const glm::dquat& turn, const glm::dvec3& about);

// Two points of the scene are held, at `from` before and at `to` now: the scene moves, turns about the
// vertical and grows with them, or turns freely with them if `tilted`. Points above one another do not turn
// it about the vertical axis, and the scale stays between 1e-6 and 1e6 scene units per metre.
Similarity heldBy(const Similarity& scene_from_room, const std::array<glm::dvec3, 2>& from,
                  const std::array<glm::dvec3, 2>& to, bool tilted = false);
// Makes the scene upright, given its up direction `up`, a unit vector, with the same heading; `about`, in the
// room, stays in place.
Similarity levelledAlong(const Similarity& scene_from_room, const glm::dvec3& up, const glm::dvec3& about);

// The horizontal part of the wearer's view direction, or straight ahead if there is none.
glm::dvec3 levelAhead(const Pose& room_from_head);

}  // namespace binosplat
