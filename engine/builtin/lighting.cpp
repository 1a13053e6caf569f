// Casts rays against a few dozen boxes and ellipsoids; the sample patterns are fixed, so the result is smooth
// in the point.
#include "engine/builtin/lighting.h"

#include "engine/builtin/noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace binosplat::builtin {

namespace {

constexpr float kFar = 1e9f;

// The distance at which a ray enters the occluder; kFar if it misses or starts inside (a surface does not
// shade itself).
float hitDistance(const Occluder& occluder, const glm::vec3& origin, const glm::vec3& direction) {
    const glm::vec3 to_centre = occluder.centre - origin;
    const float radius = occluder.bounding_radius, nearest = glm::dot(to_centre, direction);
    if (nearest < -radius || glm::dot(to_centre, to_centre) - nearest * nearest > radius * radius) {
        return kFar;
    }
    const float c = occluder.cosine, s = occluder.sine;
    const auto turn = [&](const glm::vec3& v) {
        return glm::vec3(c * v.x - s * v.z, v.y, s * v.x + c * v.z) * occluder.inverse_half;
    };
    const glm::vec3 o = turn(-to_centre), d = turn(direction);
    if (occluder.shape == Occluder::Shape::kEllipsoid) {
        const float a = glm::dot(d, d), b = glm::dot(o, d), e = glm::dot(o, o) - 1.0f;
        if (e < 0.0f || b >= 0.0f) { return kFar; }
        const float discriminant = b * b - a * e;
        return discriminant < 0.0f ? kFar : (-b - std::sqrt(discriminant)) / a;
    }
    const glm::vec3 size = glm::abs(o);
    if (size.x < 1.0f && size.y < 1.0f && size.z < 1.0f) { return kFar; }
    float enter = 0.0f, leave = kFar;
    for (int axis = 0; axis < 3; ++axis) {
        const float inverse = 1.0f / (std::abs(d[axis]) > 1e-12f ? d[axis] : 1e-12f);
        const float t0 = (-1.0f - o[axis]) * inverse, t1 = (1.0f - o[axis]) * inverse;
        enter = std::max(enter, std::min(t0, t1));
        leave = std::min(leave, std::max(t0, t1));
    }
    return enter < leave && enter > 0.0f ? enter : kFar;
}

// The occluders that rays within a cone can meet, by their bounding spheres. From most points there are few
// of them in any one direction.
using Nearby = std::vector<const Occluder*>;

Nearby selectInCone(const std::vector<Occluder>& occluders, const glm::vec3& origin, const glm::vec3& axis,
                    float cosine) {
    const float sine = std::sqrt(std::max(0.0f, 1.0f - cosine * cosine));
    Nearby nearby;
    for (const Occluder& occluder : occluders) {
        // The sphere fills the angle asin(radius / distance); it is outside if the angle to its centre is
        // larger than both together.
        const glm::vec3 to_centre = occluder.centre - origin;
        const float distance = glm::length(to_centre),
                    share = std::min(1.0f, occluder.bounding_radius / std::max(distance, 1e-6f));
        const float limit = cosine * std::sqrt(1.0f - share * share) - sine * share;
        // Beyond half a turn the sum of the two angles has no larger cosine to compare with.
        const bool everywhere = share >= 1.0f || (cosine < 0.0f && -cosine > std::sqrt(1.0f - share * share));
        if (everywhere || glm::dot(to_centre, axis) >= distance * limit) { nearby.push_back(&occluder); }
    }
    return nearby;
}

float nearestHit(const Nearby& occluders, const glm::vec3& origin, const glm::vec3& direction, float limit) {
    for (const Occluder* occluder : occluders) {
        limit = std::min(limit, hitDistance(*occluder, origin, direction));
    }
    return limit;
}

bool isBlocked(const Nearby& occluders, const glm::vec3& origin, const glm::vec3& direction, float limit) {
    return std::any_of(occluders.begin(), occluders.end(), [&](const Occluder* occluder) {
        return hitDistance(*occluder, origin, direction) < limit;
    });
}

// Bounced light from the room's own surfaces, by the wall on which a ray ends.
glm::vec3 bounceColour(const Room& room, const glm::vec3& end) {
    const float depth = (end.z - room.min.z) / (room.max.z - room.min.z);  // brighter towards the window
    const float level = 0.18f + 0.15f * depth;
    if (end.y > room.max.y - 0.01f) { return level * glm::vec3(1.0f, 0.78f, 0.56f); }
    if (end.y < room.min.y + 0.01f) { return level * glm::vec3(1.08f, 1.05f, 1.0f); }
    return level * glm::vec3(0.98f, 0.98f, 0.93f);
}

float distanceToWall(const Room& room, const glm::vec3& origin, const glm::vec3& direction) {
    float distance = kFar;
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(direction[axis]) < 1e-9f) { continue; }
        const float wall = direction[axis] > 0.0f ? room.max[axis] : room.min[axis];
        distance = std::min(distance, std::max(0.0f, (wall - origin[axis]) / direction[axis]));
    }
    return distance;
}

