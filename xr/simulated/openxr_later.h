// Additions to OpenXR since 1.0.20, the version of Debian bookworm's headers, as far as this runtime has
// them, with names, values and layouts from the registry (xr.xml). Newer headers declare them themselves.
#pragma once

#include <openxr/openxr.h>

#ifndef XR_VERSION_1_1

constexpr XrReferenceSpaceType XR_REFERENCE_SPACE_TYPE_LOCAL_FLOOR =
    static_cast<XrReferenceSpaceType>(1000426000);
constexpr XrViewConfigurationType XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO_WITH_FOVEATED_INSET =
    static_cast<XrViewConfigurationType>(1000037000);
constexpr XrResult XR_ERROR_PERMISSION_INSUFFICIENT = static_cast<XrResult>(-1000710000);
constexpr XrResult XR_ERROR_EXTENSION_DEPENDENCY_NOT_ENABLED = static_cast<XrResult>(-1000710001);
constexpr XrStructureType XR_TYPE_SPACES_LOCATE_INFO = static_cast<XrStructureType>(1000471000);
constexpr XrStructureType XR_TYPE_SPACE_LOCATIONS = static_cast<XrStructureType>(1000471001);
constexpr XrStructureType XR_TYPE_SPACE_VELOCITIES = static_cast<XrStructureType>(1000471002);

struct XrSpacesLocateInfo {
    XrStructureType type;
    const void* next;
    XrSpace baseSpace;
    XrTime time;
    uint32_t spaceCount;
    const XrSpace* spaces;
};

struct XrSpaceLocationData {
    XrSpaceLocationFlags locationFlags;
    XrPosef pose;
};

struct XrSpaceLocations {
    XrStructureType type;
    void* next;
    uint32_t locationCount;
    XrSpaceLocationData* locations;
};

struct XrSpaceVelocityData {
    XrSpaceVelocityFlags velocityFlags;
    XrVector3f linearVelocity;
    XrVector3f angularVelocity;
};

struct XrSpaceVelocities {
    XrStructureType type;
    void* next;
    uint32_t velocityCount;
    XrSpaceVelocityData* velocities;
};

using PFN_xrLocateSpaces = XrResult (*)(XrSession session, const XrSpacesLocateInfo* locateInfo,
                                        XrSpaceLocations* spaceLocations);

#endif

#ifndef XR_KHR_locate_spaces
#define XR_KHR_LOCATE_SPACES_EXTENSION_NAME "XR_KHR_locate_spaces"
using PFN_xrLocateSpacesKHR = PFN_xrLocateSpaces;
#endif

#ifndef XR_KHR_maintenance1
#define XR_KHR_MAINTENANCE1_EXTENSION_NAME "XR_KHR_maintenance1"
#endif

#ifndef XR_EXT_local_floor
#define XR_EXT_LOCAL_FLOOR_EXTENSION_NAME "XR_EXT_local_floor"
#endif

#ifndef XR_EXT_user_presence
#define XR_EXT_USER_PRESENCE_EXTENSION_NAME "XR_EXT_user_presence"
constexpr XrStructureType XR_TYPE_EVENT_DATA_USER_PRESENCE_CHANGED_EXT =
    static_cast<XrStructureType>(1000470000);
constexpr XrStructureType XR_TYPE_SYSTEM_USER_PRESENCE_PROPERTIES_EXT =
    static_cast<XrStructureType>(1000470001);

struct XrEventDataUserPresenceChangedEXT {
    XrStructureType type;
    const void* next;
    XrSession session;
    XrBool32 isUserPresent;
};

struct XrSystemUserPresencePropertiesEXT {
    XrStructureType type;
    void* next;
    XrBool32 supportsUserPresence;
};
#endif

#ifndef XR_EXT_palm_pose
#define XR_EXT_PALM_POSE_EXTENSION_NAME "XR_EXT_palm_pose"
#endif
