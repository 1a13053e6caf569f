// Shapes made of patches: quads with holes, boxes, surfaces of revolution, cushions, leaves.
#pragma once

#include "engine/builtin/patch.h"

#include <glm/glm.hpp>

#include <span>
#include <vector>

namespace binosplat::builtin {

// A material of one colour.
MaterialAt plain(const glm::vec3& albedo, float opacity = 0.97f);

// The parallelogram origin + u a + v b, seen from the side of `towards`, a point in front of it, whichever
// way a x b points.
struct Quad {
    glm::vec3 origin, a, b, towards;
};
void addQuad(Draft& draft, const Quad& quad, const MaterialAt& material, float detail);

// The same without the rectangles `holes` (min u, min v, max u, max v in the quad's unit square): surfaces
// that lie on it would otherwise mix with it, since splats are sorted by their centres.
void addQuadAround(Draft& draft, const Quad& quad, std::span<const glm::vec4> holes,
                   const MaterialAt& material, float detail);

// A box turned by yaw about the vertical axis, and an occluder of the same shape.
struct Box {
    glm::vec3 centre, half;
    float yaw_rad = 0.0f;
    bool underside = false;
};
void addBox(Draft& draft, const Box& box, const MaterialAt& material, float detail, bool occludes = true);

// From an ellipsoid (boxiness 2) to a rounded box (6), and an occluder of the same shape.
void addCushion(Draft& draft, const Box& box, float boxiness, const MaterialAt& material, float detail,
                bool occludes = true);

// The profile (radius, height above `foot`) turned about the vertical axis; corners are smoothed.
Patch& addRevolution(Draft& draft, const glm::vec3& foot, std::vector<glm::vec2> profile,
                     const MaterialAt& material, float detail);

// A thin upright or slanted rod.
void addRod(Draft& draft, const glm::vec3& from, const glm::vec3& to, float radius,
            const MaterialAt& material, float detail);

// A leaf from `base` along `direction`, drooping by `droop` of its length, `width` across; `side` is the
// direction across.
struct Leaf {
    glm::vec3 base, direction, side;
    float length, width, droop;
};
void addLeaf(Draft& draft, const Leaf& leaf, const glm::vec3& albedo, float detail);

}  // namespace binosplat::builtin
