// A picture of a hand out of its joints, as a headset's cameras find them.
#pragma once

#include "app/view/room/sprites.h"
#include "xr/extensions/hand_tracking.h"

namespace binosplat {

// So many texels go in one update of a command buffer.
constexpr glm::uvec2 kHandPicturePx(128, 128);

// Where a hand's picture hangs: through its palm, facing `eye`.
Strip handPicturePlace(const xr::HandJoints& joints, const glm::dvec3& eye);
// What `eye` sees of the hand through a picture that hangs there.
TexelPicture drawHand(const xr::HandJoints& joints, const Strip& place, const glm::dvec3& eye, const TexelLayout& layout);

}  // namespace binosplat
