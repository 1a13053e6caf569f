// The viewer's loop.
#include "app/view/viewer.h"

#include "app/interrupt.h"
#include "app/options/modes.h"
#include "app/view/shader_reload.h"
#include "app/view/view_eyes.h"
#include "app/view/view_files.h"
#include "app/view/view_scenes.h"
#include "engine/error.h"
#include "engine/picture/image_io.h"
#include "engine/setup/output_files.h"

#include <thread>

namespace binosplat {

namespace {

constexpr glm::uvec2 kCanvasPx(768, 896);
constexpr double kPanelWidthMetres = 0.6;
// While the scene loads, unless a background is asked for.
constexpr glm::vec3 kWaitingColour(0.06f, 0.07f, 0.09f);
constexpr std::size_t kPlottedFrames = 120;
// By keys of the window.
constexpr double kTurnRadiansPerSecond = 1.2, kWalkMetresPerSecond = 1.5;
// How often to look whether the session has begun to run, and how often the window is drawn meanwhile.
constexpr std::chrono::milliseconds kIdle(5), kWindowAlone(16);
// So many sessions lost in a row before one has shown a frame are too many.
constexpr int kMostLosses = 3;

Image besideOneAnother(const Image& left, const Image& right) {
    Image both{{left.size_px.x + right.size_px.x, left.size_px.y}, left.channels, {}};
    both.values.reserve(left.values.size() + right.values.size());
    const std::size_t row = std::size_t{left.size_px.x} * static_cast<std::size_t>(left.channels);
    for (std::size_t at = 0; at < left.values.size(); at += row) {
        for (const Image* eye : {&left, &right}) {
            const auto begin = eye->values.begin() + static_cast<std::ptrdiff_t>(at);
            both.values.insert(both.values.end(), begin, begin + static_cast<std::ptrdiff_t>(row));
        }
    }
    return both;
}

// Without its extension; pictures are never overwritten.
std::string freePictureName(const std::filesystem::path& folder) {
    for (int number = 1;; ++number) {
        const std::string name = fmt::format("binosplat-{:04}", number);
        if (!std::filesystem::exists(folder / (name + extensionOf(PictureKind::kDisplay)))) { return name; }
    }
}

glm::uvec2 scaledSize(const xr::Instance& instance, double scale) {
    const glm::dvec2 wanted = glm::round(scale * glm::dvec2(instance.recommendedSizePx()));
    return glm::clamp(glm::uvec2(wanted), glm::uvec2(16), instance.maxSizePx());
}

}  // namespace

Viewer::Viewer(const ViewOptions& options, const ViewSettings& settings, const xr::Instance& instance, const Context& context,
               bool mirrored)
    : options_(options),
      instance_(instance),
      context_(context),
      stay_(std::make_unique<HeadsetStay>(instance, context, kCanvasPx)),
      format_(stay_->format),
      presenter_(context_, format_),
      canvas_(context_, kCanvasPx, format_),
      panel_(kCanvasPx, kPanelWidthMetres),
      commands_(context_),
      settings_(settings),
      loader_(std::make_unique<SceneLoader>(context_, options.scene, options.run)) {
    status_.scene = asked_scene_ = options.scene;
    status_.can_reload_shaders = !shaderFolder(options.shaders).empty();
    if (mirrored) { openWindow(); }
    fitResolution();
    if (options.load_first) { takeScene(); }
}

void Viewer::run() {
    const Interrupt interrupt;
    try {
        for (bool goes_on = true; goes_on;) {
            if (!leaving_ && (interrupt.came() || (options_.frames != 0 && frames_ >= options_.frames))) { leave(); }
            try {
                goes_on = step();
            } catch (const xr::Lost& lost) {
                if (leaving_) { break; }
                renewStay(lost.what());
            }
        }
    } catch (const xr::InstanceLost& lost) {
        fmt::print("{} frames; {}\n", frames_, lost.what());
        throw;
    }
    const std::string& why = stay_->session.whyEnded();
    fmt::print("{} frames; {}\n", frames_, why.empty() ? "the session was lost as it ended" : why);
}

bool Viewer::step() {
    switch (stay_->session.beginFrame()) {
        case xr::FrameOutcome::kExit:
            return false;
        case xr::FrameOutcome::kWait:
            drawWindowAlone("The headset rests: put it on");
            std::this_thread::sleep_for(kIdle);
            return true;
        case xr::FrameOutcome::kRender:
            drawFrame();
            losses_ = 0;
            break;
        case xr::FrameOutcome::kSkip:
            drawWindowAlone("The headset shows something else, or nothing");
            stay_->session.endFrame({});
            break;
    }
    ++frames_;
    return true;
}

void Viewer::leave() {
    leaving_ = true;
    stay_->session.requestExit();
}

void Viewer::renewStay(const std::string& why) {
    if (++losses_ > kMostLosses) {
        throw Error(ExitCode::kNoDevice, fmt::format("{}: {} times in a row before a frame was shown", why, losses_));
    }
    fmt::print("frame {}: {}; another one begins\n", frames_, why);
    waitForQueue();
    panel_now_ = nullptr;
    stay_.reset();
    stay_ = std::make_unique<HeadsetStay>(instance_, context_, kCanvasPx);
    if (stay_->format != format_) { throw Error(ExitCode::kNoDevice, why + ": the next one has other formats of images"); }
    fitResolution();
}

void Viewer::settle() {
    xr::Session& session = stay_->session;
    if (!session.settle(recentre_asked_)) { return; }
    recentre_asked_ = false;
    const std::optional<double> floor_m = session.floorBelowMetres();
    fmt::print("frame {}: the wearer's place is the room's{}\n", frames_,
               floor_m ? fmt::format(", {:.2f} m above the floor", *floor_m) : "");
    panel_.hangBefore({});
}

void Viewer::drawFrame() {
    settle();
    const std::optional<std::array<xr::EyeView, 2>> views = stay_->session.locateEyes();
    if (!views) {
        drawWindowAlone("The headset does not know where it is");
        stay_->session.endFrame({});
        return;
    }
    if (loader_ && loader_->isDone()) { takeScene(); }
    const std::array<Pose, 2> room_from_eyes = roomFromEyes(*views);
    room_from_head_ = roomFromHead(room_from_eyes);
    const ViewSettings before = settings_;
    const double step_seconds = stay_->session.stepSeconds();
    controls_.update(stay_->input.read(), room_from_head_, step_seconds, panel_, settings_, scene_from_room_);
    if (const std::optional<int> hand = panel_.pulse()) { stay_->input.pulse(*hand); }
    obeyWindow(room_from_head_, step_seconds);
    govern();

    status_.state.clear();
    if (settings_.panel || window_) { layOutPanel(settings_.panel); }
    if (window_) { window_->acquire(); }
    if (scene_) {
        renderScene(*views, room_from_eyes);
    } else {
        renderWaiting();
    }
    if (window_) { window_->show(); }
    showFrame(*views, room_from_head_);

    const std::string change = describeChange(before, settings_);
    if (!change.empty()) { fmt::print("frame {}: {}\n", frames_, change); }
    const auto now = std::chrono::steady_clock::now();
    if (frames_ > 0) { status_.frame_ms.push_back(std::chrono::duration<float, std::milli>(now - last_end_).count()); }
    if (status_.frame_ms.size() > kPlottedFrames) { status_.frame_ms.erase(status_.frame_ms.begin()); }
    last_end_ = now;
}

void Viewer::showFrame(const std::array<xr::EyeView, 2>& views, const Pose& room_from_head) {
    stay_->images->release();
    const bool has_panel = std::exchange(panel_now_, nullptr) != vk::Image();
    if (has_panel) { stay_->panel_images.release(); }
    const auto submit = [&] {
        xr::Layers layers(stay_->session);
        addEyes(layers, views);
        if (has_panel) { addPanel(layers, room_from_head); }
        stay_->session.endFrame(layers.list());
    };
    try {
        submit();
    } catch (const xr::Lost&) { throw; } catch (const xr::InstanceLost&) {
        throw;
    } catch (const Error&) {
        if (!std::exchange(takes_depth_, false)) { throw; }
        fmt::print("frame {}: the runtime refuses depth; on without depth\n", frames_);
        stay_->images->dropDepth();
        submit();
    }
}

void Viewer::drawWindowAlone(const std::string& why) {
    const auto now = std::chrono::steady_clock::now();
    if (!window_ || now - last_alone_ < kWindowAlone) { return; }
    const double step_seconds = std::min(std::chrono::duration<double>(now - last_alone_).count(), 0.1);
    last_alone_ = now;
    if (loader_ && loader_->isDone()) { takeScene(); }
    const ViewSettings before = settings_;
    obeyWindow(room_from_head_, step_seconds);
    status_.state = why;
    layOutPanel(false);
    window_->acquire();
    commands_.begin();
    recordPanel(commands_);
    commands_.submitAndWait();
    window_->show();
    const std::string change = describeChange(before, settings_);
    if (!change.empty()) { fmt::print("frame {}: {}\n", frames_, change); }
}

void Viewer::takeScene() {
    const std::unique_ptr<SceneLoader> loader = std::move(loader_);
    try {
        std::unique_ptr<LoadedScene> taken = loader->take();
        waitForQueue();
        scene_ = std::move(taken);
    } catch (const Error& error) {
        if (!scene_) { throw; }  // nothing to show instead
        say(error.what());
        return;
    }
    status_.scene = scene_->name;
    fmt::print("frame {}: shows {}\n", frames_, scene_->name);
    last_ = {};
    place();
    for (const std::string& line : scene_->notes.lines) { fmt::print("note: {}\n", line); }
}

// A place that the options or the config name wins over one that is remembered.
void Viewer::place() {
    const CameraOptions& camera = options_.run.camera;
    const bool is_asked_for = camera.eye || camera.look || camera.up || settings_.scene_from_room;
    scene_from_room_ = settings_.scene_from_room.value_or(scene_->start);
    settings_.scene_from_room.reset();  // of the first scene alone
    if (is_asked_for) { return; }
    try {
        const std::optional<Similarity> remembered = rememberedPlacement(scene_->name);
        if (!remembered) { return; }
        scene_from_room_ = *remembered;
        fmt::print("frame {}: the wearer stands where this scene was saved\n", frames_);
    } catch (const Error& error) { say(error.what()); }
}

void Viewer::openWindow() {
    try {
        window_ = std::make_unique<MirrorWindow>(context_, canvas_);
    } catch (const Error& error) { fmt::print("no window: {}\n", error.what()); } catch (const vk::SystemError& error) {
        fmt::print("no window: {}\n", error.what());
    }
}

void Viewer::fitResolution() {
    const glm::uvec2 size_px = scaledSize(instance_, settings_.resolution_scale);
    std::unique_ptr<EyeImages>& images = stay_->images;
    if (images && images->sizePx() == size_px) { return; }
    images.reset();
    images = std::make_unique<EyeImages>(stay_->session, presenter_, format_, size_px);
    if (!takes_depth_) { images->dropDepth(); }
}

void Viewer::govern() {
    governor_.wish(settings_.quality, {settings_.stereo.mode, settings_.stereo.budget, settings_.resolution_scale});
    fitResolution();
    stay_->images->draw(scaledSize(instance_, governor_.settings().resolution_scale));
}

StereoOptions Viewer::governedStereo() const {
    StereoOptions stereo = settings_.stereo;
    stereo.mode = governor_.settings().mode;
    stereo.budget = governor_.settings().budget;
    return stereo;
}

void Viewer::renderWaiting() {
    for (const int e : {kLeft, kRight}) { stay_->images->acquire(e, false); }
    commands_.begin();
    const glm::dvec3& background = options_.run.camera.background;
    const glm::vec3 colour = background == glm::dvec3(0.0) ? kWaitingColour : glm::vec3(background);
    for (const int e : {kLeft, kRight}) { stay_->images->clear(commands_, e, colour); }
    recordPanel(commands_);
    commands_.submitAndWait();
}

void Viewer::renderScene(const std::array<xr::EyeView, 2>& views, const std::array<Pose, 2>& room_from_eyes) {
    std::array<Eye, 2> eyes;
    for (std::size_t e = 0; e < 2; ++e) {
        eyes[e] = eyeInScene(scene_from_room_, room_from_eyes[e], views[e].fov, stay_->images->partPx());
    }
    FrameSettings frame = frameSettings(options_.run.camera, governedStereo());
    frame.near = options_.run.camera.near * scene_from_room_.scale;  // of the wearer, however large the scene is
    frame.dominant = settings_.stereo.dominant;
    frame.keep_depth = frame.keep_both_depths = stay_->images->takesDepth();
    frame.half_floats = true;
    frame.keep_classes = settings_.tint;
    // One eye's picture for both is seen through either lens.
    if (!showsOneEye() && settings_.visibility_mask) {
        frame.hidden_tiles = stay_->lens_mask.update(stay_->session, views, stay_->images->partPx());
    }
    for (const int e : {kLeft, kRight}) {
        if (!showsOneEye() || e == frame.dominant) { stay_->images->acquire(e, true); }
    }
    last_ = scene_->frame.render(showsOneEye() ? std::span<const Eye>(&eyes[frame.dominant], 1) : std::span<const Eye>(eyes), frame,
                                 [&](Commands& commands) {
                                     recordEyes(commands, frame);
                                     recordPanel(commands);
                                 });
    const GovernedSettings before = governor_.settings();
    governor_.measure({last_.gpu_total_ms, stay_->session.periodMs()});
    if (governor_.settings() != before) { fmt::print("frame {}: {}\n", frames_, governor_.sentence()); }
    sayHidden();
}

void Viewer::recordEyes(Commands& commands, const FrameSettings& frame) {
    for (const int e : {kLeft, kRight}) {
        const bool dominant = e == frame.dominant;
        if (frame.mode == Mode::kMono && !dominant) { continue; }
        const bool tinted = settings_.tint && reprojects(frame.mode) && !dominant;
        const EyeImage& image = scene_->frame.image(frame.mode == Mode::kMono ? 0 : e);
        stay_->images->present(commands, e, image, tinted ? &scene_->frame.stereoBuffers() : nullptr, frame.near);
        // The window shows the dominant eye, or what is made of it where that is the point.
        const bool shown = frame.mode == Mode::kMono || dominant != settings_.tint;
        if (window_ && shown) { window_->keepEye(commands, presenter_.pixels(), stay_->images->partPx(), format_); }
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
    const auto layerEye = [&](int shown_to) {
        // One eye's picture for both is shown as that eye saw it.
        const int e = scene_ && showsOneEye() ? settings_.stereo.dominant : shown_to;
        return stay_->images->layerEye(e, views[static_cast<std::size_t>(e)], options_.run.camera.near);
    };
    layers.addEyes({layerEye(kLeft), layerEye(kRight)});
}

void Viewer::layOutPanel(bool hung) {
    status_.loading = loader_ ? std::optional(loader_->progress()) : std::nullopt;
    status_.has_scene = scene_ != nullptr;
    status_.governor = governor_.sentence();
    status_.frame = last_.counters.empty() ? nullptr : &last_;
    if (hung) { panel_now_ = stay_->panel_images.acquire(); }
    canvas_.begin(window_input_.pointer.place_px ? window_input_.pointer : panel_.pointer(), stay_->session.stepSeconds());
    obey(drawOverlay(kCanvasPx, settings_, status_));
}

void Viewer::recordPanel(Commands& commands) {
    if (!panel_now_ && !window_) { return; }
    commands.beginPass("panel");
    canvas_.record(commands);
    if (panel_now_) { commands.copyImage(canvas_.image(), panel_now_, kCanvasPx); }
    if (window_) { window_->record(commands); }
}

void Viewer::obeyWindow(const Pose& room_from_head, double step_seconds) {
    if (!window_) { return; }
    window_input_ = window_->poll();
    if (window_input_.quit) { leave(); }
    recentre_asked_ = recentre_asked_ || window_input_.recentre;
    if (!window_input_.dropped.empty()) { beginScene(window_input_.dropped); }
    if (window_input_.reload_shaders) { reloadShaders(); }
    if (window_input_.toggle_panel) {
        settings_.panel = !settings_.panel;
        panel_.hangBefore(room_from_head);
    }
    const double turn_rad = window_input_.turn_rad + step_seconds * window_input_.turn_rate * kTurnRadiansPerSecond;
    if (turn_rad != 0.0) { scene_from_room_ = turnedBy(scene_from_room_, turn_rad, room_from_head.position); }
    const glm::dvec3 forward = levelled(room_from_head.orientation * glm::dvec3(0.0, 0.0, 1.0)), down(0.0, 1.0, 0.0);
    const glm::dvec3 walk = window_input_.walk.x * glm::cross(down, forward) + window_input_.walk.y * down + window_input_.walk.z * forward;
    if (walk != glm::dvec3(0.0)) { scene_from_room_ = movedBy(scene_from_room_, step_seconds * kWalkMetresPerSecond * walk); }
}

void Viewer::addPanel(xr::Layers& layers, const Pose& room_from_head) const {
    layers.addPanel(panel_.roomFromPanel(), panel_.sizeMetres(), stay_->panel_images);
    if (const auto ray = panel_.ray(room_from_head)) { layers.addPanel(ray->room_from_strip, ray->size_m, stay_->ray_image); }
}

void Viewer::obey(const OverlayActions& actions) {
    if (actions.save) {
        settings_.scene_from_room = scene_from_room_;
        status_.message = saveViewSettings(status_.scene, settings_);
        settings_.scene_from_room.reset();
    }
    if (actions.load) {
        status_.message = loadViewSettings(status_.scene, settings_);
        scene_from_room_ = settings_.scene_from_room.value_or(scene_from_room_);
        settings_.scene_from_room.reset();
        settings_.panel = true;  // it was just pressed
    }
    if (actions.reload_shaders) { reloadShaders(); }
    if (actions.reset_scene) { scene_from_room_ = scene_->start; }
    if (actions.level_scene) { scene_from_room_ = levelledLike(scene_from_room_, scene_->start, room_from_head_.position); }
    if (actions.save || actions.load) { fmt::print("frame {}: {}\n", frames_, status_.message); }
    recentre_asked_ = recentre_asked_ || actions.recentre;
    if (actions.scene_step != 0) { beginScene(sceneBeside(asked_scene_, actions.scene_step)); }
    if (actions.take_picture) { takePicture(); }
    if (actions.quit) { leave(); }
}

void Viewer::reloadShaders() {
    if (!scene_ || !status_.can_reload_shaders) { return; }  // without a scene kernels are being made elsewhere
    status_.message = binosplat::reloadShaders(context_, shaderFolder(options_.shaders), [&] {
        scene_->frame.rebuildKernels();
        presenter_.rebuildKernels();
    });
    fmt::print("frame {}: {}\n", frames_, status_.message);
}

void Viewer::beginScene(const std::string& scene) {
    asked_scene_ = scene;
    loader_ = std::make_unique<SceneLoader>(context_, scene, options_.run);
}

void Viewer::takePicture() {
    if (last_.counters.empty()) { return; }
    try {
        Image both = scene_->frame.readPicture(0);
        if (!showsOneEye()) { both = besideOneAnother(both, scene_->frame.readPicture(1)); }
        const std::filesystem::path folder = std::filesystem::current_path();
        OutputFiles files(folder);
        say("picture " + writePicture(files.staging() / freePictureName(folder), PictureKind::kDisplay, both).front().filename().string());
        files.publish();
    } catch (const Error& error) { say(error.what()); }
}

void Viewer::waitForQueue() const {
    const std::lock_guard lock(context_.queueMutex());
    context_.queue().waitIdle();
}

void Viewer::say(const std::string& message) {
    status_.message = message;
    fmt::print("frame {}: {}\n", frames_, message);
}

}  // namespace binosplat
