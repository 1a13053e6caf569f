// Recognizes jumps, and fades the view back in.
#include "app/view/room/fade.h"

#include <algorithm>
#include <cmath>

namespace binosplat {

namespace {

constexpr double kSeconds = 0.3;
// A stick moves the wearer by at most 15 cm from frame to frame, or turns by 30 degrees, which wearers do
// again and again.
constexpr double kJumpMetres = 0.3, kJumpRadians = 0.6, kJumpGrowth = 1.3;

bool isJump(const Similarity& from, const Similarity& to, const Pose& room_from_head) {
    const double metres =
        glm::distance(transform(from, room_from_head.position), transform(to, room_from_head.position)) /
        to.scale;
    const double cosine = std::min(std::abs(glm::dot(from.orientation, to.orientation)), 1.0);
    return metres > kJumpMetres || 2.0 * std::acos(cosine) > kJumpRadians ||
           std::abs(std::log(to.scale / from.scale)) > std::log(kJumpGrowth);
}

}  // namespace

void Fade::update(const Similarity& placed, const Pose& room_from_head, bool is_new, double step_seconds) {
    darkness_ = std::max(darkness_ - step_seconds / kSeconds, 0.0);
    if (placed_ && (is_new || isJump(*placed_, placed, room_from_head))) { darkness_ = 1.0; }
    placed_ = placed;
}

}  // namespace binosplat
