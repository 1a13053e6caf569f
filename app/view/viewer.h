// The viewer's loop: what the wearer sees, frame by frame.
#pragma once

#include "app/view/drawn_settings.h"
#include "app/view/files/picture_writer.h"
#include "app/view/frame_submission.h"
#include "app/view/headset/headset_connection.h"
#include "app/view/headset/waiting_frames.h"
#include "app/view/kept_picture.h"
#include "app/view/message_line.h"
#include "app/view/panel/scene_requests.h"
#include "app/view/room/fade.h"
#include "app/view/room/vignette.h"
#include "app/view/scene_pointing.h"
#include "app/view/viewer_window.h"
#include "app/view/wearer/gaze_follower.h"
#include "app/view/wearer/wearer_controls.h"
#include "app/view/wearer_place.h"

#include <chrono>

namespace binosplat {

class Viewer {
public:
    // `instance` and `context` must outlive the viewer. Begins to load the scene. Frames are shown in
    // `window`, too, if it is given.
    Viewer(const ViewOptions& options, const ViewSettings& settings, xr::Instance& instance,
           const Context& context, EventWindow* window);

    // Runs until the runtime, the wearer, Ctrl-C or --frames ends it. Prints changes by frame, and why it
    // ended, to stdout. A lost session is followed by another one, with the scene as it is, once there is a
    // headset. Throws errors of the scene and the device, and Error (exit code 3) if the runtime is lost.
    void run();

private:
    // One turn of the loop; false at its end.
    bool step();
    // The eyes at the time for which the open frame is drawn; empty if the headset cannot tell.
    [[nodiscard]] std::optional<FrameViews> locate();
    [[nodiscard]] ConnectedHeadset& headset() const { return *connection_.headset(); }  // while there is one
    void loseHeadset(const std::string& why);
    // Replaces a lost session if there is a headset; false at the end.
    bool comeBack();
    void drawFrame();
    // Keeps the window alive while no frame is drawn for the headset.
    void drawWindowAlone(const std::string& why);
    // True if the next scene is loaded, and nothing is being done with this one; with its frames if `met`.
    [[nodiscard]] bool canTakeScene(bool met) const {
        return (met ? scenes_.isNextMet() : scenes_.isNextReady()) && !pictures_.isTaking();
    }
    void takeScene();
    // Has frames made for the scene that comes next, as it will be seen from where the wearer is.
    void meetComing(FrameViews& views);
    // Moves the room's origin to the head, once its pose is known or on request.
    void settle();
    void renderWaiting();
    void recordPanel(Commands& commands);
    // Chooses hands, rays and other things in the room for this frame.
    void chooseThings(const WearerNow& wearer, const FrameViews& views);
    // Reports errors of a scene that loads while it is shown, and once that everything in view is loaded.
    void sayLive(LoadedScene& scene);
    void showFrame(const FrameViews& views);
    // Lays out the widgets; acquires an image for the panel if it is `hung` and has changed.
    void layOutPanel(bool hung, double step_seconds);
    void takeWindowInput(double step_seconds);
    void togglePanel();
    void followPanel(const PanelRequests& requests);
    void openAndSave(const PanelRequests& requests);
    // The other scene of a comparison: takes it once it is loaded, and shows it while a button is held.
    void takeOther();
    void showOther();
    // Once frames can show it; it goes if they cannot.
    void meetOther();
    void reloadShaders();
    void sayPicture(const std::optional<std::string>& outcome);
    // In the log and on the panel.
    void say(const std::string& message);
    void sayChange();
    void keepPreferences(double step_seconds, bool at_once);
    void leave();

    ViewOptions options_;
    xr::Instance& instance_;
    const Context& context_;
    ViewState state_;
    FrameLog log_;
    // Says things in the log alone, or also on the panel and in front of the eyes.
    const Say log_line_ = [this](const std::string& line) { log_.say(line); };
    const Say say_ = [this](const std::string& message) { say(message); };
    HeadsetConnection connection_;
    SceneRenderer renderer_;
    FrameSubmission submission_;
    Panel panel_;
    ViewerWindow window_;
    bool panel_hangs_ = false;  // in this frame
    WearerControls controls_;
    Vignette vignette_;
    Fade fade_;
    bool is_new_view_ = false;  // another scene or another origin of the room, in this frame
    GazeFollower gaze_;
    WaitingFrames waiting_;
    ScenePointing pointing_;
    bool picture_asked_ = false;  // for the next frame
    std::uint64_t frames_without_scene_ = 0;
    // Everything in the first view of a streamed scene is loaded, and that was reported.
    bool said_there_ = false;
    bool other_asked_ = false;  // by the panel: it stays in sight
    bool recentre_asked_ = false, leaving_ = false;
    std::chrono::steady_clock::time_point last_alone_{};
    SceneNotes notes_;
    MessageLine message_line_;
    WearerPlace place_;
    FileWorker files_;   // its thread ends before the users of its results
    ShownScene scenes_;  // its loading thread ends before them
    DrawnSettings drawn_;
    SceneRequests requests_;
    KeptPicture kept_picture_;
    PictureWriter pictures_;  // last: it shows scenes
};

}  // namespace binosplat
