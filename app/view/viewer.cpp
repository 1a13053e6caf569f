// The viewer's loop.
#include "app/view/viewer.h"

#include "app/interrupt.h"
#include "app/view/panel/panel_style.h"
#include "app/view/scenes/recent_scenes.h"
#include "app/view/shader_reload.h"
#include "app/view/view_files.h"
#include "app/view/wearer/view_eyes.h"
#include "engine/error.h"

#include <thread>

namespace binosplat {

namespace {

// While the scene loads, unless a background is asked for.
constexpr glm::vec3 kWaitingColour(0.06f, 0.07f, 0.09f);
constexpr std::size_t kPlottedFrames = 120;
// How long the panel shows the times of a frame: nobody can read what changes with every frame, and the panel is drawn only when it
// changes.
constexpr double kTimesSeconds = 0.25;
// How often to look whether the session has begun to run, and how often the window is drawn meanwhile.
constexpr std::chrono::milliseconds kIdle(5), kWindowAlone(16);
// How often to look whether an unplugged headset is there again.
constexpr std::chrono::milliseconds kBetweenSearches(200);
// So often, so far apart, a session is asked for that a headset which was just plugged in again refuses.
constexpr int kMostFailures = 10;
constexpr std::chrono::milliseconds kBetweenFailures(1000);

}  // namespace

Viewer::Viewer(const ViewOptions& options, const ViewSettings& settings, xr::Instance& instance, const Context& context, bool mirrored)
    : options_(options),
      instance_(instance),
      context_(context),
      settings_(settings),
      stay_(std::make_unique<HeadsetStay>(instance, context, kPanelPx)),
      format_(stay_->format),
      renderer_(instance, context, options_.run, log_, format_),
      canvas_(context_, kPanelPx, format_),
      panel_(kPanelPx, kPanelWidthMetres),
      commands_(context_),
      scenes_(context_, options_, log_,
              FramesAhead{settings.stereo, renderer_.sizePx(settings), instance.takesDepth(), settings.tint, {}}) {
    status_.can_reload_shaders = !shaderFolder(options.shaders).empty();
    if (!canvas_.fontComplaint().empty()) { fmt::print("{}\n", canvas_.fontComplaint()); }
    if (mirrored) { openWindow(); }
}

void Viewer::run() {
    const Interrupt interrupt;
    try {
        try {
            renderer_.fitImages(*stay_, settings_);
        } catch (const xr::Lost& lost) { loseStay(lost.what()); }
        while (options_.load_first && !scenes_.get() && !leaving_) {
            if (interrupt.came()) { leave(); }
            if (scenes_.isNextReady()) { takeScene(); }
            drawWindowAlone("The scene is on its way");
            std::this_thread::sleep_for(kIdle);
        }
        for (bool goes_on = true; goes_on;) {
            if (!leaving_ && (interrupt.came() || (options_.frames != 0 && log_.frame >= options_.frames))) { leave(); }
            try {
                goes_on = stay_ ? step() : comeBack();
            } catch (const xr::Lost& lost) {
                if (leaving_) { break; }
                loseStay(lost.what());
            }
        }
    } catch (const xr::InstanceLost& lost) {
        fmt::print("{} frames; {}\n", log_.frame, lost.what());
        throw;
    }
    sayPicture(pictures_.finish());
    const std::string why = stay_ ? stay_->session.whyEnded() : "stopped while there was no headset";
    fmt::print("{} frames; {}\n", log_.frame, why.empty() ? "the session was lost as it ended" : why);
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
            losses_.forget();
            break;
        case xr::FrameOutcome::kSkip:
            drawWindowAlone("The headset shows something else, or nothing");
            stay_->session.endFrame({});
            break;
    }
    ++log_.frame;
    return true;
}

void Viewer::leave() {
    if (std::exchange(leaving_, true)) { return; }
    if (stay_) { stay_->session.requestExit(); }
}

void Viewer::loseStay(const std::string& why) {
    if (!losses_.add(std::chrono::steady_clock::now())) {
        throw Error(ExitCode::kNoDevice, fmt::format("{}: {} times in a row before a frame was shown", why, losses_.count()));
    }
    why_lost_ = why;
    is_gone_ = false;
    next_search_ = {};
    waitForQueue();
    panel_now_ = nullptr;
    canvas_.giveUp();
    stay_.reset();
}

