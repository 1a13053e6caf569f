// The wearer's place in numbers, and changes to it.
#include "app/view/wearer_place.h"

#include "app/view/panel/measure.h"
#include "app/view/placement/placement.h"
#include "app/view/scenes/viewpoints.h"

#include <utility>

namespace binosplat {

namespace {

// If the scene's floor is unknown: its assumed distance below a standing person's eyes.
constexpr double kUsualEyesMetres = 1.6;
// A tour stays longer than in a window, where moving between viewpoints takes time: for five seconds.
constexpr double kTourPace = ViewpointList::kRestSeconds / 5.0;

}  // namespace

void WearerPlace::show(LoadedScene* scene) {
    scene_ = scene;
    viewpoints_.show(scene);
    ruler_.close();
}

ShownPlace WearerPlace::shown() const {
    const Similarity& placement = state_.sceneFromRoom();
    ShownPlace place;
    place.size_m = scene_->facts.size_units / placement.scale;
    place.growth = 1.0 / (scene_->measured.value_or(metres_per_unit_) * placement.scale);
    const double eyes = glm::dot(scene_->up, transform(placement, room_from_head_.position));
    place.has_floor = scene_->floor.has_value();
    place.eyes_m =
        (eyes - scene_->floor.value_or(glm::dot(scene_->up, scene_->start.position))) / placement.scale;
    place.view = viewpoints_.at();
    return place;
}

bool WearerPlace::follow(const PanelRequests& requests, TextEntry& entry) {
    if (scene_ == nullptr) { return false; }
    if (requests.reset_scene) { state_.place(scene_->start); }
    if (requests.level_scene) {
        state_.place(levelledAlong(state_.sceneFromRoom(), scene_->up, room_from_head_.position));
    }
    if (requests.measure) { say_(openRuler(ruler_)); }
    const std::optional<double> measured = takeMeasure(requests, ruler_, *scene_);
    grow(requests.natural_size || measured
             ? scene_->measured.value_or(metres_per_unit_) * state_.sceneFromRoom().scale
             : requests.growth);
    if (measured) { notes_.save(scene_->name, savedPlace(state_, *scene_)); }
    if (requests.rise_m != 0.0) {
        state_.place(movedBy(state_.sceneFromRoom(), {0.0, -requests.rise_m, 0.0}));
    }
    const bool jumps = requests.viewpoint_step != 0 && goTo(viewpoints_.goBy(requests.viewpoint_step));
    if (requests.keep_viewpoint) { viewpoints_.keep(viewOf(state_.sceneFromRoom(), room_from_head_)); }
    followViewpoints(requests, entry, viewpoints_);
    return jumps;
}

void WearerPlace::grow(double growth) {
    if (growth == 1.0) { return; }
    // About the feet, so that the wearer stays on the floor.
    const ShownPlace place = shown();
    glm::dvec3 feet = room_from_head_.position;
    feet.y += place.has_floor && place.eyes_m > 0.0 ? place.eyes_m : kUsualEyesMetres;
    state_.place(grownBy(state_.sceneFromRoom(), growth, feet));
}

bool WearerPlace::measure(const std::array<xr::Hand, 2>& hands, const PanelInRoom& panel,
                          const ScenePointing& pointing, TextEntry& entry) {
    bool is_measured = false;
    for (const int h : {kLeft, kRight}) {
        const auto at = static_cast<std::size_t>(h);
        const bool clicks = hands[at].clicks, begins = !std::exchange(clicked_[at], clicks) && clicks;
        const std::optional<Pose> aim = panel.missesWith(h);
        if (!begins || !ruler_.isOpen() || !aim || scene_ == nullptr) { continue; }
        std::optional<glm::dvec3> place;
        if (const std::optional<double> meets_m = pointing.meetsMetres(h)) {
            place = transform(state_.sceneFromRoom(), transform(*aim, {0.0, 0.0, *meets_m}));
        }
        say_(measureAt(place, ruler_, state_.sceneFromRoom().scale, entry));
        is_measured = is_measured || !ruler_.isOpen();
    }
    return is_measured;
}

bool WearerPlace::goBy(int step) {
    if (step == 0) { return false; }
    viewpoints_.endTour();
    return goTo(viewpoints_.goBy(step));
}

bool WearerPlace::passTour(double step_seconds) {
    return goTo(viewpoints_.pass(kTourPace * step_seconds, true));
}

bool WearerPlace::goTo(const Viewpoint* viewpoint) {
    if (viewpoint == nullptr) { return false; }
    state_.place(placedAt(viewpoint->view, state_.sceneFromRoom(), room_from_head_));
    log_(viewpoints_.words());
    return true;
}

}  // namespace binosplat
