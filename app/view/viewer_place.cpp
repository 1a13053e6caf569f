// The wearer's place in the scene, and what the viewer stores about it.
#include "app/view/panel/measure.h"
#include "app/view/placement/placement.h"
#include "app/view/scenes/viewpoints.h"
#include "app/view/viewer.h"
#include "engine/error.h"
#include "engine/picture/turned.h"

namespace binosplat {

namespace {

// If the scene's floor is unknown: its assumed distance below a standing person's eyes.
constexpr double kUsualEyesMetres = 1.6;
// A scene that was shown for less than a third of a second was only passed through.
constexpr std::uint64_t kLeastFramesSeen = 30;

}  // namespace

ShownPlace Viewer::shownPlace() const {
    const LoadedScene& scene = *scenes_.get();
    const Similarity& placement = state_.sceneFromRoom();
    ShownPlace place;
    place.size_m = scene.facts.size_units / placement.scale;
    place.growth = 1.0 / (scene.measured.value_or(options_.run.metres_per_unit) * placement.scale);
    const double eyes = glm::dot(scene.up, transform(placement, room_from_head_.position));
    place.has_floor = scene.floor.has_value();
    place.eyes_m = (eyes - scene.floor.value_or(glm::dot(scene.up, scene.start.position))) / placement.scale;
    place.view = viewpoints_.at();
    return place;
}

void Viewer::movePlace(const PanelRequests& requests) {
    LoadedScene& scene = *scenes_.get();
    if (requests.reset_scene) { state_.place(scene.start); }
    if (requests.level_scene) {
        state_.place(levelledAlong(state_.sceneFromRoom(), scene.up, room_from_head_.position));
    }
    if (requests.measure) { say(openRuler(ruler_)); }
    const std::optional<double> measured = takeMeasure(requests, ruler_, scene);
    const double growth =
        requests.natural_size || measured
            ? scene.measured.value_or(options_.run.metres_per_unit) * state_.sceneFromRoom().scale
            : requests.growth;
    if (growth != 1.0) {
        // About the feet, so that the wearer stays on the floor.
        const ShownPlace place = shownPlace();
        glm::dvec3 feet = room_from_head_.position;
        feet.y += place.has_floor && place.eyes_m > 0.0 ? place.eyes_m : kUsualEyesMetres;
        state_.place(grownBy(state_.sceneFromRoom(), growth, feet));
    }
    if (measured) { notes_.save(scene.name, savedPlace(state_, scene)); }
    if (requests.rise_m != 0.0) {
        state_.place(movedBy(state_.sceneFromRoom(), {0.0, -requests.rise_m, 0.0}));
    }
    if (requests.viewpoint_step != 0) { goTo(viewpoints_.goBy(requests.viewpoint_step)); }
    if (requests.keep_viewpoint) { viewpoints_.keep(viewOf(state_.sceneFromRoom(), room_from_head_)); }
    followViewpoints(requests, panel_.entry(), viewpoints_);
}

void Viewer::measure(const std::array<xr::Hand, 2>& hands) {
    for (const int h : {kLeft, kRight}) {
        const auto at = static_cast<std::size_t>(h);
        const bool clicks = hands[at].clicks, begins = !std::exchange(clicked_[at], clicks) && clicks;
        const std::optional<Pose> aim = panel_.inRoom().missesWith(h);
        if (!begins || !ruler_.isOpen() || !aim || scenes_.get() == nullptr) { continue; }
        std::optional<glm::dvec3> place;
        if (probes_seen_.hands[at].meets) {
            place = transform(state_.sceneFromRoom(),
                              transform(*aim, {0.0, 0.0, probeMetres(*probes_seen_.hands[at].meets)}));
        }
        say(measureAt(place, ruler_, state_.sceneFromRoom().scale, panel_.entry()));
        if (!ruler_.isOpen()) { showPanel(); }
    }
}

void Viewer::showPanel() {
    if (state_.settings().panel) { return; }
    state_.togglePanel();
    panel_.inRoom().hangBefore(room_from_head_);
}

void Viewer::goTo(const Viewpoint* viewpoint) {
    if (viewpoint == nullptr) { return; }
    state_.place(placedAt(viewpoint->view, state_.sceneFromRoom(), room_from_head_));
    controls_.letGo();
    log_.say(viewpoints_.words());
}

bool Viewer::isWorthKeeping() const {
    return scenes_.get() != nullptr && frames_of_scene_ >= kLeastFramesSeen && !scenes_.drawsOther();
}

void Viewer::recordCopy(Commands& commands) {
    if (scenes_.drawsOther()) { return; }
    const std::size_t eye = eyeOfPicture();
    copy_.record(commands, scenes_.frame().picture(static_cast<int>(eye)), renderer_.pictures().at(eye),
                 renderer_.views().at(eye));
}

bool Viewer::hasKeptPicture() {
    if (!isWorthKeeping()) {
        copy_.drop();
        return true;
    }
    if (!copy_.ask()) { return false; }
    frames_of_scene_ = 0;
    if (std::function<Image()> view = copy_.take()) { notes_.keepPicture(*scenes_.get(), std::move(view)); }
    return true;
}

void Viewer::keepPictureAtOnce() {
    const std::size_t eye = eyeOfPicture();
    if (!isWorthKeeping() || eye >= renderer_.pictures().size()) { return; }
    frames_of_scene_ = 0;
    try {
        waitForQueue();
        notes_.keepPicture(
            *scenes_.get(),
            [picture = scenes_.frame().readPicture(static_cast<int>(eye)), of = renderer_.pictures().at(eye),
             view = renderer_.views().at(eye)] { return showTurned(picture, of, view); });
    } catch (const vk::DeviceLostError&) { throw; } catch (const vk::SystemError&) {
        // A missing picture is not worth a message.
    } catch (const Error&) {}
}

}  // namespace binosplat
