// Standing on the scene's ground, wherever one goes: on stairs, slopes and uneven floors.
#pragma once

#include "app/view/wearer/wearer_tool.h"

#include <array>
#include <map>

namespace binosplat {

// Where the ground may be seen: at the level of the feet, beneath the wearer and in front of them. Points in
// the room.
ProbePath groundAhead(const Pose& room_from_head, double feet_m);

// If chosen: the wearer rises and sinks to what was seen where they stand now, or to the scene's floor where
// nothing was. What is higher than a step is furniture, what is deeper is no ground to stand on. The wearer
// never gets below the scene's floor.
class FollowGround : public WearerTool {
public:
    void update(const WearerNow& now, const PanelInRoom& panel, ViewState& state) override;
    void letGo() override { seen_.clear(); }
    [[nodiscard]] std::vector<ToolChoice> choices() const override {
        return {{"On ground", {}, &ViewSettings::follow_ground}};
    }

private:
    void remember(const std::vector<glm::dvec3>& ground_scene, double units_per_metre);
    // The height of what was seen there, as the room's y; empty: nothing within a step.
    [[nodiscard]] std::optional<double> groundAt(const glm::dvec3& feet,
                                                 const Similarity& scene_from_room) const;

    std::map<std::array<int, 3>, glm::dvec3> seen_;  // a point of the ground for each cell of the scene
    double units_per_metre_ = 1.0;                   // when they were seen
};

}  // namespace binosplat
