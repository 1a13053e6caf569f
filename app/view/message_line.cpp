// Which of them, and for how long.
#include "app/view/message_line.h"

#include "app/view/panel/message_picture.h"

#include <algorithm>
#include <utility>

namespace binosplat {

namespace {

constexpr double kMessageSeconds = 6.0;
constexpr double kHighMetres = 0.16;  // enough for three lines

}  // namespace

void MessageLine::show(RoomSight& sight, const TexelLayout& layout, const PanelInRoom* panel,
                       const Pose& room_from_head, double step_seconds) {
    const bool panel_is_shown = panel != nullptr;
    const std::string message = std::exchange(message_, {});
    seconds_left_ = panel_is_shown ? 0.0 : std::max(seconds_left_ - step_seconds, 0.0);
    if (!message.empty() && !panel_is_shown) {
        sight.message = drawMessage(message, layout);
        seconds_left_ = kMessageSeconds;
    }
    if (const auto gesture = seconds_left_ > 0.0 ? std::nullopt : first_steps_.update(step_seconds)) {
        sight.message = drawGesture(*gesture, layout);
    }
    const auto isFree = [&](double down_m) {
        return !panel_is_shown ||
               !panel->covers(room_from_head, {0.0, down_m, 1.0}, {kMessageMetres, kHighMetres});
    };
    if (!panel_is_shown) { down_m_ = kPlacesMetres[0]; }
    if (const auto place = std::ranges::find_if(kPlacesMetres, isFree);
        !isFree(down_m_) && place != kPlacesMetres.end()) {
        down_m_ = *place;
    }
    sight.message_place = {0.0, down_m_, 1.0};
    sight.has_message = seconds_left_ > 0.0 || first_steps_.areShown();
}

}  // namespace binosplat
