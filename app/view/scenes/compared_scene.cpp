// Another scene of the same place, to compare with the one that is shown.
#include "app/view/scenes/shown_scene.h"
#include "engine/gpu/device_error.h"

#include <utility>

namespace binosplat {

std::string ShownScene::toggleComparison() {
    if (other_.scene || other_next_.loader) {
        const std::string was = other_.scene ? other_.scene->name : other_next_.loader->scene();
        giveUp(other_next_);
        dropOther();
        return fmt::format("{} is no longer compared with", was);
    }
    compares_next_ = !compares_next_ && shown_.scene;
    return compares_next_ ? fmt::format("choose, open or drop a scene to compare with {}", shown_.scene->name)
                          : "nothing is compared";
}

void ShownScene::beginOther(const std::string& scene) {
    dropOther();  // never more than two
    giveUp(other_next_);
    ++asked_count_;
    RunOptions run = options_.run;  // a given place belongs to the first one
    run.camera.cameras_file.clear();
    run.camera.eye = run.camera.look = run.camera.up = std::nullopt;
    other_next_.loader = makeLoader(scene, std::move(run));
}

void ShownScene::dropOther() {
    draw(false);
    if (maker_ && made_for_ == &other_) { maker_.reset(); }
    letGo(other_);
}

std::string ShownScene::takeOther() {
    Coming coming = std::exchange(other_next_, {});
    other_name_ = coming.loader->scene();
    try {
        std::unique_ptr<LoadedScene> taken = coming.loader->take();
        maker_.reset();
        other_.frames = takeFrames(coming);
        const bool is_met = other_.frames.frame && coming.like;
        if (!other_.frames.frame) {
            other_.frames.frame = std::make_unique<StereoFrame>(context_, taken->gpu_scene, kernels_);
        }
        other_.scene = std::move(taken);
        if (ahead_) { haveReady(other_, coming.loader->madeFor()); }
        other_.met = is_met ? coming.like : other_.ready;
    } catch (const vk::DeviceLostError&) { throw; } catch (const vk::SystemError& error) {
        dropOther();
        return error.what();
    } catch (const Error& error) { return goOnAlone(error); }
    log_.say(fmt::format("compares {} with {}", shown_.scene->name, other_.scene->name));
    for (const std::string& line : other_.scene->notes.lines) { log_.print("note: " + line); }
    return {};
}

std::string ShownScene::goOnAlone(const Error& error) {
    dropOther();
    freeGone();
    const auto* const of_device = dynamic_cast<const DeviceError*>(&error);
    if (of_device == nullptr || of_device->kind() != DeviceError::Kind::kMemory) { return error.what(); }
    return fmt::format("{} and {} do not fit into the device's memory together: the first one stays",
                       shown_.scene->name, other_name_);
}

void ShownScene::meetOther(std::span<const Eye> eyes, const FrameSettings& frame,
                           std::span<const Eye> inset_eyes, const FrameSettings& inset) {
    if (!other_.scene || draws_other_) { return; }
    // See remakeFrames.
    if (!options_.load_first && other_.met && shown_.met && !other_.met->hasFramesOf(*shown_.met)) { return; }
    const glm::uvec3 shape = shapeOfFrames(eyes, frame);
    if (std::exchange(other_.frames.shape, shape) == shape) { return; }
    const auto meet = [&](StereoFrame& other, std::span<const Eye> seen, const FrameSettings& settings) {
        const std::vector<Eye> there = seenFromResting(seen);
        other.reserve(there, settings);
        // Each has memory of its own.
        for (int turn = 0; turn < 2; ++turn) { (void)other.renderAhead(there, settings); }
    };
    meet(*other_.frames.frame, eyes, frame);
    if (inset_eyes.empty()) { return; }
    if (!other_.frames.insets) { other_.frames.insets = StereoFrame::beside(*other_.frames.frame); }
    meet(*other_.frames.insets, inset_eyes, inset);
}

void ShownScene::draw(bool other) {
    other = other && other_.scene;
    if (std::exchange(draws_other_, other) == other) { return; }
    for (StereoFrame* const frame : {drawing().frames.frame.get(), drawing().frames.insets.get()}) {
        if (frame != nullptr) { frame->forgetHistory(); }
    }
}

Similarity ShownScene::drawnFrom(Similarity scene_from_room) const {
    if (draws_other_) { scene_from_room.position += otherFromShown(); }
    return scene_from_room;
}

std::vector<Eye> ShownScene::seenFromDrawn(std::vector<Eye> eyes) const {
    for (Eye& eye : eyes) {
        eye.world_from_camera.position += draws_other_ ? otherFromShown() : glm::dvec3(0.0);
    }
    return eyes;
}

std::vector<Eye> ShownScene::seenFromResting(std::span<const Eye> eyes) const {
    std::vector<Eye> there(eyes.begin(), eyes.end());
    for (Eye& eye : there) {
        eye.world_from_camera.position += (draws_other_ ? -1.0 : 1.0) * otherFromShown();
    }
    return there;
}

void ShownScene::follow(std::span<const Eye> eyes, double step_seconds) {
    LoadedScene& scene = *drawn();
    scene.follow(eyes, step_seconds);
    LoadedScene* const rests = resting().scene.get();
    if (rests == nullptr || !rests->live) { return; }
    const bool keeps_time = rests->moving != nullptr && scene.moving != nullptr;
    if (keeps_time) { rests->clock.goWith(scene.clock); }
    rests->follow(seenFromResting(eyes), keeps_time ? 0.0 : step_seconds);
}

}  // namespace binosplat
