// From input to what it changes, in order.
#include "app/view/wearer_actions.h"

namespace binosplat {

WearerNow WearerActions::wearerNow(ConnectedHeadset& headset, const FrameViews& views) {
    WearerNow now{headset.input.read(), views.room_from_head, headset.session.floorBelowMetres(),
                  headset.session.stepSeconds(), pointing_.hands()};
    now.measures = place_.measures();
    now.ground_scene = pointing_.takeGround();
    if (const LoadedScene* const scene = scenes_.get(); scene != nullptr && scene->floor) {
        now.scene_floor = SceneFloor{scene->up, *scene->floor};
    }
    return now;
}

void WearerActions::take(ConnectedHeadset& headset, FrameViews& views) {
    const WearerNow now = wearerNow(headset, views);
    PanelInRoom& panel = panel_.inRoom();
    controls_.update(now, panel, state_);
    if (place_.measure(now.hands, panel, pointing_, panel_.entry()) && !state_.settings().panel) {
        togglePanel();
    }
    pointing_.ask(panel, controls_, state_.settings(),
                  state_.settings().follow_ground && !scenes_.drawsOther(), views.room_from_head,
                  now.floor_m.value_or(kUsualFloorMetres));
    if (const double clear_deg = state_.settings().stereo.foveation_deg; clear_deg > 0.0 && !views.insets) {
        views.gazes = gaze_.update(headset.input.gaze(), views.room_from_eyes, glm::radians(clear_deg),
                                   now.step_seconds);
    } else {
        gaze_ = {};
    }
    if (place_.goBy(controls_.viewpointStep()) || place_.passTour(now.step_seconds)) { letGo(); }
    play(headset);
    seen_.choose(headset, now, controls_, panel, pointing_, state_.settings(), views.eyes);
}

void WearerActions::play(ConnectedHeadset& headset) {
    if (scenes_.other() == nullptr) { return scenes_.moveTime(controls_.playPressed(), 0, {}); }
    const std::array<bool, 2>& held = controls_.playHeld();
    if (!exchange_.showOther(held[kLeft] || held[kRight])) { return; }
    pointing_.forget();
    for (const int h : {kLeft, kRight}) {
        if (held[static_cast<std::size_t>(h)]) { headset.input.pulse(h); }
    }
}

void WearerActions::togglePanel() {
    state_.togglePanel();
    panel_.inRoom().hangBefore(place_.roomFromHead());
}

}  // namespace binosplat
