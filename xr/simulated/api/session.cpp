// Sessions: the calls that make, begin and end them, their states, and what the script's events do to them.
#include "xr/simulated/api/session.h"

#include <cmath>

#include "xr/simulated/api/api.h"
#include "xr/simulated/api/structures.h"
#include "xr/simulated/names.h"

namespace simulated {
namespace {

// The state that the wearer and the script would have the session in.
XrSessionState targetOf(const Session& session, const State& wanted) {
    if (session.wants_exit || !wanted.worn) return XR_SESSION_STATE_STOPPING;
    if (!wanted.visible) return XR_SESSION_STATE_SYNCHRONIZED;
    return wanted.focused ? XR_SESSION_STATE_FOCUSED : XR_SESSION_STATE_VISIBLE;
}

// Graphics bindings of the two extensions are the same structure with the same type. None: the session is headless.
const XrGraphicsBindingVulkan2KHR* checkedBinding(const Instance& instance, const XrSessionCreateInfo& info) {
    const XrBaseInStructure* const found = findInChain(info.next, XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR);
    if (found == nullptr && instance.extensions.contains(XR_MND_HEADLESS_EXTENSION_NAME)) return nullptr;
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
    return {loader == instance.vulkan_loaders.end() ? systemVulkanLoader() : loader->second,
            binding.instance,
            binding.physicalDevice,
            binding.device,
            binding.queueFamilyIndex,
            binding.queueIndex};
}

// LOCAL_FLOOR goes where LOCAL goes.
void announceRecentring(const Session& session, XrTime change_time) {
    std::vector<XrReferenceSpaceType> moved{XR_REFERENCE_SPACE_TYPE_LOCAL};
    if (session.instance.has1_1Or(XR_EXT_LOCAL_FLOOR_EXTENSION_NAME)) moved.push_back(XR_REFERENCE_SPACE_TYPE_LOCAL_FLOOR);
    for (const XrReferenceSpaceType type : moved) {
        session.instance.events.push(XrEventDataReferenceSpaceChangePending{XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING,
                                                                            nullptr,
                                                                            handleOf(session),
                                                                            type,
                                                                            change_time,
                                                                            XR_FALSE,
                                                                            {{0, 0, 0, 1}, {0, 0, 0}}});
    }
}

}  // namespace

Session::Session(Instance& owner, std::unique_ptr<Device> graphics) : instance(owner), device(std::move(graphics)) {
    instance.session = this;
}

Session::~Session() {
    wakeFrameWaiters();
    instance.session = nullptr;
    // It was unplugged: a program asks again for everything.
    if (const std::uint32_t calls = instance.simulation->script.calls_after_loss; loss_announced && calls > 0) {
        instance.simulation->calls_until_plugged = calls;
        instance.has_asked_requirements = false;
        instance.graphics_device = VK_NULL_HANDLE;
    }
    instance.events.forget(handleOf(*this));
}

State Session::at(XrTime time) const {
    State scripted = instance.simulation->at(time);
    automation.applyTo(scripted);
    return scripted;
}

void Session::enter(XrSessionState next) {
    state = next;
    log_events.emplace_back("state ").append(wordOf(next));
    instance.events.push(XrEventDataSessionStateChanged{XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED, nullptr, handleOf(*this), next,
                                                        instance.simulation->clock.now()});
}

void Session::step(const State& wanted) {
    if (loss_announced || state == XR_SESSION_STATE_STOPPING) return;
    const XrSessionState target = targetOf(*this, wanted);
    if (state == XR_SESSION_STATE_READY)
        enter(XR_SESSION_STATE_SYNCHRONIZED);
    else if (target == XR_SESSION_STATE_STOPPING && state == XR_SESSION_STATE_SYNCHRONIZED)
        enter(XR_SESSION_STATE_STOPPING);
    else if (target == XR_SESSION_STATE_STOPPING || target < state)
        enter(static_cast<XrSessionState>(state - 1));
    else if (target > state)
        enter(static_cast<XrSessionState>(state + 1));
}

void Session::settle() {
    const Simulation& simulation = *instance.simulation;
    const State wanted = simulation.at(simulation.clock.now());
    for (XrSessionState before = XR_SESSION_STATE_UNKNOWN; before != state;) {
        before = state;
        step(wanted);
    }
}

void Session::passHeadlessFrame() {
    if (frames.are_used) return;
    Clock& clock = instance.simulation->clock;
    if (!clock.isReal()) clock.nextFrame();
    meetEvents(clock.now());
    announcePresence(instance.simulation->at(clock.now()));
    settle();
    log_events.clear();  // nobody logs
}

void Session::meetEvents(XrTime display_time) {
    Simulation& simulation = *instance.simulation;
    const double time_s = simulation.clock.secondsAt(display_time);
    const XrTime grace_ends = display_time + kFramesOfGrace * simulation.clock.period();
    for (const ScriptEvent& event : simulation.script.eventsIn(simulation.events_until_s, time_s)) {
        std::string& logged = log_events.emplace_back(nameOf(event.kind));
        if (event.kind == ScriptEvent::Kind::kRate) logged.append(" ").append(std::to_string(std::lround(event.value)));
        if (event.kind == ScriptEvent::Kind::kSlowImages) logged.append(" ").append(std::to_string(event.count));
        switch (event.kind) {
            case ScriptEvent::Kind::kRate:
                changeRate(instance, event.value);
                break;
            case ScriptEvent::Kind::kSlowImages:
                slow_images = event.count;
                break;
            case ScriptEvent::Kind::kExit:
                wants_exit = true;
                break;
            case ScriptEvent::Kind::kRecentre:
                announceRecentring(*this, simulation.clock.timeAt(event.time_s + ScriptEvent::kNoticeSeconds));
                break;
            case ScriptEvent::Kind::kLoseSession:
                loss_announced = display_time;
                lost_from = grace_ends;
                simulation.survives = true;
                enter(XR_SESSION_STATE_LOSS_PENDING);
                break;
            case ScriptEvent::Kind::kLoseInstance:
                instance.lost_from = grace_ends;
                simulation.survives = true;
                instance.events.push(
                    XrEventDataInstanceLossPending{XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING, nullptr, *instance.lost_from});
                break;
        }
    }
    simulation.events_until_s = time_s;
}

void Session::announcePresence(const State& now) {
    const bool present = now.present && now.worn;
    if (!instance.extensions.contains(XR_EXT_USER_PRESENCE_EXTENSION_NAME) || announced_presence == present) return;
    announced_presence = present;
    instance.events.push(XrEventDataUserPresenceChangedEXT{XR_TYPE_EVENT_DATA_USER_PRESENCE_CHANGED_EXT, nullptr, handleOf(*this),
                                                           static_cast<XrBool32>(present)});
}

void Session::idle() {
    if (state != XR_SESSION_STATE_IDLE || is_running) return;
    Simulation& simulation = *instance.simulation;
    simulation.clock.pass();
    const XrTime now = simulation.clock.now();
    meetEvents(now);
    if (loss_announced) return;
    if (wants_exit)
        enter(XR_SESSION_STATE_EXITING);
    else if (simulation.at(now).worn)
        enter(XR_SESSION_STATE_READY);
}

void Session::announceMasks(const State& now) {
    if (!instance.simulation->script.visibility_mask || !instance.extensions.contains(XR_KHR_VISIBILITY_MASK_EXTENSION_NAME)) return;
    for (const Side side : kSides) {
        if (!masked || (*masked)[side] == now.eyes[side].fov) continue;
        instance.events.push(XrEventDataVisibilityMaskChangedKHR{XR_TYPE_EVENT_DATA_VISIBILITY_MASK_CHANGED_KHR, nullptr, handleOf(*this),
                                                                 XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO,
                                                                 static_cast<std::uint32_t>(side)});
    }
    masked = {now.eyes[kLeft].fov, now.eyes[kRight].fov};
}

Session& getSession(XrSession session) {
    Session& found = get<Session>(session);
    checkNotLost(found);
    return found;
}

void checkNotLost(const Session& session) {
    getInstance(handleOf(session.instance));
    require(!session.lost_from || session.instance.simulation->clock.now() < *session.lost_from, XR_ERROR_SESSION_LOST,
            "the script lost it");
}

XrResult successOf(const Session& session, XrResult success) { return session.loss_announced ? XR_SESSION_LOSS_PENDING : success; }

XrResult xrCreateSession(XrInstance instance, const XrSessionCreateInfo* createInfo, XrSession* session) {
    return answer(__func__, [&] {
        Instance& owner = getInstance(instance);
        const XrSessionCreateInfo& info = checked(createInfo, XR_TYPE_SESSION_CREATE_INFO);
        XrSession& output = checkedOutput(session);
        require(info.createFlags == 0, XR_ERROR_VALIDATION_FAILURE, "no session creation flags are known");
        checkSystem(info.systemId);
        require(owner.simulation->calls_until_plugged == 0, XR_ERROR_SYSTEM_INVALID, "the headset is not there any more");
        const XrGraphicsBindingVulkan2KHR* const binding = checkedBinding(owner, info);
        require(owner.session == nullptr, XR_ERROR_LIMIT_REACHED, "one session at a time");
        auto device = binding == nullptr ? nullptr : std::make_unique<Device>(graphicsOf(owner, *binding));
        Session& created = adopt(owner, std::make_unique<Session>(owner, std::move(device)));
        created.enter(XR_SESSION_STATE_IDLE);
        if (owner.simulation->at(owner.simulation->clock.now()).worn) created.enter(XR_SESSION_STATE_READY);
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
        const XrSessionBeginInfo& info = checked(beginInfo, XR_TYPE_SESSION_BEGIN_INFO);
        // XR_MND_headless: whatever it says is ignored.
        if (!begun.isHeadless()) checkViewConfiguration(begun.instance, info.primaryViewConfigurationType);
        require(!begun.is_running, XR_ERROR_SESSION_RUNNING, "the session runs already");
        require(begun.state == XR_SESSION_STATE_READY, XR_ERROR_SESSION_NOT_READY, "the session is not READY");
        begun.is_running = true;
        begun.frames = {};
        begun.announced_presence.reset();
        begun.announcePresence(begun.instance.simulation->at(begun.instance.simulation->clock.now()));
        if (begun.isHeadless()) begun.settle();
        return successOf(begun);
    });
}

XrResult xrEndSession(XrSession session) {
    return answer(__func__, [&] {
        Session& ended = getSession(session);
        require(ended.is_running, XR_ERROR_SESSION_NOT_RUNNING, "the session does not run");
        const bool may_end = ended.state == XR_SESSION_STATE_STOPPING || ended.loss_announced;
        require(may_end, XR_ERROR_SESSION_NOT_STOPPING, "the session is not STOPPING");
        ended.is_running = false;
        wakeFrameWaiters();
        if (ended.loss_announced) return XR_SESSION_LOSS_PENDING;
        ended.enter(XR_SESSION_STATE_IDLE);
        if (ended.wants_exit) ended.enter(XR_SESSION_STATE_EXITING);
        return XR_SUCCESS;
    });
}

XrResult xrRequestExitSession(XrSession session) {
    return answer(__func__, [&] {
        Session& leaving = getSession(session);
        require(leaving.is_running, XR_ERROR_SESSION_NOT_RUNNING, "the session does not run");
        leaving.wants_exit = true;
        if (leaving.isHeadless()) leaving.settle();
        return successOf(leaving);
    });
}

}  // namespace simulated
