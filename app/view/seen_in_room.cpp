// Chooses what the headset's layers show.
#include "app/view/seen_in_room.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace binosplat {

void SeenInRoom::choose(ConnectedHeadset& headset, const WearerNow& wearer, const WearerControls& controls,
                        const PanelInRoom& panel, const ScenePointing& pointing, const ViewSettings& settings,
                        const std::array<xr::EyeView, 2>& views) {
    for (const int h : {kLeft, kRight}) {
        if (panel.pulses(h)) { headset.input.pulse(h); }
    }
    vignette_.update(settings.vignette && controls.isMoving(), wearer.step_seconds);
    std::array<std::optional<double>, 2> meets_m;
    for (std::size_t h = 0; h < 2 && !controls.aimingHand(); ++h) {
        meets_m[h] = pointing.meetsMetres(static_cast<int>(h));
    }
    RoomSight sight;
    sight.eye = wearer.room_from_head.position;
    if (settings.hands) { sight.hands = wearer.hands; }
    sight.things = panel.rays(sight.eye, controls.aimingHand(), meets_m);
    std::ranges::copy(controls.things(sight.eye), std::back_inserter(sight.things));
    sight.arc = controls.arc();
    sight.vignette_m = vignette_.widthMetres(views);
    message_line_.show(sight, headset.things.layout(), settings.panel ? &panel : nullptr,
                       wearer.room_from_head, wearer.step_seconds);
    headset.things.choose(sight);
}

void SeenInRoom::darken(ConnectedHeadset& headset, const Similarity& placed, const Pose& room_from_head,
                        bool was_cut_short, double step_seconds, const std::array<xr::EyeView, 2>& views) {
    const bool is_new = std::exchange(is_new_view_, false) || was_cut_short;
    fade_.update(placed, room_from_head, is_new, step_seconds);
    headset.things.darken(fade_.darkness(), coverMetres(views));
}

}  // namespace binosplat
