// Chapter 9: a session and its life from IDLE to EXITING or LOSS_PENDING. The application's frames drive it:
// each, even one that xrEndFrame refused, moves it a state towards the one that the script wants.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "xr/simulated/api/attachment.h"
#include "xr/simulated/api/automation.h"
#include "xr/simulated/api/device.h"
#include "xr/simulated/api/handles.h"
#include "xr/simulated/api/instance.h"

namespace simulated {

// The progress of the calls xrWaitFrame, xrBeginFrame, xrEndFrame.
struct FrameLoop {
    std::optional<XrTime> waited;  // returned by xrWaitFrame, not begun yet
    std::optional<XrTime> begun;   // begun, not ended yet
    std::int64_t missed = 0;       // periods beyond its own that the last ended frame took
    std::optional<double> gpu_ms;  // the GPU time that the script gives it
    bool should_render = false;    // what the last xrWaitFrame answered
    bool are_used = false;         // a frame was waited for since the session began
    bool moves_state = false;      // the frame that was begun has yet to move the session's state
    std::string refused_for;       // why the begun frame could not be ended
    // Display time of the frame begun last. Another thread may have moved the clock on.
    std::optional<XrTime> last_begun;
};

struct Session : Object {
    using Handle = XrSession;

    Instance& instance;
    // Null for a headless session (XR_MND_headless).
    std::unique_ptr<Device> device;
    XrSessionState state = XR_SESSION_STATE_UNKNOWN;
    bool is_running = false;
    bool wants_exit = false;
    // As the last xrLocateViews asked (XR_VARJO_foveated_rendering).
    bool moves_insets = false;
    // As xrBeginSession was told.
    XrViewConfigurationType view_configuration = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
    FrameLoop frames;
    // From xrAttachSessionActionSets on.
    std::optional<Attachment> attachment;
    std::optional<XrTime> loss_announced, lost_from;
    std::uint32_t slow_images = 0;
    // The eyes' angles in the previous frame: a mask changes with them.
    std::optional<std::array<Fov, kEyes>> masked;
    std::vector<std::string> log_events;
    Automation automation;
    Labels labels;
    // The last user presence reported to the application (XR_EXT_user_presence).
    std::optional<bool> announced_presence;

    Session(Instance& owner, std::unique_ptr<Device> graphics);
    ~Session() override;

    // The script's state at a time, with the controllers as the program's own test sets them.
    [[nodiscard]] State at(XrTime time) const;
    void enter(XrSessionState next);
    // Moves one state towards the one that the headset's state at a frame asks for.
    void step(const State& wanted);
    // A begun frame moves the session once: when it ends, or when the program gives it up.
    void passFrame(XrTime time);
    // A headless session needs no frames: it enters the script's state at once, and each xrSyncActions takes
    // a frame's time. If the program waits for frames nevertheless, they drive time and states, as in any
    // other session.
    [[nodiscard]] bool isHeadless() const { return device == nullptr; }
    void settle();
    void passHeadlessFrame();
    // Handles the script's events up to this display time.
    void meetEvents(XrTime display_time);
    // Announces whether somebody wears the headset, if that changed.
    void announcePresence(const State& now);
    // Lets time pass while nobody wears the headset: a period for each xrPollEvent that finds no event.
    void idle();
    // Announces visibility masks that changed since the previous frame.
    void announceMasks(const State& now);
};

// XR_ERROR_INSTANCE_LOST, XR_ERROR_SESSION_LOST.
void checkNotLost(const Session& session);
inline void checkNotLost(const SessionChild& child) { checkNotLost(child.session); }
// XR_ERROR_SESSION_NOT_RUNNING.
void checkRunning(const Session& session);

// While a loss is pending, every success becomes XR_SESSION_LOSS_PENDING.
XrResult successOf(const Session& session, XrResult success);
inline XrResult successOf(const SessionChild& child, XrResult success) {
    return successOf(child.session, success);
}

// Another display rate, from the next frame on; the application is told if it enabled the extension.
void changeRate(Instance& instance, double rate_hz);

// Wakes an xrWaitFrame on another thread: the frame that it waits for was begun, or never will be.
void wakeFrameWaiters();

constexpr int kFramesOfGrace = 3;

}  // namespace simulated
