// The viewer's loop: what the wearer sees, frame by frame.
#pragma once

#include "app/view/headset/losses.h"
#include "app/view/panel/canvas.h"
#include "app/view/panel/overlay.h"
#include "app/view/panel/overlay_panel.h"
#include "app/view/picture_pair.h"
#include "app/view/room/vignette.h"
#include "app/view/scene_renderer.h"
#include "app/view/scenes/shown_scene.h"
#include "app/view/view_settings.h"
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
    void loseStay(const std::string& why);
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
    void showFrame(const FrameViews& views);
    // Trouble with the window ends the window alone.
    void onWindow(void (MirrorWindow::*act)());
    void addEyes(xr::Layers& layers, const FrameViews& views) const;
    // The widgets; takes an image for the panel where that is `hung` and has changed.
    void layOutPanel(bool hung, double step_seconds);
    void showTimes(double step_seconds);
    void keepFrameTime();
    void obeyWindow(double step_seconds);
    void obey(const OverlayActions& actions);
    void obeyFiles(const OverlayActions& actions);
    void reloadShaders();
    // What was rendered last, as a file; and what became of that.
    void takePicture();
    void sayPicture(const std::optional<std::string>& outcome);
    // Also on the panel.
    void say(const std::string& message);
    void sayChange(const ViewSettings& before) const;
    void leave();
    void waitForQueue() const;

    ViewOptions options_;
    xr::Instance& instance_;
    const Context& context_;
    ViewSettings settings_;
    std::optional<ViewSettings> settings_that_fit_;  // of the last frame there was memory for
    FrameLog log_;
    std::unique_ptr<HeadsetStay> stay_;  // null while there is no session
    vk::Format format_;                  // of every session's images
    SceneRenderer renderer_;
    Canvas canvas_;
    std::unique_ptr<MirrorWindow> window_;
    WindowInput window_input_;
    bool mouse_points_ = false;  // on the panel, and not a hand
    bool panel_hangs_ = false;   // in this frame
    vk::Image panel_now_;        // where the panel has to be drawn anew
    OverlayPanel panel_;
    WearerControls controls_;
    Vignette vignette_;
    GazeFollower gaze_;
    Commands commands_;
    OverlayStatus status_;
    FrameResult shown_frame_;  // whose times the panel shows
    PictureWriter pictures_;
    bool picture_asked_ = false;   // of the next frame
    std::vector<float> frame_ms_;  // see OverlayStatus
    double times_age_s_ = 0.0;
    OverlayPages pages_;
    Pose room_from_head_;  // as last known
    bool recentre_asked_ = false, takes_depth_ = true, leaving_ = false;
    Losses losses_;     // since a frame was shown
    int failures_ = 0;  // of sessions that were to come after it, in a row
    std::string why_lost_;
    bool is_gone_ = false;  // the headset, since then
    std::chrono::steady_clock::time_point last_end_{}, last_alone_{}, next_search_{};
    ShownScene scenes_;  // last: the loading thread ends first
};

}  // namespace binosplat