// Sky light through the window, from a grid of points on it; the upper part is sky, the lower part hills.
glm::vec3 gatherWindow(const Room& room, const std::vector<Occluder>& all_occluders, const glm::vec3& point,
                       const glm::vec3& normal) {
    constexpr int kColumns = 10, kRows = 6;
    const glm::vec2 extent = room.window_max - room.window_min;
    const glm::vec3 axis =
        glm::normalize(glm::vec3(0.5f * (room.window_min + room.window_max), room.max.z) - point);
    float cosine_of_window = 1.0f;
    for (const glm::vec2& corner :
         {room.window_min, room.window_max, glm::vec2(room.window_min.x, room.window_max.y),
          glm::vec2(room.window_max.x, room.window_min.y)}) {
        cosine_of_window =
            std::min(cosine_of_window, glm::dot(axis, glm::normalize(glm::vec3(corner, room.max.z) - point)));
    }
    const Nearby occluders = selectInCone(all_occluders, point, axis, cosine_of_window);
    const float cell_area = extent.x * extent.y / (kColumns * kRows);
    glm::vec3 sum(0.0f);
    for (int row = 0; row < kRows; ++row) {
        for (int column = 0; column < kColumns; ++column) {
            // Rows are shifted against each other so that the samples' shadows do not line up.
            const float shift = 0.5f + 0.3f * static_cast<float>((row * 2) % 5 - 2) / 2.0f;
            const glm::vec2 share((static_cast<float>(column) + shift) / kColumns,
                                  (static_cast<float>(row) + 0.5f) / kRows);
            const glm::vec3 target(room.window_min + share * extent, room.max.z);
            const glm::vec3 offset = target - point;
            const float square = std::max(glm::dot(offset, offset), 0.04f), length = std::sqrt(square);
            const glm::vec3 direction = offset / length;
            const float cosine = glm::dot(direction, normal), window_cosine = direction.z;
            if (cosine <= 0.0f || window_cosine <= 0.0f || isBlocked(occluders, point, direction, length)) {
                continue;
            }
            const glm::vec3 radiance = glm::mix(glm::vec3(3.3f, 3.7f, 4.3f), glm::vec3(1.5f, 1.5f, 1.2f),
                                                glm::smoothstep(0.3f, 0.8f, share.y));
            sum += radiance * (cosine * window_cosine * cell_area / (square * kPi));
        }
    }
    return sum;
}

// One bounce of cosine-distributed rays. Near surfaces are dark themselves, which darkens corners and
// contacts.
glm::vec3 gatherBounce(const Room& room, const std::vector<Occluder>& all_occluders, const glm::vec3& point,
                       const glm::vec3& normal) {
    constexpr int kRays = 48;
    const Nearby occluders = selectInCone(all_occluders, point, normal, 0.0f);
    const glm::vec3 not_parallel =
        std::abs(normal.y) < 0.9f ? glm::vec3(0.0f, 1.0f, 0.0f) : glm::vec3(1.0f, 0.0f, 0.0f);
    const glm::vec3 tangent = glm::normalize(glm::cross(not_parallel, normal)),
                    bitangent = glm::cross(normal, tangent);
    glm::vec3 sum(0.0f);
    for (int i = 0; i < kRays; ++i) {
        const float radius_square = (static_cast<float>(i) + 0.5f) / kRays,
                    angle = 2.39996323f * static_cast<float>(i);
        const float radius = std::sqrt(radius_square);
        const glm::vec3 direction = radius * (std::cos(angle) * tangent + std::sin(angle) * bitangent) +
                                    std::sqrt(1.0f - radius_square) * normal;
        const float wall = distanceToWall(room, point, direction);
        const float distance = nearestHit(occluders, point, direction, wall);
        const glm::vec3 colour =
            distance < wall ? glm::vec3(0.15f, 0.135f, 0.115f) : bounceColour(room, point + wall * direction);
        sum += colour * (distance / (distance + 0.3f));
    }
    return sum / static_cast<float>(kRays);
}

}  // namespace

