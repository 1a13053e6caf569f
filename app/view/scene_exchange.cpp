// Between frames, without a wait.
#include "app/view/scene_exchange.h"

#include "engine/error.h"

#include <fmt/format.h>

namespace binosplat {

SceneExchange::Taken SceneExchange::take(bool at_once) {
    const LoadedScene* const before = scenes_.get();
    Taken taken = Taken::kNone;
    if ((at_once ? scenes_.isNextReady() : scenes_.isNextMet()) && !writer_.isTaking() &&
        (at_once || kept_.isKept())) {
        if (at_once) { kept_.keepAtOnce(); }
        const std::string complaint = scenes_.take(state_);
        if (!complaint.empty()) { say_(complaint); }
        if (scenes_.get() != before) {
            taken = before == nullptr ? Taken::kFirst : Taken::kAnother;
            renderer_.forgetScene();
            place_.show(scenes_.get());
        }
        // It may have made way for the next one.
        if (taken != Taken::kNone && scenes_.get() != nullptr) {
            kept_.beginScene();
            said_there_ = false;
            notes_.remember(scenes_.name(), complaint);
        }
    }
    if (at_once ? scenes_.isOtherReady() : scenes_.isOtherMet()) { takeOther(); }
    return taken;
}

void SceneExchange::meetComing(ConnectedHeadset& headset, const ViewSettings& drawn, FrameViews& views) {
    const std::optional<Similarity> there = scenes_.placeWithoutFrames(state_);
    if (!there) { return; }
    const bool shows = scenes_.get() != nullptr;
    const Similarity here = shows ? scenes_.drawnFrom(state_.sceneFromRoom()) : *there;
    if (!shows) { renderer_.aim(headset, here, drawn, views); }
    scenes_.makeFrames(renderer_.framesWanted(headset, compose(*there, inverse(here))));
}

void SceneExchange::takeOther() {
    if (const std::string complaint = scenes_.takeOther(); !complaint.empty()) { return say_(complaint); }
    other_stays_ = false;
    notes_.remember(scenes_.other()->name, {});
    say_(fmt::format("hold X or A, or press Other on the page Scenes, to see {}", scenes_.other()->name));
}

bool SceneExchange::showOther(bool is_held) {
    const bool before = scenes_.drawsOther();
    scenes_.draw(other_stays_ != is_held);
    if (scenes_.drawsOther() == before) { return false; }
    log_(fmt::format("shows {}", scenes_.drawn()->name));
    return true;
}

void SceneExchange::meetOther(const ConnectedHeadset& headset) {
    try {
        renderer_.meetOther(headset, scenes_);
    } catch (const Error& error) { say_(scenes_.goOnAlone(error)); }
}

void SceneExchange::sayLive() {
    for (LoadedScene* const scene : {scenes_.get(), scenes_.other()}) {
        if (scene != nullptr && scene->live) { sayLive(*scene); }
    }
}

void SceneExchange::sayLive(LoadedScene& scene) {
    for (const std::string& line : scene.live->takeLines(Waits::kNever)) { say_(line); }
    if (said_there_ || scene.stream == nullptr || !scene.stream->isSettled()) { return; }
    const std::optional<LoaderWork> work = scene.stream->tryWork();
    if (!work) { return; }
    said_there_ = true;
    const StreamCounters counters = scene.stream->counters();
    log_(fmt::format(
        "everything in view is loaded: {} splats, {} levels of leaves, {:.2f} million splats "
        "read in {:.1f} s; frames that waited for it: {}",
        counters.splats_resident, counters.chunks_resident, 1e-6 * static_cast<double>(work->splats),
        work->seconds, counters.frames_waited_for_loading));
}

}  // namespace binosplat
