// Finding the runtime and the headset.
#include "xr/instance.h"

#include "engine/platform.h"
#include "xr/bindings.h"
#include "xr/platform.h"
#include "xr/runtime_place.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace binosplat::xr {
namespace {

// Of OpenXR 1.1; older headers lack its name.
constexpr const char* kLocalFloorExtension = "XR_EXT_local_floor";

[[noreturn]] void refuse(const std::string& what, XrResult result) {
    const std::string line = fmt::format("{} ({}); {}", what, nameOf(result), kRuntimeHint);
    if (result == XR_ERROR_RUNTIME_FAILURE) { throw RuntimeFailed(ExitCode::kNoDevice, line); }
    throw Error(ExitCode::kNoDevice, line);
}

std::vector<XrExtensionProperties> listExtensions() {
    std::uint32_t count = 0;
    XrResult result = xrEnumerateInstanceExtensionProperties(nullptr, 0, &count, nullptr);
    if (XR_FAILED(result)) { refuse(fmt::format("no OpenXR runtime found: looked for {}", whereRuntimeIs()), result); }
    std::vector<XrExtensionProperties> extensions(count, {XR_TYPE_EXTENSION_PROPERTIES, nullptr, {}, 0});
    result = BINOSPLAT_XR(xrEnumerateInstanceExtensionProperties(nullptr, count, &count, extensions.data()));
    extensions.resize(count);
    return extensions;
}

XrResult getSystem(XrInstance instance, XrSystemId& system) {
    auto wanted = structure<XrSystemGetInfo>(XR_TYPE_SYSTEM_GET_INFO);
    wanted.formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY;
    return xrGetSystem(instance, &wanted, &system);
}

}  // namespace

Instance::Instance(const InstanceOptions& options) {
    // The loader speaks on stderr where it finds nothing; one line of ours says it better.
    if (environment("XR_LOADER_DEBUG").empty()) { setEnvironment("XR_LOADER_DEBUG", "none"); }
    create(options);
    try {
        findSystem(options);
        readSystem();
        readViews();
    } catch (...) {
        xrDestroyInstance(instance_);
        throw;
    }
}

Instance::~Instance() { xrDestroyInstance(instance_); }

void Instance::create(const InstanceOptions& options) {
    const std::vector<XrExtensionProperties> available = listExtensions();
    const auto has = [&](const char* name) {
        return std::ranges::any_of(available, [&](const auto& extension) { return std::strcmp(extension.extensionName, name) == 0; });
    };
    if (!has(XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME)) {
        refuse("the OpenXR runtime has not XR_KHR_vulkan_enable2", XR_ERROR_EXTENSION_NOT_PRESENT);
    }
    takes_depth_ = has(XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME);
    has_visibility_mask_ = options.visibility_mask && has(XR_KHR_VISIBILITY_MASK_EXTENSION_NAME);
    has_local_floor_ = has(kLocalFloorExtension);
    knows_hands_ = has(XR_EXT_HAND_TRACKING_EXTENSION_NAME);
    knows_eyes_ = options.eye_tracking && has(XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME);
    has_refresh_rates_ = has(XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME);
    std::vector<const char*> extensions{XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME};
    if (takes_depth_) { extensions.push_back(XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME); }
    if (has_local_floor_) { extensions.push_back(kLocalFloorExtension); }
    if (has_refresh_rates_) { extensions.push_back(XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME); }
    if (knows_hands_) { extensions.push_back(XR_EXT_HAND_TRACKING_EXTENSION_NAME); }
    if (knows_eyes_) { extensions.push_back(XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME); }
    for (const ProfileBindings& profile : allProfileBindings()) {
        if (profile.extension == nullptr || !has(profile.extension)) { continue; }
        if (controller_extensions_.insert(profile.extension).second) { extensions.push_back(profile.extension); }
    }
    if (has_visibility_mask_) { extensions.push_back(XR_KHR_VISIBILITY_MASK_EXTENSION_NAME); }

    auto info = structure<XrInstanceCreateInfo>(XR_TYPE_INSTANCE_CREATE_INFO);
    std::strcpy(info.applicationInfo.applicationName, "binosplat");
    std::strcpy(info.applicationInfo.engineName, "binosplat");
    info.applicationInfo.applicationVersion = info.applicationInfo.engineVersion = 1;
    info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.enabledExtensionNames = extensions.data();
    const XrResult result = xrCreateInstance(&info, &instance_);
    if (XR_FAILED(result)) { refuse(fmt::format("the OpenXR runtime does not start: looked for {}", whereRuntimeIs()), result); }
}

