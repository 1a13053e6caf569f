// Finds the controls that attached actions are bound to, which of them count, and what they read.
#include "xr/simulated/api/attachment.h"

#include <algorithm>
#include <numbers>

#include "xr/simulated/api/actions.h"
#include "xr/simulated/api/automation.h"
#include "xr/simulated/api/profiles.h"
#include "xr/simulated/api/session.h"
#include "xr/simulated/script/script_profile.h"

namespace simulated {
namespace {

constexpr double kPressed = 0.5;

glm::dvec2 valueOf(const ControllerState& controller, const BoundSource& source, XrActionType type) {
    if (type == XR_ACTION_TYPE_VECTOR2F_INPUT) {
        return {controller.input(source.component + "/x"), controller.input(source.component + "/y")};
    }
    const double value = controller.input(source.component);
    if (type == XR_ACTION_TYPE_BOOLEAN_INPUT) { return {value >= kPressed ? 1.0 : 0.0, 0.0}; }
    return {value, 0.0};
}

Pose poseOf(const ControllerState& controller, const BoundSource& source) {
    if (source.source == "aim" || source.source == "gaze_ext") { return controller.stage_from_aim; }
    return compose(controller.stage_from_grip, gripFromPose(source.component, source.device));
}

bool isActivatedBy(const ActiveSet& active, const AttachedAction& action, const BoundSource& source) {
    return active.set == action.set &&
           (active.subaction_path == XR_NULL_PATH || active.subaction_path == source.user_path);
}

bool isActivated(const std::vector<ActiveSet>& active, const AttachedAction& action,
                 const BoundSource& source) {
    return std::any_of(active.begin(), active.end(),
                       [&](const ActiveSet& set) { return isActivatedBy(set, action, source); });
}

using Priorities = std::map<std::pair<std::size_t, std::string>, std::uint32_t>;

// The highest priority that any active action has on each source; lower ones count as unbound.
Priorities findHighestPriorities(const std::vector<AttachedAction>& actions,
                                 const std::vector<ActiveSet>& active) {
    Priorities highest;
    for (const AttachedAction& action : actions) {
        for (const BoundSource& source : action.sources) {
            if (!isActivated(active, action, source)) { continue; }
            auto& priority = highest[{source.device, source.source}];
            priority = std::max(priority, action.priority);
        }
    }
    return highest;
}

ActionReading readAction(const AttachedAction& action, XrPath subaction_path, const State& state,
                         const std::vector<ActiveSet>& active, const Priorities& highest) {
    ActionReading reading;
    const std::optional<std::size_t> followed_before = action.readings.at(subaction_path).followed;
    bool keeps_followed = false;
    for (std::size_t i = 0; i < action.sources.size(); ++i) {
        const BoundSource& source = action.sources[i];
        if (subaction_path != XR_NULL_PATH && source.user_path != subaction_path) { continue; }
        if (!isActivated(active, action, source) ||
            action.priority < highest.at({source.device, source.source})) {
            continue;
        }
        reading.is_activated = true;
        keeps_followed = keeps_followed || followed_before == i;
        const ControllerState& controller = state.device(source.device);
        if (!controller.tracked) { continue; }
        reading.is_active = true;
        if (!reading.followed) { reading.followed = i; }
        if (action.type == XR_ACTION_TYPE_POSE_INPUT || action.type == XR_ACTION_TYPE_VIBRATION_OUTPUT) {
            continue;
        }
        // Among several sources, the strongest counts; for booleans that is "or".
        const glm::dvec2 value = valueOf(controller, source, action.type);
        if (glm::dot(value, value) > glm::dot(reading.value, reading.value)) { reading.value = value; }
    }
    if (keeps_followed || !reading.followed) { reading.followed = followed_before; }
    return reading;
}

}  // namespace

Pose gripFromPose(std::string_view component, std::size_t device) {
    // For a right hand; a straight finger points along the grip's -y.
    double turn = 0.25;
    glm::dvec3 place_m(0.02, 0.0, 0.0);
    if (component == "pinch_ext/pose") { place_m = {0.01, -0.07, -0.05}; }
    if (component == "poke_ext/pose") {
        turn = 0.5;
        place_m = {0.02, -0.115, -0.027};
    }
    if (component == "grip/pose") { return {}; }
    if (device == kLeftHand) { place_m.x = -place_m.x; }
    return {glm::angleAxis(-turn * std::numbers::pi, glm::dvec3(1, 0, 0)), place_m};
}

AttachedAction* Attachment::find(std::uint64_t action) {
    const auto found = std::find_if(actions.begin(), actions.end(),
                                    [&](const auto& attached) { return attached.number == action; });
    return found == actions.end() ? nullptr : &*found;
}

bool Attachment::isSuggested(const Instance& instance, const Profile& profile) const {
    const XrPath path = instance.paths.findPath(profile.path);
    return std::any_of(suggestions.begin(), suggestions.end(),
                       [&](const auto& one) { return one.profile == path; });
}

bool Attachment::chooseProfiles(Instance& instance, const Automation& automation, double time_s) {
    const Simulation& simulation = *instance.simulation;
    const std::string later = simulation.script.later_profiles.at(time_s);
    const std::string now_wanted =
        later.empty() ? simulation.favourite_profile : std::string(findHandProfile(later)->path);
    if (now_wanted != hands_wanted) {
        hands = nullptr;
        std::vector<Profile> candidates(listProfiles().begin(), listProfiles().end());
        std::stable_partition(candidates.begin(), candidates.end(),
                              [&](const Profile& one) { return one.path == now_wanted; });
        for (const Profile& candidate : candidates) {
            if (!candidate.user_paths.front().starts_with("/user/hand/") ||
                !isSuggested(instance, candidate)) {
                continue;
            }
            if (!hands_wanted) { checkInputs(simulation.script, candidate); }
            hands = findProfile(candidate.path);
            break;
        }
        hands_wanted = now_wanted;
    }
    std::array<const Profile*, kDevices> chosen{hands, hands};
    const Profile* const tracker = findProfile("/interaction_profiles/ext/eye_gaze_interaction");
    const bool tracks_eyes = simulation.script.gaze.tracker != EyeTracking::kOff;
    if (tracks_eyes && isSuggested(instance, *tracker)) { chosen[kGaze] = tracker; }
    const Profile* const gamepad = findProfile("/interaction_profiles/microsoft/xbox_controller");
    if (simulation.script.gamepad.isThere() && isSuggested(instance, *gamepad)) {
        chosen[kGamepad] = gamepad;
    }
    for (std::size_t device = 0; device < kDevices; ++device) {
        const Profile* const wanted = automation.devices[device].profile;
        if (wanted != nullptr) { chosen[device] = isSuggested(instance, *wanted) ? wanted : nullptr; }
    }
    if (chosen == profiles) { return false; }
    profiles = chosen;
    bindSources(instance);
    return true;
}

void Attachment::bindSources(const Instance& instance) {
    for (AttachedAction& action : actions) {
        action.sources.clear();
        for (auto& [subaction_path, reading] : action.readings) { reading.followed.reset(); }
    }
    for (const SuggestedProfile& suggested : suggestions) {
        const Profile* const profile = findProfile(instance.paths.textOf(suggested.profile));
        for (const SuggestedBinding& binding : suggested.bindings) {
            AttachedAction* const action = find(binding.action);
            if (action == nullptr) { continue; }
            auto source = bindSource(instance, *profile, binding.path, action->type);
            if (source && profiles[source->device] == profile) {
                action->sources.push_back(std::move(*source));
            }
        }
    }
}

void Attachment::read(const State& state, const std::vector<ActiveSet>& active, XrTime time) {
    const Priorities highest = findHighestPriorities(actions, active);
    for (AttachedAction& action : actions) {
        for (auto& [subaction_path, reading] : action.readings) {
            ActionReading now = readAction(action, subaction_path, state, active, highest);
            if (now.is_active) {
                now.has_changed = reading.is_active && now.value != reading.value;
                now.changed_at = reading.is_active && !now.has_changed ? reading.changed_at : time;
            }
            reading = now;
        }
    }
}

AttachedAction& getAttached(Session& session, XrAction action) {
    const Action& described = getAction(session.instance, action);
    AttachedAction* const attached =
        session.attachment ? session.attachment->find(described.number) : nullptr;
    require(attached != nullptr, XR_ERROR_ACTIONSET_NOT_ATTACHED, "the set of the action ", described.name,
            " is not attached to this session");
    return *attached;
}

namespace {

// An action and what it read; null if it is not attached, or the session is not running.
std::pair<const AttachedAction*, const ActionReading*> readingOf(const Session& session, std::uint64_t action,
                                                                 XrPath subaction_path) {
    if (!session.attachment || !session.is_running) { return {}; }
    for (const AttachedAction& attached : session.attachment->actions) {
        if (attached.number != action) { continue; }
        const auto reading = attached.readings.find(subaction_path);
        if (reading != attached.readings.end()) { return {&attached, &reading->second}; }
    }
    return {};
}

// The source of a pose action; null while it is inactive.
const BoundSource* sourceOf(const Session& session, std::uint64_t action, XrPath subaction_path) {
    const auto [attached, reading] = readingOf(session, action, subaction_path);
    if (reading == nullptr || !reading->is_active || !reading->followed) { return nullptr; }
    return &attached->sources[*reading->followed];
}

}  // namespace

std::optional<Pose> stageFromAction(const Session& session, std::uint64_t action, XrPath subaction_path,
                                    const State& state) {
    const BoundSource* const source = sourceOf(session, action, subaction_path);
    if (source == nullptr || !state.device(source->device).tracked) { return std::nullopt; }
    return poseOf(state.device(source->device), *source);
}

bool isLocatable(const Session& session, std::uint64_t action, XrPath subaction_path) {
    const ActionReading* const reading = readingOf(session, action, subaction_path).second;
    return reading != nullptr && reading->is_activated;
}

bool isOfGaze(const Session& session, std::uint64_t action, XrPath subaction_path) {
    const BoundSource* const source = sourceOf(session, action, subaction_path);
    return source != nullptr && source->device == kGaze;
}

}  // namespace simulated
