// The viewer's loop.
#include "app/view/viewer.h"

#include "app/terminal/interrupt.h"
#include "app/view/panel/panel_style.h"
#include "app/view/placement/view_eyes.h"
#include "app/view/shader_reload.h"
#include "engine/error.h"

#include <thread>

namespace binosplat {

namespace {

// While the scene loads, unless a background is asked for.
constexpr glm::vec3 kWaitingColour(0.06f, 0.07f, 0.09f);
// How often to look whether the session has begun to run, and how often the window is drawn meanwhile.
constexpr std::chrono::milliseconds kIdle(5), kWindowAlone(16);

}  // namespace

Viewer::Viewer(const ViewOptions& options, const ViewSettings& settings, xr::Instance& instance, const Context& context, bool mirrored)
    : options_(options),
      instance_(instance),
      context_(context),
      settings_(settings),
      drawn_(settings),
      connection_(instance, context, kPanelPx, [this](const std::string& message) { log_.say(message); }),
      renderer_(instance, context, options_.run, log_, connection_.format()),
      panel_(context, connection_.format()),
      commands_(context_),
      scenes_(context_, options_, log_,
              FramesAhead{settings.stereo, renderer_.sizePx(settings), instance.takesDepth(), settings.tint, {}}) {
    panel_.status().can_reload_shaders = !shaderFolder(options.shaders).empty();
    if (const std::string& complaint = panel_.canvas().fontComplaint(); !complaint.empty()) { log_.print(complaint); }
    if (mirrored) { openWindow(); }
}

void Viewer::run() {
    const Interrupt interrupt;
    try {
        try {
            renderer_.fitImages(headset(), settings_);
        } catch (const xr::Lost& lost) { loseHeadset(lost.what()); }
        while (options_.load_first && !scenes_.get() && !leaving_) {
            if (interrupt.came()) { leave(); }
            if (scenes_.isNextReady()) { takeScene(); }
            drawWindowAlone("Loading the scene");
            std::this_thread::sleep_for(kIdle);
        }
        for (bool goes_on = true; goes_on;) {
            if (!leaving_ && (interrupt.came() || (options_.frames != 0 && log_.frame >= options_.frames))) { leave(); }
            try {
                goes_on = connection_.headset() != nullptr ? step() : comeBack();
            } catch (const xr::Lost& lost) {
                if (leaving_) { break; }
                loseHeadset(lost.what());
            }
        }
    } catch (const xr::InstanceLost& lost) {
        log_.print(fmt::format("{} frames; {}", log_.frame, lost.what()));
        throw;
    }
    sayPicture(pictures_.finish());
    keepPictureOfScene();
    files_.finish();
    const std::string why = connection_.headset() != nullptr ? headset().session.whyEnded() : "stopped while there was no headset";
    log_.print(fmt::format("{} frames; {}", log_.frame, why.empty() ? "the session was lost as it ended" : why));
}

bool Viewer::step() {
    for (const std::string& trouble : instance_.troubles().take()) { say(trouble); }
    switch (headset().session.beginFrame()) {
        case xr::FrameOutcome::kExit:
            return false;
        case xr::FrameOutcome::kWait:
            drawWindowAlone("Put the headset on");
            std::this_thread::sleep_for(kIdle);
            return true;
        case xr::FrameOutcome::kRender:
            drawFrame();
            connection_.showedFrame();
            break;
        case xr::FrameOutcome::kSkip:
            drawWindowAlone("The headset is showing something else");
            headset().session.endFrame({});
            break;
    }
    ++log_.frame;
    return true;
}

void Viewer::leave() {
    if (std::exchange(leaving_, true)) { return; }
    if (connection_.headset() != nullptr) { headset().session.requestExit(); }
}

void Viewer::loseHeadset(const std::string& why) {
    connection_.lose(why);
    panel_.giveUp();
}

bool Viewer::comeBack() {
    if (leaving_) { return false; }
    switch (connection_.search([this](const std::string& message) { say(message); })) {
        case HeadsetConnection::Search::kLater:
            drawWindowAlone("The headset is unplugged: plug it in");
            std::this_thread::sleep_for(kIdle);
            break;
        case HeadsetConnection::Search::kNone:
            break;
        case HeadsetConnection::Search::kFound:
            renderer_.fitImages(headset(), settings_);
            break;
    }
    return true;
}

void Viewer::settle() {
    xr::Session& session = headset().session;
    if (!session.settle(recentre_asked_)) { return; }
    recentre_asked_ = false;
    controls_.letGo();
    const std::optional<double> floor_m = session.floorBelowMetres();
    log_.say("the room now begins where the wearer stands" +
             (floor_m ? fmt::format(", {:.2f} m above the floor", *floor_m) : std::string()));
    panel_.inRoom().hangBefore({});
}

void Viewer::drawFrame() {
    settle();
    const std::optional<std::array<xr::EyeView, 2>> located = headset().session.locateEyes();
    if (!located) {
        drawWindowAlone("The headset cannot tell where it is");
        headset().session.endFrame({});
        return;
    }
    files_.deliver();
    if (scenes_.isNextReady()) { takeScene(); }
    const std::array<xr::EyeView, 2> eyes = withoutNoise(*located);
    const std::array<Pose, 2> room_from_eyes = roomFromEyes(eyes);
    FrameViews views{eyes, room_from_eyes, roomFromHead(room_from_eyes), {}};
    room_from_head_ = views.room_from_head;
    const ViewSettings before = settings_;
    const double step_seconds = headset().session.stepSeconds();
    const WearerNow wearer{headset().input.read(), room_from_head_, headset().session.floorBelowMetres(), step_seconds};
    controls_.update(wearer, panel_.inRoom(), settings_, scenes_.scene_from_room);
    if (const double clear_deg = settings_.stereo.foveation_deg; clear_deg > 0.0) {
        views.gazes = gaze_.update(headset().input.gaze(), room_from_eyes, glm::radians(clear_deg), step_seconds);
    } else {
        gaze_ = {};
    }
    if (const int step = controls_.viewpointStep(); step != 0) { goToViewpoint(step); }
    chooseThings(wearer, views);
    takeWindowInput(step_seconds);
    if (const std::string complaint = headset().session.askForRate(settings_.refresh_rate); !complaint.empty()) { say(complaint); }
    panel_.status().state.clear();
    panel_hangs_ = settings_.panel;
    if (panel_hangs_ || window_) { layOutPanel(panel_hangs_, step_seconds); }
    // Last, since the panel and the window may change what is wished for.
    const bool fits = prepareScene(views);
    onWindow(&MirrorWindow::acquire);
    if (LoadedScene* scene = scenes_.get(); scene != nullptr && fits) {
        renderer_.render(headset(), *scene, drawn_, window_.get(), [this](Commands& commands) { recordPanel(commands); });
        ++frames_of_scene_;
        if (picture_asked_) { takePicture(); }
    } else {
        renderWaiting();
    }
    picture_asked_ = false;
    sayPicture(pictures_.takeOutcome());
    onWindow(&MirrorWindow::show);
    showFrame(views);
    sayChange(before);
    panel_.keepFrameTime();
}

bool Viewer::prepareScene(const FrameViews& views) {
    LoadedScene* scene = scenes_.get();
    scenes_.expect(settings_.stereo, renderer_.sizePx(settings_), settings_.tint);
    const ViewSettings drawable = scenes_.drawable(settings_);
    const bool waits = drawable != settings_;
    if (std::exchange(waits_for_kernels_, waits) && !waits) { log_.say(fmt::format("{} is ready", nameOf(settings_.stereo.mode))); }
    drawn_ = drawable;
    try {
        renderer_.govern(headset(), drawn_);
        ViewSettings wished = drawn_;
        if (picture_asked_) { wished.visibility_mask = false; }  // no lens hides anything of a picture
        if (scene != nullptr) { renderer_.prepare(headset(), *scene, scenes_.scene_from_room, wished, views); }
        settings_that_fit_ = drawn_;
        return true;
    } catch (const Error& error) {
        const std::string change = settings_that_fit_ ? describeChange(*settings_that_fit_, settings_) : "";
        if (change.empty()) { throw; }
        say(fmt::format("{} does not fit: {}", change, error.what()));
    }
    settings_ = drawn_ = *settings_that_fit_;
    renderer_.govern(headset(), drawn_);
    return false;
}

void Viewer::chooseThings(const WearerNow& wearer, const FrameViews& views) {
    for (const int h : {kLeft, kRight}) {
        if (panel_.inRoom().pulses(h)) { headset().input.pulse(h); }
    }
    vignette_.update(settings_.vignette && controls_.isMoving(), wearer.step_seconds);
    RoomSight sight;
    sight.eye = wearer.room_from_head.position;
    if (settings_.hands) { sight.hands = wearer.hands; }
    sight.things = panel_.inRoom().rays(sight.eye, controls_.aimingHand());
    std::ranges::copy(thingsOf(controls_.teleportAim(), sight.eye), std::back_inserter(sight.things));
    sight.vignette_m = vignette_.widthMetres(views.eyes);
    headset().things.choose(sight);
}

void Viewer::showFrame(const FrameViews& views) {
    headset().images->release();
    panel_.release(headset());
    headset().things.release();
    headset().session.seeThrough(renderer_.seesThrough(settings_));
    submitFrame(views);
}

void Viewer::submitFrame(const FrameViews& views) {
    const auto submit = [&](bool with_things) {
        xr::Layers layers(headset().session);
        addEyes(layers, views);
        if (with_things) { headset().things.addBehindPanel(layers); }
        if (panel_hangs_) { layers.addPanel(panel_.inRoom().roomFromPanel(), panel_.inRoom().sizeMetres(), headset().panel_images); }
        if (with_things) { headset().things.addBeforePanel(layers); }
        headset().session.endFrame(layers.list());
    };
    std::string refusal;
    const auto isTaken = [&](bool with_things) {
        try {
            submit(with_things);
            return true;
        } catch (const Error& error) { refusal = error.what(); }
        return false;
    };
    if (isTaken(true)) { return; }
    // What can be done without is left out, the cheaper first.
    if (headset().things.areShown() && isTaken(false)) {
        instance_.troubles().add(refusal + "; on without hands, rays and the vignette");
        headset().things.giveUp();
        return;
    }
    if (std::exchange(takes_depth_, false)) {
        log_.say("the runtime refuses depth; on without depth");
        renderer_.dropDepth(headset());
    }
    submit(true);
}

void Viewer::drawWindowAlone(const std::string& why) {
    const auto now = std::chrono::steady_clock::now();
    if (!window_ || now - last_alone_ < kWindowAlone) { return; }
    const double step_seconds = std::min(std::chrono::duration<double>(now - last_alone_).count(), 0.1);
    last_alone_ = now;
    files_.deliver();
    if (scenes_.isNextReady()) { takeScene(); }
    const ViewSettings before = settings_;
    takeWindowInput(step_seconds);
    panel_.status().state = why;
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

void Viewer::openWindow() {
    try {
        window_ = std::make_unique<MirrorWindow>(context_, panel_.canvas());
    } catch (const Error& error) { log_.print(fmt::format("no window: {}", error.what())); } catch (const vk::SystemError& error) {
        log_.print(fmt::format("no window: {}", error.what()));
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
    for (const int e : {kLeft, kRight}) { headset().images->acquire(e, false); }
    commands_.begin();
    const glm::dvec3& background = options_.run.camera.background;
    const glm::vec3 behind = background == glm::dvec3(0.0) ? kWaitingColour : glm::vec3(background);
    const glm::vec4 colour = renderer_.seesThrough(settings_) ? glm::vec4(0.0f) : glm::vec4(behind, 1.0f);
    for (const int e : {kLeft, kRight}) { headset().images->clear(commands_, e, colour); }
    recordPanel(commands_);
    commands_.submit(window_ ? window_->drawn() : vk::Semaphore());
    commands_.wait();
}

void Viewer::addEyes(xr::Layers& layers, const FrameViews& views) const {
    const auto layerEye = [&](int shown_to) {
        // One eye's picture for both is shown as that eye saw it.
        const int e = scenes_.get() != nullptr && drawn_.showsOneEye() ? drawn_.stereo.dominant : shown_to;
        return headset().images->layerEye(e, views.eyes[static_cast<std::size_t>(e)], options_.run.camera.near);
    };
    layers.addEyes({layerEye(kLeft), layerEye(kRight)}, renderer_.seesThrough(settings_));
}

void Viewer::layOutPanel(bool hung, double step_seconds) {
    PanelStatus& status = panel_.status();
    status.scene = scenes_.name();
    status.loading = scenes_.loading();
    status.rate = renderer_.rate();
    status.has_scene = scenes_.get() != nullptr;
    status.can_pass_through = instance_.canSeeThrough();
    if (connection_.headset() != nullptr) { status.refresh_rates = headset().refresh_rates; }
    if (status.has_scene) { status.usual_order = scenes_.get()->gpu_scene.usualOrder(); }
    if (status.has_scene) {
        status.facts = describeFacts(scenes_.get()->facts, 1.0 / scenes_.scene_from_room.scale);
        status.place = shownPlace();
        status.viewpoint_count = scenes_.get()->viewpoints.size();
        status.viewpoint = viewpoint_ ? scenes_.get()->viewpoints[*viewpoint_].name : "";
    }
    panel_.showTimes(renderer_.lastFrame(), renderer_.governorSentence(), step_seconds);
    panel_.askFor(files_, settings_);
    if (status.files.empty() && scenes_.isMakingKernels()) {
        status.files = fmt::format("making ready: {}", nameOf(settings_.stereo.mode));
    }
    followPanel(
        panel_.layOut(hung ? connection_.headset() : nullptr, window_input_.pointer, window_input_.uses_panel, settings_, step_seconds));
}

void Viewer::recordPanel(Commands& commands) {
    if (connection_.headset() != nullptr) { headset().things.record(commands); }
    panel_.record(commands, connection_.headset(), window_ != nullptr);
    if (window_) { window_->record(commands); }
}

void Viewer::takeWindowInput(double step_seconds) {
    if (!window_) { return; }
    window_input_ = window_->poll();
    if (window_input_.quit) { leave(); }
    recentre_asked_ = recentre_asked_ || window_input_.recentre;
    if (!window_input_.dropped.empty()) { scenes_.begin(window_input_.dropped); }
    if (window_input_.reload_shaders) { reloadShaders(); }
    if (window_input_.toggle_panel) {
        settings_.panel = !settings_.panel;
        panel_.inRoom().hangBefore(room_from_head_);
    }
    scenes_.scene_from_room = movedByWindow(scenes_.scene_from_room, window_input_, room_from_head_, step_seconds);
}

void Viewer::followPanel(const PanelRequests& actions) {
    if (actions.reload_shaders) { reloadShaders(); }
    if (scenes_.get() != nullptr) { movePlace(actions); }
    recentre_asked_ = recentre_asked_ || actions.recentre;
    openAndSave(actions);
    if (actions.quit) { leave(); }
}

void Viewer::waitForQueue() const {
    const std::lock_guard lock(context_.queueMutex());
    context_.queue().waitIdle();
}

void Viewer::say(const std::string& message) {
    panel_.status().message = message;
    log_.say(message);
}

void Viewer::sayChange(const ViewSettings& before) const {
    const std::string change = describeChange(before, settings_);
    if (!change.empty()) { log_.say(change); }
}

}  // namespace binosplat