bool Viewer::comeBack() {
    if (leaving_) { return false; }
    const auto now = std::chrono::steady_clock::now();
    if (now < next_search_) {
        drawWindowAlone("The headset is gone: plug it in");
        std::this_thread::sleep_for(kIdle);
        return true;
    }
    next_search_ = now + kBetweenSearches;
    if (!instance_.findHeadset(context_)) {
        if (!std::exchange(is_gone_, true)) { say(why_lost_ + "; the headset is gone: waiting for it"); }
        std::fflush(stdout);
        return true;
    }
    say(is_gone_ ? "the headset is there again; a new session begins" : why_lost_ + "; another one begins");
    try {
        stay_ = std::make_unique<HeadsetStay>(instance_, context_, kPanelPx);
        failures_ = 0;
    } catch (const xr::Lost&) { throw; } catch (const xr::InstanceLost&) {
        throw;
    } catch (const Error& error) {
        // It was found, but is not awake yet.
        if (++failures_ > kMostFailures) { throw; }
        why_lost_ = error.what();
        next_search_ = now + kBetweenFailures;
        return true;
    }
    if (stay_->format != format_) { throw Error(ExitCode::kNoDevice, why_lost_ + ": the next one has other formats of images"); }
    renderer_.fitImages(*stay_, settings_);
    return true;
}

void Viewer::settle() {
    xr::Session& session = stay_->session;
    if (!session.settle(recentre_asked_)) { return; }
    recentre_asked_ = false;
    controls_.letGo();
    const std::optional<double> floor_m = session.floorBelowMetres();
    log_.say("the room now begins where the wearer stands" +
             (floor_m ? fmt::format(", {:.2f} m above the floor", *floor_m) : std::string()));
    panel_.hangBefore({});
}

void Viewer::drawFrame() {
    settle();
    const std::optional<std::array<xr::EyeView, 2>> located = stay_->session.locateEyes();
    if (!located) {
        drawWindowAlone("The headset does not know where it is");
        stay_->session.endFrame({});
        return;
    }
    if (scenes_.isNextReady()) { takeScene(); }
    const std::array<xr::EyeView, 2> eyes = withoutNoise(*located);
    const std::array<Pose, 2> room_from_eyes = roomFromEyes(eyes);
    FrameViews views{eyes, room_from_eyes, roomFromHead(room_from_eyes), {}};
    room_from_head_ = views.room_from_head;
    const ViewSettings before = settings_;
    const double step_seconds = stay_->session.stepSeconds();
    const WearerNow wearer{stay_->input.read(), room_from_head_, stay_->session.floorBelowMetres(), step_seconds};
    controls_.update(wearer, panel_, settings_, scenes_.scene_from_room);
    if (const double clear_deg = settings_.stereo.foveation_deg; clear_deg > 0.0) {
        views.gazes = gaze_.update(stay_->input.gaze(), room_from_eyes, glm::radians(clear_deg), step_seconds);
    } else {
        gaze_ = {};
    }
    chooseThings(wearer, views);
    obeyWindow(step_seconds);
    if (const std::string complaint = stay_->session.askForRate(settings_.refresh_rate); !complaint.empty()) { say(complaint); }
    status_.state.clear();
    panel_hangs_ = settings_.panel;
    if (panel_hangs_ || window_) { layOutPanel(panel_hangs_, step_seconds); }
    // Last, since the panel and the window may change what is wished for.
    const bool fits = prepareScene(views);
    onWindow(&MirrorWindow::acquire);
    if (LoadedScene* scene = scenes_.get(); scene != nullptr && fits) {
        renderer_.render(*stay_, *scene, settings_, window_.get(), [this](Commands& commands) { recordPanel(commands); });
        if (picture_asked_) { takePicture(); }
    } else {
        renderWaiting();
    }
    picture_asked_ = false;
    sayPicture(pictures_.takeOutcome());
    onWindow(&MirrorWindow::show);
    showFrame(views);
    sayChange(before);
    keepFrameTime();
}

