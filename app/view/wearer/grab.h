// Hands that hold the scene.
#pragma once

#include "app/view/wearer/wearer_tool.h"

namespace binosplat {

// With one hand squeezed, the scene moves with it; with both, it also turns and grows with them.
class Grab : public WearerTool {
public:
    void update(const WearerNow& now, const PanelInRoom& panel, ViewState& state) override;
    void letGo() override { held_ = {}; }
    [[nodiscard]] std::vector<ToolChoice> choices() const override {
        return {{"Two-handed tilt", {}, &ViewSettings::tilt}};
    }

private:
    std::array<std::optional<glm::dvec3>, 2> held_;  // the last places of the hands that hold the scene
};

}  // namespace binosplat
