// The programs' instances, Vulkan devices, sessions and frames, and the messages of Vulkan's validation.
#include "tests/xr/simulated/api/simulated_fixture.h"

#include <fmt/ranges.h>

#include <unistd.h>

namespace binosplat::test {
namespace {

namespace fs = std::filesystem;

VkBool32 keepMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                     const VkDebugUtilsMessengerCallbackDataEXT* data, void* messages) {
    static_cast<std::vector<std::string>*>(messages)->emplace_back(data->pMessage);
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfo(std::vector<std::string>& messages) {
    constexpr auto kSevere =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT;
    return {VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT, nullptr,     0,        kSevere,
            VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,          keepMessage, &messages};
}

template <std::size_t size>
void setText(char (&destination)[size], const std::string& text) {
    REQUIRE(text.size() < size);
    std::strcpy(destination, text.c_str());
}

VulkanDevice& sharedDevice(const InstanceFixture& runtime) {
    static VulkanDevice device(runtime, vkGetInstanceProcAddr);
    return device;
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
    setenv("SIMULATED_OPENXR_CLOCK", clock, 1);
}

Headset::~Headset() {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
}

std::vector<nlohmann::json> Headset::logged() const {
    std::vector<nlohmann::json> lines;
    for (const std::string& line : linesIn(textIn(written / "frames.jsonl"))) {
        lines.push_back(nlohmann::json::parse(line));
    }
    return lines;
}

std::string InstanceFixture::states() const {
    static constexpr std::array kNames{"UNKNOWN", "IDLE",     "READY",        "SYNCHRONIZED", "VISIBLE",
                                       "FOCUSED", "STOPPING", "LOSS_PENDING", "EXITING"};
    std::vector<std::string> names;
    for (const auto& event :
         events<XrEventDataSessionStateChanged>(XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED)) {
        names.push_back(kNames.at(static_cast<std::size_t>(event.state)));
    }
    return fmt::format("{}", fmt::join(names, " "));
}

std::string InstanceFixture::rateChanges() const {
    std::string text;
    for (const auto& event :
         events<XrEventDataDisplayRefreshRateChangedFB>(XR_TYPE_EVENT_DATA_DISPLAY_REFRESH_RATE_CHANGED_FB)) {
        text += fmt::format("{} to {}", event.fromDisplayRefreshRate, event.toDisplayRefreshRate);
    }
    return text;
}

XrInstanceCreateInfo instanceInfo(const Extensions& extensions, XrVersion version) {
    XrInstanceCreateInfo info{XR_TYPE_INSTANCE_CREATE_INFO};
    setText(info.applicationInfo.applicationName, "test");
    info.applicationInfo.apiVersion = version;
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.enabledExtensionNames = extensions.data();
    return info;
}

XrResult tryInstance(const XrInstanceCreateInfo& info, PFN_xrGetInstanceProcAddr find) {
    PFN_xrVoidFunction create = nullptr, destroy = nullptr;
    REQUIRE(find(XR_NULL_HANDLE, "xrCreateInstance", &create) == XR_SUCCESS);
    XrInstance instance = XR_NULL_HANDLE;
    const XrResult result = reinterpret_cast<PFN_xrCreateInstance>(create)(&info, &instance);
    if (result == XR_SUCCESS) {
        REQUIRE(find(instance, "xrDestroyInstance", &destroy) == XR_SUCCESS);
        CHECK(reinterpret_cast<PFN_xrDestroyInstance>(destroy)(instance) == XR_SUCCESS);
    }
    return result;
}

XrActionSetCreateInfo actionSetInfo(const std::string& name, const std::string& localized_name) {
    XrActionSetCreateInfo info{XR_TYPE_ACTION_SET_CREATE_INFO};
    setText(info.actionSetName, name);
    setText(info.localizedActionSetName, localized_name);
    return info;
}

XrActionCreateInfo actionInfo(const std::string& name, const std::string& localized_name, XrActionType type) {
    XrActionCreateInfo info{XR_TYPE_ACTION_CREATE_INFO};
    setText(info.actionName, name);
    setText(info.localizedActionName, localized_name);
    info.actionType = type;
    return info;
}

XrSwapchainCreateInfo swapchainInfo(VkFormat format) {
    XrSwapchainCreateInfo info{XR_TYPE_SWAPCHAIN_CREATE_INFO};
    const bool is_depth = format == VK_FORMAT_D32_SFLOAT || format == VK_FORMAT_D16_UNORM ||
                          format == VK_FORMAT_D24_UNORM_S8_UINT || format == VK_FORMAT_D32_SFLOAT_S8_UINT;
    info.usageFlags =
        is_depth ? XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT;
    info.format = format;
    info.width = 64;
    info.height = 32;
    info.sampleCount = info.faceCount = info.arraySize = info.mipCount = 1;
    return info;
}

VulkanDevice::VulkanDevice(const InstanceFixture& runtime, PFN_vkGetInstanceProcAddr loader) {
    const VkApplicationInfo application{
        VK_STRUCTURE_TYPE_APPLICATION_INFO, nullptr, "test", 0, nullptr, 0, VK_API_VERSION_1_1};
    const char* const layer = "VK_LAYER_KHRONOS_validation";
    const char* const extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    const VkValidationFeatureEnableEXT feature = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkDebugUtilsMessengerCreateInfoEXT messenger_info = messengerInfo(messages);
    const VkValidationFeaturesEXT features{
        VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT, &messenger_info, 1, &feature, 0, nullptr};
    const VkInstanceCreateInfo vulkan_info{
        VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, &features, 0, &application, 1, &layer, 1, &extension};
    const XrVulkanInstanceCreateInfoKHR info = runtime.vulkanInstanceInfo(loader, vulkan_info);
    VkResult result = VK_ERROR_UNKNOWN;
    REQUIRE(runtime.XR(xrCreateVulkanInstanceKHR)(runtime.instance, &info, &instance, &result) == XR_SUCCESS);
    REQUIRE(result == VK_SUCCESS);
    const auto makeMessenger = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"));
    REQUIRE(makeMessenger(instance, &messenger_info, nullptr, &messenger) == VK_SUCCESS);

    REQUIRE(runtime.findGraphicsDevice(instance, physical_device) == XR_SUCCESS);
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue_info{
        VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, 0, 1, &priority};
    const VkDeviceCreateInfo device_info{
        VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, nullptr, 0, 1, &queue_info, 0, nullptr, 0, nullptr, nullptr};
    const XrVulkanDeviceCreateInfoKHR make = runtime.vulkanDeviceInfo(loader, physical_device, device_info);
    REQUIRE(runtime.XR(xrCreateVulkanDeviceKHR)(runtime.instance, &make, &device, &result) == XR_SUCCESS);
    REQUIRE(result == VK_SUCCESS);
}

void VulkanDevice::endDevice() { vkDestroyDevice(std::exchange(device, VK_NULL_HANDLE), nullptr); }

VulkanDevice::~VulkanDevice() {
    endDevice();
    reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"))(instance, messenger, nullptr);
    vkDestroyInstance(instance, nullptr);
    if (messages.empty()) { return; }
    // At the end of the tests.
    for (const std::string& message : messages) { std::fprintf(stderr, "%s\n", message.c_str()); }
    std::_Exit(1);
}

VulkanFixture::VulkanFixture(const std::string& script, const Extensions& more_extensions,
                             PFN_vkGetInstanceProcAddr loader)
    : InstanceFixture(script, more_extensions),
      own(loader == nullptr ? nullptr : std::make_unique<VulkanDevice>(*this, loader)),
      used(own == nullptr ? sharedDevice(*this) : *own) {
    XrGraphicsRequirementsVulkan2KHR requirements{XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN2_KHR};
    REQUIRE(XR(xrGetVulkanGraphicsRequirements2KHR)(instance, system, &requirements) == XR_SUCCESS);
    VkPhysicalDevice found = VK_NULL_HANDLE;
    REQUIRE(findGraphicsDevice(vulkan, found) == XR_SUCCESS);
    REQUIRE(found == physical_device);
}

VulkanFixture::~VulkanFixture() {
    // OpenXR's objects are destroyed first, since they hold images of this device.
    XR(xrDestroyInstance)(std::exchange(instance, XR_NULL_HANDLE));
    if (own != nullptr) { own->endDevice(); }
    for (const std::string& message : std::exchange(used.messages, {})) { FAIL_CHECK(message); }
}

XrGraphicsBindingVulkan2KHR VulkanFixture::binding() const {
    return {XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR, nullptr, vulkan, physical_device, device, 0, 0};
}

std::vector<VkImage> SessionFixture::imagesOf(XrSwapchain swapchain) const {
    using Image = XrSwapchainImageVulkan2KHR;
    const auto list = [&](std::uint32_t capacity, std::uint32_t* count, Image* found) {
        return xrEnumerateSwapchainImages(swapchain, capacity, count,
                                          reinterpret_cast<XrSwapchainImageBaseHeader*>(found));
    };
    std::vector<VkImage> images;
    for (const Image& one : checkList<Image>(list, {XR_TYPE_SWAPCHAIN_IMAGE_VULKAN2_KHR})) {
        images.push_back(one.image);
    }
    return images;
}

}  // namespace binosplat::test
