// The wearer's place in the scene, and what the viewer stores about it.
#include "app/view/placement/placement.h"
#include "app/view/scenes/viewpoints.h"
#include "app/view/viewer.h"
#include "engine/error.h"
#include "engine/picture/turned.h"

namespace binosplat {

namespace {

// If the scene has no known floor: its distance below a standing person's eyes.
constexpr double kUsualEyesMetres = 1.6;
// A scene that was seen for less than a third of a second was only passed on the way.
constexpr std::uint64_t kLeastFramesSeen = 30;

}  // namespace

ShownPlace Viewer::shownPlace() const {
    const LoadedScene& scene = *scenes_.get();
    const Similarity& placement = state_.sceneFromRoom();
    ShownPlace place;
    place.size_m = scene.facts.size_units / placement.scale;
    place.growth = 1.0 / (options_.run.metres_per_unit * placement.scale);
    const double eyes = glm::dot(scene.up, transform(placement, room_from_head_.position));
    place.has_floor = scene.floor.has_value();
    place.eyes_m = (eyes - scene.floor.value_or(glm::dot(scene.up, scene.start.position))) / placement.scale;
    place.view = viewpoint_;
    return place;
}

std::optional<double> Viewer::sceneFloorMetres() const {
    if (scenes_.get() == nullptr || !scenes_.get()->floor) { return std::nullopt; }
    return room_from_head_.position.y + shownPlace().eyes_m;
}

void Viewer::movePlace(const PanelRequests& requests) {
    const LoadedScene& scene = *scenes_.get();
    if (requests.reset_scene) { state_.place(scene.start); }
    if (requests.level_scene) { state_.place(levelledAlong(state_.sceneFromRoom(), scene.up, room_from_head_.position)); }
    const double growth = requests.natural_size ? options_.run.metres_per_unit * state_.sceneFromRoom().scale : requests.growth;
    if (growth != 1.0) {
        // About the feet, so that the wearer stays on the floor.
        const ShownPlace place = shownPlace();
        glm::dvec3 feet = room_from_head_.position;
        feet.y += place.has_floor && place.eyes_m > 0.0 ? place.eyes_m : kUsualEyesMetres;
        state_.place(grownBy(state_.sceneFromRoom(), growth, feet));
    }
    if (requests.rise_m != 0.0) { state_.place(movedBy(state_.sceneFromRoom(), {0.0, -requests.rise_m, 0.0})); }
    if (requests.viewpoint_step != 0) { goToViewpoint(requests.viewpoint_step); }
    if (requests.keep_viewpoint) { keepViewpointHere(); }
}

void Viewer::goToViewpoint(int step) {
    const LoadedScene* scene = scenes_.get();
    if (scene == nullptr) { return; }
    if (scene->viewpoints.empty()) {
        say("this scene has no viewpoints: keep one on the page Scenes, or put a cameras.json beside it");
        return;
    }
    const auto count = static_cast<std::ptrdiff_t>(scene->viewpoints.size());
    const std::ptrdiff_t before = viewpoint_ ? static_cast<std::ptrdiff_t>(*viewpoint_) : step > 0 ? -1 : 0;
    viewpoint_ = static_cast<std::size_t>(((before + step) % count + count) % count);
    const Viewpoint& there = scene->viewpoints[*viewpoint_];
    state_.place(placedAt(there.view, state_.sceneFromRoom(), room_from_head_));
    controls_.letGo();
    log_.say(fmt::format("viewpoint {} of {}: {}", *viewpoint_ + 1, count, there.name));
}

void Viewer::keepViewpointHere() {
    LoadedScene& scene = *scenes_.get();
    notes_.addViewpoint(scene, viewOf(state_.sceneFromRoom(), room_from_head_));
    viewpoint_ = scene.viewpoints.size() - 1;
}

void Viewer::keepPictureOfScene() {
    LoadedScene* scene = scenes_.get();
    if (scene == nullptr || std::exchange(frames_of_scene_, 0) < kLeastFramesSeen) { return; }
    try {
        waitForQueue();
        const std::size_t eye = drawn_.showsOneEye() ? 0 : static_cast<std::size_t>(drawn_.stereo.dominant);
        if (eye >= renderer_.pictures().size()) { return; }
        const Image picture = scenes_.frame().readPicture(static_cast<int>(eye));
        notes_.keepPicture(*scene, showTurned(picture, renderer_.pictures().at(eye), renderer_.views().at(eye)));
    } catch (const vk::DeviceLostError&) { throw; } catch (const vk::SystemError&) {
        // A missing picture is not worth a message.
    } catch (const Error&) {}
}

}  // namespace binosplat
