// Programs for the simulated runtime, as far as tests need them: an instance through the standard loader, a session on a Vulkan device with
// validation, frames. Any message of the Vulkan validation layer fails the test.
#pragma once

#define XR_USE_GRAPHICS_API_VULKAN
#define XR_USE_TIMESPEC
#include <time.h>
#include <vulkan/vulkan.h>
//
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <doctest/doctest.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

namespace doctest {
template <>
struct StringMaker<XrResult> {
    static String convert(XrResult result);
};
}  // namespace doctest

namespace binosplat::test {

inline constexpr const char* kQuietScript = "size 64 64\nframes none\n";

// The environment that the runtime reads, and an empty folder for what it writes; both end with the test.
class Headset {
public:
    explicit Headset(const std::string& script);
    ~Headset();
    Headset(const Headset&) = delete;
    Headset& operator=(const Headset&) = delete;

    std::filesystem::path folder, written;
};

struct InstanceFixture : Headset {
    XrInstance instance = XR_NULL_HANDLE;
    XrSystemId system = XR_NULL_SYSTEM_ID;

    explicit InstanceFixture(const std::string& script = kQuietScript, const std::vector<const char*>& more_extensions = {});
    ~InstanceFixture();

    XrPath path(const std::string& text) const;
    XrActionSet makeActionSet(const std::string& name, std::uint32_t priority = 0) const;
    XrAction makeAction(XrActionSet set, const std::string& name, XrActionType type, const std::vector<XrPath>& subaction_paths = {}) const;
    XrResult suggest(const std::string& profile, const std::vector<XrActionSuggestedBinding>& bindings) const;
    // The next event's type; XR_TYPE_UNKNOWN if none waits.
    XrStructureType poll(XrEventDataBuffer& event) const;

    template <class Function>
    Function function(const char* name) const {
        PFN_xrVoidFunction found = nullptr;
        REQUIRE(xrGetInstanceProcAddr(instance, name, &found) == XR_SUCCESS);
        return reinterpret_cast<Function>(found);
    }
};

XrInstanceCreateInfo instanceInfo(const std::vector<const char*>& extensions);

// A Vulkan instance and device made through the runtime.
struct VulkanFixture : InstanceFixture {
    VkInstance vulkan = VK_NULL_HANDLE;
    VkPhysicalDevice physical_device = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    std::vector<std::string> messages;

    // The loader is what the runtime finds Vulkan's functions by.
    explicit VulkanFixture(const std::string& script = kQuietScript, const std::vector<const char*>& more_extensions = {},
                           PFN_vkGetInstanceProcAddr loader = vkGetInstanceProcAddr);
    ~VulkanFixture();

    XrGraphicsBindingVulkan2KHR binding() const;
    VkQueue queue() const;

private:
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
};

struct SessionFixture : VulkanFixture {
    XrSession session = XR_NULL_HANDLE;
    XrSpace local = XR_NULL_HANDLE;

    explicit SessionFixture(const std::string& script = kQuietScript, const std::vector<const char*>& more_extensions = {},
                            PFN_vkGetInstanceProcAddr loader = vkGetInstanceProcAddr);
    ~SessionFixture();

    // The states of all events that wait.
    std::vector<XrSessionState> states() const;
    void begin() const;
    XrFrameState waitFrame() const;
    XrResult endFrame(XrTime time, const std::vector<const XrCompositionLayerBaseHeader*>& layers = {}) const;
    // Wait, begin, end.
    XrFrameState frame(const std::vector<const XrCompositionLayerBaseHeader*>& layers = {}) const;
    // Begins, and runs frames until the session is FOCUSED.
    void focus() const;
    XrSpace makeSpace(XrReferenceSpaceType type) const;
    XrSwapchain makeSwapchain(VkFormat format = VK_FORMAT_R8G8B8A8_SRGB, XrSwapchainCreateFlags flags = 0) const;
    // Acquire, wait, release.
    void turn(XrSwapchain swapchain) const;
    void attach(const std::vector<XrActionSet>& sets) const;
    XrResult sync(XrActionSet set, XrPath subaction_path = XR_NULL_PATH) const;
};

XrSwapchainCreateInfo swapchainInfo(VkFormat format = VK_FORMAT_R8G8B8A8_SRGB);

inline constexpr XrPosef kIdentity{{0, 0, 0, 1}, {0, 0, 0}};

}  // namespace binosplat::test
