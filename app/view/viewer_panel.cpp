// The viewer's panel and its window: what they show, and the requests made there.
#include "app/view/viewer.h"

#include "engine/error.h"

namespace binosplat {

namespace {

// How often the window is drawn while there are no frames.
constexpr std::chrono::milliseconds kWindowAlone(16);

}  // namespace

void Viewer::drawWindowAlone(const std::string& why) {
    const auto now = std::chrono::steady_clock::now();
    if (!window_ || now - last_alone_ < kWindowAlone) { return; }
    const double step_seconds = std::min(std::chrono::duration<double>(now - last_alone_).count(), 0.1);
    last_alone_ = now;
    files_.deliver();
    if (canTakeScene(false)) {
        kept_picture_.keepAtOnce();
        takeScene();
    }
    if (scenes_.isOtherReady()) { takeOther(); }
    takeWindowInput(step_seconds);
    panel_.status().state = why;
    layOutPanel(false, step_seconds);
    sayPicture(pictures_.takeOutcome());
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
    if (input.toggle_panel) { togglePanel(); }
    state_.place(movedByWindow(state_.sceneFromRoom(), input, place_.roomFromHead(), step_seconds));
}

void Viewer::togglePanel() {
    state_.togglePanel();
    panel_.inRoom().hangBefore(place_.roomFromHead());
}

void Viewer::layOutPanel(bool hung, double step_seconds) {
    PanelStatus& status = panel_.status();
    requests_.fillStatus(other_asked_, place_.viewpoints());
    status.rate = renderer_.rate();
    status.can_pass_through = instance_.canSeeThrough();
    status.takes_depth = instance_.takesDepth();
    status.tools = controls_.choices();
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

void Viewer::recordPanel(Commands& commands) {
    if (connection_.headset() != nullptr) { headset().things.record(commands); }
    panel_.record(commands, connection_.headset(), static_cast<bool>(window_));
    if (window_) { window_.get()->record(commands); }
}

void Viewer::followPanel(const PanelRequests& requests) {
    state_.set(requests.settings);
    if (requests.reload_shaders) { reloadShaders(); }
    if (place_.follow(requests, panel_.entry())) { controls_.letGo(); }
    recentre_asked_ = recentre_asked_ || requests.recentre;
    openAndSave(requests);
    if (requests.quit) { leave(); }
}

}  // namespace binosplat
