// The programs' instances, Vulkan devices, sessions and frames, and the messages of Vulkan's validation.
#include "tests/xr/simulated/api/simulated_fixture.h"

#include <unistd.h>

#include <cstdlib>
#include <fstream>

doctest::String doctest::StringMaker<XrResult>::convert(XrResult result) { return doctest::toString(static_cast<int>(result)); }

namespace binosplat::test {
namespace {

namespace fs = std::filesystem;

VkBool32 keepMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                     const VkDebugUtilsMessengerCallbackDataEXT* data, void* messages) {
    static_cast<std::vector<std::string>*>(messages)->emplace_back(data->pMessage);
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfo(std::vector<std::string>& messages) {
    VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    info.pfnUserCallback = keepMessage;
    info.pUserData = &messages;
    return info;
}

template <std::size_t size>
void setText(char (&destination)[size], const std::string& text) {
    REQUIRE(text.size() < size);
    std::strcpy(destination, text.c_str());
}

}  // namespace

Headset::Headset(const std::string& script) {
    std::string name = (fs::temp_directory_path() / "binosplat-headset-XXXXXX").string();
    folder = mkdtemp(name.data());
    written = folder / "written";
    std::ofstream(folder / "test.script") << script;
    setenv("XR_RUNTIME_JSON", BINOSPLAT_SIMULATED_RUNTIME, 1);
    setenv("SIMULATED_OPENXR_SCRIPT", (folder / "test.script").c_str(), 1);
    setenv("SIMULATED_OPENXR_OUT", written.c_str(), 1);
    unsetenv("SIMULATED_OPENXR_CLOCK");
}

Headset::~Headset() {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
}

XrInstanceCreateInfo instanceInfo(const std::vector<const char*>& extensions) {
    XrInstanceCreateInfo info{XR_TYPE_INSTANCE_CREATE_INFO};
    setText(info.applicationInfo.applicationName, "test");
    info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.enabledExtensionNames = extensions.data();
    return info;
}

InstanceFixture::InstanceFixture(const std::string& script, const std::vector<const char*>& more_extensions) : Headset(script) {
    std::vector<const char*> extensions{XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME, XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME,
                                        XR_KHR_VISIBILITY_MASK_EXTENSION_NAME};
    extensions.insert(extensions.end(), more_extensions.begin(), more_extensions.end());
    const XrInstanceCreateInfo info = instanceInfo(extensions);
    REQUIRE(xrCreateInstance(&info, &instance) == XR_SUCCESS);
    XrSystemGetInfo get{XR_TYPE_SYSTEM_GET_INFO, nullptr, XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY};
    REQUIRE(xrGetSystem(instance, &get, &system) == XR_SUCCESS);
}

InstanceFixture::~InstanceFixture() {
    if (instance != XR_NULL_HANDLE) xrDestroyInstance(instance);
}

XrPath InstanceFixture::path(const std::string& text) const {
    XrPath path = XR_NULL_PATH;
    REQUIRE(xrStringToPath(instance, text.c_str(), &path) == XR_SUCCESS);
    return path;
}

XrActionSet InstanceFixture::makeActionSet(const std::string& name, std::uint32_t priority) const {
    XrActionSetCreateInfo info{XR_TYPE_ACTION_SET_CREATE_INFO};
    setText(info.actionSetName, name);
    setText(info.localizedActionSetName, "the " + name);
    info.priority = priority;
    XrActionSet set = XR_NULL_HANDLE;
    REQUIRE(xrCreateActionSet(instance, &info, &set) == XR_SUCCESS);
    return set;
}

XrAction InstanceFixture::makeAction(XrActionSet set, const std::string& name, XrActionType type,
                                     const std::vector<XrPath>& subaction_paths) const {
    XrActionCreateInfo info{XR_TYPE_ACTION_CREATE_INFO};
    setText(info.actionName, name);
    setText(info.localizedActionName, "the " + name);
    info.actionType = type;
    info.countSubactionPaths = static_cast<std::uint32_t>(subaction_paths.size());
    info.subactionPaths = subaction_paths.data();
    XrAction action = XR_NULL_HANDLE;
    REQUIRE(xrCreateAction(set, &info, &action) == XR_SUCCESS);
    return action;
}

XrResult InstanceFixture::suggest(const std::string& profile, const std::vector<XrActionSuggestedBinding>& bindings) const {
    XrInteractionProfileSuggestedBinding info{XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING};
    info.interactionProfile = path(profile);
    info.countSuggestedBindings = static_cast<std::uint32_t>(bindings.size());
    info.suggestedBindings = bindings.data();
    return xrSuggestInteractionProfileBindings(instance, &info);
}

XrStructureType InstanceFixture::poll(XrEventDataBuffer& event) const {
    event = {XR_TYPE_EVENT_DATA_BUFFER};
    return xrPollEvent(instance, &event) == XR_SUCCESS ? event.type : XR_TYPE_UNKNOWN;
}

VulkanFixture::VulkanFixture(const std::string& script, const std::vector<const char*>& more_extensions, PFN_vkGetInstanceProcAddr loader)
    : InstanceFixture(script, more_extensions) {
    XrGraphicsRequirementsVulkan2KHR requirements{XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN2_KHR};
    const auto getRequirements = function<PFN_xrGetVulkanGraphicsRequirements2KHR>("xrGetVulkanGraphicsRequirements2KHR");
    REQUIRE(getRequirements(instance, system, &requirements) == XR_SUCCESS);

    const VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO, nullptr, "test", 0, nullptr, 0, VK_API_VERSION_1_1};
    const char* const layer = "VK_LAYER_KHRONOS_validation";
    const char* const extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    const VkValidationFeatureEnableEXT feature = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkDebugUtilsMessengerCreateInfoEXT messenger_info = messengerInfo(messages);
    const VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT, &messenger_info, 1, &feature, 0, nullptr};
    const VkInstanceCreateInfo vulkan_info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, &features, 0, &application, 1, &layer, 1, &extension};
    XrVulkanInstanceCreateInfoKHR info{XR_TYPE_VULKAN_INSTANCE_CREATE_INFO_KHR};
    info.systemId = system;
    info.pfnGetInstanceProcAddr = loader;
    info.vulkanCreateInfo = &vulkan_info;
    VkResult result = VK_ERROR_UNKNOWN;
    REQUIRE(function<PFN_xrCreateVulkanInstanceKHR>("xrCreateVulkanInstanceKHR")(instance, &info, &vulkan, &result) == XR_SUCCESS);
    REQUIRE(result == VK_SUCCESS);
    const auto makeMessenger =
        reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(vkGetInstanceProcAddr(vulkan, "vkCreateDebugUtilsMessengerEXT"));
    REQUIRE(makeMessenger(vulkan, &messenger_info, nullptr, &messenger) == VK_SUCCESS);

    const XrVulkanGraphicsDeviceGetInfoKHR get{XR_TYPE_VULKAN_GRAPHICS_DEVICE_GET_INFO_KHR, nullptr, system, vulkan};
    REQUIRE(function<PFN_xrGetVulkanGraphicsDevice2KHR>("xrGetVulkanGraphicsDevice2KHR")(instance, &get, &physical_device) == XR_SUCCESS);
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue_info{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, 0, 1, &priority};
    const VkDeviceCreateInfo device_info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, nullptr, 0, 1, &queue_info, 0, nullptr, 0, nullptr, nullptr};
    XrVulkanDeviceCreateInfoKHR make{XR_TYPE_VULKAN_DEVICE_CREATE_INFO_KHR};
    make.systemId = system;
    make.pfnGetInstanceProcAddr = loader;
    make.vulkanPhysicalDevice = physical_device;
    make.vulkanCreateInfo = &device_info;
    REQUIRE(function<PFN_xrCreateVulkanDeviceKHR>("xrCreateVulkanDeviceKHR")(instance, &make, &device, &result) == XR_SUCCESS);
    REQUIRE(result == VK_SUCCESS);
}

