// Programs for the simulated runtime, as far as tests need them: an instance, through the standard loader or
// without it; a session on a Vulkan device with validation, or a headless one; frames and actions. Any
// message of the Vulkan validation layer fails the test.
#pragma once

#define XR_USE_GRAPHICS_API_VULKAN
#define XR_USE_TIMESPEC
#include <time.h>
#include <vulkan/vulkan.h>
//
#include <openxr/openxr_platform.h>

#include "tests/xr/simulated/api/simulated_checks.h"

// A function of a fixture's instance: made.XR(xrLocateSpace)(...).
#define XR(name) function<PFN_##name>(#name)

namespace binosplat::test {

inline const std::string kQuietScript = "size 64 64\nframes none\n";
inline constexpr XrTime kStart = 1'000'000'000;  // where time in lock-step begins
inline constexpr XrPosef kIdentity{{0, 0, 0, 1}, {0, 0, 0}};
inline constexpr XrSwapchainImageWaitInfo kWait{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO, nullptr,
                                                XR_INFINITE_DURATION};
inline constexpr auto kStereo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
inline constexpr const char* kTouch = "/interaction_profiles/oculus/touch_controller";
inline constexpr const char* kSimple = "/interaction_profiles/khr/simple_controller";
inline constexpr XrSpaceLocationFlags kValid =
    XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT;
inline constexpr XrSpaceLocationFlags kTracked =
    XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT;
inline constexpr XrSpaceVelocityFlags kMoving =
    XR_SPACE_VELOCITY_LINEAR_VALID_BIT | XR_SPACE_VELOCITY_ANGULAR_VALID_BIT;

using Extensions = std::vector<const char*>;
using Layers = std::vector<const XrCompositionLayerBaseHeader*>;
using Bindings = std::vector<std::pair<XrAction, std::string>>;
XrInstanceCreateInfo instanceInfo(const Extensions& extensions, XrVersion version = XR_MAKE_VERSION(1, 0, 0));
// The result of creating an instance, which is destroyed again.
XrResult tryInstance(const XrInstanceCreateInfo& info,
                     PFN_xrGetInstanceProcAddr find = xrGetInstanceProcAddr);
XrActionSetCreateInfo actionSetInfo(const std::string& name, const std::string& localized_name);
XrActionCreateInfo actionInfo(const std::string& name, const std::string& localized_name,
                              XrActionType type = XR_ACTION_TYPE_BOOLEAN_INPUT);
XrSwapchainCreateInfo swapchainInfo(VkFormat format = VK_FORMAT_R8G8B8A8_SRGB);

// A view of a projection layer, and the layer of such views.
inline XrCompositionLayerProjectionView projectionView(const XrSwapchainSubImage& image, const XrFovf& fov,
                                                       const XrPosef& pose = kIdentity) {
    return {XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW, nullptr, pose, fov, image};
}
template <std::size_t count>
XrCompositionLayerProjection projectionOf(XrSpace space,
                                          const std::array<XrCompositionLayerProjectionView, count>& views) {
    return {XR_TYPE_COMPOSITION_LAYER_PROJECTION, nullptr, 0, space, count, views.data()};
}

template <class Layer>
const XrCompositionLayerBaseHeader* headerOf(const Layer& layer) {
    return reinterpret_cast<const XrCompositionLayerBaseHeader*>(&layer);
}

// The environment that the runtime reads, and an empty folder for what it writes.
class Headset {
public:
    explicit Headset(const std::string& script);
    ~Headset();
    Headset(const Headset&) = delete;
    Headset& operator=(const Headset&) = delete;

    // The log, line by line.
    std::vector<nlohmann::json> logged() const;

    static inline const char* clock = "lockstep";
    std::filesystem::path folder, written;
};

struct InstanceFixture : Headset {
    XrInstance instance = XR_NULL_HANDLE;
    XrSystemId system = XR_NULL_SYSTEM_ID;
    XrSession session = XR_NULL_HANDLE;
    XrPath left = XR_NULL_PATH, right = XR_NULL_PATH;  // hands

