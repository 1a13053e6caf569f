// One stay in the headset: the state machine, the pace of frames, and where the eyes are.
#pragma once

#include "engine/geometry.h"
#include "xr/display_pace.h"
#include "xr/instance.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace binosplat::xr {

// What beginFrame() found.
enum class FrameOutcome {
    kRender,  // a frame is open and will be seen: draw, then endFrame with its layers
    kSkip,    // a frame is open but nobody sees it: endFrame without layers
    kWait,    // no frame is open since the session does not run (yet, or for now): come again
    kExit,    // the runtime or the user wants the end: leave; whyEnded() says which
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

    // Takes the runtime's events, waits for the next frame and opens it. Throws Lost where the session is lost or about to be, InstanceLost
    // where the runtime is.
    FrameOutcome beginFrame();
    // Closes the frame with these layers, back to front. Throws Lost and InstanceLost, and Error where the runtime refuses a layer: then
    // the frame is still open.
    void endFrame(std::span<const XrCompositionLayerBaseHeader* const> layers);
    // Whether the room shows behind the layers, where the headset can; from the next endFrame() on.
    void seeThrough(bool see_through) { blend_mode_ = instance_.blendMode(see_through); }
    // Asks the runtime for the end; frames go on until beginFrame() returns kExit.
    void requestExit();

    // Of the open frame.
    [[nodiscard]] XrTime displayTime() const { return frame_state_.predictedDisplayTime; }
    // Seconds from the last frame to this one, at most a tenth, whatever period the runtime states.
    [[nodiscard]] double stepSeconds() const { return step_seconds_; }
    // Of the display, see DisplayPace, in milliseconds: what a frame may take; 90 Hz where the runtime states none.
    [[nodiscard]] double periodMs() const;
    // See DisplayPace.
    [[nodiscard]] double lostPeriods() const { return pace_.lostPeriods(); }
    // Frames a second that this headset can be asked for, in its order; empty where it cannot be asked.
    [[nodiscard]] std::vector<double> refreshRates() const;
    // Asks for so many frames a second, if that is not what was asked for last; 0: what the runtime likes. A sentence for people where that
    // cannot be had, empty otherwise. The period follows when the runtime says so.
    std::string askForRate(double rate_hz);
    // Where the eyes are in space(); empty where the headset does not know how it is turned. While it does not know where it is, it stays
    // where it was last.
    [[nodiscard]] std::optional<std::array<EyeView, 2>> locateEyes();

    // The room begins at the head, upright, and ahead is where it looks: nothing may be assumed of where the runtime's own spaces begin.
    // Puts it there for the open frame and those after it, the first time that the head's pose is known, again when the runtime recentred
    // its space, and where `demanded`. Whether it did.
    bool settle(bool demanded);
    // How far below the room's origin the floor lies, in metres; empty where the runtime does not know.
    [[nodiscard]] std::optional<double> floorBelowMetres();

    // How often input has begun to come to this program.
    [[nodiscard]] int timesFocused() const { return times_focused_; }
    [[nodiscard]] const std::string& whyEnded() const { return why_ended_; }

    [[nodiscard]] XrSession handle() const { return session_; }
    [[nodiscard]] const Instance& instance() const { return instance_; }
    [[nodiscard]] const Context& context() const { return context_; }
    // The room: see settle(). Before that, LOCAL.
    [[nodiscard]] XrSpace space() const { return space_; }
    // What moves with the head.
    [[nodiscard]] XrSpace headSpace() const { return head_; }
    // Read at the start and again whenever the runtime says so; empty without XR_KHR_visibility_mask.
    [[nodiscard]] const std::array<HiddenMesh, 2>& hiddenMeshes() const { return hidden_meshes_; }
    // Another number whenever they were read.
    [[nodiscard]] int hiddenMeshVersion() const { return hidden_mesh_version_; }

private:
    // Of xrLocateViews, with what is known of it.
    struct Located {
        std::array<EyeView, 2> eyes;
        bool turn_known = false, place_known = false;
    };
    [[nodiscard]] Located locate(XrSpace space) const;
    [[nodiscard]] XrSpace makeSpace(XrReferenceSpaceType type, const XrPosef& pose) const;
    // The display's; 0 where the runtime does not say it.
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
    XrDuration told_period_ = 0, told_for_ = 0;  // what the runtime says of the display, and the stated period at which it was asked
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
