// Names from the lists in OpenXR's own headers, and of values that these may not have yet.
#include "xr/simulated/names.h"

#include <openxr/openxr_reflection.h>

#include <span>

namespace simulated {

#define SIMULATED_CASE(name, value) \
    case name:                      \
        return #name;

namespace {

// Values that the headers may not list yet.
template <class Value>
struct LaterName {
    Value value;
    const char* name;
};

constexpr LaterName<XrResult> kLaterResults[] = {
    {XR_ERROR_PERMISSION_INSUFFICIENT, "XR_ERROR_PERMISSION_INSUFFICIENT"},
    {XR_ERROR_EXTENSION_DEPENDENCY_NOT_ENABLED, "XR_ERROR_EXTENSION_DEPENDENCY_NOT_ENABLED"},
};
constexpr LaterName<XrStructureType> kLaterTypes[] = {
    {XR_TYPE_SPACES_LOCATE_INFO, "XR_TYPE_SPACES_LOCATE_INFO"},
    {XR_TYPE_SPACE_LOCATIONS, "XR_TYPE_SPACE_LOCATIONS"},
    {XR_TYPE_SPACE_VELOCITIES, "XR_TYPE_SPACE_VELOCITIES"},
    {XR_TYPE_EVENT_DATA_USER_PRESENCE_CHANGED_EXT, "XR_TYPE_EVENT_DATA_USER_PRESENCE_CHANGED_EXT"},
    {XR_TYPE_SYSTEM_USER_PRESENCE_PROPERTIES_EXT, "XR_TYPE_SYSTEM_USER_PRESENCE_PROPERTIES_EXT"},
};

template <class Value>
const char* findName(std::span<const LaterName<Value>> names, Value value) {
    for (const auto& [later, name] : names) {
        if (later == value) { return name; }
    }
    return nullptr;
}

}  // namespace

const char* nameOf(XrResult result) {
    switch (result) {
        XR_LIST_ENUM_XrResult(SIMULATED_CASE);
        default:
            return findName<XrResult>(kLaterResults, result);
    }
}

const char* nameOf(XrStructureType type) {
    switch (type) {
        XR_LIST_ENUM_XrStructureType(SIMULATED_CASE);
        default:
            return findName<XrStructureType>(kLaterTypes, type);
    }
}

#define SIMULATED_WORD(name, value) \
    case name:                      \
        return #name + sizeof "XR_SESSION_STATE_" - 1;

#define SIMULATED_BLEND_WORD(name, value) \
    case name:                            \
        return #name + sizeof "XR_ENVIRONMENT_BLEND_MODE_" - 1;

const char* wordOf(XrSessionState state) {
    switch (state) {
        XR_LIST_ENUM_XrSessionState(SIMULATED_WORD);
        default:
            return nullptr;
    }
}

const char* wordOf(XrEnvironmentBlendMode mode) {
    switch (mode) {
        XR_LIST_ENUM_XrEnvironmentBlendMode(SIMULATED_BLEND_WORD);
        default:
            return nullptr;
    }
}

#undef SIMULATED_BLEND_WORD
#undef SIMULATED_CASE
#undef SIMULATED_WORD

}  // namespace simulated