    explicit InstanceFixture(const std::string& script = kQuietScript, const Extensions& more_extensions = {})
        : InstanceFixture(script, xrGetInstanceProcAddr, instanceInfo(withUsual(more_extensions))) {}

    ~InstanceFixture() {
        if (instance != XR_NULL_HANDLE) { XR(xrDestroyInstance)(instance); }
    }

    template <class Function>
    Function function(const char* name) const {
        PFN_xrVoidFunction found = nullptr;
        REQUIRE_MESSAGE(find_function(instance, name, &found) == XR_SUCCESS, name);
        return reinterpret_cast<Function>(found);
    }
    bool has(const char* name) const {
        PFN_xrVoidFunction found = nullptr;
        return find_function(instance, name, &found) == XR_SUCCESS;
    }
    // What the system says, also in an extension's structure.
    XrSystemProperties systemProperties(void* of_extension = nullptr) const {
        XrSystemProperties properties{XR_TYPE_SYSTEM_PROPERTIES, of_extension};
        REQUIRE(XR(xrGetSystemProperties)(instance, system, &properties) == XR_SUCCESS);
        return properties;
    }
    XrPath path(const std::string& text) const {
        XrPath path = XR_NULL_PATH;
        REQUIRE(XR(xrStringToPath)(instance, text.c_str(), &path) == XR_SUCCESS);
        return path;
    }
    std::string textOf(XrPath path) const {
        char text[XR_MAX_PATH_LENGTH];
        std::uint32_t count = 0;
        REQUIRE(XR(xrPathToString)(instance, path, sizeof text, &count, text) == XR_SUCCESS);
        return text;
    }
    // The next event's type, or XR_TYPE_UNKNOWN if there is none.
    XrStructureType poll(XrEventDataBuffer& event) const {
        event = {XR_TYPE_EVENT_DATA_BUFFER};
        return XR(xrPollEvent)(instance, &event) == XR_SUCCESS ? event.type : XR_TYPE_UNKNOWN;
    }
    // Those of one type among the waiting events, which are all taken.
    template <class Event>
    std::vector<Event> events(XrStructureType type) const {
        std::vector<Event> found;
        XrEventDataBuffer event;
        for (XrStructureType next = poll(event); next != XR_TYPE_UNKNOWN; next = poll(event)) {
            if (next == type) { found.push_back(reinterpret_cast<const Event&>(event)); }
        }
        return found;
    }
    // The session's new states: "IDLE READY".
    std::string states() const;
    // "100 to 50" for each change of the display's rate.
    std::string rateChanges() const;
    bool isProfileAnnounced() const {
        XrEventDataBuffer event;
        return poll(event) == XR_TYPE_EVENT_DATA_INTERACTION_PROFILE_CHANGED;
    }

