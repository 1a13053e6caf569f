// Places the scene around the wearer.
#include "app/view/placement/placement.h"

#include <algorithm>
#include <cmath>

namespace binosplat {

namespace {

const glm::dvec3 kDown(0.0, 1.0, 0.0);
// Hands closer together than this say nothing about size; if their horizontal distance is less, they say
// nothing about direction.
constexpr double kLeastSpanMetres = 0.02;
constexpr double kLeastScale = 1e-6, kMostScale = 1e6;

// About the vertical axis; a positive turn is to the right.
glm::dquat turnAboutDown(double angle_rad) { return glm::angleAxis(angle_rad, kDown); }

// `turn` and `growth` map the new room to the old one; `about` stays in place.
Similarity turnedAndGrown(const Similarity& scene_from_room, const glm::dquat& turn, double growth,
                          const glm::dvec3& about) {
    return compose(scene_from_room, {turn, about - growth * (turn * about), growth});
}

// The shortest turn that brings `from` into the direction of `to`.
glm::dquat turnBetween(const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 a = glm::normalize(from), b = glm::normalize(to);
    const double cosine = glm::dot(a, b);
    if (cosine > -0.999999) { return glm::normalize(glm::dquat(1.0 + cosine, glm::cross(a, b))); }
    // Half a turn, about any perpendicular axis.
    const glm::dvec3 across =
        glm::cross(a, std::abs(a.x) < 0.7 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 0.0, 1.0));
    return glm::angleAxis(3.14159265358979323846, glm::normalize(across));
}

// Of a horizontal direction: 0 ahead, positive to the right.
double headingOf(const glm::dvec3& direction) { return std::atan2(direction.x, direction.z); }

}  // namespace

Similarity startPlacement(const View& view, double metres_per_unit) {
    const Pose looking = lookAt(view.eye, view.look, view.up);
    // The wearer stands upright: gravity is opposite to `up`, whatever the view's tilt.
    const glm::dvec3 up = glm::normalize(view.up), forward = view.look - view.eye;
    const glm::dvec3 level = forward - glm::dot(forward, up) * up;
    return {lookAt(glm::dvec3(0.0),
                   glm::length(level) > 0.0 ? level : looking.orientation * glm::dvec3(0.0, 0.0, 1.0), up)
                .orientation,
            view.eye, 1.0 / metres_per_unit};
}

double growthToSee(const View& view, double metres_per_unit) {
    constexpr double kNearestMetres = 0.5, kMostGrowth = 1000.0;
    return std::clamp(kNearestMetres / (metres_per_unit * glm::distance(view.eye, view.look)), 1.0,
                      kMostGrowth);
}

Similarity movedBy(const Similarity& scene_from_room, const glm::dvec3& step_m) {
    return compose(scene_from_room, {glm::dquat(1.0, 0.0, 0.0, 0.0), step_m, 1.0});
}

Similarity turnedBy(const Similarity& scene_from_room, double angle_rad, const glm::dvec3& about) {
    return turnedAndGrown(scene_from_room, turnAboutDown(angle_rad), 1.0, about);
}

Similarity grownBy(const Similarity& scene_from_room, double growth, const glm::dvec3& about) {
    const double old_from_new =
        std::clamp(scene_from_room.scale / growth, kLeastScale, kMostScale) / scene_from_room.scale;
    return turnedAndGrown(scene_from_room, glm::dquat(1.0, 0.0, 0.0, 0.0), old_from_new, about);
}

Similarity tiltedBy(const Similarity& scene_from_room, const glm::dquat& turn, const glm::dvec3& about) {
    return turnedAndGrown(scene_from_room, glm::conjugate(turn), 1.0, about);
}

Similarity heldBy(const Similarity& scene_from_room, const std::array<glm::dvec3, 2>& from,
                  const std::array<glm::dvec3, 2>& to, bool tilted) {
    const glm::dvec3 span_from = from[1] - from[0], span_to = to[1] - to[0];
    const auto level = [](const glm::dvec3& v) { return glm::dvec3(v.x, 0.0, v.z); };
    const auto areApart = [](const glm::dvec3& a, const glm::dvec3& b) {
        return std::min(glm::length(a), glm::length(b)) > kLeastSpanMetres;
    };
    const bool has_size = areApart(span_from, span_to);
    double growth = has_size ? glm::length(span_from) / glm::length(span_to) : 1.0;
    const double turn =
        areApart(level(span_from), level(span_to)) ? headingOf(span_from) - headingOf(span_to) : 0.0;
    growth = std::clamp(scene_from_room.scale * growth, kLeastScale, kMostScale) / scene_from_room.scale;
    // From the new room to the old one: `to` must be where `from` was.
    const glm::dquat old_from_new =
        tilted && has_size ? turnBetween(span_to, span_from) : turnAboutDown(turn);
    const glm::dvec3 middle_from = 0.5 * (from[0] + from[1]), middle_to = 0.5 * (to[0] + to[1]);
    return compose(scene_from_room,
                   {old_from_new, middle_from - growth * (old_from_new * middle_to), growth});
}

Similarity levelledAlong(const Similarity& scene_from_room, const glm::dvec3& up, const glm::dvec3& about) {
    const glm::dquat scene_from_tilted = turnBetween(scene_from_room.orientation * kDown, -up);
    const glm::dvec3 fixed = transform(scene_from_room, about);
    Similarity level{glm::normalize(scene_from_tilted * scene_from_room.orientation), glm::dvec3(0.0),
                     scene_from_room.scale};
    level.position = fixed - transform(level, about);
    return level;
}

glm::dvec3 levelAhead(const Pose& room_from_head) {
    const glm::dvec3 forward = room_from_head.orientation * glm::dvec3(0.0, 0.0, 1.0),
                     level(forward.x, 0.0, forward.z);
    return glm::length(level) > 1e-6 ? glm::normalize(level) : glm::dvec3(0.0, 0.0, 1.0);
}

}  // namespace binosplat
