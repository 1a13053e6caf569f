// What hands point at in the scene, and where its ground is: known three frames late.
#pragma once

#include "app/view/room/scene_probe.h"
#include "app/view/scene_renderer.h"
#include "app/view/wearer/wearer_controls.h"

#include <array>
#include <optional>

namespace binosplat {

class ScenePointing {
public:
    explicit ScenePointing(const Context& context) : probe_(context) {}

    // Once per frame, before it is recorded: where the rays and the arc, and the ground ahead if it is
    // `followed`, this far below the head, are to be met.
    void ask(const PanelInRoom& panel, const WearerControls& controls, const ViewSettings& settings,
             bool followed, const Pose& room_from_head, double feet_m);
    // Within the frame's commands, after its pictures; may be repeated.
    void record(Commands& commands, const ShownScene& scenes, const SceneRenderer& renderer,
                const Similarity& scene_from_room);
    // Another scene is shown.
    void forget() { probe_.forget(); }

    [[nodiscard]] const std::array<PathSeen, 2>& hands() const { return seen_.hands; }
    [[nodiscard]] std::vector<glm::dvec3> takeGround() { return std::move(seen_.ground); }
    // How far along its ray a hand meets the scene.
    [[nodiscard]] std::optional<double> meetsMetres(int hand) const;

private:
    SceneProbe probe_;
    ProbesSeen seen_;
};

}  // namespace binosplat
