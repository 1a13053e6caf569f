// The calls that make, begin and end sessions.
#include "xr/simulated/api/api.h"
#include "xr/simulated/api/session.h"
#include "xr/simulated/api/structures.h"
#include "xr/simulated/api/views.h"
#include "xr/simulated/compose/show.h"
#include "xr/simulated/names.h"

namespace simulated {
namespace {

// Graphics bindings of the two extensions are the same structure with the same type. None: the session is headless.
const XrGraphicsBindingVulkan2KHR* checkBinding(const Instance& instance, const XrSessionCreateInfo& info) {
    const XrBaseInStructure* const found = findInChain(info.next, XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR);
    if (found == nullptr && instance.extensions.contains(XR_MND_HEADLESS_EXTENSION_NAME)) { return nullptr; }
    const bool is_enabled = instance.extensions.contains(XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME) ||
                            instance.extensions.contains(XR_KHR_VULKAN_ENABLE_EXTENSION_NAME);
    require(found != nullptr && is_enabled, XR_ERROR_GRAPHICS_DEVICE_INVALID, "no graphics binding of an enabled extension in the chain");
    require(findInChain(found->next, XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR) == nullptr, XR_ERROR_GRAPHICS_DEVICE_INVALID,
            "more than one graphics binding");
    require(instance.has_asked_requirements, XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING,
            "xrGetVulkanGraphicsRequirements(2)KHR was not called");
    const auto& binding = *reinterpret_cast<const XrGraphicsBindingVulkan2KHR*>(found);
    require(binding.instance != VK_NULL_HANDLE && binding.device != VK_NULL_HANDLE && binding.physicalDevice != VK_NULL_HANDLE,
            XR_ERROR_GRAPHICS_DEVICE_INVALID, "a Vulkan handle is null");
    require(instance.graphics_device == binding.physicalDevice, XR_ERROR_GRAPHICS_DEVICE_INVALID,
            "not the device that xrGetVulkanGraphicsDevice(2)KHR gave");
    return &binding;
}

GraphicsBinding graphicsOf(const Instance& instance, const XrGraphicsBindingVulkan2KHR& binding) {
    const auto loader = instance.vulkan_loaders.find(binding.instance);
    return {loader == instance.vulkan_loaders.end() ? findSystemVulkanLoader() : loader->second,
            binding.instance,
            binding.physicalDevice,
            binding.device,
            binding.queueFamilyIndex,
            binding.queueIndex};
}

}  // namespace

XrResult xrCreateSession(XrInstance instance, const XrSessionCreateInfo* createInfo, XrSession* session) {
    return answer(__func__, [&] {
        Instance& owner = getInstance(instance);
        const XrSessionCreateInfo& info = checkStruct(createInfo, XR_TYPE_SESSION_CREATE_INFO);
        XrSession& output = checkOutput(session);
        require(info.createFlags == 0, XR_ERROR_VALIDATION_FAILURE, "createFlags is ", info.createFlags, ", no flags are known");
        checkSystem(info.systemId);
        require(owner.simulation->calls_until_plugged == 0, XR_ERROR_SYSTEM_INVALID, "the headset is not there any more");
        const XrGraphicsBindingVulkan2KHR* const binding = checkBinding(owner, info);
        require(owner.session == nullptr, XR_ERROR_LIMIT_REACHED, "one session at a time");
        auto device = binding == nullptr ? nullptr : std::make_unique<Device>(graphicsOf(owner, *binding));
        Session& created = adopt(owner, std::make_unique<Session>(owner, std::move(device)));
        created.enter(XR_SESSION_STATE_IDLE);
        if (owner.simulation->at(owner.simulation->clock.now()).worn) { created.enter(XR_SESSION_STATE_READY); }
        output = handleOf(created);
        return XR_SUCCESS;
    });
}

XrResult xrDestroySession(XrSession session) {
    return answer(__func__, [&] {
        destroyObject(get<Session>(session));
        return XR_SUCCESS;
    });
}

XrResult xrBeginSession(XrSession session, const XrSessionBeginInfo* beginInfo) {
    return answer(__func__, [&] {
        Session& begun = getSession(session);
        const XrSessionBeginInfo& info = checkStruct(beginInfo, XR_TYPE_SESSION_BEGIN_INFO);
        // XR_MND_headless: whatever it says is ignored.
        if (!begun.isHeadless()) { checkViewConfiguration(begun.instance, info.primaryViewConfigurationType); }
        require(!begun.is_running, XR_ERROR_SESSION_RUNNING, "the session runs already");
        require(begun.state == XR_SESSION_STATE_READY, XR_ERROR_SESSION_NOT_READY, "the session is ", wordOf(begun.state),
                ", must be READY");
        begun.is_running = true;
        if (!begun.isHeadless()) { begun.view_configuration = info.primaryViewConfigurationType; }
        begun.frames = {};
        begun.announced_presence.reset();
        begun.announcePresence(begun.instance.simulation->at(begun.instance.simulation->clock.now()));
        if (begun.isHeadless()) { begun.settle(); }
        return successOf(begun);
    });
}

XrResult xrEndSession(XrSession session) {
    return answer(__func__, [&] {
        Session& ended = getSession(session);
        require(ended.is_running, XR_ERROR_SESSION_NOT_RUNNING, "the session does not run");
        const bool may_end = ended.state == XR_SESSION_STATE_STOPPING || ended.loss_announced;
        require(may_end, XR_ERROR_SESSION_NOT_STOPPING, "the session is ", wordOf(ended.state), ", must be STOPPING");
        ended.is_running = false;
        wakeFrameWaiters();
        if (ended.loss_announced) { return XR_SESSION_LOSS_PENDING; }
        ended.enter(XR_SESSION_STATE_IDLE);
        if (ended.wants_exit) { ended.enter(XR_SESSION_STATE_EXITING); }
        logBetween(ended);
        return XR_SUCCESS;
    });
}

XrResult xrRequestExitSession(XrSession session) {
    return answer(__func__, [&] {
        Session& leaving = getSession(session);
        require(leaving.is_running, XR_ERROR_SESSION_NOT_RUNNING, "the session does not run");
        leaving.wants_exit = true;
        if (leaving.isHeadless()) { leaving.settle(); }
        return successOf(leaving);
    });
}

}  // namespace simulated
