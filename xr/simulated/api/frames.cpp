// Sections 10.4 and 10.5: the frame loop. In lock-step, xrWaitFrame advances time by one period and does not
// sleep.
#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <thread>

#include "xr/simulated/api/api.h"
#include "xr/simulated/api/layers.h"
#include "xr/simulated/api/session.h"
#include "xr/simulated/api/spaces.h"
#include "xr/simulated/api/structures.h"
#include "xr/simulated/compose/show.h"
#include "xr/simulated/names.h"

namespace simulated {
namespace {

// An xrWaitFrame on another thread waits here for xrBeginFrame.
std::condition_variable& getFrameBegun() {
    static std::condition_variable begun;
    return begun;
}

Session& getRunningSession(XrSession session) {
    Session& found = get<Session>(session);
    checkNotLost(found);
    checkRunning(found);
    return found;
}

void checkBlendMode(XrEnvironmentBlendMode mode, const Script& script) {
    const bool is_known =
        mode >= XR_ENVIRONMENT_BLEND_MODE_OPAQUE && mode <= XR_ENVIRONMENT_BLEND_MODE_ALPHA_BLEND;
    require(is_known, XR_ERROR_VALIDATION_FAILURE, mode, " is not a blend mode");
    const bool is_offered = std::ranges::any_of(script.blend_modes, [&](Script::BlendMode offered) {
        return static_cast<int>(offered) + 1 == static_cast<int>(mode);
    });
    require(is_offered, XR_ERROR_ENVIRONMENT_BLEND_MODE_UNSUPPORTED, "the headset does not offer ",
            wordOf(mode));
}

// A begun frame that is refused is logged, once for each reason; the program may try to end it again.
const XrFrameEndInfo& checkFrame(Session& session, const XrFrameEndInfo* frame_end_info) {
    try {
        const XrFrameEndInfo& info = checkStruct(frame_end_info, XR_TYPE_FRAME_END_INFO);
        require(session.frames.begun.has_value(), XR_ERROR_CALL_ORDER_INVALID,
                "xrBeginFrame was not called for this frame");
        checkTime(info.displayTime);
        checkBlendMode(info.environmentBlendMode, session.instance.simulation->script);
        checkLayers(session, info);
        return info;
    } catch (const Refusal& refusal) {
        if (session.frames.begun &&
            std::exchange(session.frames.refused_for, refusal.reason) != refusal.reason) {
            logBetween(session, &refusal);
        }
        throw;
    }
}

// A frame is displayed in the first period in which the device is done with it.
void loadGpu(Session& session, const XrFrameEndInfo& info) {
    const Simulation& simulation = *session.instance.simulation;
    const GpuLoad load = simulation.script.gpu_load.at(simulation.clock.secondsAt(info.displayTime));
    session.frames.gpu_ms.reset();
    if (load.amount == 0 || session.isHeadless()) { return; }
    double megapixels = 0;
    for (std::uint32_t i = 0; i < info.layerCount; ++i) {
        if (info.layers[i]->type != XR_TYPE_COMPOSITION_LAYER_PROJECTION) { continue; }
        const auto& layer = *reinterpret_cast<const XrCompositionLayerProjection*>(info.layers[i]);
        for (std::uint32_t view = 0; view < layer.viewCount; ++view) {
            const XrExtent2Di& size = layer.views[view].subImage.imageRect.extent;
            megapixels += 1e-6 * size.width * size.height;
        }
    }
    const double period_ms = 1e-6 * static_cast<double>(simulation.clock.period());
    session.frames.gpu_ms = load.ms(period_ms, megapixels);
    session.frames.missed = std::max<std::int64_t>(
        static_cast<std::int64_t>(std::ceil(*session.frames.gpu_ms / period_ms - 1e-9)) - 1, 0);
}

}  // namespace

void wakeFrameWaiters() { getFrameBegun().notify_all(); }

XrResult xrWaitFrame(XrSession session, const XrFrameWaitInfo* frameWaitInfo, XrFrameState* frameState) {
    Clock::Frame frame{};
    std::unique_lock lock(getRuntimeLock());
    const XrResult result = answerUnlocked(__func__, [&] {
        getRunningSession(session);
        checkOptional(frameWaitInfo, XR_TYPE_FRAME_WAIT_INFO);
        XrFrameState& output = checkStruct(frameState, XR_TYPE_FRAME_STATE);
        // The session may end meanwhile, so it is looked up again each time.
        getFrameBegun().wait(lock, [&] {
            const Session* const waiting = find<Session>(session);
            return waiting == nullptr || !waiting->is_running || !waiting->frames.waited;
        });
        Session& owner = getRunningSession(session);
        Simulation& simulation = *owner.instance.simulation;
        // Time goes on even though no frame ends.
        if (!owner.frames.refused_for.empty()) { owner.passFrame(simulation.clock.now()); }
        const std::int64_t missed = std::exchange(owner.frames.missed, 0);
        frame = simulation.clock.nextFrame(missed);
        const State state = simulation.at(frame.display_time);
        owner.meetEvents(frame.display_time);
        owner.announceMasks(state);
        owner.announcePresence(state);
        const bool is_visible =
            owner.state == XR_SESSION_STATE_VISIBLE || owner.state == XR_SESSION_STATE_FOCUSED;
        owner.frames.waited = frame.display_time;
        owner.frames.are_used = true;
        owner.frames.should_render = is_visible && state.should_render && !owner.isHeadless();
        output.predictedDisplayTime = frame.display_time;
        output.predictedDisplayPeriod =
            simulation.clock.period() *
            (simulation.script.stretches_period && !simulation.clock.isReal() ? 1 + missed : 1);
        output.shouldRender = owner.frames.should_render;
        if (!simulation.clock.isReal()) { frame.wake_time = {}; }
        return successOf(owner, XR_SUCCESS);
    });
    lock.unlock();
    deliverMessages();
    if (XR_SUCCEEDED(result)) { std::this_thread::sleep_until(frame.wake_time); }
    return result;
}

XrResult xrBeginFrame(XrSession session, const XrFrameBeginInfo* frameBeginInfo) {
    return answerFor<Session>(__func__, session, [&](Session& owner) {
        checkRunning(owner);
        checkOptional(frameBeginInfo, XR_TYPE_FRAME_BEGIN_INFO);
        require(owner.frames.waited.has_value(), XR_ERROR_CALL_ORDER_INVALID,
                "xrWaitFrame was not called for this frame");
        const bool is_discarding = owner.frames.begun.has_value();
        if (is_discarding) { owner.passFrame(*owner.frames.begun); }
        owner.frames.begun = std::exchange(owner.frames.waited, std::nullopt);
        owner.frames.last_begun = owner.frames.begun;
        owner.frames.moves_state = true;
        owner.frames.refused_for.clear();
        if (owner.instance.simulation->script.changes_state_at_begin) {
            owner.passFrame(*owner.frames.begun);
        }
        wakeFrameWaiters();
        return is_discarding ? XR_FRAME_DISCARDED : XR_SUCCESS;
    });
}

XrResult xrEndFrame(XrSession session, const XrFrameEndInfo* frameEndInfo) {
    return answerFor<Session>(__func__, session, [&](Session& owner) {
        checkRunning(owner);
        const XrFrameEndInfo& info = checkFrame(owner, frameEndInfo);
        owner.frames.begun.reset();
        owner.frames.refused_for.clear();
        const State state = owner.at(info.displayTime);
        loadGpu(owner, info);
        showFrame(owner, info, state);
        owner.passFrame(info.displayTime);
    });
}

}  // namespace simulated
