// The calls that make, begin and end sessions.
#include "xr/simulated/api/api.h"
#include "xr/simulated/api/session.h"
#include "xr/simulated/api/structures.h"
#include "xr/simulated/api/views.h"
#include "xr/simulated/compose/show.h"
#include "xr/simulated/names.h"

namespace simulated {
namespace {

// Graphics bindings of the two extensions are the same structure with the same type. Null: the session is
// headless.
const XrGraphicsBindingVulkan2KHR* checkBinding(const Instance& instance, const XrSessionCreateInfo& info) {
    const auto* const found =
        findInChain<const XrGraphicsBindingVulkan2KHR>(info.next, XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR);
    if (found == nullptr && instance.extensions.contains(XR_MND_HEADLESS_EXTENSION_NAME)) { return nullptr; }
    const bool is_enabled = instance.extensions.contains(XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME) ||
                            instance.extensions.contains(XR_KHR_VULKAN_ENABLE_EXTENSION_NAME);
    require(found != nullptr && is_enabled, XR_ERROR_GRAPHICS_DEVICE_INVALID,
            "no graphics binding of an enabled extension in the chain");
    require(findInChain(found->next, XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR) == nullptr,
            XR_ERROR_GRAPHICS_DEVICE_INVALID, "more than one graphics binding");
    require(instance.has_asked_requirements, XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING,
            "xrGetVulkanGraphicsRequirements(2)KHR was not called");
    require(found->instance != VK_NULL_HANDLE && found->device != VK_NULL_HANDLE &&
                found->physicalDevice != VK_NULL_HANDLE,
            XR_ERROR_GRAPHICS_DEVICE_INVALID, "a Vulkan handle is null");
    require(instance.graphics_device == found->physicalDevice, XR_ERROR_GRAPHICS_DEVICE_INVALID,
            "not the device that xrGetVulkanGraphicsDevice(2)KHR gave");
    return found;
}

}  // namespace

XrResult xrCreateSession(XrInstance instance, const XrSessionCreateInfo* createInfo, XrSession* session) {
    return answerFor<Instance>(__func__, instance, [&](Instance& owner) {
        const XrSessionCreateInfo& info = checkStruct(createInfo, XR_TYPE_SESSION_CREATE_INFO);
        XrSession& output = checkOutput(session);
        require(info.createFlags == 0, XR_ERROR_VALIDATION_FAILURE, "createFlags is ", info.createFlags,
                ", no flags are known");
        checkSystem(info.systemId);
        require(owner.simulation->calls_until_plugged == 0, XR_ERROR_SYSTEM_INVALID,
                "the headset is not there any more");
        const XrGraphicsBindingVulkan2KHR* const binding = checkBinding(owner, info);
        require(owner.session == nullptr, XR_ERROR_LIMIT_REACHED, "one session at a time");
        auto device = binding == nullptr
                          ? nullptr
                          : std::make_unique<Device>(owner.vulkanLoaderOf(binding->instance), *binding);
        Session& created = adopt(owner, std::make_unique<Session>(owner, std::move(device)));
        created.enter(XR_SESSION_STATE_IDLE);
        if (owner.simulation->at(owner.simulation->clock.now()).worn) {
            created.enter(XR_SESSION_STATE_READY);
        }
        output = handleOf(created);
    });
}

XrResult xrDestroySession(XrSession session) {
    return answer(__func__, [&] { destroyObject(get<Session>(session)); });
}

XrResult xrBeginSession(XrSession session, const XrSessionBeginInfo* beginInfo) {
    return answerFor<Session>(__func__, session, [&](Session& begun) {
        const XrSessionBeginInfo& info = checkStruct(beginInfo, XR_TYPE_SESSION_BEGIN_INFO);
        // XR_MND_headless: the view configuration is ignored.
        if (!begun.isHeadless()) {
            checkViewConfiguration(begun.instance, info.primaryViewConfigurationType);
        }
        require(!begun.is_running, XR_ERROR_SESSION_RUNNING, "the session runs already");
        require(begun.state == XR_SESSION_STATE_READY, XR_ERROR_SESSION_NOT_READY, "the session is ",
                wordOf(begun.state), ", must be READY");
        begun.is_running = true;
        if (!begun.isHeadless()) { begun.view_configuration = info.primaryViewConfigurationType; }
        begun.frames = {};
        begun.announced_presence.reset();
        begun.announcePresence(begun.instance.simulation->at(begun.instance.simulation->clock.now()));
        if (begun.isHeadless()) { begun.settle(); }
    });
}

XrResult xrEndSession(XrSession session) {
    return answerFor<Session>(__func__, session, [&](Session& ended) {
        checkRunning(ended);
        const bool may_end = ended.state == XR_SESSION_STATE_STOPPING || ended.loss_announced;
        require(may_end, XR_ERROR_SESSION_NOT_STOPPING, "the session is ", wordOf(ended.state),
                ", must be STOPPING");
        ended.is_running = false;
        wakeFrameWaiters();
        if (ended.loss_announced) { return; }
        ended.enter(XR_SESSION_STATE_IDLE);
        if (ended.wants_exit) { ended.enter(XR_SESSION_STATE_EXITING); }
        logBetween(ended);
    });
}

XrResult xrRequestExitSession(XrSession session) {
    return answerFor<Session>(__func__, session, [&](Session& leaving) {
        checkRunning(leaving);
        leaving.wants_exit = true;
        if (leaving.isHeadless()) { leaving.settle(); }
    });
}

}  // namespace simulated
