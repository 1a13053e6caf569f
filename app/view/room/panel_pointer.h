// The hand or mouse that points at the panel.
#pragma once

#include <glm/glm.hpp>

#include <optional>

namespace binosplat {

struct PanelPointer {
    std::optional<glm::dvec2> place_px;  // empty: nowhere near
    bool pressed = false;
    double wheel = 0.0;
};

}  // namespace binosplat