    XrActionSet makeActionSet(const std::string& name, std::uint32_t priority = 0) const {
        XrActionSetCreateInfo info = actionSetInfo(name, "the " + name);
        info.priority = priority;
        XrActionSet set = XR_NULL_HANDLE;
        REQUIRE(XR(xrCreateActionSet)(instance, &info, &set) == XR_SUCCESS);
        return set;
    }
    XrAction makeAction(XrActionSet set, const std::string& name, XrActionType type,
                        const std::vector<XrPath>& subaction_paths = {}) const {
        XrActionCreateInfo info = actionInfo(name, "the " + name, type);
        info.countSubactionPaths = static_cast<std::uint32_t>(subaction_paths.size());
        info.subactionPaths = subaction_paths.data();
        XrAction action = XR_NULL_HANDLE;
        REQUIRE(XR(xrCreateAction)(set, &info, &action) == XR_SUCCESS);
        return action;
    }
    XrResult suggest(const std::string& profile, const Bindings& bindings) const {
        std::vector<XrActionSuggestedBinding> all;
        for (const auto& [action, binding] : bindings) { all.push_back({action, path(binding)}); }
        return suggestPaths(profile, all);
    }
    XrResult suggestPaths(const std::string& profile,
                          const std::vector<XrActionSuggestedBinding>& bindings) const {
        const XrInteractionProfileSuggestedBinding info{
            XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING, nullptr, path(profile),
            static_cast<std::uint32_t>(bindings.size()), bindings.data()};
        return XR(xrSuggestInteractionProfileBindings)(instance, &info);
    }
    // Binds a new action.
    XrResult suggest(const std::string& profile, const std::string& binding,
                     XrActionType type = XR_ACTION_TYPE_POSE_INPUT) const {
        const XrActionSet set = makeActionSet("set");
        const XrResult result = suggest(profile, {{makeAction(set, "action", type), binding}});
        REQUIRE(XR(xrDestroyActionSet)(set) == XR_SUCCESS);
        return result;
    }
    void attach(const std::vector<XrActionSet>& sets) const {
        const XrSessionActionSetsAttachInfo info{XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO, nullptr,
                                                 static_cast<std::uint32_t>(sets.size()), sets.data()};
        REQUIRE(XR(xrAttachSessionActionSets)(session, &info) == XR_SUCCESS);
    }
    XrResult sync(const std::vector<XrActiveActionSet>& active = {}) const {
        const XrActionsSyncInfo info{XR_TYPE_ACTIONS_SYNC_INFO, nullptr,
                                     static_cast<std::uint32_t>(active.size()), active.data()};
        return XR(xrSyncActions)(session, &info);
    }
    XrResult sync(XrActionSet set, XrPath subaction_path = XR_NULL_PATH) const {
        return sync({XrActiveActionSet{set, subaction_path}});
    }
    auto boolean(XrAction action, XrPath hand = XR_NULL_PATH) const {
        return stateOf(XR(xrGetActionStateBoolean), XR_TYPE_ACTION_STATE_BOOLEAN, action, hand);
    }
    auto number(XrAction action, XrPath hand = XR_NULL_PATH) const {
        return stateOf(XR(xrGetActionStateFloat), XR_TYPE_ACTION_STATE_FLOAT, action, hand);
    }
    auto vector(XrAction action, XrPath hand = XR_NULL_PATH) const {
        return stateOf(XR(xrGetActionStateVector2f), XR_TYPE_ACTION_STATE_VECTOR2F, action, hand);
    }
    auto pose(XrAction action, XrPath hand = XR_NULL_PATH) const {
        return stateOf(XR(xrGetActionStatePose), XR_TYPE_ACTION_STATE_POSE, action, hand);
    }
    // The path of the current profile, or "none".
    std::string profileOf(XrPath user_path) const {
        XrInteractionProfileState state{XR_TYPE_INTERACTION_PROFILE_STATE};
        REQUIRE(XR(xrGetCurrentInteractionProfile)(session, user_path, &state) == XR_SUCCESS);
        return state.interactionProfile == XR_NULL_PATH ? "none" : textOf(state.interactionProfile);
    }

    XrVulkanInstanceCreateInfoKHR vulkanInstanceInfo(PFN_vkGetInstanceProcAddr loader,
                                                     const VkInstanceCreateInfo& info) const {
        return {XR_TYPE_VULKAN_INSTANCE_CREATE_INFO_KHR, nullptr, system, 0, loader, &info, nullptr};
    }
    XrVulkanDeviceCreateInfoKHR vulkanDeviceInfo(PFN_vkGetInstanceProcAddr loader, VkPhysicalDevice on,
                                                 const VkDeviceCreateInfo& info) const {
        return {XR_TYPE_VULKAN_DEVICE_CREATE_INFO_KHR, nullptr, system, 0, loader, on, &info, nullptr};
    }
    XrResult findGraphicsDevice(VkInstance vulkan, VkPhysicalDevice& found) const {
        const XrVulkanGraphicsDeviceGetInfoKHR get{XR_TYPE_VULKAN_GRAPHICS_DEVICE_GET_INFO_KHR, nullptr,
                                                   system, vulkan};
        return XR(xrGetVulkanGraphicsDevice2KHR)(instance, &get, &found);
    }

