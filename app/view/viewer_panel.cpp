// The viewer's panel and its window: what they show, and the requests made there.
#include "app/view/viewer.h"

#include "engine/error.h"

namespace binosplat {

namespace {

// How often the window is drawn while there are no frames.
constexpr std::chrono::milliseconds kWindowAlone(16);

}  // namespace

void Viewer::openWindow(EventWindow& window) {
    const auto goOnWithout = [&](const char* why) {
        log_.print(fmt::format("no window: {}", why));
        window.close();
    };
    try {
        window_ = std::make_unique<MirrorWindow>(context_, panel_.canvas(), window);
    } catch (const Error& error) { goOnWithout(error.what()); } catch (const vk::SystemError& error) {
        goOnWithout(error.what());
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

void Viewer::drawWindowAlone(const std::string& why) {
    const auto now = std::chrono::steady_clock::now();
    if (!window_ || now - last_alone_ < kWindowAlone) { return; }
    const double step_seconds = std::min(std::chrono::duration<double>(now - last_alone_).count(), 0.1);
    last_alone_ = now;
    files_.deliver();
    if (canTakeScene(false)) {
        keepPictureAtOnce();
        takeScene();
    }
    if (scenes_.isOtherReady()) { takeOther(); }
    takeWindowInput(step_seconds);
    panel_.status().state = why;
    layOutPanel(false, step_seconds);
    sayPicture(pictures_.takeOutcome());
    onWindow(&MirrorWindow::acquire);
    if (!window_) { return; }
    scenes_.passOver(true);
    recordPanel(waiting_.begin());
    waiting_.submit(window_->drawn());
    onWindow(&MirrorWindow::show);
    sayChange();
}

void Viewer::takeWindowInput(double step_seconds) {
    if (!window_) { return; }
    window_input_ = window_->poll();
    if (window_input_.quit) { leave(); }
    recentre_asked_ = recentre_asked_ || window_input_.recentre;
    if (const std::string& dropped = window_input_.dropped; dropped.ends_with(".viewpoints.json")) {
        viewpoints_.read(dropped);
    } else if (!dropped.empty()) {
        scenes_.begin(dropped);
    }
    if (window_input_.reload_shaders) { reloadShaders(); }
    moveTime(window_input_.play, window_input_.frame_step, {});
    if (window_input_.toggle_panel) {
        state_.togglePanel();
        panel_.inRoom().hangBefore(room_from_head_);
    }
    state_.place(movedByWindow(state_.sceneFromRoom(), window_input_, room_from_head_, step_seconds));
}

void Viewer::layOutPanel(bool hung, double step_seconds) {
    PanelStatus& status = panel_.status();
    status.scene = scenes_.names();
    status.compares = scenes_.other() != nullptr;
    status.compares_next = scenes_.comparesNext();
    status.shows_other = status.compares && other_asked_;
    status.loading = scenes_.loading();
    status.rate = renderer_.rate();
    status.has_scene = scenes_.get() != nullptr;
    status.can_pass_through = instance_.canSeeThrough();
    status.takes_depth = instance_.takesDepth();
    status.tools = controls_.choices();
    if (connection_.headset() != nullptr) {
        status.refresh_rates = headset().refresh_rates;
        if (state_.settings().page == PanelPage::kHelp) { status.held = headset().input.held(); }
    }
    if (status.has_scene) {
        status.facts = describeFacts(scenes_.get()->facts, 1.0 / state_.sceneFromRoom().scale);
        status.place = shownPlace();
        status.viewpoint_count = viewpoints_.count();
        status.viewpoint = viewpoints_.current() != nullptr ? viewpoints_.current()->name : "";
        status.tours = viewpoints_.isTouring();
        status.time.reset();
        if (const LoadedScene& scene = *scenes_.get(); scene.moving != nullptr) {
            status.time = {scene.clock.frame(), scene.clock.frameCount(), scene.moving->rateHz(),
                           scene.clock.plays(), scene.moving->counters().scene_frames_late};
        }
    }
    panel_.showTimes(renderer_.lastFrame(), renderer_.governorSentence(), step_seconds);
    panel_.askFor(files_, state_.settings());
    if (status.files.empty() && scenes_.isMakingMethod()) {
        status.files = fmt::format("preparing {}", nameOf(state_.settings().stereo.mode));
    }
    keepPreferences(step_seconds, false);
    followPanel(panel_.layOut(hung ? connection_.headset() : nullptr, window_input_.pointer,
                              window_input_.uses_panel, state_.settings(), step_seconds));
}

void Viewer::moveTime(bool play, int step, std::optional<std::size_t> frame) {
    LoadedScene* const scene = scenes_.get();
    if (scene == nullptr) { return; }
    if (const std::string said = scene->moveTime(play, step, frame); !said.empty()) { log_.say(said); }
}

void Viewer::recordPanel(Commands& commands) {
    if (connection_.headset() != nullptr) { headset().things.record(commands); }
    panel_.record(commands, connection_.headset(), window_ != nullptr);
    if (window_) { window_->record(commands); }
}

void Viewer::followPanel(const PanelRequests& requests) {
    state_.set(requests.settings);
    if (requests.reload_shaders) { reloadShaders(); }
    if (scenes_.get() != nullptr) { movePlace(requests); }
    moveTime(requests.play, requests.frame_step, requests.frame);
    recentre_asked_ = recentre_asked_ || requests.recentre;
    openAndSave(requests);
    if (requests.quit) { leave(); }
}

}  // namespace binosplat
