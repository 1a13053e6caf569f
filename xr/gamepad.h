// A gamepad, along with the hands or in their place. It has no ray, so the panel needs hands.
#pragma once

#include "xr/actions.h"
#include "xr/bindings.h"
#include "xr/hand.h"

#include <array>

namespace binosplat::xr {

class Gamepad {
public:
    // Makes its actions. Call bind() before they are attached; with a runtime that does not know gamepads, it
    // stays at rest.
    explicit Gamepad(const Actions& actions);
    void bind(const Instance& instance) const;

    // Adds what its sticks and buttons do to what the hands do: each stick to the hand on its side, the
    // shoulders as pressed sticks, the buttons for the panel and for moving scenes to the right hand's.
    void addTo(std::array<Hand, 2>& hands);
    // Buttons that are pressed count once they have been released.
    void forget();

private:
    const Actions& actions_;
    std::array<XrAction, kGamepadBindings.size()> inputs_;
    std::array<Hold, kGamepadBindings.size()> holds_;
};

}  // namespace binosplat::xr
