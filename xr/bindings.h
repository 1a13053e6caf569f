// What the controllers' buttons do.
#pragma once

#include "xr/hand.h"

#include <openxr/openxr.h>

#include <array>
#include <span>
#include <string>

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
// Bindings of the controllers that most people have.
const ProfileBindings& usualBindings();

// What people call an input, by its binding path: "trigger" for "input/trigger/value".
std::string inputName(const char* path);

// An input of a gamepad, below /user/gamepad, and what it does.
struct GamepadBinding {
    const char* path;
    const char* name;         // of the action
    const char* description;  // for people
    int side;                 // of the hand that does the same
    bool is_stick = false;
    bool Hand::*button = nullptr;  // of others
};
inline constexpr const char* kGamepadProfile = "microsoft/xbox_controller";
inline constexpr std::array<GamepadBinding, 7> kGamepadBindings{{
    {"input/thumbstick_left", "gamepad_walk", "Walk, with a gamepad", kLeft, true},
    {"input/thumbstick_right", "gamepad_turn", "Turn, with a gamepad", kRight, true},
    {"input/menu/click", "gamepad_menu", "Show or hide the panel, with a gamepad", kRight, false,
     &Hand::menu},
    {"input/b/click", "gamepad_b", "Show or hide the panel, with a gamepad's B", kRight, false, &Hand::menu},
    {"input/a/click", "gamepad_play", "Pause or play, or hold to see the other scene, with a gamepad", kRight,
     false, &Hand::play},
    {"input/shoulder_left/click", "gamepad_back", "Previous viewpoint, with a gamepad", kLeft, false,
     &Hand::stick_presses},
    {"input/shoulder_right/click", "gamepad_on", "Next viewpoint, with a gamepad", kRight, false,
     &Hand::stick_presses},
}};

}  // namespace binosplat::xr
