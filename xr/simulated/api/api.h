// All API functions of this runtime in one list: they are declared here, dispatch.cpp finds them by name, and
// docs/openxr_runtime.md says what each one checks. Each is defined in the file of its chapter.
#pragma once

#include <type_traits>

#include "xr/simulated/openxr.h"

// clang-format off
#define SIMULATED_CORE_FUNCTIONS(_)                                                                         \
    _(xrGetInstanceProcAddr) _(xrEnumerateApiLayerProperties) _(xrEnumerateInstanceExtensionProperties)     \
    _(xrCreateInstance)                                                                                     \
    _(xrDestroyInstance) _(xrGetInstanceProperties) _(xrPollEvent) _(xrResultToString)                      \
    _(xrStructureTypeToString)                                                                              \
    _(xrGetSystem) _(xrGetSystemProperties) _(xrEnumerateEnvironmentBlendModes)                             \
    _(xrEnumerateViewConfigurations) _(xrGetViewConfigurationProperties)                                    \
    _(xrEnumerateViewConfigurationViews)                                                                    \
    _(xrCreateSession) _(xrDestroySession) _(xrBeginSession) _(xrEndSession) _(xrRequestExitSession)        \
    _(xrEnumerateReferenceSpaces) _(xrCreateReferenceSpace) _(xrGetReferenceSpaceBoundsRect)                \
    _(xrCreateActionSpace)                                                                                  \
    _(xrLocateSpace) _(xrDestroySpace)                                                                      \
    _(xrEnumerateSwapchainFormats) _(xrCreateSwapchain) _(xrDestroySwapchain) _(xrEnumerateSwapchainImages) \
    _(xrAcquireSwapchainImage) _(xrWaitSwapchainImage) _(xrReleaseSwapchainImage)                           \
    _(xrWaitFrame) _(xrBeginFrame) _(xrEndFrame) _(xrLocateViews)                                           \
    _(xrStringToPath) _(xrPathToString)                                                                     \
    _(xrCreateActionSet) _(xrDestroyActionSet) _(xrCreateAction) _(xrDestroyAction)                         \
    _(xrSuggestInteractionProfileBindings) _(xrAttachSessionActionSets) _(xrGetCurrentInteractionProfile)   \
    _(xrGetActionStateBoolean) _(xrGetActionStateFloat) _(xrGetActionStateVector2f)                         \
    _(xrGetActionStatePose) _(xrSyncActions)                                                                \
    _(xrEnumerateBoundSourcesForAction) _(xrGetInputSourceLocalizedName)                                    \
    _(xrApplyHapticFeedback) _(xrStopHapticFeedback)

// For instances of API 1.1.
#define SIMULATED_CORE_1_1_FUNCTIONS(_) _(xrLocateSpaces)

