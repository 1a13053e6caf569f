// Making action sets and actions, checks of their names and subaction paths, and the bindings that an
// application suggests.
#include "xr/simulated/api/actions.h"

#include <algorithm>

#include "xr/simulated/api/api.h"
#include "xr/simulated/api/instance.h"
#include "xr/simulated/api/profiles.h"
#include "xr/simulated/api/structures.h"

namespace simulated {
namespace {

void checkNames(const std::string& name, const std::string& localized_name) {
    require(!name.empty(), XR_ERROR_NAME_INVALID, "the name is empty");
    require(!localized_name.empty(), XR_ERROR_LOCALIZED_NAME_INVALID, name, ": the localized name is empty");
    require(isPathLevel(name), XR_ERROR_PATH_FORMAT_INVALID, name,
            ": a name has characters that a path may not have");
}

// Only among live objects: a destroyed one frees its names.
template <class T>
void checkUnique(const Object& parent, const std::string& name, const std::string& localized_name) {
    for (const auto& child : parent.children) {
        const T* const sibling = dynamic_cast<const T*>(child.get());
        if (sibling == nullptr) { continue; }
        require(sibling->name != name, XR_ERROR_NAME_DUPLICATED, name, ": the name is taken");
        require(sibling->localized_name != localized_name, XR_ERROR_LOCALIZED_NAME_DUPLICATED, localized_name,
                ": the localized name is taken");
    }
}

std::vector<XrPath> checkSubactionPaths(const Instance& instance, const XrActionCreateInfo& info) {
    std::vector<XrPath> paths;
    for (const XrPath path : checkArray(info.subactionPaths, info.countSubactionPaths, "subaction paths")) {
        const std::string& text = instance.paths.textOf(path);
        require(deviceOf(text) && instance.hasUserPath(text), XR_ERROR_PATH_UNSUPPORTED, text,
                " is not a subaction path");
        require(std::find(paths.begin(), paths.end(), path) == paths.end(), XR_ERROR_PATH_UNSUPPORTED,
                "the subaction path ", text, " comes twice");
        paths.push_back(path);
    }
    return paths;
}

}  // namespace

ActionSet& getActionSet(const Instance& instance, XrActionSet set) {
    ActionSet& found = get<ActionSet>(set);
    if (found.parent != &instance) { refuseHandle(set, " of this instance"); }
    return found;
}

Action& getAction(const Instance& instance, XrAction action) {
    Action& found = get<Action>(action);
    if (found.parent->parent != &instance) { refuseHandle(action, " of this instance"); }
    return found;
}

void checkSubactionPath(const Instance& instance, const std::vector<XrPath>& declared, XrPath path) {
    if (path == XR_NULL_PATH) { return; }
    const std::string& text = instance.paths.textOf(path);
    require(std::find(declared.begin(), declared.end(), path) != declared.end(), XR_ERROR_PATH_UNSUPPORTED,
            text, " is not among the subaction paths that were declared");
}

XrResult xrCreateActionSet(XrInstance instance, const XrActionSetCreateInfo* createInfo,
                           XrActionSet* actionSet) {
    return answerFor<Instance>(__func__, instance, [&](Instance& owner) {
        const XrActionSetCreateInfo& info = checkStruct(createInfo, XR_TYPE_ACTION_SET_CREATE_INFO);
        XrActionSet& output = checkOutput(actionSet);
        auto created = std::make_unique<ActionSet>();
        created->name = textOf(info.actionSetName);
        created->localized_name = textOf(info.localizedActionSetName);
        created->priority = info.priority;
        checkNames(created->name, created->localized_name);
        checkUnique<ActionSet>(owner, created->name, created->localized_name);
        output = handleOf(adopt(owner, std::move(created)));
    });
}

XrResult xrDestroyActionSet(XrActionSet actionSet) {
    return answer(__func__, [&] { destroyObject(get<ActionSet>(actionSet)); });
}

XrResult xrCreateAction(XrActionSet actionSet, const XrActionCreateInfo* createInfo, XrAction* action) {
    return answer(__func__, [&] {
        ActionSet& set = get<ActionSet>(actionSet);
        const auto& instance = dynamic_cast<const Instance&>(*set.parent);
        checkNotLost(instance);
        const XrActionCreateInfo& info = checkStruct(createInfo, XR_TYPE_ACTION_CREATE_INFO);
        XrAction& output = checkOutput(action);
        require(!set.is_attached, XR_ERROR_ACTIONSETS_ALREADY_ATTACHED, "the action set ", set.name,
                " is attached already");
        switch (info.actionType) {
            case XR_ACTION_TYPE_BOOLEAN_INPUT:
            case XR_ACTION_TYPE_FLOAT_INPUT:
            case XR_ACTION_TYPE_VECTOR2F_INPUT:
            case XR_ACTION_TYPE_POSE_INPUT:
            case XR_ACTION_TYPE_VIBRATION_OUTPUT:
                break;
            default:
                refuse(XR_ERROR_VALIDATION_FAILURE, info.actionType, " is not a type of action");
        }
        auto created = std::make_unique<Action>();
        created->name = textOf(info.actionName);
        created->localized_name = textOf(info.localizedActionName);
        created->type = info.actionType;
        created->subaction_paths = checkSubactionPaths(instance, info);
        checkNames(created->name, created->localized_name);
        checkUnique<Action>(set, created->name, created->localized_name);
        output = handleOf(adopt(set, std::move(created)));
    });
}

XrResult xrDestroyAction(XrAction action) {
    return answer(__func__, [&] { destroyObject(get<Action>(action)); });
}

XrResult xrSuggestInteractionProfileBindings(XrInstance instance,
                                             const XrInteractionProfileSuggestedBinding* suggestedBindings) {
    return answerFor<Instance>(__func__, instance, [&](Instance& owner) {
        const XrInteractionProfileSuggestedBinding& info =
            checkStruct(suggestedBindings, XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING);
        const std::string& name = owner.paths.textOf(info.interactionProfile);
        const Profile* const profile = findProfile(name);
        require(profile != nullptr, XR_ERROR_PATH_UNSUPPORTED, name, " is not an interaction profile");
        require(owner.has(*profile), XR_ERROR_PATH_UNSUPPORTED, name, " needs ", profile->depends);
        require(info.countSuggestedBindings > 0 && info.suggestedBindings != nullptr,
                XR_ERROR_VALIDATION_FAILURE, name, ": no bindings are suggested");
        SuggestedProfile suggested{info.interactionProfile, {}};
        for (std::uint32_t i = 0; i < info.countSuggestedBindings; ++i) {
            const Action& action = getAction(owner, info.suggestedBindings[i].action);
            require(!action.set().is_attached, XR_ERROR_ACTIONSETS_ALREADY_ATTACHED, "the action set ",
                    action.set().name, " is attached already");
            const XrPath path = info.suggestedBindings[i].binding;
            const std::string& binding = owner.paths.textOf(path);
            if (!allowsBinding(*profile, binding, owner)) {
                const std::string_view needed = findNeeded(*profile, binding);
                refuse(XR_ERROR_PATH_UNSUPPORTED, name, " has no ", binding,
                       needed.empty() ? "" : " without ", needed, ", suggested for the action ", action.name);
            }
            suggested.bindings.push_back({action.number, path});
        }
        std::erase_if(owner.suggestions,
                      [&](const auto& earlier) { return earlier.profile == suggested.profile; });
        owner.suggestions.push_back(std::move(suggested));
    });
}

}  // namespace simulated