VulkanFixture::~VulkanFixture() {
    // OpenXR's objects go first: they hold images of this device.
    xrDestroyInstance(instance);
    instance = XR_NULL_HANDLE;
    vkDestroyDevice(device, nullptr);
    for (const std::string& message : messages) FAIL_CHECK(message);
    reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(vkGetInstanceProcAddr(vulkan, "vkDestroyDebugUtilsMessengerEXT"))(
        vulkan, messenger, nullptr);
    vkDestroyInstance(vulkan, nullptr);
}

XrGraphicsBindingVulkan2KHR VulkanFixture::binding() const {
    return {XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR, nullptr, vulkan, physical_device, device, 0, 0};
}

VkQueue VulkanFixture::queue() const {
    VkQueue queue = VK_NULL_HANDLE;
    vkGetDeviceQueue(device, 0, 0, &queue);
    return queue;
}

SessionFixture::SessionFixture(const std::string& script, const std::vector<const char*>& more_extensions, PFN_vkGetInstanceProcAddr loader)
    : VulkanFixture(script, more_extensions, loader) {
    const XrGraphicsBindingVulkan2KHR graphics = binding();
    const XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO, &graphics, 0, system};
    REQUIRE(xrCreateSession(instance, &info, &session) == XR_SUCCESS);
    local = makeSpace(XR_REFERENCE_SPACE_TYPE_LOCAL);
}

