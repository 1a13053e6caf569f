// Chapter 11, first half: action sets and actions as the application describes them.
#pragma once

#include <string>
#include <vector>

#include "xr/simulated/api/handles.h"

namespace simulated {

struct Instance;

struct ActionSet : Object {
    using Handle = XrActionSet;

    std::string name, localized_name;
    std::uint32_t priority = 0;
    // Attached to any session: from then on it does not change.
    bool is_attached = false;
};

struct Action : Object {
    using Handle = XrAction;

    std::string name, localized_name;
    XrActionType type = XR_ACTION_TYPE_BOOLEAN_INPUT;
    std::vector<XrPath> subaction_paths;

    [[nodiscard]] ActionSet& set() const { return dynamic_cast<ActionSet&>(*parent); }
};

// XR_ERROR_HANDLE_INVALID also for handles of another instance.
ActionSet& getActionSet(const Instance& instance, XrActionSet set);
Action& getAction(const Instance& instance, XrAction action);

// XR_NULL_PATH stands for all of them. XR_ERROR_PATH_INVALID, XR_ERROR_PATH_UNSUPPORTED.
void checkSubactionPath(const Instance& instance, const std::vector<XrPath>& declared, XrPath path);

}  // namespace simulated