Occluder::Occluder(Shape shape_in, const glm::vec3& centre_in, const glm::vec3& half, float yaw_rad)
    : shape(shape_in),
      centre(centre_in),
      inverse_half(1.0f / half),
      cosine(std::cos(yaw_rad)),
      sine(std::sin(yaw_rad)),
      bounding_radius(glm::length(half)) {}

Light gatherLight(const Room& room, const std::vector<Occluder>& occluders, const glm::vec3& point,
                  const glm::vec3& normal) {
    const glm::vec3 origin = point + 0.012f * normal;
    Light light;
    light.diffuse =
        gatherWindow(room, occluders, origin, normal) + gatherBounce(room, occluders, origin, normal);

    // The lamp: four points within the shade, 11 cm from its middle at most.
    const glm::vec3 to_lamp = room.lamp - origin;
    const float lamp_share = std::min(1.0f, 0.12f / glm::length(to_lamp));
    const Nearby before_lamp =
        selectInCone(occluders, origin, glm::normalize(to_lamp), std::sqrt(1.0f - lamp_share * lamp_share));
    for (int i = 0; i < 4; ++i) {
        const glm::vec3 offset = room.lamp +
                                 glm::vec3(0.08f * (static_cast<float>(i % 2) - 0.5f),
                                           0.07f * (static_cast<float>(i) - 1.5f), 0.0f) -
                                 origin;
        const float square = std::max(glm::dot(offset, offset), 0.03f), length = std::sqrt(square);
        const float cosine = glm::dot(offset, normal) / length;
        if (cosine <= 0.0f || isBlocked(before_lamp, origin, offset / length, length)) { continue; }
        light.diffuse += glm::vec3(0.26f, 0.17f, 0.08f) * (0.25f * cosine / (square + 0.15f));
    }

    // The sun is half a degree wide; a wider cone hides the grid of the light samples.
    const glm::vec3 sun = glm::normalize(room.to_sun);
    const float cosine = glm::dot(sun, normal);
    if (cosine > 0.0f) {
        constexpr int kRays = 9;
        const Nearby before_sun = selectInCone(occluders, origin, sun, 0.999f);
        int free = 0;
        for (int i = 0; i < kRays; ++i) {
            const float angle = 2.39996323f * static_cast<float>(i),
                        radius = 0.03f * std::sqrt((static_cast<float>(i) + 0.5f) / kRays);
            const glm::vec3 direction =
                glm::normalize(sun + glm::vec3(radius * std::cos(angle), radius * std::sin(angle), 0.0f));
            free += !isBlocked(before_sun, origin, direction, kFar);
        }
        light.sun = cosine * static_cast<float>(free) / kRays;
    }
    return light;
}

float sunThroughWindow(const Room& room, const glm::vec3& point) {
    const glm::vec3 sun = glm::normalize(room.to_sun);
    const float distance = (room.max.z - point.z) / sun.z;
    if (distance <= 0.0f) { return 1.0f; }
    const glm::vec2 at =
        (glm::vec2(point.x + distance * sun.x, point.y + distance * sun.y) - room.window_min) /
        (room.window_max - room.window_min) * room.window_panes;
    const glm::vec2 pane = glm::floor(at), within = at - pane;
    if (pane.x < 0.0f || pane.y < 0.0f || pane.x >= room.window_panes.x || pane.y >= room.window_panes.y) {
        return 0.0f;
    }
    // Bars take 3.5 cm on each side of a pane; the penumbra grows with the distance.
    const glm::vec2 pane_m = (room.window_max - room.window_min) / room.window_panes;
    const float soft = 0.006f + 0.006f * distance;
    const glm::vec2 edge = glm::min(within, 1.0f - within) * pane_m;
    return glm::smoothstep(0.035f - soft, 0.035f + soft, edge.x) *
           glm::smoothstep(0.035f - soft, 0.035f + soft, edge.y);
}

glm::vec3 sunColour() { return {2.6f, 2.15f, 1.55f}; }

glm::vec3 encode(const glm::vec3& linear) {
    const glm::vec3 shoulder = 1.0f - glm::exp(-1.35f * glm::max(linear, glm::vec3(0.0f)));
    return glm::pow(shoulder, glm::vec3(1.0f / 2.2f));
}

}  // namespace binosplat::builtin