// Function, and the extension that has to be enabled for it.
#define SIMULATED_EXTENSION_FUNCTIONS(_)                                              \
    _(xrCreateVulkanInstanceKHR, XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME)                \
    _(xrCreateVulkanDeviceKHR, XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME)                  \
    _(xrGetVulkanGraphicsDevice2KHR, XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME)            \
    _(xrGetVulkanGraphicsRequirements2KHR, XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME)      \
    _(xrGetVulkanInstanceExtensionsKHR, XR_KHR_VULKAN_ENABLE_EXTENSION_NAME)          \
    _(xrGetVulkanDeviceExtensionsKHR, XR_KHR_VULKAN_ENABLE_EXTENSION_NAME)            \
    _(xrGetVulkanGraphicsDeviceKHR, XR_KHR_VULKAN_ENABLE_EXTENSION_NAME)              \
    _(xrGetVulkanGraphicsRequirementsKHR, XR_KHR_VULKAN_ENABLE_EXTENSION_NAME)        \
    _(xrGetVisibilityMaskKHR, XR_KHR_VISIBILITY_MASK_EXTENSION_NAME)                  \
    _(xrLocateSpacesKHR, XR_KHR_LOCATE_SPACES_EXTENSION_NAME)                         \
    _(xrConvertTimespecTimeToTimeKHR, XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME)    \
    _(xrConvertTimeToTimespecTimeKHR, XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME)    \
    _(xrSetInputDeviceActiveEXT, XR_EXT_CONFORMANCE_AUTOMATION_EXTENSION_NAME)        \
    _(xrSetInputDeviceStateBoolEXT, XR_EXT_CONFORMANCE_AUTOMATION_EXTENSION_NAME)     \
    _(xrSetInputDeviceStateFloatEXT, XR_EXT_CONFORMANCE_AUTOMATION_EXTENSION_NAME)    \
    _(xrSetInputDeviceStateVector2fEXT, XR_EXT_CONFORMANCE_AUTOMATION_EXTENSION_NAME) \
    _(xrSetInputDeviceLocationEXT, XR_EXT_CONFORMANCE_AUTOMATION_EXTENSION_NAME)      \
    _(xrCreateDebugUtilsMessengerEXT, XR_EXT_DEBUG_UTILS_EXTENSION_NAME)              \
    _(xrDestroyDebugUtilsMessengerEXT, XR_EXT_DEBUG_UTILS_EXTENSION_NAME)             \
    _(xrSubmitDebugUtilsMessageEXT, XR_EXT_DEBUG_UTILS_EXTENSION_NAME)                \
    _(xrSetDebugUtilsObjectNameEXT, XR_EXT_DEBUG_UTILS_EXTENSION_NAME)                \
    _(xrSessionBeginDebugUtilsLabelRegionEXT, XR_EXT_DEBUG_UTILS_EXTENSION_NAME)      \
    _(xrSessionEndDebugUtilsLabelRegionEXT, XR_EXT_DEBUG_UTILS_EXTENSION_NAME)        \
    _(xrSessionInsertDebugUtilsLabelEXT, XR_EXT_DEBUG_UTILS_EXTENSION_NAME)           \
    _(xrCreateHandTrackerEXT, XR_EXT_HAND_TRACKING_EXTENSION_NAME)                    \
    _(xrDestroyHandTrackerEXT, XR_EXT_HAND_TRACKING_EXTENSION_NAME)                   \
    _(xrLocateHandJointsEXT, XR_EXT_HAND_TRACKING_EXTENSION_NAME)                     \
    _(xrEnumerateDisplayRefreshRatesFB, XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME)    \
    _(xrGetDisplayRefreshRateFB, XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME)           \
    _(xrRequestDisplayRefreshRateFB, XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME)       \
    _(xrCreatePassthroughFB, XR_FB_PASSTHROUGH_EXTENSION_NAME)                        \
    _(xrDestroyPassthroughFB, XR_FB_PASSTHROUGH_EXTENSION_NAME)                       \
    _(xrPassthroughStartFB, XR_FB_PASSTHROUGH_EXTENSION_NAME)                         \
    _(xrPassthroughPauseFB, XR_FB_PASSTHROUGH_EXTENSION_NAME)                         \
    _(xrCreatePassthroughLayerFB, XR_FB_PASSTHROUGH_EXTENSION_NAME)                   \
    _(xrDestroyPassthroughLayerFB, XR_FB_PASSTHROUGH_EXTENSION_NAME)                  \
    _(xrPassthroughLayerPauseFB, XR_FB_PASSTHROUGH_EXTENSION_NAME)                    \
    _(xrPassthroughLayerResumeFB, XR_FB_PASSTHROUGH_EXTENSION_NAME)                   \
    _(xrPassthroughLayerSetStyleFB, XR_FB_PASSTHROUGH_EXTENSION_NAME)                 \
    _(xrCreateGeometryInstanceFB, XR_FB_PASSTHROUGH_EXTENSION_NAME)                   \
    _(xrDestroyGeometryInstanceFB, XR_FB_PASSTHROUGH_EXTENSION_NAME)                  \
    _(xrGeometryInstanceSetTransformFB, XR_FB_PASSTHROUGH_EXTENSION_NAME)
// clang-format on

namespace simulated {

#define SIMULATED_DECLARE(name) std::remove_pointer_t<PFN_##name> name;
#define SIMULATED_DECLARE_EXTENSION(name, extension) std::remove_pointer_t<PFN_##name> name;
SIMULATED_CORE_FUNCTIONS(SIMULATED_DECLARE)
SIMULATED_CORE_1_1_FUNCTIONS(SIMULATED_DECLARE)
SIMULATED_EXTENSION_FUNCTIONS(SIMULATED_DECLARE_EXTENSION)
#undef SIMULATED_DECLARE
#undef SIMULATED_DECLARE_EXTENSION

}  // namespace simulated
