// From a scene that is loaded to one that is shown, from one that was shown to memory that is free, and from
// one method or resolution to another, without a wait.
#include "app/view/scenes/shown_scene.h"
#include "engine/gpu/device_error.h"

#include <algorithm>
#include <utility>

namespace binosplat {

const ShownScene::Coming* ShownScene::lacksFrames() const {
    const auto lacks = [](const Coming& coming) {
        return coming.loader->loaded() != nullptr && !coming.frames.valid();
    };
    if (isNextReady() && lacks(next_)) { return &next_; }
    return isOtherReady() && lacks(other_next_) ? &other_next_ : nullptr;
}

std::optional<Similarity> ShownScene::placeWithoutFrames(const ViewState& state) const {
    const Coming* const coming = lacksFrames();
    if (coming == nullptr) { return std::nullopt; }
    const LoadedScene& scene = *coming->loader->loaded();
    if (coming == &next_) { return placementOf(scene, state); }
    Similarity place = state.sceneFromRoom();
    place.position += shown_.scene->origin - scene.origin;
    return place;
}

void ShownScene::makeFrames(FramesWanted wanted) {
    Coming& coming = lacksFrames() == &next_ ? next_ : other_next_;
    coming.like = drawing().met;
    coming.frames =
        std::async(std::launch::async, [this, scene = coming.loader->loaded(), wanted = std::move(wanted)] {
            return binosplat::makeFrames(context_, kernels_, scene->gpu_scene, wanted);
        });
}

SceneFrames ShownScene::takeFrames(Coming& coming) {
    if (!coming.frames.valid()) { return {}; }
    try {
        return coming.frames.get();
    } catch (const DeviceError& error) {
        // Those that are shown make way for them.
        if (error.kind() != DeviceError::Kind::kMemory) { throw; }
        return {};
    }
}

void ShownScene::keepDrawn(const ViewSettings& drawn, glm::uvec2 images_px) {
    if (!ahead_ || !drawing().ready) { return; }
    std::optional<FramesAhead>& met = drawing().met;
    if (met && met->stereo == drawn.stereo && met->tint == drawn.tint && met->images_px == images_px &&
        met->resolution_scale == drawn.resolution_scale) {
        return;
    }
    met = *drawing().ready;
    met->stereo = drawn.stereo;
    met->tint = drawn.tint;
    met->images_px = images_px;
    met->resolution_scale = drawn.resolution_scale;
}

std::optional<Similarity> ShownScene::toRemake() const {
    if (!ahead_ || options_.load_first) { return std::nullopt; }
    Similarity there;
    if (lacksNewFrames(drawing())) { return there; }
    const Held& rests = draws_other_ ? shown_ : other_;
    if (!lacksNewFrames(rests)) { return std::nullopt; }
    there.position = (draws_other_ ? -1.0 : 1.0) * otherFromShown();
    return there;
}

void ShownScene::remakeFrames(FramesWanted wanted) {
    Held& held = lacksNewFrames(drawing()) ? drawing() : resting();
    held.remade_for = ahead_;
    for (const StereoFrame* const frame : {held.frames.frame.get(), held.frames.insets.get()}) {
        const std::uint64_t bytes = frame != nullptr ? frame->bytesForChanges() : 0;
        wanted.bytes_for_changes = std::max(wanted.bytes_for_changes, bytes);
    }
    held.remade = std::async(
        std::launch::async, [this, scene = std::make_unique<GpuScene>(held.scene->gpu_scene.asItIs()),
                             wanted = std::move(wanted)]() mutable {
            RemadeFrames remade{std::move(scene), {}};
            remade.frames = binosplat::makeFrames(context_, kernels_, *remade.scene, wanted);
            return remade;
        });
}

void ShownScene::takeRemade() {
    const auto lacksNone = [&](const Held& held) { return hasExpectedFrames(held) || held.hasRemade(); };
    if (!lacksNone(shown_) || !lacksNone(other_)) { return; }
    takeRemade(shown_);
    takeRemade(other_);
}

void ShownScene::takeRemade(Held& held) {
    if (!held.hasRemade()) { return; }
    try {
        RemadeFrames remade = held.remade.get();
        const GpuScene& scene = held.scene->gpu_scene;
        const bool fits = remade.scene->splatCount() == scene.splatCount();
        if (!fits || !held.remade_for->hasFramesOf(*ahead_)) {  // others were asked for meanwhile
            freeing_.push_back(std::async(std::launch::async, [gone = std::move(remade)]() mutable {
                const RemadeFrames here = std::move(gone);
            }));
            return;
        }
        for (StereoFrame* const frame : {remade.frames.frame.get(), remade.frames.insets.get()}) {
            if (frame != nullptr) { frame->goOnWith(scene); }
        }
        Held before;
        before.frames = std::exchange(held.frames, std::move(remade.frames));
        letGo(before);
    } catch (const vk::DeviceLostError&) { throw; } catch (const vk::SystemError&) {
        // Its frames are made as they are drawn, which says what is wrong.
    } catch (const Error&) {}
    // Unless nobody wants that one any more.
    if (held.remade_for->hasFramesOf(*ahead_)) { held.met = held.remade_for; }
}

bool ShownScene::growFor(glm::uvec2 size_px, glm::uvec2 inset_px) {
    bool has_capacity = true;
    for (const Held* const held : {&shown_, &other_}) {
        for (const auto& [frame, its_px] :
             {std::pair(held->frames.frame.get(), size_px), std::pair(held->frames.insets.get(), inset_px)}) {
            // Each begins what it lacks.
            if (frame != nullptr && !frame->growFor(its_px)) { has_capacity = false; }
        }
    }
    return has_capacity;
}

void ShownScene::letGo(Held& held) {
    if (held.scene || held.frames.frame) { leaving_.push_back({std::exchange(held, {})}); }
}

void ShownScene::passOver(bool nothing) {
    const auto pass = [](const Held& held) {
        for (StereoFrame* const frame : {held.frames.frame.get(), held.frames.insets.get()}) {
            if (frame != nullptr) { frame->passOver(); }
        }
    };
    pass(resting());
    if (nothing) { pass(drawing()); }
    for (Leaving& leaving : leaving_) {
        pass(leaving.held);
        if (--leaving.frames_left > 0) { continue; }
        freeing_.push_back(std::async(std::launch::async, [held = std::move(leaving.held)]() mutable {
            const Held gone = std::move(held);
        }));
    }
    std::erase_if(leaving_, [](const Leaving& leaving) { return leaving.frames_left == 0; });
    std::erase_if(freeing_, [](const std::future<void>& freed) { return isReady(freed); });
}

void ShownScene::freeGone() {
    leaving_.clear();  // their frames wait for the device
    freeing_.clear();
}

}  // namespace binosplat
