// Turning flat pictures towards the eyes.
#include "app/view/room/strips.h"

namespace binosplat {

namespace {

constexpr double kLeastMetres = 1e-6;
const glm::dvec3 kUpwards(0.0, -1.0, 0.0), kForwards(0.0, 0.0, 1.0);

}  // namespace

std::optional<Strip> stripBetween(const glm::dvec3& from, const glm::dvec3& to, double width_m,
                                  const glm::dvec3& eye) {
    const double length_m = glm::length(to - from);
    if (length_m < kLeastMetres) { return std::nullopt; }
    const glm::dvec3 along = (to - from) / length_m, middle = 0.5 * (from + to);
    // Its z points away from the eye, as far as a direction perpendicular to it can.
    glm::dvec3 away = middle - eye;
    away -= glm::dot(away, along) * along;
    if (glm::length(away) < kLeastMetres) { return std::nullopt; }
    away = glm::normalize(away);
    const glm::dmat3 room_from_strip(glm::cross(along, away), along, away);
    return Strip{{glm::normalize(glm::quat_cast(room_from_strip)), middle}, {width_m, length_m}};
}

Strip facing(const glm::dvec3& middle, const glm::dvec2& size_m, const glm::dvec3& eye) {
    const glm::dvec3 away = middle - eye;
    if (glm::length(away) < kLeastMetres) { return {{glm::dquat(1.0, 0.0, 0.0, 0.0), middle}, size_m}; }
    const bool is_steep = glm::length(glm::cross(glm::normalize(away), kUpwards)) < 0.05;
    return {lookAt(middle, middle + away, is_steep ? kForwards : kUpwards), size_m};
}

Strip lying(const glm::dvec3& middle, double width_m) {
    return {lookAt(middle, middle - kUpwards, kForwards), glm::dvec2(width_m)};
}

}  // namespace binosplat
