// The functions of the controllers' buttons.
#pragma once

#include <openxr/openxr.h>

#include <array>
#include <span>

namespace binosplat::xr {

// An interaction profile's inputs, below /user/hand/left and /user/hand/right; null if it has none.
struct ProfileBindings {
    const char* path;       // below /interaction_profiles
    const char* extension;  // required of the runtime; null: core
    const char* trigger;
    const char* squeeze;
    const char* stick;
    const char* stick_click;          // for pads that thumbs rest on: the stick counts while this is pressed
    const char* stick_press;          // for sticks that can be pressed in
    std::array<const char*, 2> menu;  // left, right
    std::array<const char*, 2> play;  // left, right
    const char* haptic;
};

std::span<const ProfileBindings> allProfileBindings();

}  // namespace binosplat::xr
