// Baked light of a box-shaped room with one window in its far wall: sky light through the window, sun, one
// bounce with darkening near other surfaces, and a lamp. Linear radiance, arbitrary units in which a sunlit
// white wall is about 1.
#pragma once

#include <glm/glm.hpp>

#include <numbers>
#include <optional>
#include <vector>

namespace binosplat::builtin {

inline constexpr float kPi = std::numbers::pi_v<float>;

// Occluders of light: boxes (turned about the vertical) and ellipsoids (upright).
struct Occluder {
    enum class Shape { kBox, kEllipsoid };
    Occluder(Shape shape, const glm::vec3& centre, const glm::vec3& half, float yaw_rad);
    Shape shape;
    glm::vec3 centre, inverse_half;
    float cosine, sine;  // of the yaw
    float bounding_radius;
};

struct Room {
    glm::vec3 min{-3.0f, -2.8f, 0.0f}, max{3.0f, 0.0f, 5.0f};       // y down: min.y is the ceiling
    glm::vec2 window_min{-1.9f, -2.35f}, window_max{0.9f, -0.75f};  // x, y on the wall z = max.z
    glm::vec2 window_panes{3.0f, 2.0f};
    glm::vec3 to_sun{-0.35f, -0.62f, 0.70f};
    glm::vec3 lamp{2.35f, -1.62f, 4.35f};
};

// Light falling on a point, by source; the sun's part is kept apart because its pattern (window bars) is
// finer than the grid.
struct Light {
    glm::vec3 diffuse{0.0f};
    float sun = 0.0f;  // share of the sun not blocked by furniture, times the cosine
};
Light gatherLight(const Room& room, const std::vector<Occluder>& occluders, const glm::vec3& point,
                  const glm::vec3& normal);

// The share of sunlight that the window lets through to `point`, with bars and penumbra.
float sunThroughWindow(const Room& room, const glm::vec3& point);
glm::vec3 sunColour();

// Display-encoded colour of linear radiance: a soft shoulder, then a gamma of 2.2.
glm::vec3 encode(const glm::vec3& linear);

}  // namespace binosplat::builtin
