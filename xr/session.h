// One session in the headset: the state machine, the pace of frames, and the poses of the eyes.
#pragma once

#include "engine/geometry.h"
#include "xr/display_pace.h"
#include "xr/instance.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace binosplat::xr {

// The result of beginFrame().
enum class FrameOutcome {
    kRender,  // a frame is open and will be seen: draw, then endFrame with its layers
    kSkip,    // a frame is open but nobody sees it: endFrame without layers
    kWait,    // no frame is open since the session does not run (yet, or for now): call again
    kExit,    // the runtime or the user wants to end: leave; whyEnded() says which
};

// An eye at the predicted display time.
struct EyeView {
    XrPosef pose;
    XrFovf fov;
};

// A part of an eye's picture that the lenses never show: triangles in the plane z = -1 of the eye (OpenXR axes).
struct HiddenMesh {
    std::vector<XrVector2f> vertices;
    std::vector<std::uint32_t> indices;
};

class Session {
public:
    // `context` must have been opened with the instance's deviceMaker(); both outlive the session.
    Session(const Instance& instance, const Context& context);
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;
    ~Session();

    // Takes the runtime's events, waits for the next frame and opens it. Throws Lost if the session is lost or about to be, InstanceLost
    // if the runtime is.
    FrameOutcome beginFrame();
    // Closes the frame with these layers, back to front. Throws Lost and InstanceLost, and Error if the runtime refuses a layer; then
    // the frame is still open.
    void endFrame(std::span<const XrCompositionLayerBaseHeader* const> layers);
    // Shows the room behind the layers, if the headset can; from the next endFrame() on.
    void seeThrough(bool see_through) { blend_mode_ = instance_.blendMode(see_through); }
    // Asks the runtime to end; frames go on until beginFrame() returns kExit.
    void requestExit();

    // Of the open frame.
    [[nodiscard]] XrTime displayTime() const { return frame_state_.predictedDisplayTime; }
    // Seconds from the last frame to this one, at most a tenth, whatever period the runtime states.
    [[nodiscard]] double stepSeconds() const { return step_seconds_; }
    // The display's period, see DisplayPace, in milliseconds, for a frame to fit in; that of 90 Hz if the runtime states none.
    [[nodiscard]] double periodMs() const;
    // See DisplayPace.
    [[nodiscard]] double lostPeriods() const { return pace_.lostPeriods(); }
    // The refresh rates that this headset offers, in its order; empty if it offers no choice.
    [[nodiscard]] std::vector<double> refreshRates() const;
    // Requests a refresh rate, unless it was the last one requested; 0: the runtime's choice. Returns a sentence for people if that
    // fails, otherwise empty. The period follows when the runtime reports it.
    std::string askForRate(double rate_hz);
    // The poses of the eyes in space(); empty if the headset's orientation is unknown. While its position is unknown, the last known one
    // is used.
    [[nodiscard]] std::optional<std::array<EyeView, 2>> locateEyes();

    // The room's origin is at the head, upright and facing its direction: the origins of the runtime's own spaces are arbitrary.
    // Places it for the open frame and those after it, the first time that the head's pose is known, again when the runtime recentred
    // its space, and when `demanded`. Returns true if it did.
    bool settle(bool demanded);
    // The distance of the floor below the room's origin, in metres; empty if the runtime does not know it.
    [[nodiscard]] std::optional<double> floorBelowMetres();

    // The number of times that this program has gained the input.
    [[nodiscard]] int timesFocused() const { return times_focused_; }
    [[nodiscard]] const std::string& whyEnded() const { return why_ended_; }

    [[nodiscard]] XrSession handle() const { return session_; }
    [[nodiscard]] const Instance& instance() const { return instance_; }
    [[nodiscard]] const Context& context() const { return context_; }
    // The room: see settle(). Before that, LOCAL.
    [[nodiscard]] XrSpace space() const { return space_; }
    // The space that moves with the head.
    [[nodiscard]] XrSpace headSpace() const { return head_; }
    // Read at the start and again whenever the runtime reports a change; empty without XR_KHR_visibility_mask.
    [[nodiscard]] const std::array<HiddenMesh, 2>& hiddenMeshes() const { return hidden_meshes_; }
    // A new number whenever they were read.
    [[nodiscard]] int hiddenMeshVersion() const { return hidden_mesh_version_; }

private:
    // Of xrLocateViews, with what is known of it.
    struct Located {
        std::array<EyeView, 2> eyes;
        bool turn_known = false, place_known = false;
    };
    [[nodiscard]] Located locate(XrSpace space) const;
    [[nodiscard]] XrSpace makeSpace(XrReferenceSpaceType type, const XrPosef& pose) const;
    // The display's; 0 if the runtime does not report it.
    [[nodiscard]] XrDuration askForPeriod() const;
    void findFloor();
    void pollEvents();
    void changeState(XrSessionState state);
    void end(const std::string& why);
    void readHiddenMesh(int eye);

    const Instance& instance_;
    const Context& context_;
    XrSession session_ = XR_NULL_HANDLE;
    XrSpace local_ = XR_NULL_HANDLE, space_ = XR_NULL_HANDLE, head_ = XR_NULL_HANDLE;
    XrSpace floor_ = XR_NULL_HANDLE;  // on the floor, somewhere; null: the runtime has none
    int times_focused_ = 0;
    XrFrameState frame_state_ = structure<XrFrameState>(XR_TYPE_FRAME_STATE);
    XrTime last_display_time_ = 0;
    double step_seconds_ = 0.0;
    DisplayPace pace_;
    XrDuration told_period_ = 0, told_for_ = 0;  // the display's period from the runtime, and the stated period at the time of the request
    double busy_from_seconds_ = 0.0;             // of this thread, since the frame began
    double asked_rate_hz_ = 0.0;
    bool running_ = false, ended_ = false;
    bool turn_settled_ = false, place_settled_ = false;
    std::optional<XrTime> recentred_from_;  // the runtime's own recentring
    XrVector3f last_place_{};               // of the head in space(), as it was last known
    std::string why_ended_;
    std::array<HiddenMesh, 2> hidden_meshes_;
    int hidden_mesh_version_ = 0;
    XrEnvironmentBlendMode blend_mode_;
};

}  // namespace binosplat::xr
