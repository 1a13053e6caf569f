// Chapter 9: a session and its life from IDLE to EXITING or LOSS_PENDING. The application's frames drive it: each moves it a state
// towards the one that the script wants, also one that xrEndFrame refused.
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

// Where the calls xrWaitFrame, xrBeginFrame, xrEndFrame stand.
struct FrameLoop {
    std::optional<XrTime> waited;  // returned by xrWaitFrame, not begun yet
    std::optional<XrTime> begun;   // begun, not ended yet
    std::int64_t missed = 0;       // periods that the frame ended last took beyond its own
    std::optional<double> gpu_ms;  // what the script says it took
    bool should_render = false;    // as the frame that was waited for last was told
    bool are_used = false;         // a frame was waited for since the session began
    bool moves_state = false;      // the frame that was begun has yet to move the session's state
    std::string refused_for;       // why it could not be ended
    // When the frame that was begun last is displayed. Another thread may have moved the clock on.
    std::optional<XrTime> last_begun;
};

struct Session : Object {
    using Handle = XrSession;

    Instance& instance;
    // None of a headless session (XR_MND_headless).
    std::unique_ptr<Device> device;
    XrSessionState state = XR_SESSION_STATE_UNKNOWN;
    bool is_running = false;
    bool wants_exit = false;
    // As xrBeginSession was told.
    XrViewConfigurationType view_configuration = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
    FrameLoop frames;
    // From xrAttachSessionActionSets on.
    std::optional<Attachment> attachment;
    std::optional<XrTime> loss_announced, lost_from;
    std::uint32_t slow_images = 0;
    // The eyes' angles as of the frame before: a mask changes with them.
    std::optional<std::array<Fov, kEyes>> masked;
    std::vector<std::string> log_events;
    Automation automation;
    Labels labels;
    // The last user presence reported to the application (XR_EXT_user_presence).
    std::optional<bool> announced_presence;

    Session(Instance& owner, std::unique_ptr<Device> graphics);
    ~Session() override;

    // The script's state at a time, with what the program's own test says of the controllers.
    [[nodiscard]] State at(XrTime time) const;
    void enter(XrSessionState next);
    // A state nearer to what the headset's state at a frame wants.
    void step(const State& wanted);
    // The frame that was begun moves the session, once: when it ends, or when the program gives it up.
    void passFrame(XrTime time);
    // A headless session needs no frames: it goes at once where the script wants it, and each xrSyncActions is a frame's time. If the
    // program waits for frames all the same, time and states go by them, as in any other session.
    [[nodiscard]] bool isHeadless() const { return device == nullptr; }
    void settle();
    void passHeadlessFrame();
    // The script's events up to this display time.
    void meetEvents(XrTime display_time);
    // Tells whether somebody wears the headset, if that is new.
    void announcePresence(const State& now);
    // Time passes while nobody wears the headset: a period with every look for events that finds none.
    void idle();
    // Tells of visibility masks that are others than in the frame before.
    void announceMasks(const State& now);
};

// XR_ERROR_INSTANCE_LOST, XR_ERROR_SESSION_LOST.
void checkNotLost(const Session& session);
inline void checkNotLost(const SessionChild& child) { checkNotLost(child.session); }
// XR_ERROR_SESSION_NOT_RUNNING.
void checkRunning(const Session& session);

// While a loss is pending, whatever succeeds says so.
XrResult successOf(const Session& session, XrResult success);
inline XrResult successOf(const SessionChild& child, XrResult success) { return successOf(child.session, success); }

// Another display rate, from the next frame on; the application is told if it asked to be.
void changeRate(Instance& instance, double rate_hz);

// For an xrWaitFrame on another thread that waits for a frame which will not come any more.
void wakeFrameWaiters();

constexpr int kFramesOfGrace = 3;

}  // namespace simulated
