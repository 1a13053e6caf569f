// OpenXR's actions: making, binding and reading them.
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

    // With a state for each of `hands`, or a single one.
    [[nodiscard]] XrAction make(const char* name, const char* description, XrActionType type,
                                std::span<const XrPath> hands = {}) const;
    // `profile` is relative to /interaction_profiles. A runtime need not know it: returns the result, but
    // throws InstanceLost.
    [[nodiscard]] XrResult suggest(const std::string& profile,
                                   std::span<const XrActionSuggestedBinding> bindings) const;
    void attach() const;
    // The space of a pose action, for one hand or for none in particular.
    [[nodiscard]] OwnedSpace makeSpace(XrAction action, XrPath hand = XR_NULL_PATH) const;

    // Updates the states read below; false while another program has the input.
    [[nodiscard]] bool sync() const;
    // Empty if the action is inactive.
    [[nodiscard]] std::optional<double> readNumber(XrAction action, XrPath hand) const;
    [[nodiscard]] std::optional<bool> readButton(XrAction action, XrPath hand) const;
    // Zero if the action is inactive.
    [[nodiscard]] glm::dvec2 readStick(XrAction action, XrPath hand) const;
    // At the open frame's display time, in the room; empty unless the location has all of `needed`.
    [[nodiscard]] std::optional<Pose> locate(XrAction action, XrPath hand, const OwnedSpace& space,
                                             XrSpaceLocationFlags needed) const;

    static constexpr XrSpaceLocationFlags kKnown =
        XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT;
    static constexpr XrSpaceLocationFlags kTracked =
        XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT;

private:
    const Session& session_;
    OwnedActionSet set_;  // belongs to the instance: it would outlive the session
};

}  // namespace binosplat::xr
