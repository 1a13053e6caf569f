// The objects on the table and the sideboard. The vase is the one glossy thing in the room.
#include "engine/builtin/atelier.h"
#include "engine/builtin/noise.h"
#include "engine/builtin/shapes.h"

#include <cmath>

namespace binosplat::builtin {

namespace {

constexpr float kTableTop = -0.74f;

void addVase(Draft& draft) {
    const glm::vec3 foot(0.72f, kTableTop, 2.50f);
    const MaterialAt glaze = [foot](const glm::vec3& p, const glm::vec2& uv) {
        // Deep blue, running thin and pale at the rim and the foot.
        const float height = (foot.y - p.y) / 0.42f,
                    run = 0.05f * std::sin(18.0f * uv.x) +
                          0.06f * (fractalNoise({uv.x * 12.0f, 0.0f}, 7u) - 0.5f);
        const float thin = glm::smoothstep(0.84f + run, 0.95f + run, height) + 1.0f -
                           glm::smoothstep(0.03f, 0.09f + run, height);
        return Material{glm::mix(glm::vec3(0.018f, 0.075f, 0.21f), glm::vec3(0.30f, 0.36f, 0.34f),
                                 glm::clamp(thin, 0.0f, 1.0f)),
                        glm::vec3(0.0f), 0.985f};
    };
    Patch& vase = addRevolution(draft, foot,
                                {{0.0f, 0.0f},
                                 {0.065f, 0.002f},
                                 {0.085f, 0.03f},
                                 {0.135f, 0.12f},
                                 {0.150f, 0.20f},
                                 {0.125f, 0.28f},
                                 {0.068f, 0.345f},
                                 {0.050f, 0.38f},
                                 {0.072f, 0.42f}},
                                glaze, 22.0f);
    vase.glossy = true;
    draft.occluders().push_back(
        {Occluder::Shape::kEllipsoid, foot + glm::vec3(0.0f, -0.19f, 0.0f), {0.142f, 0.19f, 0.142f}, 0.0f});
    // Dry grasses standing in it.
    for (std::uint32_t i = 0; i < 17; ++i) {
        const float angle = 2.39996f * static_cast<float>(i), lean = 0.12f + 0.35f * unitFloat(hash(i, 41u));
        const glm::vec3 side(-std::sin(angle), 0.0f, std::cos(angle));
        const glm::vec3 tint =
            glm::mix(glm::vec3(0.55f, 0.38f, 0.16f), glm::vec3(0.40f, 0.46f, 0.20f), unitFloat(hash(i, 43u)));
        addLeaf(draft,
                {foot + glm::vec3(0.02f * std::cos(angle), -0.38f, 0.02f * std::sin(angle)),
                 {lean * std::cos(angle), -1.0f, lean * std::sin(angle)},
                 side,
                 0.30f + 0.22f * unitFloat(hash(i, 47u)),
                 0.022f,
                 0.22f * lean},
                tint, 20.0f);
    }
}

void addFruit(Draft& draft) {
    const glm::vec3 foot(0.12f, kTableTop, 2.30f);
    addRevolution(draft, foot,
                  {{0.0f, 0.002f},
                   {0.06f, 0.0f},
                   {0.07f, 0.012f},
                   {0.13f, 0.045f},
                   {0.165f, 0.085f},
                   {0.155f, 0.085f},
                   {0.12f, 0.05f},
                   {0.0f, 0.03f}},
                  plain({0.66f, 0.64f, 0.58f}), 12.0f);
    draft.occluders().push_back(
        {Occluder::Shape::kEllipsoid, foot + glm::vec3(0.0f, -0.03f, 0.0f), {0.13f, 0.045f, 0.13f}, 0.0f});
    const glm::vec3 places[] = {{-0.065f, -0.085f, -0.03f},
                                {0.05f, -0.085f, -0.055f},
                                {0.06f, -0.085f, 0.055f},
                                {-0.04f, -0.085f, 0.07f},
                                {0.0f, -0.155f, 0.0f}};
    for (std::uint32_t i = 0; i < 5; ++i) {
        const bool apple = i == 1 || i == 4;
        const MaterialAt skin = [=](const glm::vec3& p, const glm::vec2& uv) {
            const float pores = noise(uv * glm::vec2(60.0f, 40.0f), i);
            const glm::vec3 orange = glm::vec3(0.78f, 0.30f, 0.03f) * (0.9f + 0.15f * pores);
            const glm::vec3 red =
                glm::mix(glm::vec3(0.48f, 0.045f, 0.03f), glm::vec3(0.62f, 0.48f, 0.10f),
                         glm::smoothstep(0.55f, 0.8f, fractalNoise({p.x * 22.0f, p.z * 22.0f}, 9u)));
            return Material{apple ? red : orange, glm::vec3(0.0f), 0.97f};
        };
        addCushion(draft, {foot + places[i], {0.052f, 0.049f, 0.052f}, 0.0f}, 2.0f, skin, 16.0f);
    }
}

void addTableBooks(Draft& draft) {
    const auto addBook = [&](const glm::vec3& centre, const glm::vec3& half, float yaw,
                             const glm::vec3& cover) {
        const MaterialAt material = [=](const glm::vec3& p, const glm::vec2&) {
            // The cover above and below, the pages between.
            const float height = (p.y - centre.y) / half.y;
            const float lines = 0.85f + 0.15f * std::sin(p.y * 5000.0f);
            return Material{std::abs(height) > 0.72f ? cover : glm::vec3(0.72f, 0.67f, 0.55f) * lines,
                            glm::vec3(0.0f), 0.975f};
        };
        addBox(draft, {centre, half, yaw}, material, 12.0f);
    };
    addBook({-0.22f, kTableTop - 0.018f, 2.62f}, {0.15f, 0.018f, 0.11f}, 0.25f, {0.06f, 0.16f, 0.17f});
    addBook({-0.21f, kTableTop - 0.050f, 2.62f}, {0.13f, 0.014f, 0.095f}, -0.1f, {0.48f, 0.10f, 0.06f});
    // A cup on them.
    addRevolution(draft, {-0.20f, kTableTop - 0.064f, 2.60f},
                  {{0.0f, 0.002f},
                   {0.025f, 0.0f},
                   {0.036f, 0.02f},
                   {0.040f, 0.055f},
                   {0.042f, 0.075f},
                   {0.036f, 0.075f},
                   {0.034f, 0.05f},
                   {0.0f, 0.045f}},
                  plain({0.72f, 0.70f, 0.66f}), 22.0f);
    draft.occluders().push_back(
        {Occluder::Shape::kEllipsoid, {-0.20f, kTableTop - 0.10f, 2.60f}, {0.038f, 0.04f, 0.038f}, 0.0f});
}

void addSideboardThings(Draft& draft) {
    // A small plant in a pale pot, and a row of three candlesticks.
    const glm::vec3 foot(2.70f, -0.79f, 2.25f);
    addRevolution(
        draft, foot,
        {{0.0f, 0.0f}, {0.06f, 0.0f}, {0.085f, 0.08f}, {0.095f, 0.16f}, {0.085f, 0.165f}, {0.0f, 0.15f}},
        plain({0.66f, 0.58f, 0.48f}), 9.0f);
    draft.occluders().push_back(
        {Occluder::Shape::kEllipsoid, foot + glm::vec3(0.0f, -0.08f, 0.0f), {0.09f, 0.09f, 0.09f}, 0.0f});
    for (std::uint32_t i = 0; i < 22; ++i) {
        const float angle = 2.39996f * static_cast<float>(i), lift = 0.35f + 1.1f * unitFloat(hash(i, 61u));
        addLeaf(draft,
                {foot + glm::vec3(0.0f, -0.15f, 0.0f),
                 {std::cos(angle), -lift, std::sin(angle)},
                 {-std::sin(angle), 0.0f, std::cos(angle)},
                 0.16f + 0.12f * unitFloat(hash(i, 63u)),
                 0.055f,
                 0.5f},
                {0.13f, 0.26f, 0.07f}, 9.0f);
    }
    for (int i = 0; i < 3; ++i) {
        const float height = 0.12f + 0.05f * static_cast<float>(i);
        const glm::vec3 base(2.72f, -0.79f, 3.35f + 0.14f * static_cast<float>(i));
        addRevolution(
            draft, base,
            {{0.045f, 0.0f}, {0.04f, 0.012f}, {0.012f, 0.03f}, {0.012f, height}, {0.022f, height + 0.01f}},
            plain({0.50f, 0.36f, 0.16f}), 10.0f);
        addRod(draft, base + glm::vec3(0.0f, -height, 0.0f), base + glm::vec3(0.0f, -height - 0.16f, 0.0f),
               0.011f, plain({0.80f, 0.76f, 0.66f}), 12.0f);
    }
}

}  // namespace

void addStillLife(Draft& draft) {
    addVase(draft);
    addFruit(draft);
    addTableBooks(draft);
    addSideboardThings(draft);
}

}  // namespace binosplat::builtin