    void begin(XrViewConfigurationType type = kStereo) const {
        const XrSessionBeginInfo info{XR_TYPE_SESSION_BEGIN_INFO, nullptr, type};
        REQUIRE(XR(xrBeginSession)(session, &info) == XR_SUCCESS);
    }
    XrFrameState waitFrame() const {
        XrFrameState state{XR_TYPE_FRAME_STATE};
        REQUIRE(XR_SUCCEEDED(XR(xrWaitFrame)(session, nullptr, &state)));
        return state;
    }
    XrResult endFrame(XrTime time, const Layers& layers = {}) const {
        const auto count = static_cast<std::uint32_t>(layers.size());
        const XrFrameEndInfo info{XR_TYPE_FRAME_END_INFO,           nullptr, time,
                                  XR_ENVIRONMENT_BLEND_MODE_OPAQUE, count,   layers.data()};
        return XR(xrEndFrame)(session, &info);
    }
    // Wait, begin, end.
    XrFrameState frame(const Layers& layers = {}) const {
        const XrFrameState state = waitFrame();
        REQUIRE(XR_SUCCEEDED(XR(xrBeginFrame)(session, nullptr)));
        REQUIRE(XR_SUCCEEDED(endFrame(state.predictedDisplayTime, layers)));
        return state;
    }
    // The result of ending a frame with a layer; if it is refused, the frame is ended without the layer.
    XrResult show(const void* layer) const {
        const XrTime time = waitFrame().predictedDisplayTime;
        REQUIRE(XR(xrBeginFrame)(session, nullptr) == XR_SUCCESS);
        const XrResult result = endFrame(time, {static_cast<const XrCompositionLayerBaseHeader*>(layer)});
        if (XR_FAILED(result)) { REQUIRE(endFrame(time) == XR_SUCCESS); }
        return result;
    }

    XrResult trySpace(XrReferenceSpaceType type, XrSpace& space) const {
        const XrReferenceSpaceCreateInfo info{XR_TYPE_REFERENCE_SPACE_CREATE_INFO, nullptr, type, kIdentity};
        return XR(xrCreateReferenceSpace)(session, &info, &space);
    }
    XrSpace makeSpace(XrReferenceSpaceType type) const {
        XrSpace space = XR_NULL_HANDLE;
        REQUIRE(trySpace(type, space) == XR_SUCCESS);
        return space;
    }
    XrSpace makeActionSpace(XrAction action, XrPath hand = XR_NULL_PATH,
                            const XrPosef& pose_in_space = kIdentity) const {
        const XrActionSpaceCreateInfo info{XR_TYPE_ACTION_SPACE_CREATE_INFO, nullptr, action, hand,
                                           pose_in_space};
        XrSpace space = XR_NULL_HANDLE;
        REQUIRE(XR(xrCreateActionSpace)(session, &info, &space) == XR_SUCCESS);
        return space;
    }
    XrSpaceLocation locate(XrSpace space, XrSpace base, XrTime time, void* next = nullptr) const {
        XrSpaceLocation location{XR_TYPE_SPACE_LOCATION, next};
        REQUIRE(XR(xrLocateSpace)(space, base, time, &location) == XR_SUCCESS);
        return location;
    }

protected:
    InstanceFixture(const std::string& script, PFN_xrGetInstanceProcAddr find,
                    const XrInstanceCreateInfo& info)
        : Headset(script), find_function(find) {
        REQUIRE(XR(xrCreateInstance)(&info, &instance) == XR_SUCCESS);
        const XrSystemGetInfo get{XR_TYPE_SYSTEM_GET_INFO, nullptr, XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY};
        REQUIRE(XR(xrGetSystem)(instance, &get, &system) == XR_SUCCESS);
        left = path("/user/hand/left");
        right = path("/user/hand/right");
    }

private:
    static Extensions withUsual(Extensions more) {
        const Extensions usual{XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME,
                               XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME,
                               XR_KHR_VISIBILITY_MASK_EXTENSION_NAME};
        more.insert(more.end(), usual.begin(), usual.end());
        return more;
    }
    template <class State>
    State stateOf(XrResult(XRAPI_PTR* get)(XrSession, const XrActionStateGetInfo*, State*),
                  XrStructureType type, XrAction action, XrPath hand) const {
        State state{type};
        const XrActionStateGetInfo info{XR_TYPE_ACTION_STATE_GET_INFO, nullptr, action, hand};
        REQUIRE(get(session, &info, &state) == XR_SUCCESS);
        return state;
    }

