// From a scene that is loaded to one that is shown, and from one that was shown to memory that is free,
// without a wait.
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
    std::erase_if(freeing_, [](const std::future<void>& freed) {
        return freed.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    });
}

void ShownScene::freeGone() {
    leaving_.clear();  // their frames wait for the device
    freeing_.clear();
}

}  // namespace binosplat
