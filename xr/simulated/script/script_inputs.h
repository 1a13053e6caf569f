// The inputs that a script can move, by the identifiers of OpenXR's binding paths.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

namespace simulated {

enum class InputKind {
    kButton,   // click, touch
    kAnalog,   // value, force, click, touch
    kStick,    // x, y, click, touch; a trackpad also force
    kGesture,  // value, ready_ext
};

inline constexpr std::array<std::pair<std::string_view, InputKind>, 24> kInputs{
    {{"trigger", InputKind::kAnalog},
     {"squeeze", InputKind::kAnalog},
     {"thumbstick", InputKind::kStick},
     {"trackpad", InputKind::kStick},
     {"a", InputKind::kButton},
     {"b", InputKind::kButton},
     {"x", InputKind::kButton},
     {"y", InputKind::kButton},
     {"menu", InputKind::kButton},
     {"select", InputKind::kAnalog},
     {"system", InputKind::kButton},
     {"thumbrest", InputKind::kButton},
     {"shoulder", InputKind::kButton},
     {"primary", InputKind::kButton},
     {"secondary", InputKind::kButton},
     {"back", InputKind::kButton},
     {"view", InputKind::kButton},
     {"dpad_down", InputKind::kButton},
     {"cluster_front_logitech", InputKind::kButton},
     {"cluster_middle_logitech", InputKind::kAnalog},
     {"cluster_back_logitech", InputKind::kButton},
     {"pinch_ext", InputKind::kGesture},
     {"aim_activate_ext", InputKind::kGesture},
     {"grasp_ext", InputKind::kGesture}}};

// Those of a gamepad, whose triggers have only a value.
inline constexpr std::array<std::pair<std::string_view, InputKind>, 16> kGamepadInputs{
    {{"thumbstick_left", InputKind::kStick},
     {"thumbstick_right", InputKind::kStick},
     {"trigger_left", InputKind::kAnalog},
     {"trigger_right", InputKind::kAnalog},
     {"shoulder_left", InputKind::kButton},
     {"shoulder_right", InputKind::kButton},
     {"dpad_up", InputKind::kButton},
     {"dpad_down", InputKind::kButton},
     {"dpad_left", InputKind::kButton},
     {"dpad_right", InputKind::kButton},
     {"a", InputKind::kButton},
     {"b", InputKind::kButton},
     {"x", InputKind::kButton},
     {"y", InputKind::kButton},
     {"menu", InputKind::kButton},
     {"view", InputKind::kButton}}};

using Inputs = std::span<const std::pair<std::string_view, InputKind>>;

// Of either.
[[nodiscard]] std::optional<InputKind> kindOfInput(std::string_view name);

}  // namespace simulated
