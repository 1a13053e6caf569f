// The headset's images of another size, made beside frames of the present one.
#pragma once

#include "app/view/headset/eye_images.h"
#include "engine/gpu/own_image.h"

#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <vector>

namespace binosplat {

// The sizes that images are made for.
struct ImagesAsked {
    glm::uvec2 view_px{0, 0}, inset_px{0, 0};
    bool stay = false;  // whether the pictures' axes do
    bool operator==(const ImagesAsked&) const = default;
};

// All that is as large as the headset's images.
struct ImageSet {
    std::unique_ptr<EyeImages> eyes, insets;  // insets: in a session that has them
    Presenter::Buffers presented;
    std::optional<OwnImage> mirrored;  // an eye, in a window on the desktop
};

class ImagesAhead {
public:
    // Begins to make images of `size_px` on a thread, unless that is done, under way or has failed. True if
    // there is nothing to wait for: they are there, or there will be none.
    bool have(const ImagesAsked& asked, glm::uvec2 size_px, std::function<ImageSet()> make);
    // Nobody wants them any more.
    void giveUp();
    // The size of what have() was last asked for.
    [[nodiscard]] glm::uvec2 sizePx() const { return size_px_; }
    // What have() made; empty if it made none of that kind.
    [[nodiscard]] std::optional<ImageSet> take(const ImagesAsked& asked);
    // They are freed on a thread, once no frame that is in flight now uses them.
    void letGo(ImageSet images);
    // In each frame, before anything is recorded.
    void passOver();
    // While no frame is in flight: waits until all that leave are freed. False if there are none.
    bool freeGone();

private:
    struct Leaving {
        ImageSet images;
        int frames_left = 2;
    };
    void land();
    void free(ImageSet images);

    std::optional<ImagesAsked> asked_;
    glm::uvec2 size_px_{0, 0};
    std::optional<ImageSet> made_;
    std::vector<Leaving> leaving_;
    std::vector<std::future<void>> freeing_;
    std::future<ImageSet> coming_;  // last: its thread ends first
};

}  // namespace binosplat
