// Chapter 9: a session and its life from IDLE to EXITING or LOSS_PENDING. The application's frames drive it: each xrEndFrame moves it a
// state towards the one that the script wants.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "xr/simulated/attachment.h"
#include "xr/simulated/device.h"
#include "xr/simulated/handles.h"
#include "xr/simulated/instance.h"

namespace simulated {

// Where the calls xrWaitFrame, xrBeginFrame, xrEndFrame stand.
struct FrameLoop {
    std::optional<XrTime> waited;  // returned by xrWaitFrame, not begun yet
    std::optional<XrTime> begun;   // begun, not ended yet
    bool should_render = false;    // as the frame that was waited for last was told
};

struct Session : Object {
    using Handle = XrSession;

    Instance& instance;
    Device device;
    XrSessionState state = XR_SESSION_STATE_UNKNOWN;
    bool is_running = false;
    bool wants_exit = false;
    FrameLoop frames;
    // From xrAttachSessionActionSets on.
    std::optional<Attachment> attachment;
    std::optional<XrTime> loss_announced, lost_from;
    std::uint32_t slow_images = 0;
    // The eyes' angles as of the frame before: a mask changes with them.
    std::optional<std::array<Fov, kEyes>> masked;
    std::vector<std::string> log_events;

    Session(Instance& owner, const GraphicsBinding& binding);
    ~Session() override;

    void enter(XrSessionState next);
    // After an xrEndFrame whose frame shows the headset in this state.
    void step(const State& wanted);
    // What the script lets happen once, up to this display time.
    void meetEvents(XrTime display_time);
    // Time passes while nobody wears the headset: a period with every look for events that finds none.
    void idle();
    // Tells of visibility masks that are others than in the frame before.
    void announceMasks(const State& now);
};

// XR_ERROR_HANDLE_INVALID, XR_ERROR_INSTANCE_LOST, XR_ERROR_SESSION_LOST.
Session& getSession(XrSession session);
// The same for a session's children.
void checkNotLost(const Session& session);

// While a loss is pending, whatever succeeds says so.
XrResult successOf(const Session& session, XrResult success = XR_SUCCESS);

// For an xrWaitFrame on another thread that waits for a frame which will not come any more.
void wakeFrameWaiters();

constexpr int kFramesOfGrace = 3;

}  // namespace simulated