bool Viewer::prepareScene(const FrameViews& views) {
    LoadedScene* scene = scenes_.get();
    try {
        renderer_.govern(*stay_, settings_);
        ViewSettings wished = settings_;
        if (picture_asked_) { wished.visibility_mask = false; }  // no lens hides anything of a picture
        if (scene != nullptr) { renderer_.prepare(*stay_, *scene, scenes_.scene_from_room, wished, views); }
        settings_that_fit_ = settings_;
        return true;
    } catch (const xr::Lost&) { throw; } catch (const xr::InstanceLost&) {
        throw;
    } catch (const Error& error) {
        const std::string change = settings_that_fit_ ? describeChange(*settings_that_fit_, settings_) : "";
        if (change.empty()) { throw; }
        say(fmt::format("{} does not fit: {}", change, error.what()));
    }
    settings_ = *settings_that_fit_;
    renderer_.govern(*stay_, settings_);
    return false;
}

void Viewer::chooseThings(const WearerNow& wearer, const FrameViews& views) {
    for (const int h : {kLeft, kRight}) {
        if (panel_.pulses(h)) { stay_->input.pulse(h); }
    }
    vignette_.update(settings_.vignette && controls_.isMoving(), wearer.step_seconds);
    RoomSight sight;
    sight.eye = wearer.room_from_head.position;
    if (settings_.hands) { sight.hands = wearer.hands; }
    sight.rays = panel_.rays(sight.eye, controls_.aimingHand());
    sight.teleport = controls_.teleportAim();
    sight.vignette_m = vignette_.widthMetres(views.eyes);
    stay_->things.choose(sight);
}

void Viewer::keepFrameTime() {
    const auto now = std::chrono::steady_clock::now();
    if (last_end_ != std::chrono::steady_clock::time_point()) {
        frame_ms_.push_back(std::chrono::duration<float, std::milli>(now - last_end_).count());
    }
    if (frame_ms_.size() > kPlottedFrames) { frame_ms_.erase(frame_ms_.begin()); }
    last_end_ = now;
}

void Viewer::showFrame(const FrameViews& views) {
    stay_->images->release();
    if (std::exchange(panel_now_, nullptr)) {
        stay_->panel_images.release();
        stay_->panel_revision = canvas_.revision();
    }
    stay_->things.release();
    stay_->session.seeThrough(renderer_.seesThrough(settings_));
    const auto submit = [&] {
        xr::Layers layers(stay_->session);
        addEyes(layers, views);
        stay_->things.addBehindPanel(layers);
        if (panel_hangs_) { layers.addPanel(panel_.roomFromPanel(), panel_.sizeMetres(), stay_->panel_images); }
        stay_->things.addBeforePanel(layers);
        stay_->session.endFrame(layers.list());
    };
    try {
        submit();
    } catch (const xr::Lost&) { throw; } catch (const xr::InstanceLost&) {
        throw;
    } catch (const Error&) {
        if (!std::exchange(takes_depth_, false)) { throw; }
        log_.say("the runtime refuses depth; on without depth");
        renderer_.dropDepth(*stay_);
        submit();
    }
}

void Viewer::drawWindowAlone(const std::string& why) {
    const auto now = std::chrono::steady_clock::now();
    if (!window_ || now - last_alone_ < kWindowAlone) { return; }
    const double step_seconds = std::min(std::chrono::duration<double>(now - last_alone_).count(), 0.1);
    last_alone_ = now;
    if (scenes_.isNextReady()) { takeScene(); }
    const ViewSettings before = settings_;
    obeyWindow(step_seconds);
    status_.state = why;
    layOutPanel(false, step_seconds);
    sayPicture(pictures_.takeOutcome());
    onWindow(&MirrorWindow::acquire);
    if (!window_) { return; }
    waitForQueue();  // what the panel is drawn from is that of the last frame
    commands_.begin();
    recordPanel(commands_);
    commands_.submit(window_->drawn());
    commands_.wait();
    onWindow(&MirrorWindow::show);
    sayChange(before);
}