void Instance::findSystem(const InstanceOptions& options) {
    auto runtime = structure<XrInstanceProperties>(XR_TYPE_INSTANCE_PROPERTIES);
    BINOSPLAT_XR(xrGetInstanceProperties(instance_, &runtime));
    runtime_name_ = runtime.runtimeName;
    XrResult result = getSystem(instance_, system_);
    while (result == XR_ERROR_FORM_FACTOR_UNAVAILABLE && options.wait_for_headset) {
        options.wait_for_headset(runtime_name_);
        result = getSystem(instance_, system_);
    }
    if (XR_FAILED(result)) { refuse(fmt::format("no headset: the OpenXR runtime {} offers none", runtime_name_), result); }
}

bool Instance::findHeadset(const Context& context) {
    // Nobody is left for whom they were, but that the runtime itself goes away.
    for (;;) {
        auto event = structure<XrEventDataBuffer>(XR_TYPE_EVENT_DATA_BUFFER);
        if (BINOSPLAT_XR(xrPollEvent(instance_, &event)) == XR_EVENT_UNAVAILABLE) { break; }
        if (event.type == XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING) { throw InstanceLost(ExitCode::kNoDevice, kGoingAway); }
    }
    const XrResult result = getSystem(instance_, system_);
    // Some runtimes have no better word for it.
    if (result == XR_ERROR_FORM_FACTOR_UNAVAILABLE || result == XR_ERROR_RUNTIME_FAILURE) { return false; }
    checkResult(result, "xrGetSystem");
    readSystem();
    readViews();
    static_cast<void>(leastVulkan());
    if (vk::PhysicalDevice(graphicsDevice(*context.instance())) != *context.physicalDevice()) {
        throw Error(ExitCode::kNoDevice, fmt::format("{} is on another graphics device than before: start anew", description_));
    }
    return true;
}

void Instance::readSystem() {
    auto properties = structure<XrSystemProperties>(XR_TYPE_SYSTEM_PROPERTIES);
    auto hands = structure<XrSystemHandTrackingPropertiesEXT>(XR_TYPE_SYSTEM_HAND_TRACKING_PROPERTIES_EXT);
    auto eyes = structure<XrSystemEyeGazeInteractionPropertiesEXT>(XR_TYPE_SYSTEM_EYE_GAZE_INTERACTION_PROPERTIES_EXT);
    BINOSPLAT_XR(xrGetSystemProperties(instance_, system_, &properties));
    // One after the other: OpenXR's own validation layer refuses a chain of two.
    const auto read = [&](void* chained) {
        properties.next = chained;
        BINOSPLAT_XR(xrGetSystemProperties(instance_, system_, &properties));
    };
    if (knows_hands_) {
        troubles_.tryFor("hand tracking", [&] { read(&hands); });
    }
    if (knows_eyes_) {
        troubles_.tryFor("eye tracking", [&] { read(&eyes); });
    }
    tracks_hands_ = knows_hands_ && hands.supportsHandTracking == XR_TRUE;
    tracks_eyes_ = knows_eyes_ && eyes.supportsEyeGazeInteraction == XR_TRUE;
    description_ = fmt::format("{}: {}", runtime_name_, properties.systemName);
}

void Instance::readViews() {
    constexpr auto kStereo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
    std::uint32_t count = 0;
    const XrResult result = xrEnumerateViewConfigurationViews(instance_, system_, kStereo, 0, &count, nullptr);
    if (result == XR_ERROR_SYSTEM_INVALID) { checkResult(result, "xrEnumerateViewConfigurationViews"); }  // unplugged
    if (XR_FAILED(result)) { refuse(fmt::format("{} does not show two eyes", description_), result); }
    std::vector<XrViewConfigurationView> views(count, {XR_TYPE_VIEW_CONFIGURATION_VIEW, nullptr, 0, 0, 0, 0, 0, 0});
    BINOSPLAT_XR(xrEnumerateViewConfigurationViews(instance_, system_, kStereo, count, &count, views.data()));
    recommended_size_px_ = glm::uvec2(0);
    max_size_px_ = glm::uvec2(UINT32_MAX);
    for (const XrViewConfigurationView& view : views) {
        recommended_size_px_ = glm::max(recommended_size_px_, glm::uvec2(view.recommendedImageRectWidth, view.recommendedImageRectHeight));
        max_size_px_ = glm::min(max_size_px_, glm::uvec2(view.maxImageRectWidth, view.maxImageRectHeight));
    }
    BINOSPLAT_XR(xrEnumerateEnvironmentBlendModes(instance_, system_, kStereo, 0, &count, nullptr));
    std::vector<XrEnvironmentBlendMode> modes(count);
    BINOSPLAT_XR(xrEnumerateEnvironmentBlendModes(instance_, system_, kStereo, count, &count, modes.data()));
    const auto has = [&](XrEnvironmentBlendMode mode) { return std::ranges::find(modes, mode) != modes.end(); };
    blend_mode_ = has(XR_ENVIRONMENT_BLEND_MODE_OPAQUE) || modes.empty() ? XR_ENVIRONMENT_BLEND_MODE_OPAQUE : modes.front();
    see_through_.reset();
    for (const XrEnvironmentBlendMode mode : {XR_ENVIRONMENT_BLEND_MODE_ADDITIVE, XR_ENVIRONMENT_BLEND_MODE_ALPHA_BLEND}) {
        if (has(mode)) { see_through_ = mode; }
    }
}

