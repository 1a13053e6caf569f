// A session's states, and how the script's events change them.
#include "xr/simulated/api/session.h"

#include <cmath>

#include "xr/simulated/api/api.h"
#include "xr/simulated/api/poses.h"
#include "xr/simulated/api/structures.h"
#include "xr/simulated/compose/show.h"
#include "xr/simulated/names.h"

namespace simulated {
namespace {

// The state in which the wearer and the script want the session to be.
XrSessionState targetOf(const Session& session, const State& wanted) {
    if (session.wants_exit || !wanted.worn) { return XR_SESSION_STATE_STOPPING; }
    if (!wanted.visible) { return XR_SESSION_STATE_SYNCHRONIZED; }
    return wanted.focused ? XR_SESSION_STATE_FOCUSED : XR_SESSION_STATE_VISIBLE;
}

// LOCAL_FLOOR moves along with LOCAL.
void announceRecentring(const Session& session, double change_s) {
    const Simulation& simulation = *session.instance.simulation;
    const XrTime change_time = simulation.clock.timeAt(change_s);
    const auto announce = [&](XrReferenceSpaceType type, Pose (Script::*stage_from_space)(double) const) {
        // Just before and after, since the time itself is a sum and subject to rounding.
        constexpr double kBeside = 1e-6;
        const Pose before = (simulation.script.*stage_from_space)(change_s - kBeside),
                   after = (simulation.script.*stage_from_space)(change_s + kBeside);
        session.instance.events.push(XrEventDataReferenceSpaceChangePending{
            XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING, nullptr, handleOf(session), type, change_time,
            XR_TRUE, toXr(compose(inverse(before), after))});
    };
    announce(XR_REFERENCE_SPACE_TYPE_LOCAL, &Script::stageFromLocal);
    if (session.instance.has1_1Or(XR_EXT_LOCAL_FLOOR_EXTENSION_NAME)) {
        announce(XR_REFERENCE_SPACE_TYPE_LOCAL_FLOOR, &Script::stageFromLocalFloor);
    }
}

}  // namespace

Session::Session(Instance& owner, std::unique_ptr<Device> graphics)
    : instance(owner), device(std::move(graphics)) {
    instance.session = this;
}

Session::~Session() {
    wakeFrameWaiters();
    try {
        logBetween(*this);
    } catch (const std::exception& failure) { explainFailure("xrDestroySession", failure.what()); }
    instance.session = nullptr;
    // The headset was unplugged: the program must ask for everything again.
    if (const std::uint32_t calls = instance.simulation->script.calls_after_loss;
        loss_announced && calls > 0) {
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
    instance.events.push(XrEventDataSessionStateChanged{XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED, nullptr,
                                                        handleOf(*this), next,
                                                        instance.simulation->clock.now()});
}

void Session::step(const State& wanted) {
    if (loss_announced || state == XR_SESSION_STATE_STOPPING) { return; }
    const XrSessionState target = targetOf(*this, wanted);
    if (state == XR_SESSION_STATE_READY) {
        enter(XR_SESSION_STATE_SYNCHRONIZED);
    } else if (target == XR_SESSION_STATE_STOPPING && state == XR_SESSION_STATE_SYNCHRONIZED) {
        enter(XR_SESSION_STATE_STOPPING);
        // There may be no further frame to log it.
        if (!frames.begun) { logBetween(*this); }
    } else if (target == XR_SESSION_STATE_STOPPING || target < state) {
        enter(static_cast<XrSessionState>(state - 1));
    } else if (target > state) {
        enter(static_cast<XrSessionState>(state + 1));
    }
}

void Session::passFrame(XrTime time) {
    if (std::exchange(frames.moves_state, false)) { step(at(time)); }
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
    if (frames.are_used) { return; }
    Clock& clock = instance.simulation->clock;
    if (!clock.isReal()) { clock.nextFrame(); }
    meetEvents(clock.now());
    announcePresence(instance.simulation->at(clock.now()));
    settle();
    log_events.clear();  // headless sessions log nothing
}

void Session::meetEvents(XrTime display_time) {
    Simulation& simulation = *instance.simulation;
    const double time_s = simulation.clock.secondsAt(display_time);
    const XrTime grace_ends = display_time + kFramesOfGrace * simulation.clock.period();
    for (const ScriptEvent& event : simulation.script.eventsIn(simulation.events_until_s, time_s)) {
        std::string& logged = log_events.emplace_back(nameOf(event.kind));
        if (event.kind == ScriptEvent::Kind::kRate) {
            logged.append(" ").append(std::to_string(std::lround(event.value)));
        }
        if (event.kind == ScriptEvent::Kind::kSlowImages) {
            logged.append(" ").append(std::to_string(event.count));
        }
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
                announceRecentring(*this, event.time_s + ScriptEvent::kNoticeSeconds);
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
                instance.events.push(XrEventDataInstanceLossPending{XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING,
                                                                    nullptr, *instance.lost_from});
                break;
        }
    }
    simulation.events_until_s = time_s;
}

void Session::announcePresence(const State& now) {
    const bool present = now.present && now.worn;
    if (!instance.extensions.contains(XR_EXT_USER_PRESENCE_EXTENSION_NAME) || announced_presence == present) {
        return;
    }
    announced_presence = present;
    instance.events.push(XrEventDataUserPresenceChangedEXT{XR_TYPE_EVENT_DATA_USER_PRESENCE_CHANGED_EXT,
                                                           nullptr, handleOf(*this),
                                                           static_cast<XrBool32>(present)});
}

void Session::idle() {
    if (state != XR_SESSION_STATE_IDLE || is_running) { return; }
    Simulation& simulation = *instance.simulation;
    frames.last_begun.reset();
    simulation.clock.pass();
    const XrTime now = simulation.clock.now();
    meetEvents(now);
    if (loss_announced) { return; }
    if (wants_exit) {
        enter(XR_SESSION_STATE_EXITING);
        logBetween(*this);
    } else if (simulation.at(now).worn) {
        enter(XR_SESSION_STATE_READY);
    }
}

void Session::announceMasks(const State& now) {
    if (!instance.simulation->script.visibility_mask ||
        !instance.extensions.contains(XR_KHR_VISIBILITY_MASK_EXTENSION_NAME)) {
        return;
    }
    for (const Side side : kSides) {
        if (!masked || (*masked)[side] == now.eyes[side].fov) { continue; }
        instance.events.push(XrEventDataVisibilityMaskChangedKHR{
            XR_TYPE_EVENT_DATA_VISIBILITY_MASK_CHANGED_KHR, nullptr, handleOf(*this), view_configuration,
            static_cast<std::uint32_t>(side)});
    }
    masked = {now.eyes[kLeft].fov, now.eyes[kRight].fov};
}

void checkNotLost(const Session& session) {
    checkNotLost(session.instance);
    require(!session.lost_from || session.instance.simulation->clock.now() < *session.lost_from,
            XR_ERROR_SESSION_LOST, "the script lost the session");
}

void checkRunning(const Session& session) {
    require(session.is_running, XR_ERROR_SESSION_NOT_RUNNING, "the session does not run");
}

XrResult successOf(const Session& session, XrResult success) {
    return session.loss_announced && XR_SUCCEEDED(success) ? XR_SESSION_LOSS_PENDING : success;
}

}  // namespace simulated
