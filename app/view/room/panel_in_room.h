// The panel as a thing in the room: its place, and the hands that point at it or carry it. Room axes: x
// right, y down, z forward; metres.
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

    // Follows the hands while the panel is `shown`. Both may point; the one that clicked last is the pointer
    // for as long as it hits the panel. A hand that squeezes while it points carries the panel until it lets
    // go.
    void update(const std::array<xr::Hand, 2>& hands, bool shown);
    // While the panel is shown: if the wearer looks elsewhere for long enough, and neither points at the
    // panel nor carries it, it moves back in front of the eyes.
    void comeBefore(const Pose& room_from_head, double step_seconds);
    // Hangs the panel in front of the eyes, a little to the left, facing them.
    void hangBefore(const Pose& room_from_head);

    [[nodiscard]] const Pose& roomFromPanel() const { return room_from_panel_; }
    [[nodiscard]] glm::dvec2 sizeMetres() const { return size_m_; }
    [[nodiscard]] const PanelPointer& pointer() const { return pointer_; }
    // True if it is in front of part of a rectangle of `size_m` around this place, in the head's axes.
    [[nodiscard]] bool covers(const Pose& room_from_head, const glm::dvec3& place,
                              const glm::dvec2& size_m) const;
    // True if this hand is the pointer.
    [[nodiscard]] bool isPointedAtBy(int hand) const { return pointing_hand_ == hand; }
    // True if this hand has just hit the panel or clicked on it.
    [[nodiscard]] bool pulses(int hand) const { return of(hand).pulses; }
    // True while this hand holds a click that did not begin on the panel.
    [[nodiscard]] bool clicksElsewhere(int hand) const { return of(hand).clicks && !of(hand).clicks_here; }
    // True if this hand carries the panel.
    [[nodiscard]] bool isCarriedBy(int hand) const { return carrier_ == hand; }

    // The rays of all pointing hands except `without`, while the panel is shown or the trigger is pulled: up
    // to the panel or, if they miss it, a short way, fading out; a ring shows where they hit the scene, this
    // many metres away.
    [[nodiscard]] std::vector<Thing> rays(const glm::dvec3& eye, std::optional<int> without,
                                          const std::array<std::optional<double>, 2>& meets_m = {}) const;
    // Where this hand points, if it has a ray that misses the panel.
    [[nodiscard]] std::optional<Pose> missesWith(int hand) const {
        return of(hand).hit ? std::nullopt : of(hand).aim;
    }

private:
    // Where on the canvas and how far along the ray; empty if it misses.
    struct Hit {
        glm::dvec2 place_px;
        double distance_m;
    };
    [[nodiscard]] std::optional<Hit> meet(const Pose& room_from_aim) const;

    struct HandNow {
        std::optional<Pose> aim;  // where it points, if that matters
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
    double unseen_seconds_ = 0.0;
};

}  // namespace binosplat