XrVersion Instance::leastVulkan() const {
    auto needs = structure<XrGraphicsRequirementsVulkan2KHR>(XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN2_KHR);
    BINOSPLAT_XR(function<PFN_xrGetVulkanGraphicsRequirements2KHR>("xrGetVulkanGraphicsRequirements2KHR")(instance_, system_, &needs));
    return needs.minApiVersionSupported;
}

VkPhysicalDevice Instance::graphicsDevice(VkInstance vulkan_instance) const {
    auto info = structure<XrVulkanGraphicsDeviceGetInfoKHR>(XR_TYPE_VULKAN_GRAPHICS_DEVICE_GET_INFO_KHR);
    info.systemId = system_;
    info.vulkanInstance = vulkan_instance;
    VkPhysicalDevice chosen = VK_NULL_HANDLE;
    BINOSPLAT_XR(function<PFN_xrGetVulkanGraphicsDevice2KHR>("xrGetVulkanGraphicsDevice2KHR")(instance_, &info, &chosen));
    return chosen;
}

DeviceMaker Instance::deviceMaker() const {
    const auto refuseVulkan = [](VkResult result, const char* what) {
        if (result == VK_SUCCESS) { return; }
        throw Error(ExitCode::kNoDevice, fmt::format("{}: {}", what, vk::to_string(vk::Result(result))));
    };
    DeviceMaker maker;
    maker.create_instance = [this, refuseVulkan](PFN_vkGetInstanceProcAddr get_address, const VkInstanceCreateInfo& vulkan_info) {
        const XrVersion least = leastVulkan();
        const std::uint32_t wanted = vulkan_info.pApplicationInfo->apiVersion;
        const XrVersion version = XR_MAKE_VERSION(VK_API_VERSION_MAJOR(wanted), VK_API_VERSION_MINOR(wanted), 0);
        if (version < least) {
            throw Error(ExitCode::kNoDevice,
                        fmt::format("{} needs Vulkan {}.{} or newer, this program uses {}.{}", description_, XR_VERSION_MAJOR(least),
                                    XR_VERSION_MINOR(least), VK_API_VERSION_MAJOR(wanted), VK_API_VERSION_MINOR(wanted)));
        }
        auto info = structure<XrVulkanInstanceCreateInfoKHR>(XR_TYPE_VULKAN_INSTANCE_CREATE_INFO_KHR);
        info.systemId = system_;
        info.pfnGetInstanceProcAddr = get_address;
        info.vulkanCreateInfo = &vulkan_info;
        VkInstance created = VK_NULL_HANDLE;
        VkResult result = VK_SUCCESS;
        BINOSPLAT_XR(function<PFN_xrCreateVulkanInstanceKHR>("xrCreateVulkanInstanceKHR")(instance_, &info, &created, &result));
        refuseVulkan(result, "xrCreateVulkanInstanceKHR");
        return created;
    };
    maker.choose_device = [this](VkInstance vulkan_instance) { return graphicsDevice(vulkan_instance); };
    maker.create_device = [this, refuseVulkan](PFN_vkGetInstanceProcAddr get_address, VkPhysicalDevice physical_device,
                                               const VkDeviceCreateInfo& vulkan_info) {
        auto info = structure<XrVulkanDeviceCreateInfoKHR>(XR_TYPE_VULKAN_DEVICE_CREATE_INFO_KHR);
        info.systemId = system_;
        info.pfnGetInstanceProcAddr = get_address;
        info.vulkanPhysicalDevice = physical_device;
        info.vulkanCreateInfo = &vulkan_info;
        VkDevice created = VK_NULL_HANDLE;
        VkResult result = VK_SUCCESS;
        BINOSPLAT_XR(function<PFN_xrCreateVulkanDeviceKHR>("xrCreateVulkanDeviceKHR")(instance_, &info, &created, &result));
        refuseVulkan(result, "xrCreateVulkanDeviceKHR");
        return created;
    };
    return maker;
}

XrPath Instance::path(const char* text) const {
    XrPath path = XR_NULL_PATH;
    BINOSPLAT_XR(xrStringToPath(instance_, text, &path));
    return path;
}

}  // namespace binosplat::xr
