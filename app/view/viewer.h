// The viewer's loop: what the wearer sees, frame by frame.
#pragma once

#include "app/view/files/picture_writer.h"
#include "app/view/headset/headset_connection.h"
#include "app/view/headset/taken_layers.h"
#include "app/view/headset/waiting_frames.h"
#include "app/view/panel/first_steps.h"
#include "app/view/panel/panel.h"
#include "app/view/placement/ruler.h"
#include "app/view/room/fade.h"
#include "app/view/room/vignette.h"
#include "app/view/scene_renderer.h"
#include "app/view/scenes/picture_copy.h"
#include "app/view/scenes/scene_notes.h"
#include "app/view/scenes/shown_scene.h"
#include "app/view/scenes/viewpoint_list.h"
#include "app/view/settings/view_state.h"
#include "app/view/wearer/gaze_follower.h"
#include "app/view/wearer/wearer_controls.h"
#include "app/view/window/mirror_window.h"

#include <chrono>
#include <memory>

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
    // Optional: if drawing in the window fails, a line says why.
    void openWindow(EventWindow& window);
    // Moves the room's origin to the head, once its pose is known or on request.
    void settle();
    void renderWaiting();
    void recordPanel(Commands& commands);
    // With the wearer's settings or, if memory is short, the previous ones; false: the scene is not shown in
    // this frame.
    bool prepareScene(FrameViews& views);
    // Asks where the rays and the arc meet the scene, and where the ground is.
    void probeScene(double feet_m);
    void recordProbe(Commands& commands);
    // Chooses hands, rays and other things in the room for this frame.
    void chooseThings(const WearerNow& wearer, const FrameViews& views);
    // Reports errors of a scene that loads while it is shown, and once that everything in view is loaded.
    void sayLive(LoadedScene& scene);
    void showFrame(const FrameViews& views);
    // Without what the runtime refuses, except the eyes' pictures.
    void submitFrame(const FrameViews& views);
    void goOnWith(const LayersWanted& taken, const std::vector<const char*>& things,
                  const std::string& refusal);
    // Errors of the window only close the window.
    void onWindow(void (MirrorWindow::*act)());
    void addEyes(xr::Layers& layers, const FrameViews& views, bool see_through) const;
    // Lays out the widgets; acquires an image for the panel if it is `hung` and has changed.
    void layOutPanel(bool hung, double step_seconds);
    void takeWindowInput(double step_seconds);
    // Plays or pauses a moving scene, or goes to another of its frames; does nothing for a still scene.
    void moveTime(bool play, int step, std::optional<std::size_t> frame);
    void followPanel(const PanelRequests& requests);
    void openAndSave(const PanelRequests& requests);
    // The other scene of a comparison: takes it once it is loaded, and shows it while a button is held.
    void takeOther();
    void showOther();
    // Once frames can show it; it goes if they cannot.
    void meetOther();
    // The wearer's place in numbers, and changes to it.
    [[nodiscard]] ShownPlace shownPlace() const;
    void movePlace(const PanelRequests& requests);
    void goTo(const Viewpoint* viewpoint);  // null: stays
    // While the ruler is open, a trigger says where the ray meets the scene.
    void measure(const std::array<xr::Hand, 2>& hands);
    void showPanel();
    // A small picture of the scene as it was last seen is kept for the list of scenes. It is made either from
    // what a frame has copied, for which the next scene is held back by some frames, or from the last frame,
    // which is then waited for.
    [[nodiscard]] bool hasKeptPicture();
    void recordCopy(Commands& commands);
    void keepPictureAtOnce();
    [[nodiscard]] bool isWorthKeeping() const;  // a picture of the scene
    // In frames, and so in the renderer's pictures and views.
    [[nodiscard]] std::size_t eyeOfPicture() const {
        return drawn_.showsOneEye() ? 0 : static_cast<std::size_t>(drawn_.stereo.dominant);
    }
    void load();
    void reloadShaders();
    void sayPicture(const std::optional<std::string>& outcome);
    // In the log and on the panel.
    void say(const std::string& message);
    // As a line in front of the eyes, for some seconds, while the panel is hidden; otherwise the first steps.
    void showMessage(RoomSight& sight, double step_seconds);
    void sayChange();
    void keepPreferences(double step_seconds, bool at_once);
    void leave();
    void waitForQueue() const;

    ViewOptions options_;
    xr::Instance& instance_;
    const Context& context_;
    ViewState state_;
    ViewSettings drawn_;  // of this frame: restricted to kernels that are ready
    FrameLog log_;
    HeadsetConnection connection_;
    SceneRenderer renderer_;
    Panel panel_;
    std::unique_ptr<MirrorWindow> window_;
    WindowInput window_input_;
    bool panel_hangs_ = false;  // in this frame
    WearerControls controls_;
    Vignette vignette_;
    Fade fade_;
    std::string message_;           // to be shown in front of the eyes
    double message_seconds_ = 0.0;  // left for the one shown
    bool is_new_view_ = false;      // another scene or another origin of the room, in this frame
    GazeFollower gaze_;
    WaitingFrames waiting_;
    SceneProbe probe_;
    ProbesSeen probes_seen_;  // where hands point, and the ground
    PictureCopy copy_;
    bool picture_asked_ = false;  // for the next frame
    std::uint64_t frames_of_scene_ = 0, frames_without_scene_ = 0;
    // Everything in the first view of a streamed scene is loaded, and that was reported.
    bool said_there_ = false;
    Pose room_from_head_;  // as last known
    Ruler ruler_;
    std::array<bool, 2> clicked_{};  // by hand, in the frame before
    bool other_asked_ = false;       // by the panel: it stays in sight
    bool recentre_asked_ = false, leaving_ = false, waits_for_method_ = false;
    std::chrono::steady_clock::time_point last_alone_{};
    SceneNotes notes_;
    FirstSteps first_steps_;
    ViewpointList viewpoints_;
    FileWorker files_;        // its thread ends before the users of its results
    ShownScene scenes_;       // its loading thread ends before them
    PictureWriter pictures_;  // last: it shows scenes
};

}  // namespace binosplat
