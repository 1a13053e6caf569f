// Which of them, and for how long.
#include "app/view/message_line.h"

#include "app/view/panel/message_picture.h"

#include <algorithm>
#include <utility>

namespace binosplat {

namespace {

constexpr double kMessageSeconds = 6.0;

}  // namespace

void MessageLine::show(RoomSight& sight, const TexelLayout& layout, bool panel_is_shown,
                       double step_seconds) {
    const std::string message = std::exchange(message_, {});
    seconds_left_ = panel_is_shown ? 0.0 : std::max(seconds_left_ - step_seconds, 0.0);
    if (!message.empty() && !panel_is_shown) {
        sight.message = drawMessage(message, layout);
        seconds_left_ = kMessageSeconds;
    }
    if (const auto gesture = seconds_left_ > 0.0 ? std::nullopt : first_steps_.update(step_seconds)) {
        sight.message = drawGesture(*gesture, layout);
    }
    sight.has_message = seconds_left_ > 0.0 || first_steps_.areShown();
}

}  // namespace binosplat
