// The viewer's loop: what the wearer sees, frame by frame.
#pragma once

#include "app/canvas.h"
#include "app/eye_images.h"
#include "app/mirror_window.h"
#include "app/overlay.h"
#include "app/overlay_panel.h"
#include "app/scene_loader.h"
#include "app/view_settings.h"
#include "app/wearer_controls.h"
#include "xr/input.h"
#include "xr/layers.h"

#include <chrono>
#include <memory>

namespace binosplat {

class Viewer {
public:
    // `session` outlives the viewer. Begins to load the scene. With a window beside the headset where `mirrored`.
    Viewer(const ViewOptions& options, xr::Session& session, bool mirrored);

    // Until the runtime, the wearer, Ctrl-C or --frames ends it. Says on stdout what was changed in which frame, and why it ended.
    // Throws what went wrong with the scene or the device; a lost session is no error.
    void run();

private:
    void drawFrame();
    void takeScene();
    // The headset does not need it: where it does not open, a line says why.
    void openWindow();
    void fitResolution();
    // What goes behind the panel; the scene if it is there.
    void drawEyes(const std::array<xr::EyeView, 2>& views, const std::array<Pose, 2>& room_from_eyes);
    void addEyes(xr::Layers& layers, const std::array<xr::EyeView, 2>& views) const;
    void drawPanel();
    void obeyWindow(const Pose& room_from_head);
    void addPanel(xr::Layers& layers, const Pose& room_from_head) const;
    void obey(const OverlayActions& actions);
    void fillRay();
    [[nodiscard]] bool showsOneEye() const { return settings_.stereo.mode == "mono"; }

    ViewOptions options_;
    xr::Session& session_;
    const Context& context_;
    xr::Input input_;
    vk::Format format_;
    Presenter presenter_;
    std::unique_ptr<EyeImages> images_;
    Canvas canvas_;
    std::unique_ptr<MirrorWindow> window_;
    WindowInput window_input_;
    xr::Swapchain panel_images_, ray_image_;
    bool panel_taken_ = false;  // its image, in this frame
    OverlayPanel panel_;
    WearerControls controls_;
    Commands commands_;
    ViewSettings settings_;
    Similarity scene_from_room_;
    std::unique_ptr<LoadedScene> scene_;
    FrameResult last_;
    OverlayStatus status_;
    std::uint64_t frames_ = 0;
    std::chrono::steady_clock::time_point last_end_{};
    SceneLoader loader_;  // last: its thread ends first
};

}  // namespace binosplat
