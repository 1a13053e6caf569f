// Intersects rays with the panel.
#include "app/view/room/panel_in_room.h"

#include "app/view/placement/placement.h"

#include <cmath>

namespace binosplat {

namespace {

constexpr double kScrolls = 0.5;  // of the stick
constexpr double kRayWidthMetres = 0.006, kFadingRayMetres = 0.4;
constexpr double kRingShare = 0.025;  // of its distance: a degree and a half
// In front of the eyes: 27 degrees to the left, a little below, within arm's reach.
const glm::dvec3 kPlaceMetres(-0.45, 0.1, 0.9);
const glm::dvec3 kUp(0.0, -1.0, 0.0);
// It hangs 27 degrees to the left: a wearer who looks far to the right is looking past it, one who has turned
// round has lost it.
constexpr double kUnseenRadians = 1.4, kFarMetres = 3.0, kUnseenSeconds = 1.5;

}  // namespace

PanelInRoom::PanelInRoom(glm::uvec2 size_px, double width_m)
    : size_px_(size_px),
      size_m_(width_m, width_m * static_cast<double>(size_px.y) / static_cast<double>(size_px.x)) {
    hangBefore({});
}

void PanelInRoom::hangBefore(const Pose& room_from_head) {
    const Pose upright =
        lookAt(room_from_head.position, room_from_head.position + levelAhead(room_from_head), kUp);
    const glm::dvec3 place = transform(upright, kPlaceMetres);
    room_from_panel_ = lookAt(place, place + (place - room_from_head.position), kUp);
}

void PanelInRoom::comeBefore(const Pose& room_from_head, double step_seconds) {
    const glm::dvec3 place = transform(inverse(room_from_head), room_from_panel_.position);
    const bool is_seen =
        place.z > std::cos(kUnseenRadians) * glm::length(place) && glm::length(place) < kFarMetres;
    unseen_seconds_ = is_seen || pointing_hand_ || carrier_ ? 0.0 : unseen_seconds_ + step_seconds;
    if (unseen_seconds_ < kUnseenSeconds) { return; }
    unseen_seconds_ = 0.0;
    hangBefore(room_from_head);
}

bool PanelInRoom::covers(const Pose& room_from_head, const glm::dvec3& place,
                         const glm::dvec2& size_m) const {
    const Pose head_from_panel = compose(inverse(room_from_head), room_from_panel_);
    glm::dvec2 least(1e9), most(-1e9);  // as seen at the rectangle's distance
    for (const glm::dvec2 corner : {glm::dvec2(-0.5, -0.5), {0.5, -0.5}, {-0.5, 0.5}, {0.5, 0.5}}) {
        const glm::dvec3 seen = transform(head_from_panel, glm::dvec3(corner * size_m_, 0.0));
        if (seen.z <= 0.0) { return false; }
        const glm::dvec2 at = glm::dvec2(seen) * (place.z / seen.z);
        least = glm::min(least, at);
        most = glm::max(most, at);
    }
    const glm::dvec2 middle(place);
    return glm::all(glm::lessThan(least, middle + 0.5 * size_m)) &&
           glm::all(glm::greaterThan(most, middle - 0.5 * size_m));
}

std::optional<PanelInRoom::Hit> PanelInRoom::meet(const Pose& room_from_aim) const {
    const Pose panel_from_aim = compose(inverse(room_from_panel_), room_from_aim);
    const glm::dvec3 direction = panel_from_aim.orientation * glm::dvec3(0.0, 0.0, 1.0),
                     &from = panel_from_aim.position;
    if (direction.z < 1e-3 || from.z >= 0.0) { return std::nullopt; }  // from behind, or alongside
    const double distance = -from.z / direction.z;
    const glm::dvec2 share = glm::dvec2(from + distance * direction) / size_m_ + 0.5;
    if (share.x < 0.0 || share.y < 0.0 || share.x > 1.0 || share.y > 1.0) { return std::nullopt; }
    return Hit{share * size_px_, distance};
}

void PanelInRoom::carry(const std::array<xr::Hand, 2>& hands, bool shown) {
    if (!carrier_) { return; }
    const xr::Hand& hand = hands[static_cast<std::size_t>(*carrier_)];
    if (shown && hand.grabs && hand.aim) {
        room_from_panel_ = compose(*hand.aim, hand_from_panel_);
    } else {
        carrier_.reset();
    }
}

void PanelInRoom::follow(const xr::Hand& hand, int h, bool shown) {
    HandNow& now = hands_[static_cast<std::size_t>(h)];
    const HandNow before = now;
    now = {};
    now.squeezes = hand.grabs;
    now.clicks = hand.clicks;
    if (hand.aim && (shown || hand.clicks)) { now.aim = hand.aim; }
    if (hand.aim && shown) { now.hit = meet(*hand.aim); }
    const bool begins_click = now.clicks && !before.clicks;
    now.clicks_here = now.clicks && (begins_click ? now.hit.has_value() : before.clicks_here);
    if (!now.hit) { return; }
    now.pulses = !before.hit || begins_click;
    if (begins_click) { clicked_last_ = h; }
    if (now.squeezes && !before.squeezes && !carrier_) {
        carrier_ = h;
        hand_from_panel_ = compose(inverse(*hand.aim), room_from_panel_);
    }
}

void PanelInRoom::update(const std::array<xr::Hand, 2>& hands, bool shown) {
    carry(hands, shown);
    for (const int h : {kLeft, kRight}) { follow(hands[static_cast<std::size_t>(h)], h, shown); }
    pointer_ = {};
    pointing_hand_.reset();
    const int pointer = of(clicked_last_).hit ? clicked_last_ : 1 - clicked_last_;
    if (!of(pointer).hit) { return; }
    pointing_hand_ = pointer;
    const double scroll = hands[static_cast<std::size_t>(pointer)].stick.y;
    pointer_ = {of(pointer).hit->place_px, of(pointer).clicks_here,
                std::abs(scroll) > kScrolls ? 0.2 * scroll : 0.0};
}

std::vector<Thing> PanelInRoom::rays(const glm::dvec3& eye, std::optional<int> without,
                                     const std::array<std::optional<double>, 2>& meets_m) const {
    std::vector<Thing> rays;
    for (const int h : {kLeft, kRight}) {
        const HandNow& hand = of(h);
        if (!hand.aim || without == h) { continue; }
        const double length_m = hand.hit ? hand.hit->distance_m : kFadingRayMetres;
        const glm::dvec3 end = transform(*hand.aim, glm::dvec3(0.0, 0.0, length_m));
        if (const auto strip = stripBetween(hand.aim->position, end, kRayWidthMetres, eye)) {
            rays.push_back({hand.hit ? Sprite::kRay : Sprite::kFadingRay, *strip});
        }
        const std::optional<double>& met_m = meets_m[static_cast<std::size_t>(h)];
        if (hand.hit || !met_m) { continue; }
        // The same apparent size wherever it is.
        const glm::dvec3 place = transform(*hand.aim, glm::dvec3(0.0, 0.0, *met_m));
        rays.push_back(
            {Sprite::kRing, facing(place, glm::dvec2(kRingShare * glm::distance(place, eye)), eye)});
    }
    return rays;
}

}  // namespace binosplat
