// Paths for the probe.
#include "app/view/scene_pointing.h"

#include "app/view/wearer/follow_ground.h"

namespace binosplat {

void ScenePointing::ask(const PanelInRoom& panel, const WearerControls& controls,
                        const ViewSettings& settings, bool followed, const Pose& room_from_head,
                        double feet_m) {
    std::array<std::optional<ProbePath>, kProbePaths> paths;
    if (followed) { paths[kGroundPath] = groundAhead(room_from_head, feet_m); }
    for (const int h : {kLeft, kRight}) {
        if (!settings.hands) { break; }  // hidden hands do not point
        if (const std::optional<Pose> aim = panel.missesWith(h)) {
            paths[static_cast<std::size_t>(h)] = probeRay(*aim);
        }
    }
    if (const Arc* const arc = controls.arc(); controls.aimingHand() && arc != nullptr) {
        ProbePath& path = paths[static_cast<std::size_t>(*controls.aimingHand())].emplace();
        for (std::size_t i = 0; i < path.size(); ++i) {
            path[i] = pointAlong(arc->points, static_cast<double>(i) / static_cast<double>(path.size() - 1));
        }
    }
    seen_ = probe_.ask(paths);
}

void ScenePointing::record(Commands& commands, const ShownScene& scenes, const SceneRenderer& renderer,
                           const Similarity& scene_from_room) {
    const std::optional<SeenPicture> seen = renderer.seenPicture();
    if (!seen) { return; }
    probe_.record(commands, scenes.frame().picture(seen->eye_of_frame), seen->picture,
                  scenes.drawnFrom(scene_from_room));
}

std::optional<double> ScenePointing::meetsMetres(int hand) const {
    const std::optional<double>& point = seen_.hands[static_cast<std::size_t>(hand)].meets;
    return point ? std::optional(probeMetres(*point)) : std::nullopt;
}

}  // namespace binosplat
