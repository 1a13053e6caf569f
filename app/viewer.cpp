// The viewer's loop.
#include "app/viewer.h"

#include "app/interrupt.h"
#include "app/modes.h"
#include "app/shader_reload.h"
#include "app/view_eyes.h"
#include "app/view_files.h"
#include "engine/error.h"

#include <thread>

namespace binosplat {

namespace {

constexpr glm::uvec2 kCanvasPx(768, 896);
constexpr double kPanelWidthMetres = 0.6;
constexpr glm::uvec2 kRayPx(8, 8);
constexpr glm::vec4 kRayColour(1.0f, 0.7f, 0.1f, 1.0f);
// While the scene loads, unless a background is asked for.
constexpr glm::vec3 kWaitingColour(0.06f, 0.07f, 0.09f);
constexpr std::size_t kPlottedFrames = 120;
// By keys of the window.
constexpr double kTurnRadiansPerSecond = 1.2, kWalkMetresPerSecond = 1.5;
// How often to look whether the session has begun to run.
constexpr std::chrono::milliseconds kIdle(5);

ViewSettings startSettings(const ViewOptions& options) {
    ViewSettings settings;
    settings.stereo = options.run.stereo;
    settings = readViewSettings(options.tables, settings);
    if (options.hide_panel) { settings.panel = false; }
    return settings;
}

glm::uvec2 scaledSize(const xr::Instance& instance, double scale) {
    const glm::dvec2 wanted = glm::round(scale * glm::dvec2(instance.recommendedSizePx()));
    return glm::clamp(glm::uvec2(wanted), glm::uvec2(16), instance.maxSizePx());
}

}  // namespace

Viewer::Viewer(const ViewOptions& options, xr::Session& session, bool mirrored)
    : options_(options),
      session_(session),
      context_(session.context()),
      input_(session),
      format_(chooseEyeFormat(session)),
      presenter_(context_, format_),
      canvas_(context_, kCanvasPx, format_),
      panel_images_(session, "the panel", kCanvasPx, format_, xr::ImageUse::kDraw),
      ray_image_(session, "the ray", kRayPx, format_, xr::ImageUse::kDraw),
      panel_(kCanvasPx, kPanelWidthMetres),
      commands_(context_),
      settings_(startSettings(options)),
      loader_(context_, options.scene, options.run) {
    status_.scene = options.scene;
    status_.can_reload_shaders = !shaderFolder(options.shaders).empty();
    if (mirrored) { openWindow(); }
    fitResolution();
    fillRay();
    if (options.load_first) { takeScene(); }
}

void Viewer::run() {
    const Interrupt interrupt;
    std::string why;
    bool asked = false;
    try {
        for (;;) {
            if (!asked && (interrupt.came() || (options_.frames != 0 && frames_ >= options_.frames))) {
                session_.requestExit();
                asked = true;
            }
            const xr::FrameOutcome outcome = session_.beginFrame();
            if (outcome == xr::FrameOutcome::kExit) { break; }
            if (outcome == xr::FrameOutcome::kWait) {
                std::this_thread::sleep_for(kIdle);
                continue;
            }
            if (outcome == xr::FrameOutcome::kRender) {
                drawFrame();
            } else {
                session_.endFrame({});
            }
            ++frames_;
        }
        why = session_.whyEnded();
    } catch (const xr::Lost& lost) { why = lost.what(); }
    fmt::print("{} frames; {}\n", frames_, why);
}

void Viewer::drawFrame() {
    const std::optional<std::array<xr::EyeView, 2>> views = session_.locateEyes();
    if (!views) {
        session_.endFrame({});
        return;
    }
    if (!scene_ && loader_.isDone()) { takeScene(); }
    const std::array<Pose, 2> room_from_eyes = roomFromEyes(*views);
    const Pose room_from_head = roomFromHead(room_from_eyes);
    const ViewSettings before = settings_;
    controls_.update(input_.read(), room_from_head, session_.stepSeconds(), panel_, settings_.panel, scene_from_room_);
    obeyWindow(room_from_head);
    fitResolution();

    if (settings_.panel || window_) { layOutPanel(); }
    if (window_) { window_->acquire(); }
    if (scene_) {
        renderScene(*views, room_from_eyes);
    } else {
        renderWaiting();
    }
    if (window_) { window_->show(); }
    images_->release();
    xr::Layers layers(session_);
    addEyes(layers, *views);
    if (std::exchange(panel_now_, nullptr)) {
        panel_images_.release();
        addPanel(layers, room_from_head);
    }
    session_.endFrame(layers.list());

    const std::string change = describeChange(before, settings_);
    if (!change.empty()) { fmt::print("frame {}: {}\n", frames_, change); }
    const auto now = std::chrono::steady_clock::now();
    if (frames_ > 0) { status_.frame_ms.push_back(std::chrono::duration<float, std::milli>(now - last_end_).count()); }
    if (status_.frame_ms.size() > kPlottedFrames) { status_.frame_ms.erase(status_.frame_ms.begin()); }
    last_end_ = now;
}

void Viewer::takeScene() {
    scene_ = loader_.take();
    scene_from_room_ = settings_.scene_from_room.value_or(scene_->start);
    for (const std::string& line : scene_->notes.lines) { fmt::print("note: {}\n", line); }
}

void Viewer::openWindow() {
    try {
        window_ = std::make_unique<MirrorWindow>(context_, canvas_);
    } catch (const Error& error) { fmt::print("no window: {}\n", error.what()); } catch (const vk::SystemError& error) {
        fmt::print("no window: {}\n", error.what());
    }
}

void Viewer::fitResolution() {
    const glm::uvec2 size_px = scaledSize(session_.instance(), settings_.resolution_scale);
    if (images_ && images_->sizePx() == size_px) { return; }
    images_.reset();
    images_ = std::make_unique<EyeImages>(session_, presenter_, format_, size_px);
}

void Viewer::renderWaiting() {
    for (const int e : {kLeft, kRight}) { images_->acquire(e, false); }
    commands_.begin();
    const glm::dvec3& background = options_.run.camera.background;
    const glm::vec3 colour = background == glm::dvec3(0.0) ? kWaitingColour : glm::vec3(background);
    for (const int e : {kLeft, kRight}) { images_->clear(commands_, e, colour); }
    recordPanel(commands_);
    commands_.submitAndWait();
}

void Viewer::renderScene(const std::array<xr::EyeView, 2>& views, const std::array<Pose, 2>& room_from_eyes) {
    std::array<Eye, 2> eyes;
    for (std::size_t e = 0; e < 2; ++e) { eyes[e] = eyeInScene(scene_from_room_, room_from_eyes[e], views[e].fov, images_->sizePx()); }
    FrameSettings frame = frameSettings(options_.run.camera, settings_.stereo);
    frame.dominant = settings_.stereo.dominant;
    frame.keep_depth = frame.keep_both_depths = images_->takesDepth();
    frame.half_floats = true;
    frame.keep_classes = settings_.tint;
    // One eye's picture for both is seen through either lens.
    if (!showsOneEye()) { frame.hidden_tiles = lens_mask_.update(session_, views, images_->sizePx()); }
    for (const int e : {kLeft, kRight}) {
        if (!showsOneEye() || e == frame.dominant) { images_->acquire(e, true); }
    }
    last_ = scene_->frame.render(showsOneEye() ? std::span<const Eye>(&eyes[frame.dominant], 1) : std::span<const Eye>(eyes), frame,
                                 [&](Commands& commands) {
                                     recordEyes(commands, frame);
                                     recordPanel(commands);
                                 });
    sayHidden();
}

void Viewer::recordEyes(Commands& commands, const FrameSettings& frame) {
    for (const int e : {kLeft, kRight}) {
        const bool dominant = e == frame.dominant;
        if (frame.mode == Mode::kMono && !dominant) { continue; }
        const bool tinted = settings_.tint && reprojects(frame.mode) && !dominant;
        const EyeImage& image = scene_->frame.image(frame.mode == Mode::kMono ? 0 : e);
        images_->present(commands, e, image, tinted ? &scene_->frame.stereoBuffers() : nullptr, frame.near);
        // The window shows the dominant eye, or what is made of it where that is the point.
        const bool shown = frame.mode == Mode::kMono || dominant != settings_.tint;
        if (window_ && shown) { window_->keepEye(commands, presenter_.pixels(), images_->sizePx(), format_); }
    }
}

void Viewer::sayHidden() {
    const auto count = [&](const char* name) {
        const auto found = last_.counters.find(name);
        return found == last_.counters.end() ? 0 : found->second;
    };
    const std::array<std::uint64_t, 2> hidden{count("tiles_hidden_left"), count("tiles_hidden_right")};
    if (showsOneEye() || std::exchange(hidden_tiles_, hidden) == hidden) { return; }
    fmt::print("frame {}: the lenses hide {} and {} of {} tiles\n", frames_, hidden[kLeft], hidden[kRight], count("tiles_left"));
}

void Viewer::addEyes(xr::Layers& layers, const std::array<xr::EyeView, 2>& views) const {
    const double near_m = options_.run.camera.near / scene_from_room_.scale;
    const auto layerEye = [&](int shown_to) {
        // One eye's picture for both is shown as that eye saw it.
        const int e = scene_ && showsOneEye() ? settings_.stereo.dominant : shown_to;
        return images_->layerEye(e, views[static_cast<std::size_t>(e)], near_m);
    };
    layers.addEyes({layerEye(kLeft), layerEye(kRight)});
}

void Viewer::layOutPanel() {
    status_.loading = scene_ ? std::nullopt : std::optional(loader_.progress());
    status_.frame = last_.counters.empty() ? nullptr : &last_;
    if (settings_.panel) { panel_now_ = panel_images_.acquire(); }
    canvas_.begin(window_input_.pointer.place_px ? window_input_.pointer : panel_.pointer(), session_.stepSeconds());
    obey(drawOverlay(kCanvasPx, settings_, status_));
}

void Viewer::recordPanel(Commands& commands) {
    if (!panel_now_ && !window_) { return; }
    commands.beginPass("panel");
    canvas_.record(commands);
    if (panel_now_) { commands.copyImage(canvas_.image(), panel_now_, kCanvasPx); }
    if (window_) { window_->record(commands); }
}

void Viewer::obeyWindow(const Pose& room_from_head) {
    if (!window_) { return; }
    window_input_ = window_->poll();
    if (window_input_.quit) { session_.requestExit(); }
    if (window_input_.reload_shaders) { reloadShaders(); }
    if (window_input_.toggle_panel) {
        settings_.panel = !settings_.panel;
        panel_.hangBefore(room_from_head);
    }
    const double turn_rad = window_input_.turn_rad + session_.stepSeconds() * window_input_.turn_rate * kTurnRadiansPerSecond;
    if (turn_rad != 0.0) { scene_from_room_ = turnedBy(scene_from_room_, turn_rad, room_from_head.position); }
    const glm::dvec3 forward = levelled(room_from_head.orientation * glm::dvec3(0.0, 0.0, 1.0)), down(0.0, 1.0, 0.0);
    const glm::dvec3 walk = window_input_.walk.x * glm::cross(down, forward) + window_input_.walk.y * down + window_input_.walk.z * forward;
    if (walk != glm::dvec3(0.0)) { scene_from_room_ = movedBy(scene_from_room_, session_.stepSeconds() * kWalkMetresPerSecond * walk); }
}

void Viewer::addPanel(xr::Layers& layers, const Pose& room_from_head) const {
    layers.addPanel(panel_.roomFromPanel(), panel_.sizeMetres(), panel_images_);
    if (const auto ray = panel_.ray(room_from_head)) { layers.addPanel(ray->room_from_strip, ray->size_m, ray_image_); }
}

void Viewer::obey(const OverlayActions& actions) {
    const std::filesystem::path file = viewSettingsFile(options_.scene);
    if (actions.save) {
        settings_.scene_from_room = scene_from_room_;
        status_.message = saveViewSettings(file, settings_);
    }
    if (actions.load) {
        status_.message = loadViewSettings(file, settings_);
        scene_from_room_ = settings_.scene_from_room.value_or(scene_from_room_);
        settings_.panel = true;  // it was just pressed
    }
    if (actions.reload_shaders) { reloadShaders(); }
    if (actions.reset_scene) { scene_from_room_ = scene_->start; }
    if (actions.save || actions.load) { fmt::print("frame {}: {}\n", frames_, status_.message); }
    if (actions.quit) { session_.requestExit(); }
}

void Viewer::reloadShaders() {
    if (!scene_ || !status_.can_reload_shaders) { return; }  // without a scene kernels are being made elsewhere
    status_.message = binosplat::reloadShaders(context_, shaderFolder(options_.shaders), [&] {
        scene_->frame.rebuildKernels();
        presenter_.rebuildKernels();
    });
    fmt::print("frame {}: {}\n", frames_, status_.message);
}

void Viewer::fillRay() {
    commands_.begin();
    commands_.clearImage(ray_image_.acquire(), kRayColour);
    commands_.submitAndWait();
    ray_image_.release();
}

}  // namespace binosplat
