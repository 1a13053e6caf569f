// What was seen ahead is remembered until one stands there, since nobody looks at their feet.
#include "app/view/wearer/follow_ground.h"

#include "app/view/placement/placement.h"
#include "app/view/wearer/sticks.h"

#include <algorithm>
#include <cmath>

namespace binosplat {

namespace {

constexpr double kCellMetres = 0.15, kReachMetres = 0.25;
constexpr std::size_t kMostCells = 4096;
// Two thirds of the way within so many seconds, and never faster than this.
constexpr double kSmoothSeconds = 0.15, kMostMetresPerSecond = 1.5;

bool isHeldByHand(const WearerNow& now, const PanelInRoom& panel) {
    const glm::dvec2& stick = now.hands[kRight].stick;
    const bool rises =
        std::abs(stick.y) > std::max(std::abs(stick.x), kStickDeadZone) && !panel.isPointedAtBy(kRight);
    return rises || now.hands[kLeft].grabs || now.hands[kRight].grabs;
}

// Below the wearer, as the room's y.
std::optional<double> floorMetres(const WearerNow& now, const Similarity& scene_from_room) {
    if (!now.scene_floor) { return std::nullopt; }
    const glm::dvec3& head = now.room_from_head.position;
    return head.y +
           (glm::dot(now.scene_floor->up, transform(scene_from_room, head)) - now.scene_floor->height) /
               scene_from_room.scale;
}

}  // namespace

ProbePath groundAhead(const Pose& room_from_head, double feet_m) {
    static constexpr std::array kAheadMetres{0.0, 0.4, 0.8, 1.1, 1.4, 1.8, 2.3, 3.0};
    static constexpr std::array kAsideMetres{-0.2, 0.0, 0.2};
    static_assert(kAheadMetres.size() * kAsideMetres.size() == kProbePoints);
    const glm::dvec3 ahead = levelAhead(room_from_head), aside(ahead.z, 0.0, -ahead.x);
    const glm::dvec3 feet(room_from_head.position.x, feet_m, room_from_head.position.z);
    ProbePath path;
    for (std::size_t i = 0; i < kProbePoints; ++i) {
        path[i] = feet + kAheadMetres[i / kAsideMetres.size()] * ahead +
                  kAsideMetres[i % kAsideMetres.size()] * aside;
    }
    return path;
}

void FollowGround::remember(const std::vector<glm::dvec3>& ground_scene, double units_per_metre) {
    if (std::abs(std::log(units_per_metre / units_per_metre_)) > 0.01 || seen_.size() > kMostCells) {
        seen_.clear();
        units_per_metre_ = units_per_metre;
    }
    for (const glm::dvec3& point : ground_scene) {
        const glm::ivec3 cell(glm::floor(point / (kCellMetres * units_per_metre_)));
        seen_[{cell.x, cell.y, cell.z}] = point;
    }
}

std::optional<double> FollowGround::groundAt(const glm::dvec3& feet,
                                             const Similarity& scene_from_room) const {
    std::vector<double> heights_m;
    const Similarity room_from_scene = inverse(scene_from_room);
    for (const auto& [cell, point] : seen_) {
        const glm::dvec3 from_feet = transform(room_from_scene, point) - feet;
        if (std::hypot(from_feet.x, from_feet.z) > kReachMetres || std::abs(from_feet.y) > kStepMetres) {
            continue;
        }
        heights_m.push_back(feet.y + from_feet.y);
    }
    if (heights_m.empty()) { return std::nullopt; }
    const auto middle = heights_m.begin() + static_cast<std::ptrdiff_t>(heights_m.size() / 2);
    std::ranges::nth_element(heights_m, middle);
    return *middle;
}

void FollowGround::update(const WearerNow& now, const PanelInRoom& panel, ViewState& state) {
    if (!state.settings().follow_ground) { return seen_.clear(); }
    remember(now.ground_scene, state.sceneFromRoom().scale);
    if (now.hands[kLeft].grabs || now.hands[kRight].grabs) { return; }
    const glm::dvec3& head = now.room_from_head.position;
    const glm::dvec3 feet(head.x, now.floor_m.value_or(kUsualFloorMetres), head.z);
    const std::optional<double> floor_m = floorMetres(now, state.sceneFromRoom());
    double step_m = 0.0;  // downwards
    if (!isHeldByHand(now, panel)) {
        std::optional<double> ground_m = groundAt(feet, state.sceneFromRoom());
        const bool is_near_floor = floor_m && std::abs(*floor_m - feet.y) <= kStepMetres;
        if (!ground_m && is_near_floor) { ground_m = floor_m; }
        const double most_m = kMostMetresPerSecond * now.step_seconds;
        const double share = 1.0 - std::exp(-now.step_seconds / kSmoothSeconds);
        if (ground_m) { step_m = std::clamp(share * (*ground_m - feet.y), -most_m, most_m); }
    }
    if (floor_m) { step_m = std::min(step_m, *floor_m - feet.y); }
    if (step_m != 0.0) { state.place(movedBy(state.sceneFromRoom(), {0.0, step_m, 0.0})); }
}

}  // namespace binosplat
