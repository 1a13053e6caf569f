// The panel as a thing in the room: where it hangs, who points at it, who carries it. Room axes: x right, y down, z forward; metres.
#pragma once

#include "app/view/room/panel_pointer.h"
#include "app/view/room/sprites.h"
#include "xr/input.h"

#include <array>
#include <optional>
#include <vector>

namespace binosplat {

class PanelInRoom {
public:
    // A canvas of `size_px`, `width_m` wide.
    PanelInRoom(glm::uvec2 size_px, double width_m);

    // Follows the hands while it is `shown`. Both may point; the one that clicked last is the pointer, as long as it meets the panel. A
    // hand that squeezes while it points carries the panel until it lets go.
    void update(const std::array<xr::Hand, 2>& hands, bool shown);
    // Hangs before the eyes, a little to the left, facing them.
    void hangBefore(const Pose& room_from_head);

    [[nodiscard]] const Pose& roomFromPanel() const { return room_from_panel_; }
    [[nodiscard]] glm::dvec2 sizeMetres() const { return size_m_; }
    [[nodiscard]] const PanelPointer& pointer() const { return pointer_; }
    // Whether this hand is the pointer.
    [[nodiscard]] bool isPointedAtBy(int hand) const { return pointing_hand_ == hand; }
    // Whether this hand has just met the panel or clicked on it.
    [[nodiscard]] bool pulses(int hand) const { return of(hand).pulses; }
    // Whether the trigger of this hand is pulled, and was when it did not point at the panel.
    [[nodiscard]] bool clicksElsewhere(int hand) const { return of(hand).clicks && !of(hand).clicks_here; }
    // Whether the squeeze of this hand is the panel's business.
    [[nodiscard]] bool isCarriedBy(int hand) const { return carrier_ == hand; }

    // Of each hand that points, while the panel is shown or its trigger is pulled, but of `without`: to the panel; or, where it misses
    // that, a little way, and then it fades.
    [[nodiscard]] std::vector<Thing> rays(const glm::dvec3& eye, std::optional<int> without) const;

private:
    // Where on the canvas and how far along the ray; empty if it misses.
    struct Hit {
        glm::dvec2 place_px;
        double distance_m;
    };
    [[nodiscard]] std::optional<Hit> meet(const Pose& room_from_aim) const;

    struct HandNow {
        std::optional<Pose> aim;  // where it points, if that means anything
        std::optional<Hit> hit;
        bool squeezes = false, clicks = false, clicks_here = false, pulses = false;
    };
    [[nodiscard]] const HandNow& of(int hand) const { return hands_[static_cast<std::size_t>(hand)]; }
    void follow(const xr::Hand& hand, int h, bool shown);
    void carry(const std::array<xr::Hand, 2>& hands, bool shown);

    glm::dvec2 size_px_, size_m_;
    Pose room_from_panel_;
    PanelPointer pointer_;
    std::array<HandNow, 2> hands_;
    int clicked_last_ = kRight;
    std::optional<int> pointing_hand_, carrier_;
    Pose hand_from_panel_;
};

}  // namespace binosplat
