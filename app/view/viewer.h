// The viewer's loop: what the wearer sees, frame by frame.
#pragma once

#include "app/view/files/picture_writer.h"
#include "app/view/headset/headset_connection.h"
#include "app/view/panel/panel.h"
#include "app/view/room/vignette.h"
#include "app/view/scene_renderer.h"
#include "app/view/scenes/shown_scene.h"
#include "app/view/settings/view_state.h"
#include "app/view/wearer/gaze_follower.h"
#include "app/view/wearer/wearer_controls.h"
#include "app/view/window/mirror_window.h"

#include <chrono>
#include <memory>

namespace binosplat {

class Viewer {
public:
    // `instance` and `context` outlive the viewer. Begins to load the scene. With a window beside the headset where `mirrored`.
    Viewer(const ViewOptions& options, const ViewSettings& settings, xr::Instance& instance, const Context& context, bool mirrored);

    // Until the runtime, the wearer, Ctrl-C or --frames ends it. Says on stdout what was changed in which frame, and why it ended.
    // A lost session is followed by another one, with the scene as it is, once there is a headset. Throws what went wrong with the scene or
    // the device, and Error (exit code 3) where the runtime is lost.
    void run();

private:
    // One turn of the loop; false at its end.
    bool step();
    [[nodiscard]] ConnectedHeadset& headset() const { return *connection_.headset(); }  // while there is one
    void loseHeadset(const std::string& why);
    // Another session in place of one that was lost, if there is a headset; false at the end.
    bool comeBack();
    void drawFrame();
    // The window's own life while no frame is drawn for the headset.
    void drawWindowAlone(const std::string& why);
    // The next scene, once it is there.
    void takeScene();
    // The headset does not need it: where it does not open, a line says why.
    void openWindow();
    // The room begins where the head is, once that is known or when it is asked for.
    void settle();
    void renderWaiting();
    void recordPanel(Commands& commands);
    // What the wearer wishes for, or what was before that where there is no memory for it; false: the scene is not shown in this frame.
    bool prepareScene(const FrameViews& views);
    // Hands, rays and what else hangs in the room in this frame.
    void chooseThings(const WearerNow& wearer, const FrameViews& views);
    // What is wrong with a scene that loads while it is shown, and once that all is there.
    void sayLive(LoadedScene& scene);
    void showFrame(const FrameViews& views);
    // Without hands and rays, or without depth, where the runtime refuses these.
    void submitFrame(const FrameViews& views);
    // Trouble with the window ends the window alone.
    void onWindow(void (MirrorWindow::*act)());
    void addEyes(xr::Layers& layers, const FrameViews& views) const;
    // The widgets; takes an image for the panel where that is `hung` and has changed.
    void layOutPanel(bool hung, double step_seconds);
    void takeWindowInput(double step_seconds);
    // Plays a scene that moves or has it rest, and goes to another of its frames; nothing of one that stays as it is.
    void moveTime(bool play, int step, std::optional<std::size_t> frame);
    void followPanel(const PanelRequests& requests);
    void openAndSave(const PanelRequests& requests);
    // Where the wearer stands, in numbers, and moved from there.
    [[nodiscard]] ShownPlace shownPlace() const;
    void movePlace(const PanelRequests& requests);
    void goToViewpoint(int step);
    void keepViewpointHere();
    void goBackToLastScene();
    // A small picture of the scene as it was seen last, for the list of scenes.
    void keepPictureOfScene();
    void load();
    void remember(const std::string& complaint);
    void reloadShaders();
    // What was rendered last, as a file; and what became of that.
    void takePicture();
    void sayPicture(const std::optional<std::string>& outcome);
    // Also on the panel.
    void say(const std::string& message);
    void sayChange();
    void leave();
    void waitForQueue() const;

    ViewOptions options_;
    xr::Instance& instance_;
    const Context& context_;
    ViewState state_;
    ViewSettings drawn_;  // of this frame: those whose kernels are there
    FrameLog log_;
    HeadsetConnection connection_;
    SceneRenderer renderer_;
    Panel panel_;
    std::unique_ptr<MirrorWindow> window_;
    WindowInput window_input_;
    bool panel_hangs_ = false;  // in this frame
    WearerControls controls_;
    Vignette vignette_;
    GazeFollower gaze_;
    Commands commands_;
    PictureWriter pictures_;
    bool picture_asked_ = false;  // of the next frame
    std::uint64_t frames_of_scene_ = 0;
    bool said_there_ = false;               // that all of a streamed scene is there which is seen at first
    std::optional<std::size_t> viewpoint_;  // the one gone to last
    Pose room_from_head_;                   // as last known
    bool recentre_asked_ = false, leaving_ = false, waits_for_kernels_ = false;
    std::chrono::steady_clock::time_point last_alone_{};
    FileWorker files_;   // its thread ends before what it reads for
    ShownScene scenes_;  // last: the loading thread ends first
};

}  // namespace binosplat
