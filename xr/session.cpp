// The session state machine.
#include "xr/session.h"

#include "engine/platform.h"
#include "xr/extensions/foveated_inset.h"
#include "xr/extensions/user_presence.h"
#include "xr/extensions/vulkan_enable2.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace binosplat::xr {
namespace {

// For runtimes that state no period, or an absurd one.
constexpr double kUsualPeriodSeconds = 1.0 / 90.0;
constexpr double kLongestStepSeconds = 0.1;
constexpr double kShortestPeriodMs = 1.0, kLongestPeriodMs = 100.0;

}  // namespace

void Session::DestroyLocked::operator()(XrSession session) const {
    const std::lock_guard lock(context->queueMutex());
    xrDestroySession(session);
}

Session::Handle Session::create(const Instance& instance, const Context& context) {
    const std::lock_guard lock(context.queueMutex());
    const XrGraphicsBindingVulkan2KHR binding = graphicsBinding(context);
    auto info = structure<XrSessionCreateInfo>(XR_TYPE_SESSION_CREATE_INFO);
    info.next = &binding;
    info.systemId = instance.system();
    XrSession session = XR_NULL_HANDLE;
    BINOSPLAT_XR(xrCreateSession(instance.handle(), &info, &session));
    return {session, {&context}};
}

Session::Session(const Instance& instance, const Context& context, XrViewConfigurationType views)
    : instance_(instance),
      context_(context),
      views_(views),
      session_(create(instance, context)),
      spaces_(handle(), views, views == kStereoWithInset && instance.movesInsets()),
      floor_(instance, handle()),
      hidden_meshes_(instance, handle(), views),
      refresh_rate_(instance, handle()),
      passthrough_(instance, handle()),
      blend_mode_(instance.blendMode(false)) {}

FrameOutcome Session::beginFrame() {
    pollEvents();
    if (ended_) { return FrameOutcome::kExit; }
    if (!running_) { return FrameOutcome::kWait; }
    const XrFrameWaitInfo wait_info{XR_TYPE_FRAME_WAIT_INFO, nullptr};
    frame_state_ = structure<XrFrameState>(XR_TYPE_FRAME_STATE);
    BINOSPLAT_XR(xrWaitFrame(handle(), &wait_info, &frame_state_));
    const XrDuration stated_period = frame_state_.predictedDisplayPeriod;
    if (std::abs(stated_period - told_for_) > stated_period / 100) {
        told_for_ = stated_period;
        told_period_ = refresh_rate_.period();
    }
    pace_.begin(frame_state_.predictedDisplayTime, stated_period, told_period_);
    busy_from_seconds_ = threadSeconds();
    open_from_ = std::chrono::steady_clock::now();
    follows_shown_ = std::exchange(was_shown_, false);
    const XrFrameBeginInfo begin_info{XR_TYPE_FRAME_BEGIN_INFO, nullptr};
    {
        const std::lock_guard lock(context_.queueMutex());
        BINOSPLAT_XR(xrBeginFrame(handle(), &begin_info));
    }
    const double since_last =
        static_cast<double>(frame_state_.predictedDisplayTime - last_display_time_) * 1e-9;
    const bool known = last_display_time_ != 0 && since_last > 0.0;
    step_seconds_ = std::min(known ? since_last : kUsualPeriodSeconds, kLongestStepSeconds);
    last_display_time_ = frame_state_.predictedDisplayTime;
    return frame_state_.shouldRender == XR_TRUE ? FrameOutcome::kRender : FrameOutcome::kSkip;
}

void Session::endFrame(std::span<const XrCompositionLayerBaseHeader* const> layers) {
    auto info = structure<XrFrameEndInfo>(XR_TYPE_FRAME_END_INFO);
    info.displayTime = frame_state_.predictedDisplayTime;
    info.environmentBlendMode = blend_mode_;
    info.layerCount = static_cast<std::uint32_t>(layers.size());
    info.layers = layers.empty() ? nullptr : layers.data();
    busy_seconds_ = threadSeconds() - busy_from_seconds_;
    open_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - open_from_).count();
    pace_.end(!layers.empty(), busy_seconds_);
    was_shown_ = !layers.empty();
    const std::lock_guard lock(context_.queueMutex());
    BINOSPLAT_XR(xrEndFrame(handle(), &info));
}

