// The pictures of a window, which are acquired and shown without waiting.
#pragma once

#include "engine/gpu/context.h"

#include <glm/glm.hpp>

#include <functional>
#include <future>
#include <utility>
#include <vector>

namespace binosplat {

class WindowPictures {
public:
    // `window_size_px` returns the window's current size. Without `paced` a headset sets the pace, otherwise
    // the display. Throws Error if the device cannot show on the surface.
    WindowPictures(const Context& context, vk::raii::SurfaceKHR surface,
                   std::function<glm::uvec2()> window_size_px, bool paced = false);

    WindowPictures(const WindowPictures&) = delete;
    WindowPictures& operator=(const WindowPictures&) = delete;
    ~WindowPictures();

    // Before anything is recorded, once a frame: a picture to draw on, if one is free; first that of a
    // dropped frame, if there is one. If the window has another size, pictures are made for it, on a thread
    // unless `paced`; until then none is free.
    void acquire();
    // That picture; null if none was free.
    [[nodiscard]] vk::Image current() const {
        return hold_ == Hold::kOurs ? now_.images[index_] : vk::Image();
    }
    [[nodiscard]] glm::uvec2 sizePx() const { return now_.size_px; }
    // The semaphore that the submission that draws on it signals; null if none was free.
    [[nodiscard]] vk::Semaphore drawn() const {
        return hold_ == Hold::kOurs ? *now_.drawn.at(index_) : vk::Semaphore();
    }
    // Once the submission is under way: shows the picture when it is drawn.
    void show();

private:
    // A swapchain, and what belongs to it.
    struct Made {
        vk::raii::SwapchainKHR swapchain{nullptr};  // null: there is nothing to draw on
        std::vector<vk::Image> images = {};
        std::vector<vk::raii::Semaphore> drawn = {};
        glm::uvec2 size_px{0, 0};
    };
    // In place of the one that there is; on any thread, while nobody uses that one.
    [[nodiscard]] Made make() const;
    void take(Made made);
    // True if the acquired picture is free to draw on by now.
    [[nodiscard]] bool isFree() const;
    void takePromised();

    const Context& context_;
    vk::raii::SurfaceKHR surface_;
    std::function<glm::uvec2()> window_size_px_;
    bool paced_;
    Made now_;
    vk::raii::Fence acquired_fence_{nullptr};
    // What was replaced, and for how many more calls of acquire() frames may use it.
    std::vector<std::pair<Made, int>> old_;
    glm::uvec2 window_px_{0, 0};  // when the pictures were made
    // Of the picture index_: none; promised, while the display may still read it; ours to draw on.
    enum class Hold { kNone, kPromised, kOurs } hold_ = Hold::kNone;
    bool is_stale_ = false;   // the pictures no longer fit the display
    bool is_remade_ = false;  // at the same size: if it is still suboptimal, keep it
    std::uint32_t index_ = 0;
    std::future<Made> making_;  // last: its thread uses the others
};

}  // namespace binosplat