void Viewer::takeScene() {
    const LoadedScene* before = scenes_.get();
    const std::string complaint = scenes_.take(settings_);
    if (!complaint.empty()) { say(complaint); }
    if (scenes_.get() == before) { return; }
    renderer_.forgetScene();
    try {
        rememberScene(scenes_.name());
    } catch (const Error& error) {
        if (error.what() != complaint) { log_.say(error.what()); }
    }
}

void Viewer::openWindow() {
    try {
        window_ = std::make_unique<MirrorWindow>(context_, canvas_);
    } catch (const Error& error) { fmt::print("no window: {}\n", error.what()); } catch (const vk::SystemError& error) {
        fmt::print("no window: {}\n", error.what());
    }
}

void Viewer::onWindow(void (MirrorWindow::*act)()) {
    const auto goOnWithout = [&](const char* why) {
        say(fmt::format("the window is gone: {}", why));
        window_.reset();
        window_input_ = {};
    };
    try {
        if (window_) { (*window_.*act)(); }
    } catch (const vk::DeviceLostError&) { throw; } catch (const vk::SystemError& error) {
        goOnWithout(error.what());
    } catch (const Error& error) { goOnWithout(error.what()); }
}

void Viewer::renderWaiting() {
    for (const int e : {kLeft, kRight}) { stay_->images->acquire(e, false); }
    commands_.begin();
    const glm::dvec3& background = options_.run.camera.background;
    const glm::vec3 behind = background == glm::dvec3(0.0) ? kWaitingColour : glm::vec3(background);
    const glm::vec4 colour = renderer_.seesThrough(settings_) ? glm::vec4(0.0f) : glm::vec4(behind, 1.0f);
    for (const int e : {kLeft, kRight}) { stay_->images->clear(commands_, e, colour); }
    recordPanel(commands_);
    commands_.submit(window_ ? window_->drawn() : vk::Semaphore());
    commands_.wait();
}

void Viewer::addEyes(xr::Layers& layers, const FrameViews& views) const {
    const auto layerEye = [&](int shown_to) {
        // One eye's picture for both is shown as that eye saw it.
        const int e = scenes_.get() != nullptr && settings_.showsOneEye() ? settings_.stereo.dominant : shown_to;
        return stay_->images->layerEye(e, views.eyes[static_cast<std::size_t>(e)], options_.run.camera.near);
    };
    layers.addEyes({layerEye(kLeft), layerEye(kRight)}, renderer_.seesThrough(settings_));
}

void Viewer::layOutPanel(bool hung, double step_seconds) {
    status_.scene = scenes_.name();
    status_.loading = scenes_.loading();
    status_.has_scene = scenes_.get() != nullptr;
    status_.can_pass_through = instance_.canSeeThrough();
    if (stay_) { status_.refresh_rates = stay_->refresh_rates; }
    if (status_.has_scene) { status_.facts = describeFacts(scenes_.get()->facts, 1.0 / scenes_.scene_from_room.scale); }
    showTimes(step_seconds);
    canvas_.bringLetters(namesOn(pages_, status_));
    // A mouse that lies still is nobody's wish while a hand points, and one that is pushed takes no button from a hand that holds it.
    const CanvasPointer& hand = panel_.pointer();
    const bool mouse_pointed = mouse_points_;
    mouse_points_ = hung && hand.place_px ? window_input_.uses_panel && !hand.pressed : mouse_points_ || window_input_.uses_panel;
    CanvasPointer pointer = mouse_points_ ? window_input_.pointer : hand;
    if (mouse_points_ != mouse_pointed) { pointer.pressed = false; }  // what one of them drags the other does not take along
    canvas_.begin(pointer, step_seconds);
    const OverlayActions actions = drawOverlay(kPanelPx, settings_, pages_, status_);
    canvas_.end();
    if (hung && stay_->panel_revision != canvas_.revision()) { panel_now_ = stay_->panel_images.acquire(); }
    obey(actions);
}

void Viewer::showTimes(double step_seconds) {
    times_age_s_ += step_seconds;
    const FrameResult& last = renderer_.lastFrame();
    const bool has_times = !last.counters.empty();
    if (has_times && status_.frame != nullptr && times_age_s_ < kTimesSeconds) { return; }
    times_age_s_ = 0.0;
    shown_frame_ = last;
    status_.frame = has_times ? &shown_frame_ : nullptr;
    status_.frame_ms = frame_ms_;
    status_.governor = renderer_.governorSentence();
}

