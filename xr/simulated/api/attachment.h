// Chapter 11, second half: action sets attached to a session, and what their actions read. It keeps
// everything by value, since an application may destroy its handles and still locate its action spaces.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "xr/simulated/api/bindings.h"
#include "xr/simulated/api/bound_source.h"
#include "xr/simulated/script/script.h"

namespace simulated {

struct Instance;
struct Session;
struct Profile;
struct Automation;

// As of the last xrSyncActions, for one subaction path or for all.
struct ActionReading {
    bool is_active = false;
    bool is_activated = false;   // a source of the action was to be read, even if it was not tracked
    glm::dvec2 value{0.0, 0.0};  // booleans are 0 or 1, scalars have y = 0
    bool has_changed = false;
    XrTime changed_at = 0;
    // For a pose, which of the action's sources its spaces follow. It is kept for as long as xrSyncActions
    // activates it, even while it is not tracked.
    std::optional<std::size_t> followed;
};

struct AttachedAction {
    std::uint64_t number, set;
    std::uint32_t priority;
    XrActionType type;
    std::vector<XrPath> subaction_paths;
    std::vector<BoundSource> sources;
    // By subaction path; XR_NULL_PATH is all of them.
    std::map<XrPath, ActionReading> readings;
};

struct ActiveSet {
    std::uint64_t set;
    XrPath subaction_path;
};

struct Attachment {
    std::vector<std::uint64_t> sets;
    std::vector<SuggestedProfile> suggestions;
    std::vector<AttachedAction> actions;
    // The profile that each device simulates; none before the first xrSyncActions in focus.
    std::array<const Profile*, kDevices> profiles{};
    // The profile chosen for the hands, and the one that was wanted at that time; empty: any.
    const Profile* hands = nullptr;
    std::optional<std::string> hands_wanted;

    [[nodiscard]] AttachedAction* find(std::uint64_t action);
    // True if any device now simulates a different profile. Throws ScriptError if the script moves inputs
    // that the controllers lack.
    bool chooseProfiles(Instance& instance, const Automation& automation, double time_s);
    [[nodiscard]] bool isSuggested(const Instance& instance, const Profile& profile) const;
    void bindSources(const Instance& instance);
    void read(const State& state, const std::vector<ActiveSet>& active, XrTime time);
};

// For "grip/pose", "grip_surface/pose" (or "palm_ext/pose"), "pinch_ext/pose" and "poke_ext/pose". The palm's
// surface is next to what the hand holds: to its left in the left hand, to its right in the right hand. A
// straight index finger points halfway between the direction of the held tube, -z, and that of an open hand's
// fingers, -y. Fingertips are where an open hand has them.
Pose gripFromPose(std::string_view component, std::size_t device);

// XR_ERROR_ACTIONSET_NOT_ATTACHED.
AttachedAction& getAttached(Session& session, XrAction action);

// Where a pose action's source is; empty while it is inactive.
std::optional<Pose> stageFromAction(const Session& session, std::uint64_t action, XrPath subaction_path,
                                    const State& state);
// True if the last sync activated the action with a source; otherwise its spaces cannot be located, not even
// in one another.
bool isLocatable(const Session& session, std::uint64_t action, XrPath subaction_path);
// True if the action's source is the eye tracker.
bool isOfGaze(const Session& session, std::uint64_t action, XrPath subaction_path);

}  // namespace simulated
