// OpenXR's actions: made, bound to what controllers have, and read.
#pragma once

#include "engine/geometry.h"
#include "xr/own.h"
#include "xr/session.h"

#include <optional>
#include <span>
#include <string>

namespace binosplat::xr {

// The session's only set of actions. Actions are made first, then bound, then attached, then read.
class Actions {
public:
    explicit Actions(const Session& session);

    // One for each of `hands`, or one in all.
    [[nodiscard]] XrAction make(const char* name, const char* description, XrActionType type, std::span<const XrPath> hands = {}) const;
    // `profile` is below /interaction_profiles. A runtime need not know it: returns what it says, but throws InstanceLost.
    [[nodiscard]] XrResult suggest(const std::string& profile, std::span<const XrActionSuggestedBinding> bindings) const;
    void attach() const;
    // Where a pose action is; of one hand, or of no hand in particular.
    [[nodiscard]] OwnedSpace makeSpace(XrAction action, XrPath hand = XR_NULL_PATH) const;

    // As of now on; false while another program has the input.
    [[nodiscard]] bool sync() const;
    // Empty: there is none.
    [[nodiscard]] std::optional<double> readNumber(XrAction action, XrPath hand) const;
    [[nodiscard]] std::optional<bool> readButton(XrAction action, XrPath hand) const;
    // At rest where there is none.
    [[nodiscard]] glm::dvec2 readStick(XrAction action, XrPath hand) const;
    // At the open frame's display time, in the room; empty unless the location has all of `needed`.
    [[nodiscard]] std::optional<Pose> locate(XrAction action, XrPath hand, const OwnedSpace& space, XrSpaceLocationFlags needed) const;

    static constexpr XrSpaceLocationFlags kKnown = XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT;
    static constexpr XrSpaceLocationFlags kTracked = XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT;

private:
    const Session& session_;
    OwnedActionSet set_;  // the instance's: it would outlive the session
};

}  // namespace binosplat::xr
