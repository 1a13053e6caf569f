// The viewer from its first session to its last, and its frames, from where the eyes are to what the runtime
// is told to show.
#include "app/view/viewer.h"

#include "app/terminal/interrupt.h"
#include "app/view/panel/panel_style.h"
#include "app/view/placement/view_eyes.h"
#include "app/view/shader_reload.h"
#include "engine/error.h"
#include "engine/places/standpoint.h"

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

namespace binosplat {

namespace {

// How often to check whether the session has begun to run.
constexpr std::chrono::milliseconds kIdle(5);
// How often the window is drawn while there are no frames.
constexpr std::chrono::milliseconds kWindowAlone(16);
// While the scene loads, unless a background is set.
constexpr glm::vec3 kWaitingColour(0.06f, 0.07f, 0.09f);

}  // namespace

Viewer::Viewer(const ViewOptions& options, const ViewSettings& settings, xr::Instance& instance,
               const Context& context, EventWindow* window)
    : options_(options),
      instance_(instance),
      context_(context),
      state_(settings),
      connection_(instance, context, kPanelPx, log_line_),
      renderer_(instance, context, options_.run, log_, connection_.format()),
      submission_(instance.troubles(), state_, renderer_, options_.run.camera.near.value_or(kUsualNear),
                  log_line_),
      panel_(context, connection_.format()),
      window_(say_),
      waiting_(context_),
      pointing_(context_),
      notes_(files_, say_),
      seen_(files_, settings.first_steps),
      place_(state_, notes_, files_, options_.run.metres_per_unit, say_, log_line_),
      scenes_(context_, options_, log_,
              FramesAhead{settings.stereo, renderer_.sizePx(settings), instance.takesDepth(), settings.tint}),
      drawn_(context_, state_, scenes_, renderer_, options_.load_first, say_, log_line_),
      requests_(state_, scenes_, notes_, files_, panel_, say_),
      kept_picture_(context_, scenes_, renderer_, notes_),
      exchange_(state_, scenes_, renderer_, place_, kept_picture_, notes_, pictures_, say_, log_line_),
      actions_(state_, scenes_, place_, exchange_, pointing_, panel_, seen_) {
    for (const double rate_hz : headset().refresh_rates) {
        if (options_.usual_rate_hz == 0.0 || std::abs(rate_hz - options_.usual_rate_hz) > 0.5) { continue; }
        ViewSettings usual = state_.settings();
        usual.refresh_rate = rate_hz;
        state_.set(usual);
    }
    PanelStatus& status = panel_.status();
    status.can_reload_shaders = !shaderFolder(options.shaders).empty();
    status.can_pass_through = instance.canSeeThrough();
    status.takes_depth = instance.takesDepth();
    if (const std::string& complaint = panel_.canvas().font().complaint(); !complaint.empty()) {
        log_.print(complaint);
    }
    if (window == nullptr) { return; }
    if (const std::string why = window_.open(context_, panel_.canvas(), *window); !why.empty()) {
        log_.print(fmt::format("no window: {}", why));
    }
}

void Viewer::run() {
    try {
        while (options_.load_first && !scenes_.isComplete() && !leaving_) {
            if (isInterrupted()) { leave(); }
            takeScenes(true);
            drawWindowAlone("Loading the scene");
            std::this_thread::sleep_for(kIdle);
        }
        for (bool goes_on = true; goes_on;) {
            const bool is_enough =
                options_.frames != 0 && log_.frame - frames_without_scene_ >= options_.frames;
            if (!leaving_ && (isInterrupted() || is_enough)) { leave(); }
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
    while (const std::optional<std::string> outcome = pictures_.finish()) { say(*outcome); }
    kept_picture_.keepAtOnce();
    keepPreferences(0.0, true);
    files_.finish();
    if (const LoadedScene* const scene = scenes_.get(); scene != nullptr && scene->moving != nullptr) {
        const StreamCounters counters = scene->moving->counters();
        log_.print(fmt::format("scene frames that came late: {}; frames that waited for them: {}",
                               counters.scene_frames_late, counters.frames_waited_for_loading));
    }
    const std::string why = connection_.headset() != nullptr ? headset().session.whyEnded()
                                                             : "stopped while there was no headset";
    log_.print(
        fmt::format("{} frames; {}", log_.frame, why.empty() ? "the session was lost as it ended" : why));
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
            headset().session.endFrame({});
            drawWindowAlone("The headset is showing something else");
            break;
    }
    ++log_.frame;
    frames_without_scene_ += scenes_.get() == nullptr ? 1 : 0;
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
    const HeadsetConnection::Search came = connection_.search(say_);
    if (came == HeadsetConnection::Search::kLater) {
        drawWindowAlone("The headset is unplugged: plug it in");
        std::this_thread::sleep_for(kIdle);
    }
    return true;
}

void Viewer::settle() {
    xr::Session& session = headset().session;
    if (!session.settle(recentre_asked_)) { return; }
    recentre_asked_ = false;
    seen_.beginView();
    actions_.letGo();
    const std::optional<double> floor_m = session.floorBelowMetres();
    log_.say("the room now begins where the wearer stands" +
             (floor_m ? fmt::format(", {:.2f} m above the floor", *floor_m) : std::string()));
    panel_.inRoom().hangBefore({});
}

void Viewer::takeScenes(bool at_once) {
    const SceneExchange::Taken taken = exchange_.take(at_once);
    if (taken == SceneExchange::Taken::kNone) { return; }
    actions_.beginScene();
    taken == SceneExchange::Taken::kFirst ? seen_.beginFirstView() : seen_.beginView();
}

void Viewer::drawFrame() {
    settle();
    std::optional<FrameViews> located = locateViews(headset().session);
    if (!located) {
        headset().session.endFrame({});
        drawWindowAlone("The headset cannot tell where it is");
        return;
    }
    renderer_.meetDisplay(headset().session);
    files_.deliver();
    takeScenes(false);
    FrameViews& views = *located;
    place_.setHead(views.room_from_head);
    const double step_seconds = headset().session.stepSeconds();
    actions_.take(headset(), views);
    takeWindowInput(step_seconds);
    if (const std::string complaint = headset().session.askForRate(state_.settings().refresh_rate);
        !complaint.empty()) {
        say(complaint);
    }
    panel_.status().state.clear();
    const bool hangs = state_.settings().panel;
    if (hangs || window_) { layOutPanel(hangs, step_seconds); }
    // By now the runtime knows better where the eyes will be.
    if (std::optional<FrameViews> later = locateViews(headset().session)) {
        later->gazes = views.gazes;
        views = *later;
    }
    const bool shows = renderScene(views);
    seen_.darken(headset(), state_.sceneFromRoom(), place_.roomFromHead(), renderer_.wasCutShort(),
                 step_seconds, views.eyes);
    if (const std::optional<std::string> outcome = pictures_.takeOutcome()) { say(*outcome); }
    window_.show();
    headset().releaseEyes();
    panel_.release(headset());
    headset().things.release();
    const ViewSettings& drawn = drawn_.get();
    const bool shares = scenes_.get() != nullptr && drawn.showsOneEye();
    submission_.end(headset(), views, hangs ? &panel_.inRoom() : nullptr,
                    shares ? std::optional<int>(drawn.stereo.dominant) : std::nullopt);
    if (shows && pictured_ != scenes_.drawn()->name) {
        pictured_ = scenes_.drawn()->name;
        const glm::uvec2 size_px = renderer_.sizePx(drawn);
        log_.say(fmt::format("its first picture has {}x{} pixels an eye", size_px.x, size_px.y));
    }
    if (std::exchange(picture_asked_, false) && shows) {
        pictures_.begin(
            renderer_.shotOf(scenes_, scenes_.drawnFrom(state_.sceneFromRoom()), state_.settings(), views),
            scenes_.drawn()->name);
    }
    sayChange();
    panel_.keepFrameTime();
}

bool Viewer::renderScene(FrameViews& views) {
    // Last, since the panel and the window may change the settings.
    const bool fits = drawn_.prepare(headset(), views, window_.get());
    if (fits) { exchange_.meetComing(headset(), drawn_.get(), views); }
    window_.acquire();
    if (scenes_.get() == nullptr || !fits) {
        renderWaiting();
        return false;
    }
    exchange_.meetOther(headset());
    waiting_.passOver();
    renderer_.render(headset(), scenes_, drawn_.get(), window_.get(), [this](Commands& commands) {
        recordPanel(commands);
        pointing_.record(commands, scenes_, renderer_, state_.sceneFromRoom());
        kept_picture_.record(commands);
    });
    kept_picture_.countFrame();
    exchange_.sayLive();
    return true;
}

void Viewer::renderWaiting() {
    headset().acquireEyes();
    scenes_.passOver(true);
    Commands& commands = waiting_.begin();
    const glm::dvec3& background = options_.run.camera.background;
    const glm::vec3 behind = background == glm::dvec3(0.0) ? kWaitingColour : glm::vec3(background);
    headset().clearEyes(commands,
                        renderer_.seesThrough(state_.settings()) ? glm::vec4(0.0f) : glm::vec4(behind, 1.0f));
    recordPanel(commands);
    waiting_.submit(window_.drawn());
}

void Viewer::recordPanel(Commands& commands) {
    if (connection_.headset() != nullptr) { headset().things.record(commands); }
    panel_.record(commands, connection_.headset(), static_cast<bool>(window_));
    if (window_) { window_.get()->record(commands); }
}

void Viewer::drawWindowAlone(const std::string& why) {
    const auto now = std::chrono::steady_clock::now();
    if (!window_ || now - last_alone_ < kWindowAlone) { return; }
    const double step_seconds = std::min(std::chrono::duration<double>(now - last_alone_).count(), 0.1);
    last_alone_ = now;
    files_.deliver();
    takeScenes(true);
    takeWindowInput(step_seconds);
    panel_.status().state = why;
    layOutPanel(false, step_seconds);
    if (const std::optional<std::string> outcome = pictures_.takeOutcome()) { say(*outcome); }
    window_.acquire();
    if (!window_) { return; }
    scenes_.passOver(true);
    recordPanel(waiting_.begin());
    waiting_.submit(window_.drawn());
    window_.show();
    sayChange();
}

void Viewer::takeWindowInput(double step_seconds) {
    if (!window_) { return; }
    const WindowInput& input = window_.poll();
    if (input.quit) { leave(); }
    recentre_asked_ = recentre_asked_ || input.recentre;
    if (!input.dropped.empty() && !place_.takeViewpoints(input.dropped)) { scenes_.begin(input.dropped); }
    if (input.reload_shaders) { reloadShaders(); }
    scenes_.moveTime(input.play, input.frame_step, {});
    if (input.toggle_panel) { actions_.togglePanel(); }
    state_.place(movedByWindow(state_.sceneFromRoom(), input, place_.roomFromHead(), step_seconds));
}

void Viewer::layOutPanel(bool hung, double step_seconds) {
    PanelStatus& status = panel_.status();
    requests_.fillStatus(exchange_.otherStays(), place_.viewpoints());
    status.rate = renderer_.rate();
    status.tools = actions_.choices();
    if (connection_.headset() != nullptr) {
        status.refresh_rates = headset().refresh_rates;
        if (state_.settings().page == PanelPage::kHelp) { status.held = headset().input.held(); }
    }
    if (status.has_scene) {
        status.facts = describeFacts(scenes_.get()->facts, 1.0 / state_.sceneFromRoom().scale);
        status.place = place_.shown();
    }
    panel_.showTimes(renderer_.lastFrame(), renderer_.governorSentence(), step_seconds);
    panel_.askFor(files_, state_.settings());
    if (status.files.empty() && scenes_.isMakingMethod()) {
        status.files = fmt::format("preparing {}", nameOf(state_.settings().stereo.mode));
    }
    keepPreferences(step_seconds, false);
    followPanel(panel_.layOut(hung ? connection_.headset() : nullptr, window_.input().pointer,
                              window_.input().uses_panel, state_.settings(), step_seconds));
}

void Viewer::followPanel(const PanelRequests& requests) {
    state_.set(requests.settings);
    if (requests.reload_shaders) { reloadShaders(); }
    if (place_.follow(requests, panel_.entry())) { actions_.letGo(); }
    recentre_asked_ = recentre_asked_ || requests.recentre;
    requests_.follow(requests);
    if (requests.show_other) { exchange_.toggleOther(); }
    picture_asked_ = picture_asked_ || requests.take_picture;
    if (requests.quit) { leave(); }
}

void Viewer::reloadShaders() {
    if (scenes_.get() == nullptr || !panel_.status().can_reload_shaders) { return; }
    // Their threads may be making kernels.
    if (pictures_.isTaking()) { return say("shaders stay as they are until the picture is written"); }
    if (scenes_.isLoading()) { return say("shaders stay as they are until the next scene is loaded"); }
    say(binosplat::reloadShaders(context_, shaderFolder(options_.shaders), [&] {
        scenes_.rebuildKernels();
        renderer_.presenter().rebuildKernels();
    }));
}

void Viewer::say(const std::string& message) {
    panel_.status().message = message;
    seen_.say(message);
    log_.say(message);
}

void Viewer::keepPreferences(double step_seconds, bool at_once) {
    if (!options_.simulate) { notes_.keepPreferences(state_.settings(), step_seconds, at_once); }
}

void Viewer::sayChange() {
    const std::string change = state_.takeChange();
    if (!change.empty()) { log_.say(change); }
}

}  // namespace binosplat
