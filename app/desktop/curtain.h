// Two scenes in one window, on both sides of a line that can be dragged; or the other one alone, with the
// line out of the way.
#pragma once

#include "app/desktop/desktop_window.h"
#include "app/desktop/eye_parts.h"
#include "app/terminal/frame_log.h"
#include "engine/gpu/own_image.h"

#include <array>
#include <utility>

namespace binosplat {

class Curtain {
public:
    // `log` must outlive this.
    Curtain(const Context& context, const FrameLog& log);

    // As a share of each part's width: the other scene is seen on the right of this.
    [[nodiscard]] double share() const { return is_away_ ? 0.0 : share_; }
    [[nodiscard]] bool isOtherAt(const std::vector<EyePart>& parts, const glm::dvec2& place_px) const {
        return is_away_ || shareAt(parts, place_px) > share_;
    }
    [[nodiscard]] bool isAway() const { return is_away_; }

    // It is to stay away, or hang again; in between, it is the other way round while a key is held.
    void setStaysAway(bool stays_away) { stays_away_ = stays_away; }
    [[nodiscard]] bool staysAway() const { return stays_away_; }
    // Once per turn; true if that takes it away, or brings it back.
    bool hold(bool is_held);
    // Handles mouse events outside the panel, and there while it is dragged; true if one is meant for the
    // line.
    bool takes(const DesktopEvent& event, const std::vector<EyePart>& parts);
    [[nodiscard]] bool isPointedAt() const { return is_pointed_at_; }
    [[nodiscard]] bool isDragged() const { return is_dragged_; }
    // True once after it has moved.
    [[nodiscard]] bool takeMove() { return std::exchange(has_moved_, false); }

    // Records the line over the pictures of a window.
    void compose(Commands& commands, vk::Image window, const std::vector<EyePart>& parts) const;

private:
    // Of a place, in the part that it is in or, if there is none, in the first.
    [[nodiscard]] static double shareAt(const std::vector<EyePart>& parts, const glm::dvec2& place_px);

    const FrameLog& log_;
    std::array<OwnImage, 2> inks_;  // a pixel each: its seam and itself
    double share_ = 0.5;
    bool stays_away_ = false, is_away_ = false, is_dragged_ = false, is_pointed_at_ = false,
         has_moved_ = false;
};

}  // namespace binosplat
