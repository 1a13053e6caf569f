// The view from the window: a meadow, rows of hills into the haze, trees, and the sky. Unlit: colours are
// painted with the light in them.
#include "engine/builtin/atelier.h"
#include "engine/builtin/noise.h"

#include <cmath>

namespace binosplat::builtin {

namespace {

const glm::vec3 kHaze(0.62f, 0.74f, 0.86f);
const glm::vec3 kEye(0.0f, -1.5f, 1.0f);  // about where the window is seen from

// The far side of a room needs splats by the angle it fills, not by its area: this many per square metre of
// window, seen from 4 m.
float detailFor(float seen_from_m, float window_detail) {
    return window_detail * 16.0f / (seen_from_m * seen_from_m);
}

// Height of a ridge above the eye's level, at an angle from straight ahead.
float ridgeHeight(float angle, float distance, std::uint32_t seed) {
    const float broad = fractalNoise({angle * 3.1f + 9.0f, 0.5f}, seed),
                fine = fractalNoise({angle * 14.0f, 3.5f}, seed + 7u);
    return distance * (0.16f * (broad - 0.42f) + 0.025f * (fine - 0.5f));
}

struct Ridge {
    float distance, lift;  // metres; lift: the share of the distance by which the ridge is raised
    glm::vec3 colour;
    std::uint32_t seed;
};

// A band from below the view up to the ridge line, leaning back so that nearer bands hide the feet of farther
// ones.
void addRidge(Draft& draft, const Ridge& ridge) {
    Patch patch;
    const float half_angle = 0.85f;
    patch.point = [=](const glm::vec2& uv) {
        const float angle = half_angle * (2.0f * uv.x - 1.0f), up = 1.0f - uv.y;
        const float top = ridgeHeight(angle, ridge.distance, ridge.seed) + ridge.lift * ridge.distance;
        const float bottom = -0.11f * ridge.distance;
        const float distance = ridge.distance * (0.85f + 0.3f * up);
        return kEye + glm::vec3(distance * std::sin(angle), -(bottom + (top - bottom) * up),
                                distance * std::cos(angle));
    };
    const float haze = 1.0f - std::exp(-ridge.distance / 560.0f);
    patch.material = [=](const glm::vec3& p, const glm::vec2& uv) {
        const glm::vec2 at = glm::vec2(p.x, p.y * 2.5f - p.z) / ridge.distance;
        const float fields = fractalNoise(at * 13.0f, ridge.seed + 31u),
                    woods = glm::smoothstep(0.50f, 0.58f, fractalNoise(at * 21.0f, ridge.seed + 53u));
        glm::vec3 colour = ridge.colour * (0.7f + 0.6f * fields);
        colour =
            glm::mix(colour, 0.45f * glm::vec3(0.10f, 0.17f, 0.07f) + 0.15f * ridge.colour, 0.8f * woods);
        const float light =
            0.75f + 0.5f * fractalNoise(glm::vec2(at.x * 5.0f + 3.0f, uv.y * 2.0f), ridge.seed + 77u) -
            0.2f * uv.y;
        return Material{glm::vec3(0.0f), glm::mix(1.25f * colour * light, kHaze, haze), 0.98f};
    };
    patch.size_m = {2.0f * half_angle * ridge.distance, 0.22f * ridge.distance};
    patch.detail = detailFor(ridge.distance, 1.1f);
    patch.lit = false;
    draft.add(std::move(patch));
}

void addMeadow(Draft& draft) {
    Patch patch;
    patch.point = [](const glm::vec2& uv) {
        const float z = 6.0f * std::pow(45.0f / 6.0f, uv.y), x = z * (2.0f * uv.x - 1.0f);
        const float bump = 0.6f * (fractalNoise({x * 0.12f, z * 0.12f}, 91u) - 0.5f);
        return glm::vec3(x, 1.1f + 0.035f * (z - 6.0f) - bump, z);
    };
    patch.material = [](const glm::vec3& p, const glm::vec2&) {
        const float tufts = fractalNoise({p.x * 1.6f, p.z * 0.9f}, 92u),
                    flowers = glm::smoothstep(0.70f, 0.76f, fractalNoise({p.x * 4.0f, p.z * 3.0f}, 93u));
        glm::vec3 colour = glm::mix(glm::vec3(0.16f, 0.27f, 0.07f), glm::vec3(0.46f, 0.50f, 0.16f), tufts);
        colour = glm::mix(colour, glm::vec3(0.85f, 0.72f, 0.35f), 0.6f * flowers);
        return Material{glm::vec3(0.0f), glm::mix(colour, kHaze, 1.0f - std::exp(-p.z / 600.0f)), 0.98f};
    };
    patch.size_m = {30.0f, 40.0f};
    patch.detail = detailFor(13.0f, 0.12f);
    patch.lit = false;
    draft.add(std::move(patch));
}

// One ball of leaves, darker below.
void addFoliage(Draft& draft, const glm::vec3& centre, float radius, std::uint32_t seed) {
    const float distance = glm::distance(centre, kEye);
    Patch crown;
    crown.point = [=](const glm::vec2& uv) {
        const float longitude = 2.0f * kPi * uv.x, latitude = kPi * (uv.y - 0.5f);
        const glm::vec3 unit(std::cos(latitude) * std::cos(longitude), std::sin(latitude),
                             std::cos(latitude) * std::sin(longitude));
        const float bump =
            0.78f + 0.3f * fractalNoise({unit.x * 2.5f + unit.y, unit.z * 2.5f - unit.y}, seed);
        return centre + bump * radius * unit * glm::vec3(1.0f, 0.85f, 1.0f);
    };
    crown.material = [=](const glm::vec3& p, const glm::vec2& uv) {
        const float up = (centre.y - p.y) / radius,
                    leaves = fractalNoise(uv * glm::vec2(26.0f, 15.0f), seed + 5u);
        const float light = glm::clamp(0.30f + 0.34f * up + 1.0f * (leaves - 0.5f), 0.0f, 1.0f);
        const glm::vec3 colour =
            glm::mix(glm::vec3(0.04f, 0.085f, 0.03f), glm::vec3(0.33f, 0.40f, 0.11f), light);
        return Material{glm::vec3(0.0f), glm::mix(colour, kHaze, 1.0f - std::exp(-distance / 500.0f)), 0.90f};
    };
    crown.size_m = {4.6f * radius, 2.7f * radius};
    crown.detail = detailFor(distance, 1.2f);
    crown.lit = false;
    draft.add(std::move(crown));
}

// A stem and a handful of such balls round its top.
void addTree(Draft& draft, const glm::vec3& foot, float height, std::uint32_t seed) {
    for (std::uint32_t i = 0; i < 8; ++i) {
        const float angle = 2.39996f * static_cast<float>(i),
                    out = i == 0 ? 0.0f : 0.20f + 0.08f * unitFloat(hash(seed, i));
        const float up = 0.48f + 0.40f * static_cast<float>((i * 5) % 8) / 8.0f,
                    radius = 0.15f + 0.07f * unitFloat(hash(seed, i + 100u));
        const float narrow = 1.25f - 0.8f * (up - 0.48f);
        addFoliage(
            draft,
            foot + height * glm::vec3(narrow * out * std::cos(angle), -up, narrow * out * std::sin(angle)),
            radius * height, seed * 16u + i);
    }
    Patch stem;
    stem.point = [=](const glm::vec2& uv) {
        const float angle = 2.0f * kPi * uv.x, radius = height * glm::mix(0.032f, 0.018f, uv.y);
        return foot + glm::vec3(radius * std::cos(angle), -0.55f * height * uv.y, radius * std::sin(angle));
    };
    stem.material = [](const glm::vec3& p, const glm::vec2& uv) {
        return Material{
            glm::vec3(0.0f),
            glm::vec3(0.13f, 0.10f, 0.07f) * (0.6f + 0.8f * fractalNoise({uv.x * 9.0f, p.y * 3.0f}, 71u)),
            0.97f};
    };
    stem.size_m = {0.16f * height, 0.55f * height};
    stem.detail = detailFor(glm::distance(foot, kEye), 1.2f);
    stem.lit = false;
    draft.add(std::move(stem));
}

void addSky(Draft& draft) {
    Patch patch;
    constexpr float kDistance = 420.0f;
    patch.point = [](const glm::vec2& uv) {
        const float angle = 1.0f * (2.0f * uv.x - 1.0f), elevation = -0.06f + 0.72f * (1.0f - uv.y);
        return kEye + kDistance * glm::vec3(std::cos(elevation) * std::sin(angle), -std::sin(elevation),
                                            std::cos(elevation) * std::cos(angle));
    };
    patch.material = [](const glm::vec3& p, const glm::vec2&) {
        const glm::vec3 d = glm::normalize(p - kEye);
        const float up = glm::clamp(-d.y / 0.32f, 0.0f, 1.0f);
        glm::vec3 colour =
            glm::mix(glm::vec3(0.90f, 0.93f, 0.95f), glm::vec3(0.26f, 0.50f, 0.88f), std::sqrt(up));
        const glm::vec2 cloud_at = glm::vec2(d.x, d.z) / (0.12f - d.y);
        const float cloud =
            glm::smoothstep(0.50f, 0.72f, fractalNoise(cloud_at * glm::vec2(1.1f, 1.9f) + 4.0f, 61u));
        colour = glm::mix(colour, glm::vec3(1.25f, 1.2f, 1.14f), 0.85f * cloud);
        return Material{glm::vec3(0.0f), 1.15f * colour, 0.99f};
    };
    patch.size_m = {2.0f * kDistance, 0.72f * kDistance};
    patch.detail = detailFor(kDistance, 0.5f);
    patch.lit = false;
    draft.add(std::move(patch));
}

}  // namespace

void addOutside(Draft& draft, const Room&) {
    addSky(draft);
    addRidge(draft, {320.0f, 0.075f, {0.20f, 0.26f, 0.26f}, 101u});
    addRidge(draft, {190.0f, 0.030f, {0.22f, 0.30f, 0.13f}, 211u});
    addRidge(draft, {105.0f, -0.008f, {0.30f, 0.37f, 0.12f}, 307u});
    addRidge(draft, {55.0f, -0.042f, {0.36f, 0.40f, 0.11f}, 401u});
    addMeadow(draft);
    addTree(draft, {-9.5f, 1.9f, 24.0f}, 7.0f, 1u);
    addTree(draft, {5.6f, 1.8f, 29.0f}, 6.0f, 2u);
    addTree(draft, {8.6f, 1.9f, 33.0f}, 7.5f, 3u);
    addTree(draft, {-2.6f, 2.0f, 41.0f}, 4.6f, 4u);
    addTree(draft, {-17.0f, 2.2f, 46.0f}, 8.0f, 5u);
}

}  // namespace binosplat::builtin
