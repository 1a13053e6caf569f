// Images are made and freed where no frame waits for it.
#include "app/view/headset/images_ahead.h"

#include "engine/ready.h"

#include <utility>

namespace binosplat {

void ImagesAhead::land() {
    if (!isReady(coming_)) { return; }
    try {
        made_ = coming_.get();
    } catch (const vk::DeviceLostError&) { throw; } catch (const std::exception&) {
    }  // whoever makes them between frames instead will say why
}

bool ImagesAhead::have(const ImagesAsked& asked, glm::uvec2 size_px, std::function<ImageSet()> make) {
    land();
    if (coming_.valid()) { return false; }
    if (asked_ == asked) { return true; }
    giveUp();
    asked_ = asked;
    size_px_ = size_px;
    coming_ = std::async(std::launch::async, std::move(make));
    return false;
}

void ImagesAhead::giveUp() {
    land();
    if (coming_.valid()) { return; }
    asked_.reset();
    if (made_) { free(*std::exchange(made_, std::nullopt)); }
}

std::optional<ImageSet> ImagesAhead::take(const ImagesAsked& asked) {
    return asked_ == asked ? std::exchange(made_, std::nullopt) : std::nullopt;
}

void ImagesAhead::letGo(ImageSet images) { leaving_.push_back({std::move(images)}); }

void ImagesAhead::free(ImageSet images) {
    for (EyeImages* const eyes : {images.eyes.get(), images.insets.get()}) {
        if (eyes != nullptr) { eyes->noteIdle(); }
    }
    freeing_.push_back(std::async(std::launch::async, [images = std::move(images)]() mutable {
        const ImageSet gone = std::move(images);
    }));
}

bool ImagesAhead::freeGone() {
    const bool any = !leaving_.empty() || !freeing_.empty();
    leaving_.clear();
    freeing_.clear();
    return any;
}

void ImagesAhead::passOver() {
    for (Leaving& leaving : leaving_) {
        if (--leaving.frames_left == 0) { free(std::move(leaving.images)); }
    }
    std::erase_if(leaving_, [](const Leaving& leaving) { return leaving.frames_left == 0; });
    std::erase_if(freeing_, [](const std::future<void>& freed) { return isReady(freed); });
}

}  // namespace binosplat
