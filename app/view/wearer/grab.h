// Hands that hold the scene.
#pragma once

#include "app/view/wearer/wearer_tool.h"

namespace binosplat {

// A hand squeezed: the scene moves with it; both: it turns and grows with them, too.
class Grab : public WearerTool {
public:
    void update(const WearerNow& now, const PanelInRoom& panel, ViewState& state) override;
    void letGo() override { held_ = {}; }
    [[nodiscard]] std::vector<ToolChoice> choices() const override { return {{"Two-handed tilt", {}, &ViewSettings::tilt}}; }

private:
    std::array<std::optional<glm::dvec3>, 2> held_;  // where the hands were that hold the scene
};

}  // namespace binosplat