SessionFixture::~SessionFixture() = default;

std::vector<XrSessionState> SessionFixture::states() const {
    std::vector<XrSessionState> states;
    XrEventDataBuffer event;
    for (XrStructureType type = poll(event); type != XR_TYPE_UNKNOWN; type = poll(event)) {
        if (type != XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED) continue;
        states.push_back(reinterpret_cast<const XrEventDataSessionStateChanged&>(event).state);
    }
    return states;
}

void SessionFixture::begin() const {
    const XrSessionBeginInfo info{XR_TYPE_SESSION_BEGIN_INFO, nullptr, XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO};
    REQUIRE(xrBeginSession(session, &info) == XR_SUCCESS);
}

XrFrameState SessionFixture::waitFrame() const {
    XrFrameState state{XR_TYPE_FRAME_STATE};
    REQUIRE(XR_SUCCEEDED(xrWaitFrame(session, nullptr, &state)));
    return state;
}

XrResult SessionFixture::endFrame(XrTime time, const std::vector<const XrCompositionLayerBaseHeader*>& layers) const {
    const XrFrameEndInfo info{
        XR_TYPE_FRAME_END_INFO, nullptr, time, XR_ENVIRONMENT_BLEND_MODE_OPAQUE, static_cast<std::uint32_t>(layers.size()), layers.data()};
    return xrEndFrame(session, &info);
}

XrFrameState SessionFixture::frame(const std::vector<const XrCompositionLayerBaseHeader*>& layers) const {
    const XrFrameState state = waitFrame();
    REQUIRE(XR_SUCCEEDED(xrBeginFrame(session, nullptr)));
    REQUIRE(XR_SUCCEEDED(endFrame(state.predictedDisplayTime, layers)));
    return state;
}

void SessionFixture::focus() const {
    begin();
    for (int i = 0; i < 3; ++i) frame();
    REQUIRE(states().back() == XR_SESSION_STATE_FOCUSED);
}

XrSpace SessionFixture::makeSpace(XrReferenceSpaceType type) const {
    const XrReferenceSpaceCreateInfo info{XR_TYPE_REFERENCE_SPACE_CREATE_INFO, nullptr, type, kIdentity};
    XrSpace space = XR_NULL_HANDLE;
    REQUIRE(xrCreateReferenceSpace(session, &info, &space) == XR_SUCCESS);
    return space;
}

XrSwapchainCreateInfo swapchainInfo(VkFormat format) {
    XrSwapchainCreateInfo info{XR_TYPE_SWAPCHAIN_CREATE_INFO};
    const bool is_depth = format == VK_FORMAT_D32_SFLOAT || format == VK_FORMAT_D16_UNORM;
    info.usageFlags = is_depth ? XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT;
    info.format = format;
    info.width = 64;
    info.height = 32;
    info.sampleCount = info.faceCount = info.arraySize = info.mipCount = 1;
    return info;
}

XrSwapchain SessionFixture::makeSwapchain(VkFormat format, XrSwapchainCreateFlags flags) const {
    XrSwapchainCreateInfo info = swapchainInfo(format);
    info.createFlags = flags;
    XrSwapchain swapchain = XR_NULL_HANDLE;
    REQUIRE(xrCreateSwapchain(session, &info, &swapchain) == XR_SUCCESS);
    return swapchain;
}

void SessionFixture::turn(XrSwapchain swapchain) const {
    std::uint32_t index = 0;
    REQUIRE(xrAcquireSwapchainImage(swapchain, nullptr, &index) == XR_SUCCESS);
    const XrSwapchainImageWaitInfo wait{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO, nullptr, XR_INFINITE_DURATION};
    REQUIRE(xrWaitSwapchainImage(swapchain, &wait) == XR_SUCCESS);
    REQUIRE(xrReleaseSwapchainImage(swapchain, nullptr) == XR_SUCCESS);
}

void SessionFixture::attach(const std::vector<XrActionSet>& sets) const {
    const XrSessionActionSetsAttachInfo info{XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO, nullptr, static_cast<std::uint32_t>(sets.size()),
                                             sets.data()};
    REQUIRE(xrAttachSessionActionSets(session, &info) == XR_SUCCESS);
}

XrResult SessionFixture::sync(XrActionSet set, XrPath subaction_path) const {
    const XrActiveActionSet active{set, subaction_path};
    const XrActionsSyncInfo info{XR_TYPE_ACTIONS_SYNC_INFO, nullptr, 1, &active};
    return xrSyncActions(session, &info);
}

}  // namespace binosplat::test
