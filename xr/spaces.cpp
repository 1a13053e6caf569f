// Finds where the head is, and places the room around it.
#include "xr/spaces.h"

#include "xr/convert.h"
#include "xr/extensions/foveated_inset.h"

#include <cmath>

namespace binosplat::xr {
namespace {

constexpr float kHalfIpdMetres = 0.0315f;  // until the headset says where its eyes are

// The head without its tilt, in our axes; one that looks straight up or down keeps the heading of its
// right-hand side.
Pose upright(const Pose& head) {
    const glm::dvec3 forward = head.orientation * glm::dvec3(0.0, 0.0, 1.0),
                     right = head.orientation * glm::dvec3(1.0, 0.0, 0.0);
    const bool is_level = std::hypot(forward.x, forward.z) > 0.1;
    const double heading = is_level ? std::atan2(forward.x, forward.z) : std::atan2(-right.z, right.x);
    return {glm::angleAxis(heading, glm::dvec3(0.0, 1.0, 0.0)), head.position};
}

// The midpoint between the eyes.
Pose headOf(const std::array<EyeView, 2>& eyes) {
    const Pose left = fromXr(eyes[kLeft].pose), right = fromXr(eyes[kRight].pose);
    return {glm::slerp(left.orientation, right.orientation, 0.5), 0.5 * (left.position + right.position)};
}

}  // namespace

OwnedSpace makeSpace(XrSession session, XrReferenceSpaceType type, const XrPosef& pose) {
    auto info = structure<XrReferenceSpaceCreateInfo>(XR_TYPE_REFERENCE_SPACE_CREATE_INFO);
    info.referenceSpaceType = type;
    info.poseInReferenceSpace = pose;
    XrSpace space = XR_NULL_HANDLE;
    BINOSPLAT_XR(xrCreateReferenceSpace(session, &info, &space));
    return OwnedSpace(space);
}

Spaces::Spaces(XrSession session, XrViewConfigurationType views, bool moves_insets)
    : session_(session),
      views_(views),
      moves_insets_(moves_insets),
      local_(makeSpace(session, XR_REFERENCE_SPACE_TYPE_LOCAL)),
      room_(makeSpace(session, XR_REFERENCE_SPACE_TYPE_LOCAL)),
      head_(makeSpace(session, XR_REFERENCE_SPACE_TYPE_VIEW)) {}

Spaces::Located Spaces::locate(XrSpace space, XrTime time) const {
    auto info = structure<XrViewLocateInfo>(XR_TYPE_VIEW_LOCATE_INFO);
    auto moving = structure<XrViewLocateFoveatedRenderingVARJO>(XR_TYPE_VIEW_LOCATE_FOVEATED_RENDERING_VARJO);
    moving.foveatedRenderingActive = XR_TRUE;
    if (moves_insets_) { info.next = &moving; }
    info.viewConfigurationType = views_;
    info.displayTime = time;
    info.space = space;
    auto state = structure<XrViewState>(XR_TYPE_VIEW_STATE);
    std::array<XrView, 4> views;
    views.fill({XR_TYPE_VIEW, nullptr, {}, {}});
    const std::uint32_t wanted = views_ == kStereoWithInset ? 4 : 2;
    std::uint32_t count = 0;
    BINOSPLAT_XR(xrLocateViews(session_, &info, &state, wanted, &count, views.data()));
    Located located;
    for (std::size_t e = 0; e < 2; ++e) {
        located.eyes[e] = {views[e].pose, views[e].fov};
        located.insets[e] = views[e + 2].fov;
    }
    located.turn_known = count == wanted && (state.viewStateFlags & XR_VIEW_STATE_ORIENTATION_VALID_BIT) != 0;
    located.place_known =
        located.turn_known && (state.viewStateFlags & XR_VIEW_STATE_POSITION_VALID_BIT) != 0;
    return located;
}

std::optional<std::array<EyeView, 2>> Spaces::locateEyes(XrTime time) {
    Located located = locate(room(), time);
    if (!located.turn_known) { return std::nullopt; }
    if (views_ == kStereoWithInset) { insets_ = located.insets; }
    if (located.place_known) {
        last_place_ = toXr(headOf(located.eyes).position);
        return located.eyes;
    }
    for (const int e : {kLeft, kRight}) {
        XrPosef& pose = located.eyes[static_cast<std::size_t>(e)].pose;
        pose.position = last_place_;
        const glm::dvec3 aside(static_cast<double>(e == kLeft ? -kHalfIpdMetres : kHalfIpdMetres), 0.0, 0.0);
        pose.position = toXr(transform(fromXr(pose), aside));
    }
    return located.eyes;
}

std::optional<Pose> Spaces::locateHead(XrTime time) const {
    const Located located = locate(room(), time);
    return located.place_known ? std::optional(headOf(located.eyes)) : std::nullopt;
}

bool Spaces::settle(XrTime time, bool demanded) {
    const bool moved = recentred_from_ && time >= *recentred_from_;
    if (turn_settled_ && place_settled_ && !moved && !demanded) { return false; }
    Located located = locate(local_.get(), time);
    // A headset that never knows its position can still turn.
    const bool first = !turn_settled_ || (!place_settled_ && located.place_known);
    if (!located.turn_known || (!first && !moved && !demanded)) { return false; }
    if (!located.place_known) {
        for (EyeView& eye : located.eyes) { eye.pose.position = {}; }
    }
    room_ = makeSpace(session_, XR_REFERENCE_SPACE_TYPE_LOCAL, toXr(upright(headOf(located.eyes))));
    turn_settled_ = true;
    place_settled_ = located.place_known;
    recentred_from_.reset();
    last_place_ = {};
    return true;
}

}  // namespace binosplat::xr
