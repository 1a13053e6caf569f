// Which buttons of which controllers do what.
#pragma once

#include <openxr/openxr.h>

#include <array>
#include <span>

namespace binosplat::xr {

// An interaction profile's inputs, below /user/hand/left and /user/hand/right; null where it has none.
struct ProfileBindings {
    const char* path;       // below /interaction_profiles
    const char* extension;  // that the runtime must have; null: core
    const char* trigger;
    const char* squeeze;
    const char* stick;
    const char* stick_click;          // where the stick is a pad that thumbs rest on: it counts while it is pressed
    const char* stick_press;          // where the stick can be pressed in
    std::array<const char*, 2> menu;  // left, right
    const char* haptic;
};

std::span<const ProfileBindings> allProfileBindings();

}  // namespace binosplat::xr
