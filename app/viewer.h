// The viewer's loop: what the wearer sees, frame by frame.
#pragma once

#include "app/canvas.h"
#include "app/eye_images.h"
#include "app/lens_mask.h"
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
    // Renders and shows, in one submission: the scene if it is there, and the panel.
    void renderScene(const std::array<xr::EyeView, 2>& views, const std::array<Pose, 2>& room_from_eyes);
    void renderWaiting();
    void recordEyes(Commands& commands, const FrameSettings& frame);
    void recordPanel(Commands& commands);
    void sayHidden();
    void addEyes(xr::Layers& layers, const std::array<xr::EyeView, 2>& views) const;
    // The widgets; takes the panel's image where it is shown.
    void layOutPanel();
    void obeyWindow(const Pose& room_from_head);
    void addPanel(xr::Layers& layers, const Pose& room_from_head) const;
    void obey(const OverlayActions& actions);
    void reloadShaders();
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
    vk::Image panel_now_;  // of this frame, where the panel is shown
    LensMask lens_mask_;
    std::array<std::uint64_t, 2> hidden_tiles_{};  // as last said
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
