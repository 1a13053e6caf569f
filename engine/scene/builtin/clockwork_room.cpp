// The static part of builtin:clockwork.
#include "engine/scene/builtin/clockwork.h"
#include "engine/scene/builtin/noise.h"
#include "engine/scene/builtin/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace binosplat::builtin::clockwork {

namespace {

// Boards `width` across; `across` and `along` are coordinates on the surface.
glm::vec3 boards(float across, float along, float width, const glm::vec3& dark, const glm::vec3& light, std::uint32_t seed) {
    const float board = std::floor(across / width), within = across / width - board;
    const float tone = unitFloat(hash(static_cast<std::uint32_t>(static_cast<std::int32_t>(board)), seed));
    const float grain = fractalNoise({across * 16.0f + 9.0f * tone, along * 1.6f + 40.0f * tone}, seed);
    const float joint = glm::smoothstep(0.0f, 0.03f, std::min(within, 1.0f - within) * width);
    return glm::mix(dark, light, 0.15f + 0.45f * tone + 0.6f * (grain - 0.25f)) * glm::mix(0.45f, 1.0f, joint);
}

MaterialAt varnished(const glm::vec3& colour, std::uint32_t seed) {
    return [=](const glm::vec3& p, const glm::vec2&) {
        return Material{colour * (0.75f + 0.5f * fractalNoise({(p.x + p.z) * 22.0f, p.y * 3.0f}, seed)), glm::vec3(0.0f), kOpacity};
    };
}

// The parallelogram origin + u a + v b, in the scene's axes.
Quad quadOf(const glm::vec3& origin, const glm::vec3& a, const glm::vec3& b, const glm::vec3& towards) {
    return {turnAbout(origin), turnAbout(a), turnAbout(b), turnAbout(towards)};
}

void addWallAndTable(Draft& draft) {
    const glm::vec3 eye(0.0f);
    const MaterialAt wall = [](const glm::vec3& p, const glm::vec2&) {
        return Material{boards(-p.x, p.y, 0.29f, {0.12f, 0.075f, 0.045f}, {0.40f, 0.28f, 0.17f}, 3u), glm::vec3(0.0f), kOpacity};
    };
    addQuad(draft, quadOf({-2.2f, -1.7f, 2.8f}, {4.4f, 0.0f, 0.0f}, {0.0f, 2.5f, 0.0f}, eye), wall, 1.0f);
    const MaterialAt top = [](const glm::vec3& p, const glm::vec2&) {
        return Material{boards(-p.z, p.x, 0.34f, {0.14f, 0.07f, 0.035f}, {0.42f, 0.22f, 0.11f}, 8u), glm::vec3(0.0f), kOpacity};
    };
    addQuad(draft, quadOf({-2.2f, 0.8f, 1.1f}, {4.4f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.7f}, eye), top, 1.0f);
}

// Behind the wheels, from the table up to their axles.
void addPosts(Draft& draft) {
    const MaterialAt ash = varnished({0.13f, 0.065f, 0.035f}, 21u);
    const auto addPost = [&](float x, float half_width, float top) {
        addBox(draft, {turnAbout({x, 0.5f * (top + 0.8f), 1.71f}), {half_width, 0.5f * (0.8f - top), 0.03f}, 0.0f}, ash, 2.5f);
    };
    addPost(-0.34f, 0.10f, -0.60f);
    addPost(0.015f, 0.05f, -0.36f);
}

Material dialAt(const glm::vec2& at, float radius) {
    const float r = glm::length(at) / radius, hour = std::atan2(at.y, at.x) / kPi * 6.0f,
                off = std::abs(hour - std::round(hour)) * kPi / 6.0f;
    const bool quarter = static_cast<int>(std::round(hour + 12.0f)) % 3 == 0;
    const float across = off * r * radius - (quarter ? 0.020f : 0.013f), along = std::abs(r - 0.80f) * radius - (quarter ? 0.05f : 0.035f);
    const float mark = 1.0f - glm::smoothstep(-0.004f, 0.004f, std::max(across, along));
    const glm::vec3 paper = glm::vec3(0.44f, 0.40f, 0.31f) * (0.92f + 0.16f * fractalNoise(at * 12.0f, 5u));
    return {glm::mix(paper, glm::vec3(0.02f), mark), glm::vec3(0.0f), kOpacity};
}

// A little house on the wall: front with an opening, sides, a roof, and a dark inside.
void addCase(Draft& draft) {
    const MaterialAt green = varnished({0.09f, 0.20f, 0.17f}, 31u), tiles = varnished({0.36f, 0.10f, 0.06f}, 33u),
                     dark = plain({0.03f, 0.02f, 0.02f}, kOpacity);
    const float left = 0.20f, right = 1.04f, top = -1.15f, bottom = -0.06f, front = 2.55f, back = 2.79f;
    const glm::vec3 eye(0.0f), x(right - left, 0.0f, 0.0f), y(0.0f, bottom - top, 0.0f), z(0.0f, 0.0f, back - front);
    const std::array<glm::vec4, 1> door{{{0.295f / x.x, 0.035f / y.y, 0.545f / x.x, 0.295f / y.y}}};
    addQuadAround(draft, quadOf({left, top, front}, x, y, eye), door, green, 1.6f);
    addQuad(draft, quadOf({left, top, front}, z, y, {-9.0f, 0.0f, front}), green, 1.0f);
    addQuad(draft, quadOf({right, top, front}, z, y, {9.0f, 0.0f, front}), green, 0.5f);
    addQuad(draft, quadOf({left, bottom, front}, x, z, {0.0f, 9.0f, front}), green, 1.0f);
    addQuad(draft, quadOf({0.45f, -1.145f, back}, {0.34f, 0.0f, 0.0f}, {0.0f, 0.32f, 0.0f}, eye), dark, 1.0f);
    const glm::vec3 ridge(0.62f, -1.37f, front - 0.08f), depth(0.0f, 0.0f, back - front + 0.08f);
    for (const float side : {-1.0f, 1.0f}) {
        const glm::vec3 slope(0.52f * side, 0.27f, 0.0f);
        addQuad(draft, quadOf(ridge, slope, depth, {0.62f + side, 9.0f, front}), tiles, 1.0f);
        addQuad(draft, quadOf(ridge - glm::vec3(0.0f, 0.03f, 0.0f), slope, {0.0f, 0.06f, 0.0f}, eye), tiles, 2.0f);
    }
    // The gable between the front's top and the roof.
    Patch gable;
    gable.point = [=](const glm::vec2& uv) {
        return turnAbout({0.62f + (2.0f * uv.x - 1.0f) * 0.42f * uv.y, glm::mix(-1.36f, top, uv.y), front});
    };
    gable.material = green;
    gable.size_m = {0.42f, 0.24f};
    gable.detail = 1.6f;
    gable.behind = [](const glm::vec3& point) { return point - glm::vec3(0.0f, 0.0f, 1.0f); };
    draft.add(std::move(gable));
    draft.occluders().push_back(
        {Occluder::Shape::kBox, turnAbout({0.62f, 0.5f * (top + bottom), 2.67f}), {0.41f, 0.5f * (bottom - top), 0.11f}, 0.0f});

    const Round dial{{0.62f, -0.46f, 2.50f}, 0.03f};
    const float radius = 0.32f;
    addFace(
        draft, dial, 0.0f, radius,
        [=](const glm::vec3& p, const glm::vec2&) { return dialAt(glm::vec2(turnAbout(p) - dial.centre), radius); }, 9.0f);
    const Round bezel{dial.centre, 0.045f};
    const MaterialAt brass = plain({0.26f, 0.155f, 0.04f}, kOpacity);
    addFace(draft, bezel, radius, radius + 0.04f, brass, 3.0f);
    addEdge(draft, bezel, radius + 0.04f, {0.0f, 2.0f * kPi}, true, brass, 1.0f);
}

}  // namespace

void addRoom(Draft& draft) {
    addWallAndTable(draft);
    addPosts(draft);
    addCase(draft);
    // The lamp's foot.
    addRevolution(draft, turnAbout({0.94f, 0.8f, 2.0f}),
                  {{0.11f, 0.0f}, {0.10f, 0.02f}, {0.03f, 0.04f}, {0.018f, 0.10f}, {0.018f, 0.25f}, {0.05f, 0.28f}},
                  plain({0.40f, 0.28f, 0.12f}, kOpacity), 3.0f);
}

}  // namespace binosplat::builtin::clockwork
