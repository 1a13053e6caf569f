// The viewer's loop: what the wearer sees, frame by frame.
#pragma once

#include "app/view/canvas.h"
#include "app/view/headset_stay.h"
#include "app/view/mirror_window.h"
#include "app/view/overlay.h"
#include "app/view/overlay_panel.h"
#include "app/view/scene_loader.h"
#include "app/view/view_settings.h"
#include "app/view/wearer_controls.h"

#include <chrono>
#include <memory>

namespace binosplat {

class Viewer {
public:
    // `instance` and `context` outlive the viewer. Begins to load the scene. With a window beside the headset where `mirrored`.
    Viewer(const ViewOptions& options, const ViewSettings& settings, const xr::Instance& instance, const Context& context, bool mirrored);

    // Until the runtime, the wearer, Ctrl-C or --frames ends it. Says on stdout what was changed in which frame, and why it ended.
    // A lost session is followed by another one, with the scene as it is. Throws what went wrong with the scene or the device, and
    // Error (exit code 3) where the runtime is lost.
    void run();

private:
    // One turn of the loop; false at its end.
    bool step();
    // Another session in place of one that was lost.
    void renewStay(const std::string& why);
    void drawFrame();
    // The window's own life while no frame is drawn for the headset.
    void drawWindowAlone(const std::string& why);
    void takeScene();
    void place();
    // The headset does not need it: where it does not open, a line says why.
    void openWindow();
    // What the governor makes of the wearer's settings, and images as large as that.
    void govern();
    void fitResolution();
    // The room begins where the head is, once that is known or when it is asked for.
    void settle();
    // Renders and shows, in one submission: the scene if it is there, and the panel.
    void renderScene(const std::array<xr::EyeView, 2>& views, const std::array<Pose, 2>& room_from_eyes);
    void renderWaiting();
    void recordEyes(Commands& commands, const FrameSettings& frame);
    void recordPanel(Commands& commands);
    void sayHidden();
    void showFrame(const std::array<xr::EyeView, 2>& views, const Pose& room_from_head);
    void addEyes(xr::Layers& layers, const std::array<xr::EyeView, 2>& views) const;
    // The widgets; takes the panel's image where it is `hung`.
    void layOutPanel(bool hung);
    void obeyWindow(const Pose& room_from_head, double step_seconds);
    void addPanel(xr::Layers& layers, const Pose& room_from_head) const;
    void obey(const OverlayActions& actions);
    void reloadShaders();
    // Beside the scene that is shown, which stays until the other one is there.
    void beginScene(const std::string& scene);
    // What both eyes see, beside one another, as a file of the working directory.
    void takePicture();
    void say(const std::string& message);
    void leave();
    void waitForQueue() const;
    [[nodiscard]] StereoOptions governedStereo() const;
    [[nodiscard]] bool showsOneEye() const { return settings_.stereo.mode == "mono"; }

    ViewOptions options_;
    const xr::Instance& instance_;
    const Context& context_;
    std::unique_ptr<HeadsetStay> stay_;
    vk::Format format_;  // of every session's images
    Presenter presenter_;
    Canvas canvas_;
    std::unique_ptr<MirrorWindow> window_;
    WindowInput window_input_;
    vk::Image panel_now_;                          // of this frame, where the panel is shown
    std::array<std::uint64_t, 2> hidden_tiles_{};  // as last said
    Governor governor_;
    OverlayPanel panel_;
    WearerControls controls_;
    Commands commands_;
    ViewSettings settings_;
    Similarity scene_from_room_;
    std::unique_ptr<LoadedScene> scene_;
    FrameResult last_;
    OverlayStatus status_;
    Pose room_from_head_;      // as last known
    std::string asked_scene_;  // the last one, whether it could be loaded or not
    bool recentre_asked_ = false, takes_depth_ = true, leaving_ = false;
    int losses_ = 0;  // since a frame was shown
    std::uint64_t frames_ = 0;
    std::chrono::steady_clock::time_point last_end_{}, last_alone_{};
    std::unique_ptr<SceneLoader> loader_;  // last: its thread ends first
};

}  // namespace binosplat
