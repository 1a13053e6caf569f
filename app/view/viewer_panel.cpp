// The viewer's panel and the keys of its window: what they show, and what is asked for there.
#include "app/view/shader_reload.h"
#include "app/view/viewer.h"
#include "engine/error.h"

namespace binosplat {

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
    requests_.fillStatus(exchange_.otherStays(), place_.viewpoints());
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

void Viewer::followPanel(const PanelRequests& requests) {
    state_.set(requests.settings);
    if (requests.reload_shaders) { reloadShaders(); }
    if (place_.follow(requests, panel_.entry())) { controls_.letGo(); }
    recentre_asked_ = recentre_asked_ || requests.recentre;
    requests_.follow(requests);
    if (requests.show_other) { exchange_.toggleOther(); }
    picture_asked_ = picture_asked_ || requests.take_picture;
    if (requests.quit) { leave(); }
}

void Viewer::reloadShaders() {
    if (scenes_.get() == nullptr || !panel_.status().can_reload_shaders) { return; }
    // Their threads may be making kernels.
    if (scenes_.isLoading() || pictures_.isTaking()) {
        say(fmt::format("shaders stay as they are until {}",
                        pictures_.isTaking() ? "the picture is written" : "the next scene is loaded"));
        return;
    }
    say(binosplat::reloadShaders(context_, shaderFolder(options_.shaders), [&] {
        scenes_.rebuildKernels();
        renderer_.presenter().rebuildKernels();
    }));
}

void Viewer::sayPicture(const std::optional<std::string>& outcome) {
    if (outcome) { say(*outcome); }
}

}  // namespace binosplat
