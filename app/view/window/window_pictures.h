// The pictures of a window, which are acquired and shown without waiting.
#pragma once

#include "engine/gpu/context.h"

#include <glm/glm.hpp>

#include <functional>
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
    // dropped frame, if there is one.
    void acquire();
    // That picture; null if none was free.
    [[nodiscard]] vk::Image current() const { return hold_ == Hold::kOurs ? images_[index_] : vk::Image(); }
    [[nodiscard]] glm::uvec2 sizePx() const { return size_px_; }
    // The semaphore that the submission that draws on it signals; null if none was free.
    [[nodiscard]] vk::Semaphore drawn() const {
        return hold_ == Hold::kOurs ? *drawn_.at(index_) : vk::Semaphore();
    }
    // Once the submission is under way: shows the picture when it is drawn.
    void show();

private:
    void make();
    // True if the acquired picture is free to draw on by now.
    [[nodiscard]] bool isFree() const;
    void takePromised();

    const Context& context_;
    vk::raii::SurfaceKHR surface_;
    std::function<glm::uvec2()> window_size_px_;
    bool paced_;
    vk::raii::SwapchainKHR swapchain_{nullptr};
    vk::raii::Fence acquired_fence_{nullptr};
    std::vector<vk::Image> images_;
    std::vector<vk::raii::Semaphore> drawn_;  // by picture: free again when it is
    // What was replaced, and for how many more calls of acquire() frames may use it.
    struct Old {
        vk::raii::SwapchainKHR swapchain;
        std::vector<vk::raii::Semaphore> drawn;
        int calls;
    };
    std::vector<Old> old_;
    glm::uvec2 size_px_{0, 0}, window_px_{0, 0};  // of the pictures, and of the window when they were made
    // Of the picture index_: none; promised, while the display may still read it; ours to draw on.
    enum class Hold { kNone, kPromised, kOurs } hold_ = Hold::kNone;
    bool is_stale_ = false;   // the pictures no longer fit the display
    bool is_remade_ = false;  // at the same size: if it is still suboptimal, keep it
    std::uint32_t index_ = 0;
};

}  // namespace binosplat
