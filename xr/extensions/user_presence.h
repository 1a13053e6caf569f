// XR_EXT_user_presence: whether somebody wears the headset. Its names are those of OpenXR 1.1; older headers
// lack them.
#pragma once

#include <openxr/openxr.h>

namespace binosplat::xr {

inline constexpr const char* kUserPresenceExtension = "XR_EXT_user_presence";
inline constexpr auto kUserPresenceChanged = static_cast<XrStructureType>(1000470000);

// XrEventDataUserPresenceChangedEXT. A runtime that can tell sends one when a session begins.
struct UserPresenceChanged {
    XrStructureType type;
    const void* next;
    XrSession session;
    XrBool32 is_present;
};

}  // namespace binosplat::xr