bool Session::settle(bool demanded) {
    if (spaces_.settle(displayTime(), demanded)) {
        wearing_.forgetPlace();
        return true;
    }
    if (wearing_.hasBegun()) { return false; }
    const std::optional<Pose> head = spaces_.locateHead(displayTime());
    return head && wearing_.begins(is_focused_, *head, stepSeconds()) && Wearing::isElsewhere(*head) &&
           spaces_.settle(displayTime(), true);
}

double Session::periodMs() const {
    const double period_ms = static_cast<double>(pace_.period()) * 1e-6;
    return period_ms >= kShortestPeriodMs && period_ms <= kLongestPeriodMs ? period_ms
                                                                           : 1e3 * kUsualPeriodSeconds;
}

void Session::requestExit() {
    const XrResult result = xrRequestExitSession(handle());
    // A session that is not running can just be left.
    if (XR_FAILED(result)) { end("the session was stopped before it ran"); }
}

void Session::pollEvents() {
    for (;;) {
        auto event = structure<XrEventDataBuffer>(XR_TYPE_EVENT_DATA_BUFFER);
        if (BINOSPLAT_XR(xrPollEvent(instance_.handle(), &event)) == XR_EVENT_UNAVAILABLE) { return; }
        if (event.type == kUserPresenceChanged) {
            const auto& change = reinterpret_cast<const UserPresenceChanged&>(event);
            if (change.session == handle()) { wearing_.hear(change.is_present == XR_TRUE); }
        }
        switch (event.type) {
            case XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED: {
                const auto& change = reinterpret_cast<const XrEventDataSessionStateChanged&>(event);
                if (change.session == handle()) { changeState(change.state); }
                break;
            }
            case XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING:
                throw InstanceLost(kGoingAway);
            case XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING: {
                const auto& change = reinterpret_cast<const XrEventDataReferenceSpaceChangePending&>(event);
                if (change.session == handle() &&
                    change.referenceSpaceType == XR_REFERENCE_SPACE_TYPE_LOCAL) {
                    spaces_.recentreFrom(change.changeTime);
                }
                break;
            }
            case XR_TYPE_EVENT_DATA_VISIBILITY_MASK_CHANGED_KHR:
                hidden_meshes_.read(
                    reinterpret_cast<const XrEventDataVisibilityMaskChangedKHR&>(event).viewIndex);
                break;
            case XR_TYPE_EVENT_DATA_DISPLAY_REFRESH_RATE_CHANGED_FB:
                told_for_ = 0;
                break;
            case XR_TYPE_EVENT_DATA_INTERACTION_PROFILE_CHANGED:
                ++times_held_changed_;
                break;
            case XR_TYPE_EVENT_DATA_EVENTS_LOST: {
                // Asks again for everything that lost events may have reported and that can be asked for.
                // Whether somebody wears the headset cannot: from now on, movement shows it.
                for (const std::uint32_t eye : {0u, 1u}) { hidden_meshes_.read(eye); }
                told_for_ = 0;
                ++times_held_changed_;
                wearing_.forgetPresence();
                const std::uint32_t count =
                    reinterpret_cast<const XrEventDataEventsLost&>(event).lostEventCount;
                instance_.troubles().add(
                    fmt::format("the OpenXR runtime lost {} event{}", count, count == 1 ? "" : "s"));
                break;
            }
            default:
                break;
        }
    }
}

void Session::changeState(XrSessionState state) {
    pace_.interrupt();
    was_shown_ = false;
    is_focused_ = state == XR_SESSION_STATE_FOCUSED;
    switch (state) {
        case XR_SESSION_STATE_FOCUSED:
            ++times_focused_;
            break;
        case XR_SESSION_STATE_READY: {
            auto info = structure<XrSessionBeginInfo>(XR_TYPE_SESSION_BEGIN_INFO);
            info.primaryViewConfigurationType = views_;
            BINOSPLAT_XR(xrBeginSession(handle(), &info));
            running_ = true;
            last_display_time_ = 0;
            break;
        }
        case XR_SESSION_STATE_STOPPING:
            running_ = false;
            BINOSPLAT_XR(xrEndSession(handle()));
            break;
        case XR_SESSION_STATE_EXITING:
            end("the runtime asked for the end");
            break;
        case XR_SESSION_STATE_LOSS_PENDING:
            throw Lost("the session is lost");
        default:
            break;
    }
}

void Session::end(const std::string& why) {
    if (!ended_) { why_ended_ = why; }
    ended_ = true;
    running_ = false;
}

}  // namespace binosplat::xr
