// The panel as a thing in the room: where it hangs, who points at it, who carries it. Room axes: x right, y down, z forward; metres.
#pragma once

#include "app/view/canvas.h"
#include "xr/input.h"

#include <array>
#include <optional>

namespace binosplat {

class OverlayPanel {
public:
    // A canvas of `size_px`, `width_m` wide.
    OverlayPanel(glm::uvec2 size_px, double width_m);

    // Follows the hands: the right one points first. A hand that squeezes while it points carries the panel until it lets go.
    void update(const std::array<xr::Hand, 2>& hands);
    // Hangs before the eyes, a little to the left, facing them.
    void hangBefore(const Pose& room_from_head);

    [[nodiscard]] const Pose& roomFromPanel() const { return room_from_panel_; }
    [[nodiscard]] glm::dvec2 sizeMetres() const { return size_m_; }
    [[nodiscard]] const CanvasPointer& pointer() const { return pointer_; }
    // The hand that has just met the panel or clicked on it.
    [[nodiscard]] std::optional<int> pulse() const { return pulse_; }
    // Whether the squeeze of this hand is the panel's business.
    [[nodiscard]] bool isCarriedBy(int hand) const { return carrier_ == hand; }

    // The ray that is drawn: a strip from the pointing hand to the panel, turned towards the eyes. Empty if nobody points.
    struct Ray {
        Pose room_from_strip;  // its y goes along the ray
        glm::dvec2 size_m;
    };
    [[nodiscard]] std::optional<Ray> ray(const Pose& room_from_head) const;

private:
    // Where on the canvas and how far along the ray; empty if it misses.
    struct Hit {
        glm::dvec2 place_px;
        double distance_m;
    };
    [[nodiscard]] std::optional<Hit> meet(const Pose& room_from_aim) const;

    glm::dvec2 size_px_, size_m_;
    Pose room_from_panel_;
    CanvasPointer pointer_;
    std::optional<Pose> pointing_;  // the aim that hits
    double distance_m_ = 0.0;
    std::array<bool, 2> squeezed_{};
    std::optional<int> hit_by_, pulse_;
    bool clicked_ = false;
    std::optional<int> carrier_;
    Pose hand_from_panel_;
};

}  // namespace binosplat
