// Draws a hand's bones with round ends, as seen by one eye.
#include "app/view/room/hand_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace binosplat {

namespace {

constexpr double kPictureMetres = 0.3;  // fits a spread hand with its wrist
constexpr glm::dvec3 kSkinLight(0.3, 0.42, 0.55);
constexpr double kLeastRadiusMetres = 0.004;  // if the runtime does not say
constexpr double kRimTexels = 1.2;            // width over which a border fades

constexpr std::size_t kWrist = XR_HAND_JOINT_WRIST_EXT;
// The joints next to the wrist, of the palm and of each finger; a finger's other joints follow up to its tip.
constexpr std::array<std::size_t, 6> kFirstJoints{XR_HAND_JOINT_PALM_EXT,
                                                  XR_HAND_JOINT_THUMB_METACARPAL_EXT,
                                                  XR_HAND_JOINT_INDEX_METACARPAL_EXT,
                                                  XR_HAND_JOINT_MIDDLE_METACARPAL_EXT,
                                                  XR_HAND_JOINT_RING_METACARPAL_EXT,
                                                  XR_HAND_JOINT_LITTLE_METACARPAL_EXT};

// A joint as the picture shows it, in texels.
struct SeenJoint {
    glm::dvec2 at;
    double radius, depth;  // the depth is in texels, too
};

// `light` is the brightness times alpha.
struct Hit {
    double depth = std::numeric_limits<double>::infinity(), light = 0.0, alpha = 0.0;
};

Hit over(const Hit& front, const Hit& back) {
    return {front.alpha > 0.5 ? front.depth : back.depth, front.light + (1.0 - front.alpha) * back.light,
            front.alpha + (1.0 - front.alpha) * back.alpha};
}

// Where two bones meet, one passes into the other over some texels, so that there is no staircase.
Hit join(const Hit& a, const Hit& b) {
    const double b_is_front = std::clamp((a.depth - b.depth) / kRimTexels + 0.5, 0.0, 1.0);
    const Hit with_a = over(a, b), with_b = over(b, a);
    return {b_is_front > 0.5 ? with_b.depth : with_a.depth, glm::mix(with_a.light, with_b.light, b_is_front),
            with_a.alpha};
}

void drawBone(const SeenJoint& a, const SeenJoint& b, const glm::uvec2& size_px, std::vector<Hit>& hits) {
    const double reach = std::max(a.radius, b.radius) + kRimTexels;
    const glm::dvec2 last = glm::dvec2(size_px) - 1.0;
    const glm::dvec2 low = glm::clamp(glm::floor(glm::min(a.at, b.at) - reach), glm::dvec2(0.0), last);
    const glm::dvec2 high = glm::clamp(glm::ceil(glm::max(a.at, b.at) + reach), glm::dvec2(0.0), last);
    const glm::dvec2 along = b.at - a.at;
    const double length2 = std::max(glm::dot(along, along), 1e-9);
    for (auto y = static_cast<std::uint32_t>(low.y); y <= static_cast<std::uint32_t>(high.y); ++y) {
        for (auto x = static_cast<std::uint32_t>(low.x); x <= static_cast<std::uint32_t>(high.x); ++x) {
            const glm::dvec2 at(x + 0.5, y + 0.5);
            const double t = std::clamp(glm::dot(at - a.at, along) / length2, 0.0, 1.0);
            const double radius = glm::mix(a.radius, b.radius, t),
                         aside = glm::distance(at, a.at + t * along);
            const double alpha = std::clamp((radius - aside) / kRimTexels + 0.5, 0.0, 1.0);
            if (alpha == 0.0) { continue; }
            const double facing_eye = std::sqrt(std::max(0.0, 1.0 - aside * aside / (radius * radius)));
            const double depth = glm::mix(a.depth, b.depth, t) - radius * facing_eye;
            Hit& hit = hits[std::size_t{y} * size_px.x + x];
            hit = join(hit, {depth, alpha * (0.3 + 0.7 * facing_eye), alpha});
        }
    }
}

}  // namespace

Strip handPicturePlace(const xr::HandJoints& joints, const glm::dvec3& eye) {
    return facing(joints[XR_HAND_JOINT_PALM_EXT].place, glm::dvec2(kPictureMetres), eye);
}

TexelPicture drawHand(const xr::HandJoints& joints, const Strip& place, const glm::dvec3& eye,
                      const TexelLayout& layout) {
    TexelPicture picture{kHandPicturePx, {}};
    const glm::dvec2 size(picture.size_px), texels_per_metre = size / place.size_m;
    const Pose picture_from_room = inverse(place.room_from_strip);
    const glm::dvec3 eye_there = transform(picture_from_room, eye);
    std::array<SeenJoint, XR_HAND_JOINT_COUNT_EXT> seen{};
    for (std::size_t i = 0; i < seen.size(); ++i) {
        // Through the picture's plane, z = 0; the eye is in front of it, at negative z.
        const glm::dvec3 joint = transform(picture_from_room, joints[i].place);
        const double depth_m = std::max(joint.z - eye_there.z, 0.02), growth = -eye_there.z / depth_m;
        const glm::dvec2 at = glm::dvec2(eye_there) + growth * (glm::dvec2(joint) - glm::dvec2(eye_there));
        const double radius_m = std::max(joints[i].radius_m, kLeastRadiusMetres);
        seen[i] = {at * texels_per_metre + 0.5 * size, radius_m * growth * texels_per_metre.x,
                   joint.z * texels_per_metre.x};
    }
    std::vector<Hit> hits(std::size_t{picture.size_px.x} * picture.size_px.y);
    for (std::size_t joint = 0; joint < seen.size(); ++joint) {
        if (joint == kWrist) { continue; }
        const bool is_first = std::ranges::find(kFirstJoints, joint) != kFirstJoints.end();
        drawBone(seen[is_first ? kWrist : joint - 1], seen[joint], picture.size_px, hits);
    }
    picture.texels.reserve(hits.size());
    for (const Hit& hit : hits) {
        const double brightness = hit.alpha > 0.0 ? hit.light / hit.alpha : 0.0;
        picture.texels.push_back(texelOf(brightness * kSkinLight, hit.alpha, layout));
    }
    return picture;
}

}  // namespace binosplat
