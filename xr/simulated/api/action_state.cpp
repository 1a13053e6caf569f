// Chapter 11: attaching, synchronizing and reading actions.
#include <algorithm>

#include "xr/simulated/api/actions.h"
#include "xr/simulated/api/api.h"
#include "xr/simulated/api/profiles.h"
#include "xr/simulated/api/session.h"
#include "xr/simulated/api/structures.h"

namespace simulated {
namespace {

AttachedAction attach(const Action& action, const ActionSet& set) {
    AttachedAction attached{
        action.number, set.number, set.priority, action.type, action.subaction_paths, {}, {}};
    attached.readings[XR_NULL_PATH] = {};
    for (const XrPath path : action.subaction_paths) { attached.readings[path] = {}; }
    return attached;
}

std::vector<ActiveSet> checkActiveSets(const Session& session, const XrActionsSyncInfo& info) {
    std::vector<ActiveSet> active;
    for (const auto& [handle, path] :
         checkArray(info.activeActionSets, info.countActiveActionSets, "action sets")) {
        const ActionSet& described = getActionSet(session.instance, handle);
        const std::uint64_t set = described.number;
        const bool is_attached = session.attachment && std::count(session.attachment->sets.begin(),
                                                                  session.attachment->sets.end(), set) > 0;
        require(is_attached, XR_ERROR_ACTIONSET_NOT_ATTACHED, "the action set ", described.name,
                " is not attached to this session");
        std::vector<XrPath> declared;
        for (const AttachedAction& action : session.attachment->actions) {
            if (action.set == set) {
                declared.insert(declared.end(), action.subaction_paths.begin(), action.subaction_paths.end());
            }
        }
        checkSubactionPath(session.instance, declared, path);
        active.push_back({set, path});
    }
    return active;
}

// Shared by the four xrGetActionState functions.
const ActionReading& readingFor(Session& session, const XrActionStateGetInfo* getInfo, XrActionType type) {
    const XrActionStateGetInfo& info = checkStruct(getInfo, XR_TYPE_ACTION_STATE_GET_INFO);
    const AttachedAction& action = getAttached(session, info.action);
    require(action.type == type, XR_ERROR_ACTION_TYPE_MISMATCH, "the action ",
            getAction(session.instance, info.action).name, " is of another type");
    checkSubactionPath(session.instance, action.subaction_paths, info.subactionPath);
    static constexpr ActionReading kInactive;
    return session.is_running ? action.readings.at(info.subactionPath) : kInactive;
}

template <typename State, typename ValueOf>
XrResult answerState(const char* call, XrSession session, const XrActionStateGetInfo* getInfo,
                     XrActionType type, State* state, XrStructureType state_type, const ValueOf& valueOf) {
    return answerFor<Session>(call, session, [&](Session& owner) {
        const ActionReading& reading = readingFor(owner, getInfo, type);
        State& output = checkStruct(state, state_type);
        output.currentState = valueOf(reading.value);
        output.changedSinceLastSync = reading.has_changed;
        output.lastChangeTime = reading.changed_at;
        output.isActive = reading.is_active;
    });
}

}  // namespace

XrResult xrAttachSessionActionSets(XrSession session, const XrSessionActionSetsAttachInfo* attachInfo) {
    return answerFor<Session>(__func__, session, [&](Session& owner) {
        const XrSessionActionSetsAttachInfo& info =
            checkStruct(attachInfo, XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO);
        require(info.countActionSets > 0 && info.actionSets != nullptr, XR_ERROR_VALIDATION_FAILURE,
                "no action sets");
        require(!owner.attachment, XR_ERROR_ACTIONSETS_ALREADY_ATTACHED,
                "action sets are attached once per session");
        std::vector<ActionSet*> sets;
        for (std::uint32_t i = 0; i < info.countActionSets; ++i) {
            sets.push_back(&getActionSet(owner.instance, info.actionSets[i]));
        }
        Attachment attachment;
        attachment.suggestions = owner.instance.suggestions;
        for (ActionSet* const set : sets) {
            if (std::count(attachment.sets.begin(), attachment.sets.end(), set->number) > 0) { continue; }
            set->is_attached = true;
            attachment.sets.push_back(set->number);
            for (const auto& child : set->children) {
                attachment.actions.push_back(attach(dynamic_cast<const Action&>(*child), *set));
            }
        }
        owner.attachment = std::move(attachment);
    });
}

XrResult xrSyncActions(XrSession session, const XrActionsSyncInfo* syncInfo) {
    return answerFor<Session>(__func__, session, [&](Session& owner) {
        const XrActionsSyncInfo& info = checkStruct(syncInfo, XR_TYPE_ACTIONS_SYNC_INFO);
        const std::vector<ActiveSet> active = checkActiveSets(owner, info);
        if (owner.isHeadless() && owner.is_running) { owner.passHeadlessFrame(); }
        const bool is_focused = owner.state == XR_SESSION_STATE_FOCUSED;
        if (owner.attachment) {
            const Clock& clock = owner.instance.simulation->clock;
            const XrTime now = clock.now();
            if (is_focused &&
                owner.attachment->chooseProfiles(owner.instance, owner.automation, clock.secondsAt(now))) {
                owner.instance.events.push(XrEventDataInteractionProfileChanged{
                    XR_TYPE_EVENT_DATA_INTERACTION_PROFILE_CHANGED, nullptr, session});
            }
            owner.attachment->read(owner.at(now), is_focused ? active : std::vector<ActiveSet>{}, now);
        }
        return is_focused ? XR_SUCCESS : XR_SESSION_NOT_FOCUSED;
    });
}

XrResult xrGetActionStateBoolean(XrSession session, const XrActionStateGetInfo* getInfo,
                                 XrActionStateBoolean* state) {
    return answerState(__func__, session, getInfo, XR_ACTION_TYPE_BOOLEAN_INPUT, state,
                       XR_TYPE_ACTION_STATE_BOOLEAN,
                       [](const glm::dvec2& value) { return static_cast<XrBool32>(value.x > 0); });
}

XrResult xrGetActionStateFloat(XrSession session, const XrActionStateGetInfo* getInfo,
                               XrActionStateFloat* state) {
    return answerState(__func__, session, getInfo, XR_ACTION_TYPE_FLOAT_INPUT, state,
                       XR_TYPE_ACTION_STATE_FLOAT,
                       [](const glm::dvec2& value) { return static_cast<float>(value.x); });
}

XrResult xrGetActionStateVector2f(XrSession session, const XrActionStateGetInfo* getInfo,
                                  XrActionStateVector2f* state) {
    return answerState(__func__, session, getInfo, XR_ACTION_TYPE_VECTOR2F_INPUT, state,
                       XR_TYPE_ACTION_STATE_VECTOR2F, [](const glm::dvec2& value) {
                           return XrVector2f{static_cast<float>(value.x), static_cast<float>(value.y)};
                       });
}

XrResult xrGetActionStatePose(XrSession session, const XrActionStateGetInfo* getInfo,
                              XrActionStatePose* state) {
    return answerFor<Session>(__func__, session, [&](Session& owner) {
        const ActionReading& reading = readingFor(owner, getInfo, XR_ACTION_TYPE_POSE_INPUT);
        checkStruct(state, XR_TYPE_ACTION_STATE_POSE).isActive = reading.is_active;
    });
}

}  // namespace simulated
