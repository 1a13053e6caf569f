// Chapters 5 and 10: the headset as a system, and its blend modes.
#include "xr/simulated/api/api.h"
#include "xr/simulated/api/structures.h"
#include "xr/simulated/api/views.h"

namespace simulated {
namespace {

// Sets a property in an extension's structure, if the structure is there and the extension is enabled.
template <class Structure>
void tell(const Instance& instance, void* next, XrStructureType type, const char* extension,
          XrBool32 Structure::*what, bool value) {
    auto* const found = findInChain<Structure>(next, type);
    if (found != nullptr && instance.extensions.contains(extension)) {
        found->*what = value ? XR_TRUE : XR_FALSE;
    }
}

}  // namespace

void checkSystem(XrSystemId system) {
    require(system == kSystemId, XR_ERROR_SYSTEM_INVALID, "the system is ", system, ", must be ", kSystemId);
}

XrResult xrGetSystem(XrInstance instance, const XrSystemGetInfo* getInfo, XrSystemId* systemId) {
    return answerFor<Instance>(__func__, instance, [&](const Instance& owner) {
        const XrSystemGetInfo& info = checkStruct(getInfo, XR_TYPE_SYSTEM_GET_INFO);
        XrSystemId& output = checkOutput(systemId);
        require(info.formFactor == XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY, XR_ERROR_FORM_FACTOR_UNSUPPORTED,
                "the form factor is ", info.formFactor, ", there are only head-mounted displays");
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
    });
}

XrResult xrGetSystemProperties(XrInstance instance, XrSystemId systemId, XrSystemProperties* properties) {
    return answerFor<Instance>(__func__, instance, [&](const Instance& owner) {
        checkSystem(systemId);
        XrSystemProperties& output = checkStruct(properties, XR_TYPE_SYSTEM_PROPERTIES);
        output.systemId = kSystemId;
        output.vendorId = 0;
        copyText(output.systemName, owner.simulation->script.system_name);
        output.graphicsProperties = {kMostSwapchainPixels, kMostSwapchainPixels, kMostLayers};
        output.trackingProperties = {XR_TRUE, XR_TRUE};
        tell(owner, output.next, XR_TYPE_SYSTEM_EYE_GAZE_INTERACTION_PROPERTIES_EXT,
             XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME,
             &XrSystemEyeGazeInteractionPropertiesEXT::supportsEyeGazeInteraction,
             owner.simulation->script.gaze.tracker != EyeTracking::kOff);
        tell(owner, output.next, XR_TYPE_SYSTEM_FOVEATED_RENDERING_PROPERTIES_VARJO,
             XR_VARJO_FOVEATED_RENDERING_EXTENSION_NAME,
             &XrSystemFoveatedRenderingPropertiesVARJO::supportsFoveatedRendering,
             owner.simulation->script.gaze.tracker != EyeTracking::kOff);
        tell(owner, output.next, XR_TYPE_SYSTEM_PASSTHROUGH_PROPERTIES_FB, XR_FB_PASSTHROUGH_EXTENSION_NAME,
             &XrSystemPassthroughPropertiesFB::supportsPassthrough, owner.simulation->script.passthrough);
        tell(owner, output.next, XR_TYPE_SYSTEM_HAND_TRACKING_PROPERTIES_EXT,
             XR_EXT_HAND_TRACKING_EXTENSION_NAME, &XrSystemHandTrackingPropertiesEXT::supportsHandTracking,
             true);
        tell(owner, output.next, XR_TYPE_SYSTEM_USER_PRESENCE_PROPERTIES_EXT,
             XR_EXT_USER_PRESENCE_EXTENSION_NAME, &XrSystemUserPresencePropertiesEXT::supportsUserPresence,
             true);
    });
}

XrResult xrEnumerateEnvironmentBlendModes(XrInstance instance, XrSystemId systemId,
                                          XrViewConfigurationType viewConfigurationType,
                                          uint32_t environmentBlendModeCapacityInput,
                                          uint32_t* environmentBlendModeCountOutput,
                                          XrEnvironmentBlendMode* environmentBlendModes) {
    return answerFor<Instance>(__func__, instance, [&](const Instance& owner) {
        checkSystem(systemId);
        checkViewConfiguration(owner, viewConfigurationType);
        std::vector<XrEnvironmentBlendMode> modes;
        for (const Script::BlendMode mode : owner.simulation->script.blend_modes) {
            modes.push_back(static_cast<XrEnvironmentBlendMode>(static_cast<int>(mode) + 1));
        }
        fillArray(environmentBlendModeCapacityInput, environmentBlendModeCountOutput, environmentBlendModes,
                  modes);
    });
}

}  // namespace simulated
