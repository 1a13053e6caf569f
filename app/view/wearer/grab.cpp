// From where the hands were to where they are.
#include "app/view/wearer/grab.h"

#include "app/view/placement/placement.h"

namespace binosplat {

void Grab::update(const WearerNow& now, const PanelInRoom& panel, ViewState& state) {
    std::array<std::optional<glm::dvec3>, 2> holding;
    for (const int h : {kLeft, kRight}) {
        const xr::Hand& hand = now.hands[static_cast<std::size_t>(h)];
        if (hand.grabs && hand.grip && !panel.isCarriedBy(h)) {
            holding[static_cast<std::size_t>(h)] = hand.grip->position;
        }
    }
    // If a hand begins or ceases to hold, nothing moves in this frame.
    const bool goes_on = holding[kLeft].has_value() == held_[kLeft].has_value() &&
                         holding[kRight].has_value() == held_[kRight].has_value();
    if (goes_on && holding[kLeft] && holding[kRight]) {
        state.place(heldBy(state.sceneFromRoom(), {*held_[kLeft], *held_[kRight]},
                           {*holding[kLeft], *holding[kRight]}, state.settings().tilt));
    } else if (goes_on && (holding[kLeft] || holding[kRight])) {
        const std::size_t h = holding[kLeft] ? kLeft : kRight;
        state.place(movedBy(state.sceneFromRoom(), *held_[h] - *holding[h]));
    }
    held_ = holding;
}

}  // namespace binosplat
