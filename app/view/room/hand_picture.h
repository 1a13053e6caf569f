// A picture of a hand, from the joints that a headset's cameras find.
#pragma once

#include "app/view/room/sprites.h"
#include "xr/extensions/hand_tracking.h"

namespace binosplat {

// As many texels as fit into one update of a command buffer.
constexpr glm::uvec2 kHandPicturePx(128, 128);

// Where a hand's picture hangs: through its palm, facing `eye`.
Strip handPicturePlace(const xr::HandJoints& joints, const glm::dvec3& eye);
// The hand as `eye` sees it through a picture at `place`.
TexelPicture drawHand(const xr::HandJoints& joints, const Strip& place, const glm::dvec3& eye,
                      const TexelLayout& layout);

}  // namespace binosplat
