// Computes how far the vignette is closed.
#include "app/view/room/vignette.h"

#include "app/view/placement/view_eyes.h"
#include "xr/convert.h"

#include <algorithm>
#include <cmath>

namespace binosplat {

namespace {

constexpr double kClosesInSeconds = 0.15, kOpensInSeconds = 0.3;
constexpr double kMargin = 1.05;          // for eyes to the side of the head's middle
constexpr double kLeastCosine = 0.1;      // for canted eyes, whose corners may look past the head's side
constexpr double kCorner = 1.4142135624;  // of a square, relative to its half width

// The half width of the square that both eyes see, at a distance of 1 straight ahead of the head.
double halfWidthSeen(const std::array<xr::EyeView, 2>& views) {
    std::array<Pose, 2> room_from_eyes{xr::fromXr(views[kLeft].pose), xr::fromXr(views[kRight].pose)};
    const glm::dquat head_from_room = glm::conjugate(roomFromHead(room_from_eyes).orientation);
    double widest = 0.0;
    for (std::size_t e = 0; e < 2; ++e) {
        const ViewAngles angles = xr::fromXr(views[e].fov);
        for (const double x_rad : {angles.left_rad, angles.right_rad}) {
            for (const double y_rad : {angles.up_rad, angles.down_rad}) {
                const glm::dvec3 corner = glm::normalize(head_from_room * room_from_eyes[e].orientation *
                                                         glm::dvec3(std::tan(x_rad), -std::tan(y_rad), 1.0));
                widest = std::max(widest, std::max(std::abs(corner.x), std::abs(corner.y)) /
                                              std::max(corner.z, kLeastCosine));
            }
        }
    }
    return widest;
}

}  // namespace

double coverMetres(const std::array<xr::EyeView, 2>& views) {
    return 2.0 * kVignetteMetres * kMargin * halfWidthSeen(views);
}

void Vignette::update(bool moves, double step_seconds) {
    closed_ = std::clamp(
        closed_ + (moves ? step_seconds / kClosesInSeconds : -step_seconds / kOpensInSeconds), 0.0, 1.0);
}

std::optional<double> Vignette::widthMetres(const std::array<xr::EyeView, 2>& views) const {
    if (closed_ == 0.0) { return std::nullopt; }
    constexpr double kOpen = kCorner / kVignetteClear;  // then everything visible is clear
    return coverMetres(views) * (kOpen + closed_ * (1.0 - kOpen));
}

}  // namespace binosplat