    PFN_xrGetInstanceProcAddr find_function;
};

// A Vulkan instance and device created through a runtime.
struct VulkanDevice {
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical_device = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    std::vector<std::string> messages;

    VulkanDevice(const InstanceFixture& runtime, PFN_vkGetInstanceProcAddr loader);
    ~VulkanDevice();
    VulkanDevice(const VulkanDevice&) = delete;
    VulkanDevice& operator=(const VulkanDevice&) = delete;

    void endDevice();

private:
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
};

struct VulkanFixture : InstanceFixture {
    // All fixtures of a program share those of the first. If the runtime gets Vulkan's functions through a
    // loader, a fixture has its own.
    explicit VulkanFixture(const std::string& script = kQuietScript, const Extensions& more_extensions = {},
                           PFN_vkGetInstanceProcAddr loader = nullptr);
    ~VulkanFixture();

    XrGraphicsBindingVulkan2KHR binding() const;

private:
    std::unique_ptr<VulkanDevice> own;
    VulkanDevice& used;

public:
    const VkInstance vulkan = used.instance;
    const VkPhysicalDevice physical_device = used.physical_device;
    const VkDevice device = used.device;
};

struct SessionFixture : VulkanFixture {
    XrSpace local = XR_NULL_HANDLE;

    explicit SessionFixture(const std::string& script = kQuietScript, const Extensions& more_extensions = {},
                            PFN_vkGetInstanceProcAddr loader = nullptr)
        : VulkanFixture(script, more_extensions, loader) {
        makeSession();
    }

    // Also a second one, once the first is gone.
    void makeSession() {
        const XrGraphicsBindingVulkan2KHR graphics = binding();
        const XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO, &graphics, 0, system};
        REQUIRE(xrCreateSession(instance, &info, &session) == XR_SUCCESS);
        local = makeSpace(XR_REFERENCE_SPACE_TYPE_LOCAL);
    }
    // Begins, and runs frames until the session is FOCUSED.
    void focus() const {
        begin();
        for (int i = 0; i < 3; ++i) { frame(); }
        REQUIRE(states().ends_with("FOCUSED"));
    }
    XrSwapchain makeSwapchain(const XrSwapchainCreateInfo& info = swapchainInfo()) const {
        XrSwapchain swapchain = XR_NULL_HANDLE;
        REQUIRE(xrCreateSwapchain(session, &info, &swapchain) == XR_SUCCESS);
        return swapchain;
    }
    std::vector<VkImage> imagesOf(XrSwapchain swapchain) const;
    // Returns its index.
    std::uint32_t acquire(XrSwapchain swapchain) const {
        std::uint32_t index = 0;
        REQUIRE(xrAcquireSwapchainImage(swapchain, nullptr, &index) == XR_SUCCESS);
        return index;
    }
    // Acquire, wait, use and release.
    std::uint32_t turn(
        XrSwapchain swapchain, const std::function<void(VkImage)>& use = [](VkImage) {}) const {
        const std::uint32_t index = acquire(swapchain);
        REQUIRE(xrWaitSwapchainImage(swapchain, &kWait) == XR_SUCCESS);
        use(imagesOf(swapchain).at(index));
        REQUIRE(xrReleaseSwapchainImage(swapchain, nullptr) == XR_SUCCESS);
        return index;
    }
    // A metre ahead of a space, for both eyes.
    static XrCompositionLayerQuad quadOf(XrSpace space, const XrSwapchainSubImage& image,
                                         const XrExtent2Df& size) {
        return {XR_TYPE_COMPOSITION_LAYER_QUAD, nullptr, 0, space, XR_EYE_VISIBILITY_BOTH, image,
                {{0, 0, 0, 1}, {0, 0, -1}},     size};
    }
};

}  // namespace binosplat::test
