// Objects close to the eyes, so that each eye sees different things behind them: a lattice screen and a
// plant.
#include "engine/builtin/atelier.h"
#include "engine/builtin/noise.h"
#include "engine/builtin/shapes.h"

#include <cmath>

namespace binosplat::builtin {

namespace {

// A folding screen, 1.8 m high: solid below, above it thin bars in a stepped pattern. One panel, from `from`
// to `to` on the floor.
void addScreenPanel(Draft& draft, const glm::vec2& from, const glm::vec2& to) {
    const glm::vec2 along = to - from;
    const float width = glm::length(along), yaw = -std::atan2(along.y, along.x);
    const MaterialAt cherry = [](const glm::vec3& p, const glm::vec2&) {
        return Material{glm::mix(glm::vec3(0.20f, 0.075f, 0.035f), glm::vec3(0.36f, 0.16f, 0.075f),
                                 fractalNoise({(p.x + p.z) * 40.0f, p.y * 40.0f}, 401u)),
                        glm::vec3(0.0f), 0.98f};
    };
    constexpr float kTop = -1.86f, kRail = -0.80f;
    const auto addBar = [&](float s, float y0, float y1, float half_width, float half_depth, float detail) {
        const glm::vec2 at = from + s * along;
        addBox(draft,
               {{at.x, 0.5f * (y0 + y1), at.y}, {half_width, 0.5f * std::abs(y1 - y0), half_depth}, yaw},
               cherry, detail, half_width > 0.01f);
    };
    const auto addRail = [&](float y, float s0, float s1, float half_height, float half_depth, float detail) {
        const glm::vec2 at = from + 0.5f * (s0 + s1) * along;
        addBox(draft, {{at.x, y, at.y}, {0.5f * (s1 - s0) * width, half_height, half_depth}, yaw}, cherry,
               detail, half_height > 0.01f);
    };
    addBar(0.0f, 0.0f, kTop, 0.013f, 0.013f, 14.0f);
    addBar(1.0f, 0.0f, kTop, 0.013f, 0.013f, 14.0f);
    for (const float y : {kTop, kRail, -0.06f}) { addRail(y, 0.0f, 1.0f, 0.014f, 0.011f, 14.0f); }
    addRail(0.5f * (kRail - 0.06f), 0.0f, 1.0f, 0.5f * (-0.06f - kRail), 0.005f, 4.0f);
    // The lattice: four uprights and nine cross bars, with short pieces between every other pair.
    constexpr int kUprights = 4, kBars = 9;
    for (int i = 1; i <= kUprights; ++i) {
        addBar(static_cast<float>(i) / (kUprights + 1), kRail, kTop, 0.0045f, 0.007f, 24.0f);
    }
    for (int j = 1; j <= kBars; ++j) {
        const float y = kRail + (kTop - kRail) * static_cast<float>(j) / (kBars + 1);
        addRail(y, 0.0f, 1.0f, 0.0045f, 0.006f, 24.0f);
        for (int i = 0; i <= kUprights; ++i) {
            if ((i + j) % 2 == 0) {
                addBar((static_cast<float>(i) + 0.5f) / (kUprights + 1), y, y + (kTop - kRail) / (kBars + 1),
                       0.003f, 0.005f, 24.0f);
            }
        }
    }
}

// A tall plant in a clay pot: stems with long narrow leaves, some of which reach in front of the eye.
void addPlant(Draft& draft) {
    const glm::vec3 foot(0.76f, 0.0f, 1.17f);
    addRevolution(
        draft, foot,
        {{0.0f, 0.0f},
         {0.13f, 0.0f},
         {0.15f, 0.1f},
         {0.185f, 0.26f},
         {0.195f, 0.34f},
         {0.175f, 0.345f},
         {0.17f, 0.32f},
         {0.0f, 0.31f}},
        [](const glm::vec3& p, const glm::vec2& uv) {
            return Material{glm::vec3(0.52f, 0.23f, 0.12f) *
                                (0.8f + 0.4f * fractalNoise({uv.x * 30.0f, p.y * 24.0f}, 411u)),
                            glm::vec3(0.0f), 0.98f};
        },
        5.0f);
    draft.occluders().push_back(
        {Occluder::Shape::kEllipsoid, foot + glm::vec3(0.0f, -0.16f, 0.0f), {0.19f, 0.19f, 0.19f}, 0.0f});
    const glm::vec3 tips[] = {{0.60f, -1.36f, 1.04f},
                              {0.60f, -1.72f, 1.05f},
                              {0.52f, -1.02f, 1.04f},
                              {0.90f, -1.45f, 1.25f},
                              {0.64f, -1.56f, 0.92f}};
    for (std::uint32_t stem = 0; stem < std::size(tips); ++stem) {
        const glm::vec3 root = foot + glm::vec3(0.05f * (static_cast<float>(stem % 3) - 1.0f), -0.31f,
                                                0.04f * (static_cast<float>(stem % 2) - 0.5f));
        addRod(draft, root, tips[stem], 0.0055f, plain({0.22f, 0.24f, 0.09f}), 14.0f);
        constexpr std::uint32_t kLeaves = 13;
        for (std::uint32_t i = 0; i < kLeaves; ++i) {
            const std::uint32_t chance = hash(stem * 31u + i, 421u);
            const float along = 0.35f + 0.65f * static_cast<float>(i + 1) / kLeaves,
                        angle = 2.39996f * static_cast<float>(i) + 1.3f * static_cast<float>(stem);
            const float lift = 0.25f + 0.5f * unitFloat(chance) + (i + 1 == kLeaves ? 0.8f : 0.0f),
                        length = 0.20f + 0.14f * unitFloat(hash(chance));
            addLeaf(draft,
                    {glm::mix(root, tips[stem], along),
                     {std::cos(angle), -lift, std::sin(angle)},
                     {-std::sin(angle), 0.2f * unitFloat(hash(chance, 2u)), std::cos(angle)},
                     length,
                     0.045f + 0.02f * unitFloat(hash(chance, 3u)),
                     0.55f},
                    {0.13f, 0.29f, 0.065f}, 22.0f);
        }
    }
}

}  // namespace

void addForeground(Draft& draft) {
    addScreenPanel(draft, {-0.27f, 1.09f}, {-0.62f, 0.72f});
    addScreenPanel(draft, {-0.62f, 0.72f}, {-1.05f, 0.98f});
    addPlant(draft);
}

}  // namespace binosplat::builtin
