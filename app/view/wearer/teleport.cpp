// Computes the arc of a throw.
#include "app/view/wearer/teleport.h"

#include "app/view/placement/placement.h"
#include "app/view/wearer/sticks.h"

#include <cmath>
#include <utility>

namespace binosplat {

namespace {

constexpr double kThrowMetresPerSecond = 7.0, kFallMetresPerSecond2 = 9.8;
// Hands that aim move less than that.
constexpr double kPullMetres = 0.12;
constexpr double kTargetMetres = 0.5, kAboveFloorMetres = 0.01;

bool isBlocked(const PathSeen& path, const std::vector<glm::dvec3>& arc) {
    if (path.is_hidden || !path.meets || arc.empty()) { return path.is_hidden; }
    // The scene's own floor may be a little above the room's.
    return arc.back().y - pointAlong(arc, *path.meets / static_cast<double>(kProbePoints - 1)).y >
           kStepMetres;
}

}  // namespace

TeleportAim aimTeleport(const Pose& room_from_aim, double floor_m) {
    const glm::dvec3& from = room_from_aim.position;
    const double height_m = floor_m - from.y;
    if (!(height_m > 0.0)) { return {}; }
    const glm::dvec3 start = kThrowMetresPerSecond * (room_from_aim.orientation * glm::dvec3(0.0, 0.0, 1.0));
    const glm::dvec3 fall(0.0, kFallMetresPerSecond2, 0.0);
    // height = start.y t + fall t^2 / 2
    const double seconds =
        (-start.y + std::sqrt(start.y * start.y + 2.0 * kFallMetresPerSecond2 * height_m)) /
        kFallMetresPerSecond2;
    TeleportAim aim;
    constexpr std::size_t kLast = kArcPieces * kPointsOfPiece;
    for (std::size_t i = 0; i <= kLast; ++i) {
        const double t = seconds * static_cast<double>(i) / static_cast<double>(kLast);
        aim.arc.points.push_back(from + t * start + 0.5 * t * t * fall);
    }
    aim.target = aim.arc.points.back();
    return aim;
}

bool Teleport::aims(int h, const WearerNow& now, const PanelInRoom& panel, bool is_chosen) const {
    const xr::Hand& hand = now.hands[static_cast<std::size_t>(h)];
    if (!hand.aim || !(is_chosen || hand.is_bare)) { return false; }
    // While aiming, the ray may pass over the panel.
    const bool may_push = is_chosen && h == kLeft && (aiming_ == h || !panel.isPointedAtBy(h));
    const bool pushed = may_push && hand.stick.y > (aiming_ == h ? kStickRests : kStickPushed);
    return pushed || (panel.clicksElsewhere(h) && !is_spent_[static_cast<std::size_t>(h)]);
}

bool Teleport::pullsAside(const WearerNow& now, ViewState& state) {
    const auto at = static_cast<std::size_t>(*aiming_);
    const glm::dvec3 right = glm::cross(glm::dvec3(0.0, 1.0, 0.0), levelAhead(now.room_from_head));
    const double aside_m = glm::dot(now.hands[at].aim->position - pinched_at_, right);
    if (!now.hands[at].is_bare || std::abs(aside_m) < kPullMetres) { return false; }
    state.place(
        turnedBy(state.sceneFromRoom(), std::copysign(kTurnRadians, -aside_m), now.room_from_head.position));
    return is_spent_[at] = true;
}

void Teleport::update(const WearerNow& now, const PanelInRoom& panel, ViewState& state) {
    const TeleportAim before = std::exchange(aim_, {});
    const bool is_chosen = state.settings().teleport;
    std::array<bool, 2> aim{};
    for (const int h : {kRight, kLeft}) {
        const auto at = static_cast<std::size_t>(h);
        is_spent_[at] = now.hands[at].clicks && (is_spent_[at] || now.measures);
        aim[at] = aims(h, now, panel, is_chosen);
    }
    if (aiming_ && !aim[static_cast<std::size_t>(*aiming_)]) {
        const auto at = static_cast<std::size_t>(*aiming_);
        // A hand that lost tracking did not let go.
        if (now.hands[at].aim && !is_spent_[at] && before.target && !before.arc.is_blocked) {
            glm::dvec3 step_m = *before.target - now.room_from_head.position;
            step_m.y = 0.0;
            state.place(movedBy(state.sceneFromRoom(), step_m));
        }
        aiming_.reset();
    }
    for (const int h : {kRight, kLeft}) {
        const auto at = static_cast<std::size_t>(h);
        if (aiming_ || !aim[at]) { continue; }
        aiming_ = h;
        pinched_at_ = now.hands[at].aim->position;
    }
    if (!aiming_) { return; }
    if (pullsAside(now, state)) {
        aiming_.reset();
        return;
    }
    const auto hand = static_cast<std::size_t>(*aiming_);
    aim_ = aimTeleport(*now.hands[hand].aim, now.floor_m.value_or(kUsualFloorMetres));
    aim_.arc.is_blocked = isBlocked(now.paths[hand], aim_.arc.points);
}

std::vector<Thing> Teleport::things(const glm::dvec3&) const {
    if (!aim_.target) { return {}; }
    const Strip end = lying(*aim_.target - glm::dvec3(0.0, kAboveFloorMetres, 0.0), kTargetMetres);
    return {{aim_.arc.is_blocked ? Sprite::kBlocked : Sprite::kTarget, end}};
}

}  // namespace binosplat
