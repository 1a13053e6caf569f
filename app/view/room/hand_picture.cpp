// Draws a hand's bones with round ends, as seen by one eye.
#include "app/view/room/hand_picture.h"

#include <algorithm>
#include <cmath>

namespace binosplat {

namespace {

constexpr double kPictureMetres = 0.3;  // fits a spread hand with its wrist
constexpr glm::dvec3 kSkinLight(0.3, 0.42, 0.55);
constexpr double kLeastRadiusMetres = 0.004;  // if the runtime does not say
constexpr float kRimTexels = 1.5f;            // width over which a border fades
constexpr float kLeastFacing = 0.1f;          // at borders, where surfaces are as steep as can be

constexpr std::size_t kWrist = XR_HAND_JOINT_WRIST_EXT;
// The joints next to the wrist, of the palm and of each finger; a finger's other joints follow up to its tip.
constexpr std::array<std::size_t, 6> kFirstJoints{XR_HAND_JOINT_PALM_EXT,
                                                  XR_HAND_JOINT_THUMB_METACARPAL_EXT,
                                                  XR_HAND_JOINT_INDEX_METACARPAL_EXT,
                                                  XR_HAND_JOINT_MIDDLE_METACARPAL_EXT,
                                                  XR_HAND_JOINT_RING_METACARPAL_EXT,
                                                  XR_HAND_JOINT_LITTLE_METACARPAL_EXT};

}  // namespace

Strip handPicturePlace(const xr::HandJoints& joints, const glm::dvec3& eye) {
    return facing(joints[XR_HAND_JOINT_PALM_EXT].place, glm::dvec2(kPictureMetres), eye);
}

HandDrawing::HandDrawing(const TexelLayout& layout) : layout_(layout) {
    for (std::size_t i = 0; i < opaque_.size(); ++i) {
        opaque_[i] = texelOf(static_cast<double>(i) / 255.0 * kSkinLight, 1.0, layout_);
    }
}

HandDrawing::Hit HandDrawing::over(const Hit& front, const Hit& back) {
    const Hit& shown = front.alpha > 0.5f ? front : back;
    return {shown.depth, front.light + (1.0f - front.alpha) * back.light,
            front.alpha + (1.0f - front.alpha) * back.alpha, shown.slope};
}

// Where two bones meet, one passes into the other over some texels, however steeply their depths cross: there
// is no staircase. Bones end in the same joints: where both have a border, it is one border, and no less
// soft.
HandDrawing::Hit HandDrawing::join(const Hit& a, const Hit& b) {
    if (a.alpha == 0.0f) { return b; }
    const float rim = kRimTexels * (1.0f + a.slope + b.slope);
    const float b_is_front = glm::clamp((a.depth - b.depth) / rim + 0.5f, 0.0f, 1.0f);
    const Hit with_a = over(a, b), with_b = over(b, a);
    const float alpha = std::max(a.alpha, b.alpha), light = glm::mix(with_a.light, with_b.light, b_is_front);
    const Hit& front = b_is_front > 0.5f ? with_b : with_a;
    return {front.depth, light * alpha / with_a.alpha, alpha, front.slope};
}

void HandDrawing::drawBone(const SeenJoint& a, const SeenJoint& b) {
    const float reach = std::max(a.radius, b.radius) + kRimTexels;
    const glm::vec2 last = glm::vec2(kHandPicturePx) - 1.0f;
    const glm::vec2 low = glm::clamp(glm::floor(glm::min(a.at, b.at) - reach), glm::vec2(0.0f), last);
    const glm::vec2 high = glm::clamp(glm::ceil(glm::max(a.at, b.at) + reach), glm::vec2(0.0f), last);
    const glm::vec2 along = b.at - a.at;
    const float per_length2 = 1.0f / std::max(glm::dot(along, along), 1e-9f);
    for (auto y = static_cast<std::uint32_t>(low.y); y <= static_cast<std::uint32_t>(high.y); ++y) {
        for (auto x = static_cast<std::uint32_t>(low.x); x <= static_cast<std::uint32_t>(high.x); ++x) {
            const glm::vec2 to = glm::vec2(x, y) + 0.5f - a.at;
            const float t = glm::clamp(glm::dot(to, along) * per_length2, 0.0f, 1.0f);
            const glm::vec2 across = to - t * along;
            const float aside2 = glm::dot(across, across);
            if (aside2 >= reach * reach) { continue; }
            const float radius = glm::mix(a.radius, b.radius, t);
            const float alpha = glm::clamp((radius - std::sqrt(aside2)) / kRimTexels + 0.5f, 0.0f, 1.0f);
            if (alpha == 0.0f) { continue; }
            const float facing_eye = std::sqrt(std::max(0.0f, 1.0f - aside2 / (radius * radius)));
            const float depth = glm::mix(a.depth, b.depth, t) - radius * facing_eye;
            Hit& hit = hits_[std::size_t{y} * kHandPicturePx.x + x];
            const float slope = std::sqrt(aside2) / (radius * std::max(facing_eye, kLeastFacing));
            hit = join(hit, {depth, alpha * (0.3f + 0.7f * facing_eye), alpha, slope});
        }
    }
}

void HandDrawing::draw(const xr::HandJoints& joints, const Strip& place, const glm::dvec3& eye,
                       TexelPicture& picture) {
    const glm::dvec2 size(kHandPicturePx), texels_per_metre = size / place.size_m;
    const Pose picture_from_room = inverse(place.room_from_strip);
    const glm::dvec3 eye_there = transform(picture_from_room, eye);
    std::array<SeenJoint, XR_HAND_JOINT_COUNT_EXT> seen{};
    for (std::size_t i = 0; i < seen.size(); ++i) {
        // Through the picture's plane, z = 0; the eye is in front of it, at negative z.
        const glm::dvec3 joint = transform(picture_from_room, joints[i].place);
        const double depth_m = std::max(joint.z - eye_there.z, 0.02), growth = -eye_there.z / depth_m;
        const glm::dvec2 at = glm::dvec2(eye_there) + growth * (glm::dvec2(joint) - glm::dvec2(eye_there));
        const double radius_m = std::max(joints[i].radius_m, kLeastRadiusMetres);
        seen[i] = {glm::vec2(at * texels_per_metre + 0.5 * size),
                   static_cast<float>(radius_m * growth * texels_per_metre.x),
                   static_cast<float>(joint.z * texels_per_metre.x)};
    }
    hits_.assign(std::size_t{kHandPicturePx.x} * kHandPicturePx.y, {});
    for (std::size_t joint = 0; joint < seen.size(); ++joint) {
        if (joint == kWrist) { continue; }
        const bool is_first = std::ranges::find(kFirstJoints, joint) != kFirstJoints.end();
        drawBone(seen[is_first ? kWrist : joint - 1], seen[joint]);
    }
    picture.size_px = kHandPicturePx;
    picture.texels.resize(hits_.size());
    std::ranges::transform(hits_, picture.texels.begin(), [&](const Hit& hit) -> std::uint32_t {
        if (hit.alpha == 0.0f) { return 0; }
        const float brightness = std::min(hit.light / hit.alpha, 1.0f);
        if (hit.alpha > 0.999f) { return opaque_[static_cast<std::size_t>(255.0f * brightness + 0.5f)]; }
        return texelOf(static_cast<double>(brightness) * kSkinLight, static_cast<double>(hit.alpha), layout_);
    });
}

}  // namespace binosplat
