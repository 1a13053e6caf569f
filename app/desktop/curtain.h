// The line between two scenes in a window: the one on its left, the other on its right. It can be dragged.
#pragma once

#include "app/desktop/eye_parts.h"
#include "app/view/window/window_drawing.h"
#include "engine/gpu/own_image.h"

#include <array>

namespace binosplat {

class Curtain {
public:
    explicit Curtain(const Context& context);

    // Where it hangs, as a share of each part's width.
    [[nodiscard]] double share() const { return share_; }
    // True if a place of the window is right of it.
    [[nodiscard]] bool isLeftOf(const std::vector<EyePart>& parts, const glm::dvec2& place_px) const;
    // True if somebody who presses a button there means it.
    [[nodiscard]] bool isAt(const std::vector<EyePart>& parts, const glm::dvec2& place_px) const;

    void beginDrag() { is_dragged_ = true; }
    void dragTo(const std::vector<EyePart>& parts, const glm::dvec2& place_px);
    void endDrag() { is_dragged_ = false; }
    [[nodiscard]] bool isDragged() const { return is_dragged_; }

    // Records it over the pictures of a window.
    void compose(Commands& commands, vk::Image window, const std::vector<EyePart>& parts) const;

private:
    // Of a place, in the part that it is in or, if there is none, in the first.
    [[nodiscard]] static double shareAt(const std::vector<EyePart>& parts, const glm::dvec2& place_px);

    std::array<OwnImage, 2> inks_;  // a pixel each: its seam and itself
    double share_ = 0.5;
    bool is_dragged_ = false;
};

}  // namespace binosplat
