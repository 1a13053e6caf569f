// The parametric surfaces behind shapes.h.
#include "engine/builtin/shapes.h"

#include "engine/builtin/noise.h"

#include <algorithm>
#include <cmath>

namespace binosplat::builtin {

namespace {

glm::vec3 turn(const glm::vec3& v, float yaw) {
    const float c = std::cos(yaw), s = std::sin(yaw);
    return {c * v.x + s * v.z, v.y, -s * v.x + c * v.z};
}

// Catmull-Rom through the profile's points.
glm::vec2 evaluateProfile(const std::vector<glm::vec2>& points, float v) {
    const auto last = static_cast<int>(points.size()) - 1;
    const float place = v * static_cast<float>(last);
    const int i = std::clamp(static_cast<int>(place), 0, last - 1);
    const float t = place - static_cast<float>(i);
    const auto at = [&](int k) { return points[static_cast<std::size_t>(std::clamp(k, 0, last))]; };
    const glm::vec2 p0 = at(i - 1), p1 = at(i), p2 = at(i + 1), p3 = at(i + 2);
    return 0.5f * (2.0f * p1 + t * (p2 - p0 +
                                    t * (2.0f * p0 - 5.0f * p1 + 4.0f * p2 - p3 +
                                         t * (3.0f * p1 - p0 - 3.0f * p2 + p3))));
}

}  // namespace

MaterialAt plain(const glm::vec3& albedo, float opacity) {
    return [=](const glm::vec3&, const glm::vec2&) { return Material{albedo, glm::vec3(0.0f), opacity}; };
}

void addQuad(Draft& draft, const Quad& quad, const MaterialAt& material, float detail) {
    Patch patch;
    patch.point = [quad](const glm::vec2& uv) { return quad.origin + uv.x * quad.a + uv.y * quad.b; };
    patch.material = material;
    patch.size_m = {glm::length(quad.a), glm::length(quad.b)};
    patch.detail = detail;
    patch.behind = [quad](const glm::vec3& point) { return 2.0f * point - quad.towards; };
    draft.add(std::move(patch));
}

void addQuadAround(Draft& draft, const Quad& quad, std::span<const glm::vec4> holes,
                   const MaterialAt& material, float detail) {
    // Strips between all upper and lower edges of holes, each cut at the holes it meets.
    std::vector<float> cuts{0.0f, 1.0f};
    for (const glm::vec4& hole : holes) {
        cuts.insert(cuts.end(), {std::clamp(hole.y, 0.0f, 1.0f), std::clamp(hole.w, 0.0f, 1.0f)});
    }
    std::sort(cuts.begin(), cuts.end());
    const auto addPart = [&](float u0, float v0, float u1, float v1) {
        if (u1 - u0 < 1e-5f || v1 - v0 < 1e-5f) { return; }
        addQuad(
            draft,
            {quad.origin + u0 * quad.a + v0 * quad.b, (u1 - u0) * quad.a, (v1 - v0) * quad.b, quad.towards},
            material, detail);
    };
    for (std::size_t strip = 0; strip + 1 < cuts.size(); ++strip) {
        const float v0 = cuts[strip], v1 = cuts[strip + 1], middle = 0.5f * (v0 + v1);
        std::vector<glm::vec4> here;
        for (const glm::vec4& hole : holes) {
            if (hole.y < middle && middle < hole.w) { here.push_back(hole); }
        }
        std::sort(here.begin(), here.end(), [](const glm::vec4& a, const glm::vec4& b) { return a.x < b.x; });
        float u = 0.0f;
        for (const glm::vec4& hole : here) {
            addPart(u, v0, std::clamp(hole.x, u, 1.0f), v1);
            u = std::clamp(hole.z, u, 1.0f);
        }
        addPart(u, v0, 1.0f, v1);
    }
}

void addBox(Draft& draft, const Box& box, const MaterialAt& material, float detail, bool occludes) {
    if (occludes) { draft.occluders().push_back({Occluder::Shape::kBox, box.centre, box.half, box.yaw_rad}); }
    const auto addFace = [&](const glm::vec3& normal, const glm::vec3& across, const glm::vec3& along) {
        const glm::vec3 n = turn(normal * box.half, box.yaw_rad), a = turn(across * box.half, box.yaw_rad),
                        b = turn(along * box.half, box.yaw_rad);
        addQuad(draft,
                {box.centre + n - a - b, 2.0f * a, 2.0f * b, box.centre + 100.0f * turn(normal, box.yaw_rad)},
                material, detail);
    };
    const glm::vec3 x(1.0f, 0.0f, 0.0f), y(0.0f, 1.0f, 0.0f), z(0.0f, 0.0f, 1.0f);
    addFace(-y, x, z);
    if (box.underside) { addFace(y, x, z); }
    for (const float sign : {-1.0f, 1.0f}) {
        addFace(sign * x, z, y);
        addFace(sign * z, x, y);
    }
}

void addCushion(Draft& draft, const Box& box, float boxiness, const MaterialAt& material, float detail,
                bool occludes) {
    if (occludes) {
        draft.occluders().push_back({Occluder::Shape::kEllipsoid, box.centre, 0.97f * box.half, box.yaw_rad});
    }
    Patch patch;
    patch.point = [=](const glm::vec2& uv) {
        // A direction, stretched until its norm of order `boxiness` is 1. (The usual superellipsoid formula
        // has no finite derivative there.)
        const float longitude = 2.0f * kPi * uv.x, latitude = kPi * (uv.y - 0.5f), ring = std::cos(latitude);
        const glm::vec3 d(ring * std::cos(longitude), std::sin(latitude), ring * std::sin(longitude));
        const glm::vec3 powers = glm::pow(glm::abs(d), glm::vec3(boxiness));
        return box.centre +
               turn(d * std::pow(powers.x + powers.y + powers.z, -1.0f / boxiness) * box.half, box.yaw_rad);
    };
    patch.material = material;
    patch.size_m = {4.0f * (box.half.x + box.half.z) * 0.75f, 2.0f * box.half.y + box.half.x + box.half.z};
    patch.detail = detail;
    patch.behind = [centre = box.centre](const glm::vec3&) { return centre; };
    draft.add(std::move(patch));
}

Patch& addRevolution(Draft& draft, const glm::vec3& foot, std::vector<glm::vec2> profile,
                     const MaterialAt& material, float detail) {
    float length = 0.0f, radius = 0.0f;
    for (std::size_t i = 0; i < profile.size(); ++i) {
        radius += profile[i].x / static_cast<float>(profile.size());
        if (i > 0) { length += glm::distance(profile[i], profile[i - 1]); }
    }
    Patch patch;
    patch.point = [foot, profile = std::move(profile)](const glm::vec2& uv) {
        const glm::vec2 at = evaluateProfile(profile, uv.y);
        const float angle = 2.0f * kPi * uv.x;
        return foot + glm::vec3(at.x * std::cos(angle), -at.y, at.x * std::sin(angle));
    };
    patch.material = material;
    patch.size_m = {2.0f * kPi * radius, length};
    patch.detail = detail;
    patch.behind = [foot](const glm::vec3& point) { return glm::vec3(foot.x, point.y, foot.z); };
    return draft.add(std::move(patch));
}

void addRod(Draft& draft, const glm::vec3& from, const glm::vec3& to, float radius,
            const MaterialAt& material, float detail) {
    const glm::vec3 axis = glm::normalize(to - from);
    const glm::vec3 side = glm::normalize(glm::cross(
        axis, std::abs(axis.x) < 0.9f ? glm::vec3(1.0f, 0.0f, 0.0f) : glm::vec3(0.0f, 0.0f, 1.0f)));
    const glm::vec3 other = glm::cross(axis, side);
    Patch patch;
    patch.point = [=](const glm::vec2& uv) {
        const float angle = 2.0f * kPi * uv.x;
        return glm::mix(from, to, uv.y) + radius * (std::cos(angle) * side + std::sin(angle) * other);
    };
    patch.material = material;
    patch.size_m = {2.0f * kPi * radius, glm::distance(from, to)};
    patch.detail = detail;
    patch.behind = [=](const glm::vec3& point) { return from + glm::dot(point - from, axis) * axis; };
    draft.add(std::move(patch));
}

void addLeaf(Draft& draft, const Leaf& leaf, const glm::vec3& albedo, float detail) {
    const glm::vec3 direction = glm::normalize(leaf.direction);
    const glm::vec3 side = glm::normalize(leaf.side - glm::dot(leaf.side, direction) * direction);
    const glm::vec3 up = glm::cross(side, direction);
    Patch patch;
    patch.point = [=](const glm::vec2& uv) {
        // u runs along the leaf, v across; the outline is widest at a third, and the two halves fold up a
        // little.
        const float t = uv.x, across = 2.0f * uv.y - 1.0f;
        const float outline =
            std::pow(std::max(std::sin(kPi * std::pow(0.02f + 0.96f * t, 0.8f)), 0.0f), 0.8f);
        const float reach = leaf.length * t * (1.0f - 0.25f * leaf.droop * t);
        return leaf.base + reach * direction + glm::vec3(0.0f, leaf.droop * leaf.length * t * t, 0.0f) +
               0.5f * leaf.width * outline * across * side +
               0.18f * leaf.width * outline * std::abs(across) * (up.y < 0.0f ? up : -up);
    };
    const std::uint32_t seed =
        hash(static_cast<std::uint32_t>(static_cast<std::int32_t>(leaf.base.x * 9173.0f)),
             static_cast<std::uint32_t>(static_cast<std::int32_t>(leaf.direction.y * 7919.0f)));
    const float tone = 0.8f + 0.4f * unitFloat(seed);
    patch.material = [=](const glm::vec3&, const glm::vec2& uv) {
        const float across = std::abs(2.0f * uv.y - 1.0f);
        const float rib = 1.0f - glm::smoothstep(0.0f, 0.10f, across);
        const float veins = 0.5f + 0.5f * std::sin(2.0f * kPi * (14.0f * uv.x - 3.0f * across));
        const glm::vec3 colour =
            albedo * tone * (0.88f + 0.16f * veins) + rib * glm::vec3(0.10f, 0.14f, 0.04f);
        return Material{colour, glm::vec3(0.0f), 0.96f};
    };
    patch.size_m = {leaf.length, 0.7f * leaf.width};
    patch.detail = detail;
    patch.two_sided = true;
    draft.add(std::move(patch));
}

}  // namespace binosplat::builtin