void Viewer::recordPanel(Commands& commands) {
    if (stay_) { stay_->things.record(commands); }
    if (!panel_now_ && !window_) { return; }
    commands.beginPass("panel");
    canvas_.record(commands);
    if (panel_now_) {
        commands.copyImage(canvas_.image(), panel_now_, kPanelPx);
        commands.makeMips(panel_now_, kPanelPx, stay_->panel_images.levels());
    }
    if (window_) { window_->record(commands); }
}

void Viewer::obeyWindow(double step_seconds) {
    if (!window_) { return; }
    window_input_ = window_->poll();
    if (window_input_.quit) { leave(); }
    recentre_asked_ = recentre_asked_ || window_input_.recentre;
    if (!window_input_.dropped.empty()) { scenes_.begin(window_input_.dropped); }
    if (window_input_.reload_shaders) { reloadShaders(); }
    if (window_input_.toggle_panel) {
        settings_.panel = !settings_.panel;
        panel_.hangBefore(room_from_head_);
    }
    scenes_.scene_from_room = movedByWindow(scenes_.scene_from_room, window_input_, room_from_head_, step_seconds);
}

void Viewer::obey(const OverlayActions& actions) {
    if (actions.reload_shaders) { reloadShaders(); }
    Similarity& placement = scenes_.scene_from_room;
    if (actions.reset_scene) { placement = scenes_.get()->start; }
    if (actions.level_scene) { placement = levelledAlong(placement, scenes_.get()->up, room_from_head_.position); }
    recentre_asked_ = recentre_asked_ || actions.recentre;
    obeyFiles(actions);
    if (actions.quit) { leave(); }
}

void Viewer::obeyFiles(const OverlayActions& actions) {
    if (actions.save) {
        settings_.scene_from_room = scenes_.scene_from_room;
        say(saveViewSettings(scenes_.name(), settings_));
        settings_.scene_from_room.reset();
    }
    if (actions.load) {
        say(loadViewSettings(scenes_.name(), settings_));
        scenes_.scene_from_room = settings_.scene_from_room.value_or(scenes_.scene_from_room);
        settings_.scene_from_room.reset();
        settings_.panel = true;  // it was just pressed
    }
    if (actions.scene_step != 0) { scenes_.beginBeside(actions.scene_step); }
    if (!actions.chosen_scene.empty()) { scenes_.begin(actions.chosen_scene); }
    picture_asked_ = picture_asked_ || actions.take_picture;
}

void Viewer::reloadShaders() {
    LoadedScene* scene = scenes_.get();
    if (scene == nullptr || !status_.can_reload_shaders) { return; }
    // Its thread may be making kernels.
    if (scenes_.isLoading()) {
        say("shaders stay as they are until the next scene is there");
        return;
    }
    say(binosplat::reloadShaders(context_, shaderFolder(options_.shaders), [&] {
        scene->frame.rebuildKernels();
        renderer_.presenter().rebuildKernels();
    }));
}

void Viewer::takePicture() {
    if (scenes_.get() == nullptr || renderer_.lastFrame().counters.empty()) { return; }
    try {
        std::error_code error;
        const std::filesystem::path folder = std::filesystem::current_path(error);
        check(!error, "the picture cannot be written: the working directory is gone");
        sayPicture(pictures_.finish());
        pictures_.begin(scenes_.get()->frame, settings_.showsOneEye(), folder);
    } catch (const Error& error) { say(error.what()); }
}

void Viewer::sayPicture(const std::optional<std::string>& outcome) {
    if (outcome) { say(*outcome); }
}

void Viewer::waitForQueue() const {
    const std::lock_guard lock(context_.queueMutex());
    context_.queue().waitIdle();
}

void Viewer::say(const std::string& message) {
    status_.message = message;
    log_.say(message);
}

void Viewer::sayChange(const ViewSettings& before) const {
    const std::string change = describeChange(before, settings_);
    if (!change.empty()) { log_.say(change); }
}

}  // namespace binosplat
