// The layers of a frame, back to front: the scene for both eyes, and flat panels in the room.
#pragma once

#include "engine/geometry.h"
#include "xr/swapchain.h"

#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace binosplat::xr {

// One eye of the scene's layer. `depth` may be null; then `near_m` is not used.
struct LayerEye {
    EyeView view;
    const Swapchain* colour = nullptr;
    const Swapchain* depth = nullptr;  // near_m / depth; 0 where there is nothing
    double near_m = 0.0;
    glm::uvec2 part_px{0, 0};  // of the images, from their top left corner
};

// A flat picture, visible from its -z side and blended over what is behind it; its colours are premultiplied
// by alpha.
struct LayerQuad {
    Pose pose;  // room axes, or the head's if follows_head
    glm::dvec2 size_m{0.0};
    const Swapchain* swapchain = nullptr;
    glm::uvec2 from_px{0, 0}, size_px{0, 0};  // of its image
    bool follows_head = false;
    const char* name = "a picture";  // for messages
};

class Layers {
public:
    // Only the first `most_quads` of the quads are shown: a frame can do without the rest.
    explicit Layers(const Session& session, std::size_t most_quads = SIZE_MAX)
        : session_(session), most_quads_(most_quads) {}
    Layers(const Layers&) = delete;
    Layers& operator=(const Layers&) = delete;

    // If `see_through`, the room is visible as far as the pictures' alpha lets it through; their colours are
    // premultiplied by alpha.
    void addEyes(const std::array<LayerEye, 2>& eyes, bool see_through) { addViews(eyes, see_through); }
    // The same in a session with insets, which come after the eyes.
    void addEyesAndInsets(const std::array<LayerEye, 4>& eyes_and_insets, bool see_through) {
        addViews(eyes_and_insets, see_through);
    }
    // A panel centred at `room_from_panel`, facing along its -z, size_m wide and high. Its picture is blended
    // over what is behind it; its colours are premultiplied by alpha.
    void addPanel(const Pose& room_from_panel, const glm::dvec2& size_m, const Swapchain& swapchain);
    void addQuad(const LayerQuad& quad);
    // All quads that were added, not counting panels.
    [[nodiscard]] const std::vector<const char*>& quadNames() const { return quad_names_; }

    // For Session::endFrame; valid as long as this and the swapchains.
    [[nodiscard]] std::span<const XrCompositionLayerBaseHeader* const> list() const { return list_; }

private:
    void addViews(std::span<const LayerEye> views, bool see_through);
    void hang(const LayerQuad& quad);

    const Session& session_;
    std::size_t most_quads_;
    std::vector<const char*> quad_names_;
    std::array<XrCompositionLayerProjectionView, 4> views_{};
    std::array<XrCompositionLayerDepthInfoKHR, 4> depths_{};
    XrCompositionLayerProjection scene_{};
    std::deque<XrCompositionLayerQuad> panels_;  // a deque keeps their addresses
    std::vector<const XrCompositionLayerBaseHeader*> list_;
};

}  // namespace binosplat::xr
