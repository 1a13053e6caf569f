// Chapters 5 and 10: the headset as a system, and its blend modes.
#include "xr/simulated/api/api.h"
#include "xr/simulated/api/structures.h"
#include "xr/simulated/api/views.h"

namespace simulated {
namespace {

// An extension's structure to fill, if it is there and the extension is enabled.
template <class Structure>
Structure* findChained(const Instance& instance, void* next, XrStructureType type, const char* extension) {
    if (!instance.extensions.contains(extension)) { return nullptr; }
    return reinterpret_cast<Structure*>(const_cast<XrBaseInStructure*>(findInChain(next, type)));
}

}  // namespace

void checkSystem(XrSystemId system) {
    require(system == kSystemId, XR_ERROR_SYSTEM_INVALID, "the system is ", system, ", must be ", kSystemId);
}

XrResult xrGetSystem(XrInstance instance, const XrSystemGetInfo* getInfo, XrSystemId* systemId) {
    return answer(__func__, [&] {
        const Instance& owner = getInstance(instance);
        const XrSystemGetInfo& info = checkStruct(getInfo, XR_TYPE_SYSTEM_GET_INFO);
        XrSystemId& output = checkOutput(systemId);
        require(info.formFactor == XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY, XR_ERROR_FORM_FACTOR_UNSUPPORTED, "the form factor is ",
                info.formFactor, ", there are only head-mounted displays");
        require(owner.simulation->script.plugged, XR_ERROR_FORM_FACTOR_UNAVAILABLE,
                "no headset: the script says that it is not plugged in");
        std::uint32_t& calls = owner.simulation->calls_without_headset;
        if (calls < owner.simulation->script.calls_without_headset) {
            ++calls;
            throw Refusal{XR_ERROR_FORM_FACTOR_UNAVAILABLE, "the headset is not there yet"};
        }
        std::uint32_t& calls_left = owner.simulation->calls_until_plugged;
        if (calls_left > 0) {
            --calls_left;
            throw Refusal{XR_ERROR_FORM_FACTOR_UNAVAILABLE, "the headset is not there again yet"};
        }
        output = kSystemId;
        return XR_SUCCESS;
    });
}

XrResult xrGetSystemProperties(XrInstance instance, XrSystemId systemId, XrSystemProperties* properties) {
    return answer(__func__, [&] {
        const Instance& owner = getInstance(instance);
        checkSystem(systemId);
        XrSystemProperties& output = checkStruct(properties, XR_TYPE_SYSTEM_PROPERTIES);
        output.systemId = kSystemId;
        output.vendorId = 0;
        copyText(output.systemName, owner.simulation->script.system_name);
        output.graphicsProperties = {kMostSwapchainPixels, kMostSwapchainPixels, kMostLayers};
        output.trackingProperties = {XR_TRUE, XR_TRUE};
        if (auto* gaze = findChained<XrSystemEyeGazeInteractionPropertiesEXT>(
                owner, output.next, XR_TYPE_SYSTEM_EYE_GAZE_INTERACTION_PROPERTIES_EXT, XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME)) {
            gaze->supportsEyeGazeInteraction = owner.simulation->script.gaze.tracker != EyeTracking::kOff ? XR_TRUE : XR_FALSE;
        }
        if (auto* hands = findChained<XrSystemHandTrackingPropertiesEXT>(owner, output.next, XR_TYPE_SYSTEM_HAND_TRACKING_PROPERTIES_EXT,
                                                                         XR_EXT_HAND_TRACKING_EXTENSION_NAME)) {
            hands->supportsHandTracking = XR_TRUE;
        }
        if (auto* presence = findChained<XrSystemUserPresencePropertiesEXT>(owner, output.next, XR_TYPE_SYSTEM_USER_PRESENCE_PROPERTIES_EXT,
                                                                            XR_EXT_USER_PRESENCE_EXTENSION_NAME)) {
            presence->supportsUserPresence = XR_TRUE;
        }
        return XR_SUCCESS;
    });
}

XrResult xrEnumerateEnvironmentBlendModes(XrInstance instance, XrSystemId systemId, XrViewConfigurationType viewConfigurationType,
                                          uint32_t environmentBlendModeCapacityInput, uint32_t* environmentBlendModeCountOutput,
                                          XrEnvironmentBlendMode* environmentBlendModes) {
    return answer(__func__, [&] {
        const Instance& owner = getInstance(instance);
        checkSystem(systemId);
        checkViewConfiguration(owner, viewConfigurationType);
        std::vector<XrEnvironmentBlendMode> modes;
        for (const Script::BlendMode mode : owner.simulation->script.blend_modes) {
            modes.push_back(static_cast<XrEnvironmentBlendMode>(static_cast<int>(mode) + 1));
        }
        return fillArray(environmentBlendModeCapacityInput, environmentBlendModeCountOutput, environmentBlendModes, modes);
    });
}

}  // namespace simulated
