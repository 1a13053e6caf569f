// Rays against the panel.
#include "app/view/overlay_panel.h"

#include <cmath>

namespace binosplat {

namespace {

constexpr double kScrolls = 0.5;  // of the stick
constexpr double kRayWidthMetres = 0.004;
// In front of the eyes: 27 degrees to the left, a little below, within arm's reach.
const glm::dvec3 kPlaceMetres(-0.45, 0.1, 0.9);
const glm::dvec3 kUp(0.0, -1.0, 0.0);

}  // namespace

OverlayPanel::OverlayPanel(glm::uvec2 size_px, double width_m)
    : size_px_(size_px), size_m_(width_m, width_m * static_cast<double>(size_px.y) / static_cast<double>(size_px.x)) {
    hangBefore({});
}

void OverlayPanel::hangBefore(const Pose& room_from_head) {
    const glm::dvec3 forward = room_from_head.orientation * glm::dvec3(0.0, 0.0, 1.0);
    const glm::dvec3 level(forward.x, 0.0, forward.z);
    const glm::dvec3 ahead = glm::length(level) > 1e-6 ? level : glm::dvec3(0.0, 0.0, 1.0);
    const Pose upright = lookAt(room_from_head.position, room_from_head.position + ahead, kUp);
    const glm::dvec3 place = transform(upright, kPlaceMetres);
    room_from_panel_ = lookAt(place, place + (place - room_from_head.position), kUp);
}

std::optional<OverlayPanel::Hit> OverlayPanel::meet(const Pose& room_from_aim) const {
    const Pose panel_from_aim = compose(inverse(room_from_panel_), room_from_aim);
    const glm::dvec3 direction = panel_from_aim.orientation * glm::dvec3(0.0, 0.0, 1.0), &from = panel_from_aim.position;
    if (direction.z < 1e-3 || from.z >= 0.0) { return std::nullopt; }  // from behind, or alongside
    const double distance = -from.z / direction.z;
    const glm::dvec2 share = glm::dvec2(from + distance * direction) / size_m_ + 0.5;
    if (share.x < 0.0 || share.y < 0.0 || share.x > 1.0 || share.y > 1.0) { return std::nullopt; }
    return Hit{share * size_px_, distance};
}

void OverlayPanel::update(const std::array<xr::Hand, 2>& hands) {
    pointer_ = {};
    pointing_.reset();
    pulse_.reset();
    std::optional<int> hits;
    if (carrier_) {
        const xr::Hand& hand = hands[static_cast<std::size_t>(*carrier_)];
        if (hand.grabs && hand.aim) {
            room_from_panel_ = compose(*hand.aim, hand_from_panel_);
        } else {
            carrier_.reset();
        }
    }
    for (const int h : {kRight, kLeft}) {
        const xr::Hand& hand = hands[static_cast<std::size_t>(h)];
        const bool squeezes = hand.grabs, begins = squeezes && !squeezed_[static_cast<std::size_t>(h)];
        squeezed_[static_cast<std::size_t>(h)] = squeezes;
        if (!hand.aim || pointing_) { continue; }
        const std::optional<Hit> hit = meet(*hand.aim);
        if (!hit) { continue; }
        if (begins && !carrier_) {
            carrier_ = h;
            hand_from_panel_ = compose(inverse(*hand.aim), room_from_panel_);
        }
        pointing_ = hand.aim;
        distance_m_ = hit->distance_m;
        pointer_ = {hit->place_px, hand.clicks, std::abs(hand.stick.y) > kScrolls ? 0.2 * hand.stick.y : 0.0};
        hits = h;
        if (hit_by_ != h || (hand.clicks && !clicked_)) { pulse_ = h; }
    }
    hit_by_ = hits;
    clicked_ = pointer_.pressed;
}

std::optional<OverlayPanel::Ray> OverlayPanel::ray(const Pose& room_from_head) const {
    if (!pointing_) { return std::nullopt; }
    const glm::dvec3 along = pointing_->orientation * glm::dvec3(0.0, 0.0, 1.0);
    const glm::dvec3 middle = pointing_->position + 0.5 * distance_m_ * along;
    // The strip's z points away from the eyes, as near to that as a direction across the ray can.
    glm::dvec3 away = middle - room_from_head.position;
    away -= glm::dot(away, along) * along;
    if (glm::length(away) < 1e-6) { return std::nullopt; }
    const glm::dvec3 right = glm::cross(along, glm::normalize(away));
    const glm::dmat3 room_from_strip(right, along, glm::normalize(away));
    return Ray{{glm::normalize(glm::quat_cast(room_from_strip)), middle}, {kRayWidthMetres, distance_m_}};
}

}  // namespace binosplat
