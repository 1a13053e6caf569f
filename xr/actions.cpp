// OpenXR's calls for actions.
#include "xr/actions.h"

#include "xr/convert.h"

#include <cstring>

namespace binosplat::xr {
namespace {

// Reads an action's state with `get`; `name` is that function's, for messages.
template <typename State>
State ask(XrResult(XRAPI_PTR* get)(XrSession, const XrActionStateGetInfo*, State*), const char* name,
          XrStructureType type, const Session& session, XrAction action, XrPath hand) {
    auto info = structure<XrActionStateGetInfo>(XR_TYPE_ACTION_STATE_GET_INFO);
    info.action = action;
    info.subactionPath = hand;
    auto state = structure<State>(type);
    checkResult(get(session.handle(), &info, &state), name);
    return state;
}

}  // namespace

Actions::Actions(const Session& session) : session_(session) {
    auto info = structure<XrActionSetCreateInfo>(XR_TYPE_ACTION_SET_CREATE_INFO);
    std::strcpy(info.actionSetName, "viewer");
    std::strcpy(info.localizedActionSetName, "Viewer");
    XrActionSet made = XR_NULL_HANDLE;
    BINOSPLAT_XR(xrCreateActionSet(session.instance().handle(), &info, &made));
    set_.reset(made);
}

XrAction Actions::make(const char* name, const char* description, XrActionType type,
                       std::span<const XrPath> hands) const {
    auto info = structure<XrActionCreateInfo>(XR_TYPE_ACTION_CREATE_INFO);
    std::strcpy(info.actionName, name);
    std::strcpy(info.localizedActionName, description);
    info.actionType = type;
    info.countSubactionPaths = static_cast<std::uint32_t>(hands.size());
    info.subactionPaths = hands.data();
    XrAction action = XR_NULL_HANDLE;
    BINOSPLAT_XR(xrCreateAction(set_.get(), &info, &action));
    return action;
}

XrResult Actions::suggest(const std::string& profile,
                          std::span<const XrActionSuggestedBinding> bindings) const {
    const Instance& instance = session_.instance();
    auto suggestion =
        structure<XrInteractionProfileSuggestedBinding>(XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING);
    suggestion.interactionProfile = instance.path(fmt::format("/interaction_profiles/{}", profile).c_str());
    suggestion.countSuggestedBindings = static_cast<std::uint32_t>(bindings.size());
    suggestion.suggestedBindings = bindings.data();
    const XrResult result = xrSuggestInteractionProfileBindings(instance.handle(), &suggestion);
    if (result == XR_ERROR_INSTANCE_LOST) { checkResult(result, "xrSuggestInteractionProfileBindings"); }
    return result;
}

void Actions::attach() const {
    const XrActionSet set = set_.get();
    auto info = structure<XrSessionActionSetsAttachInfo>(XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO);
    info.countActionSets = 1;
    info.actionSets = &set;
    BINOSPLAT_XR(xrAttachSessionActionSets(session_.handle(), &info));
}

OwnedSpace Actions::makeSpace(XrAction action, XrPath hand) const {
    auto info = structure<XrActionSpaceCreateInfo>(XR_TYPE_ACTION_SPACE_CREATE_INFO);
    info.action = action;
    info.subactionPath = hand;
    info.poseInActionSpace.orientation.w = 1.0f;
    XrSpace space = XR_NULL_HANDLE;
    BINOSPLAT_XR(xrCreateActionSpace(session_.handle(), &info, &space));
    return OwnedSpace(space);
}

bool Actions::sync() const {
    const XrActiveActionSet active{set_.get(), XR_NULL_PATH};
    auto info = structure<XrActionsSyncInfo>(XR_TYPE_ACTIONS_SYNC_INFO);
    info.countActiveActionSets = 1;
    info.activeActionSets = &active;
    return BINOSPLAT_XR(xrSyncActions(session_.handle(), &info)) != XR_SESSION_NOT_FOCUSED;
}

std::optional<double> Actions::readNumber(XrAction action, XrPath hand) const {
    const auto state = ask(xrGetActionStateFloat, "xrGetActionStateFloat", XR_TYPE_ACTION_STATE_FLOAT,
                           session_, action, hand);
    if (state.isActive != XR_TRUE) { return std::nullopt; }
    return static_cast<double>(state.currentState);
}

std::optional<bool> Actions::readButton(XrAction action, XrPath hand) const {
    const auto state = ask(xrGetActionStateBoolean, "xrGetActionStateBoolean", XR_TYPE_ACTION_STATE_BOOLEAN,
                           session_, action, hand);
    if (state.isActive != XR_TRUE) { return std::nullopt; }
    return state.currentState == XR_TRUE;
}

glm::dvec2 Actions::readStick(XrAction action, XrPath hand) const {
    const auto state = ask(xrGetActionStateVector2f, "xrGetActionStateVector2f",
                           XR_TYPE_ACTION_STATE_VECTOR2F, session_, action, hand);
    return state.isActive == XR_TRUE ? glm::dvec2(glm::vec2(state.currentState.x, state.currentState.y))
                                     : glm::dvec2(0.0);
}

std::optional<Pose> Actions::locate(XrAction action, XrPath hand, const OwnedSpace& space,
                                    XrSpaceLocationFlags needed) const {
    const auto state =
        ask(xrGetActionStatePose, "xrGetActionStatePose", XR_TYPE_ACTION_STATE_POSE, session_, action, hand);
    if (state.isActive != XR_TRUE) { return std::nullopt; }
    auto location = structure<XrSpaceLocation>(XR_TYPE_SPACE_LOCATION);
    BINOSPLAT_XR(xrLocateSpace(space.get(), session_.space(), session_.displayTime(), &location));
    if ((location.locationFlags & needed) != needed) { return std::nullopt; }
    return fromXr(location.pose);
}

}  // namespace binosplat::xr
