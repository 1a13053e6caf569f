// A picture of a hand, from the joints that a headset's cameras find.
#pragma once

#include "app/view/room/sprites.h"
#include "xr/extensions/hand_tracking.h"

#include <array>
#include <cstdint>
#include <vector>

namespace binosplat {

// 1.2 mm a texel: half an arm's length away, two or three of a headset's pixels.
constexpr glm::uvec2 kHandPicturePx(256, 256);

// Where a hand's picture hangs: through its palm, facing `eye`.
Strip handPicturePlace(const xr::HandJoints& joints, const glm::dvec3& eye);

// Draws hands; keeps its memory from frame to frame.
class HandDrawing {
public:
    explicit HandDrawing(const TexelLayout& layout);

    // The hand as `eye` sees it through a picture at `place`.
    void draw(const xr::HandJoints& joints, const Strip& place, const glm::dvec3& eye, TexelPicture& picture);

private:
    // `light` is the brightness times alpha; an alpha of 0: nothing is there.
    struct Hit {
        float depth, light, alpha;
        float slope;  // of the depth, per texel
    };
    // A joint as the picture shows it, in texels.
    struct SeenJoint {
        glm::vec2 at;
        float radius, depth;  // the depth is in texels, too
    };
    static Hit over(const Hit& front, const Hit& back);
    static Hit join(const Hit& a, const Hit& b);
    void drawBone(const SeenJoint& a, const SeenJoint& b);

    TexelLayout layout_;
    std::array<std::uint32_t, 256> opaque_{};  // texels by brightness
    std::vector<Hit> hits_;
};

}  // namespace binosplat
