// The inputs that a script can move, by the identifiers of OpenXR's binding paths.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <utility>

namespace simulated {

enum class InputKind {
    kButton,   // click, touch
    kAnalog,   // value, force, click, touch
    kStick,    // x, y, click, touch; a trackpad also force
    kGesture,  // value, ready_ext
};

inline constexpr std::array<std::pair<std::string_view, InputKind>, 16> kInputs{
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
     {"pinch_ext", InputKind::kGesture},
     {"aim_activate_ext", InputKind::kGesture},
     {"grasp_ext", InputKind::kGesture}}};

[[nodiscard]] std::optional<InputKind> kindOfInput(std::string_view name);

}  // namespace simulated
