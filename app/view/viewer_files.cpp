// The viewer's files: scenes, settings, pictures, shaders.
#include "app/view/shader_reload.h"
#include "app/view/viewer.h"
#include "engine/error.h"

namespace binosplat {

void Viewer::takeScene() {
    const LoadedScene* before = scenes_.get();
    const std::string complaint = scenes_.take(state_);
    if (!complaint.empty()) { say(complaint); }
    if (scenes_.get() == before) { return; }
    renderer_.forgetScene();
    pointing_.forget();
    controls_.letGo();
    is_new_view_ = before != nullptr;
    if (before == nullptr) { fade_ = {}; }  // there was nothing to jump from
    place_.show(scenes_.get());
    if (scenes_.get() == nullptr) { return; }  // it made way for the next one
    kept_picture_.beginScene();
    said_there_ = false;
    notes_.remember(scenes_.name(), complaint);
}

void Viewer::meetComing(FrameViews& views) {
    const std::optional<Similarity> there = scenes_.placeWithoutFrames(state_);
    if (!there) { return; }
    const bool shows = scenes_.get() != nullptr;
    const Similarity drawn = shows ? scenes_.drawnFrom(state_.sceneFromRoom()) : *there;
    if (!shows) { renderer_.aim(headset(), drawn, drawn_.get(), views); }
    scenes_.makeFrames(renderer_.framesWanted(headset(), compose(*there, inverse(drawn))));
}

void Viewer::takeOther() {
    if (const std::string complaint = scenes_.takeOther(); !complaint.empty()) { return say(complaint); }
    other_asked_ = false;
    notes_.remember(scenes_.other()->name, {});
    say(fmt::format("hold X or A, or press Other on the page Scenes, to see {}", scenes_.other()->name));
}

void Viewer::showOther() {
    const std::array<bool, 2>& held = controls_.playHeld();
    const bool before = scenes_.drawsOther();
    scenes_.draw(other_asked_ != (held[kLeft] || held[kRight]));
    if (scenes_.drawsOther() == before) { return; }
    pointing_.forget();
    log_.say(fmt::format("shows {}", scenes_.drawn()->name));
    for (const int h : {kLeft, kRight}) {
        if (held[static_cast<std::size_t>(h)]) { headset().input.pulse(h); }
    }
}

void Viewer::meetOther() {
    try {
        renderer_.meetOther(headset(), scenes_);
    } catch (const Error& error) { say(scenes_.goOnAlone(error)); }
}

void Viewer::openAndSave(const PanelRequests& requests) {
    requests_.follow(requests);
    if (requests.show_other) { other_asked_ = !other_asked_; }
    picture_asked_ = picture_asked_ || requests.take_picture;
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
