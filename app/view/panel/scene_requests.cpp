// The panel's scenes.
#include "app/view/panel/scene_requests.h"

#include "app/view/panel/measure.h"
#include "app/view/settings/view_files.h"

namespace binosplat {

void SceneRequests::fillStatus(bool other_stays, const ViewpointList& viewpoints) {
    PanelStatus& status = panel_.status();
    const LoadedScene* const scene = scenes_.get();
    status.scene = scenes_.names();
    status.compares = scenes_.other() != nullptr;
    status.compares_next = scenes_.comparesNext();
    status.shows_other = status.compares && other_stays;
    status.loading = scenes_.loading();
    status.has_scene = scene != nullptr;
    status.time.reset();
    if (scene == nullptr) { return; }
    status.place.view = viewpoints.at();
    status.viewpoint_count = viewpoints.count();
    status.viewpoint = viewpoints.current() != nullptr ? viewpoints.current()->name : "";
    status.tours = viewpoints.isTouring();
    if (scene->moving != nullptr) {
        status.time = {scene->clock.frame(), scene->clock.frameCount(), scene->moving->rateHz(),
                       scene->clock.plays(), scene->moving->counters().scene_frames_late};
    }
}

void SceneRequests::follow(const PanelRequests& requests) {
    scenes_.moveTime(requests.play, requests.frame_step, requests.frame);
    if (requests.save && scenes_.get() != nullptr) {
        notes_.save(scenes_.name(), savedPlace(state_, *scenes_.get()));
    }
    if (requests.load) { loadSettings(); }
    if (requests.scene_step != 0) { scenes_.beginBeside(requests.scene_step, files_); }
    if (!requests.chosen_scene.empty()) { scenes_.begin(requests.chosen_scene); }
    if (requests.compare) { say_(scenes_.toggleComparison()); }
    if (requests.last_scene && scenes_.get() != nullptr) {
        notes_.openLast(*scenes_.get(), [this](const std::string& scene) { scenes_.begin(scene); });
    }
    if (!requests.favourite.empty()) {
        notes_.toggleFavourite(requests.favourite, [this] { panel_.listAnew(); });
    }
}

void SceneRequests::loadSettings() {
    files_.read("loading saved settings", [this, scene = scenes_.name()]() -> FileWorker::Done {
        return [this, scene, saved = readSavedSettings(scene)] {
            if (scene != scenes_.name()) { return; }  // another one came meanwhile
            ViewSettings loaded = state_.settings();
            say_(takeSavedSettings(saved, loaded));
            loaded.panel = state_.settings().panel;  // it is open: Load was just pressed
            state_.set(loaded);
        };
    });
}

}  // namespace binosplat
