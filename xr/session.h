// One session in the headset: the state machine, and the pace of frames.
#pragma once

#include "engine/gpu/context.h"
#include "xr/display_pace.h"
#include "xr/extensions/passthrough.h"
#include "xr/extensions/refresh_rate.h"
#include "xr/extensions/visibility_mask.h"
#include "xr/floor.h"
#include "xr/instance.h"
#include "xr/spaces.h"
#include "xr/wearing.h"

#include <array>
#include <chrono>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace binosplat::xr {

// The result of beginFrame().
enum class FrameOutcome {
    kRender,  // a frame is open and will be seen: draw, then endFrame with its layers
    kSkip,    // a frame is open but nobody sees it: endFrame without layers
    kWait,    // no frame is open since the session is not running (yet, or for now): call again
    kExit,    // the runtime or the user wants to end: leave; whyEnded() says which
};

class Session {
public:
    // `context` must have been opened with deviceMaker(instance); both must outlive the session. `views` is
    // kStereo, or kStereoWithInset if findInset() found one.
    Session(const Instance& instance, const Context& context, XrViewConfigurationType views = kStereo);
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    // Handles the runtime's events, waits for the next frame and opens it. Throws Lost if the session is lost
    // or about to be, InstanceLost if the runtime is.
    FrameOutcome beginFrame();
    // Closes the frame with these layers, back to front. Throws Lost and InstanceLost, and Error if the
    // runtime refuses a layer; then the frame is still open.
    void endFrame(std::span<const XrCompositionLayerBaseHeader* const> layers);
    // Shows the room behind the layers, if the headset can; from the next endFrame() on.
    void seeThrough(bool see_through) {
        blend_mode_ = instance_.blendMode(see_through);
        passthrough_.show(see_through && instance_.hasPassthrough());
    }
    // What is to lie below all other layers of a frame; null: nothing.
    [[nodiscard]] const XrCompositionLayerBaseHeader* roomLayer() const { return passthrough_.layer(); }
    // Asks the runtime to end; frames go on until beginFrame() returns kExit.
    void requestExit();

    // Of the open frame.
    [[nodiscard]] XrTime displayTime() const { return frame_state_.predictedDisplayTime; }
    // Seconds from the last frame to this one, at most a tenth, whatever period the runtime states.
    [[nodiscard]] double stepSeconds() const { return step_seconds_; }
    // The display's period in milliseconds, see DisplayPace; that of 90 Hz if the runtime states none, or an
    // absurd one.
    [[nodiscard]] double periodMs() const;
    // See DisplayPace.
    [[nodiscard]] double lostPeriods() const { return pace_.lostPeriods(); }
    // True if the frame before the open one was shown, too.
    [[nodiscard]] bool followsShown() const { return follows_shown_; }
    // Of the last frame that was ended: this thread's processor time, and the time for which it was open.
    [[nodiscard]] double busySeconds() const { return busy_seconds_; }
    [[nodiscard]] double openSeconds() const { return open_seconds_; }
    // See RefreshRate. The period follows a request when the runtime reports it.
    [[nodiscard]] std::vector<double> refreshRates() const { return refresh_rate_.list(); }
    std::string askForRate(double rate_hz) { return refresh_rate_.request(rate_hz); }

    // See Spaces and Floor; for the open frame. The room is also settled once somebody begins to wear the
    // headset, unless the head is still where the room begins.
    bool settle(bool demanded);
    [[nodiscard]] std::optional<std::array<EyeView, 2>> locateEyes() {
        return spaces_.locateEyes(displayTime());
    }
    [[nodiscard]] const std::optional<std::array<XrFovf, 2>>& insets() const { return spaces_.insets(); }
    [[nodiscard]] std::optional<double> floorBelowMetres() {
        return floor_.belowMetres(space(), displayTime());
    }
    [[nodiscard]] XrSpace space() const { return spaces_.room(); }
    [[nodiscard]] XrSpace headSpace() const { return spaces_.head(); }

    // The number of times that this program has gained the input.
    [[nodiscard]] int timesFocused() const { return times_focused_; }
    // How often hands may have taken something else up.
    [[nodiscard]] int timesHeldChanged() const { return times_held_changed_; }
    [[nodiscard]] const std::string& whyEnded() const { return why_ended_; }

    [[nodiscard]] XrSession handle() const { return session_.get(); }
    [[nodiscard]] const Instance& instance() const { return instance_; }
    [[nodiscard]] const Context& context() const { return context_; }
    [[nodiscard]] const std::array<HiddenMesh, 2>& hiddenMeshes() const { return hidden_meshes_.meshes(); }
    [[nodiscard]] int hiddenMeshVersion() const { return hidden_meshes_.version(); }

private:
    // Destroys the session and its children, with the queue locked.
    struct DestroyLocked {
        const Context* context;
        void operator()(XrSession session) const;
    };
    using Handle = Owned<XrSession, DestroyLocked>;

    [[nodiscard]] static Handle create(const Instance& instance, const Context& context);
    void pollEvents();
    void changeState(XrSessionState state);
    void end(const std::string& why);

    const Instance& instance_;
    const Context& context_;
    XrViewConfigurationType views_;
    Handle session_;
    Spaces spaces_;
    Wearing wearing_;
    bool is_focused_ = false;
    Floor floor_;
    HiddenMeshes hidden_meshes_;
    RefreshRate refresh_rate_;
    Passthrough passthrough_;
    int times_focused_ = 0;
    int times_held_changed_ = 0;
    XrFrameState frame_state_ = structure<XrFrameState>(XR_TYPE_FRAME_STATE);
    XrTime last_display_time_ = 0;
    double step_seconds_ = 0.0;
    DisplayPace pace_;
    // The display's period from the runtime, and the stated period at the time of the request.
    XrDuration told_period_ = 0, told_for_ = 0;
    double busy_from_seconds_ = 0.0;  // this thread's time when the frame began
    std::chrono::steady_clock::time_point open_from_;
    double busy_seconds_ = 0.0, open_seconds_ = 0.0;
    bool was_shown_ = false, follows_shown_ = false;
    bool running_ = false, ended_ = false;
    std::string why_ended_;
    XrEnvironmentBlendMode blend_mode_;
};

}  // namespace binosplat::xr
