// Small scenes for tests; their parameters are listed in procedural.h.
#include "engine/builtin/builtin.h"

#include <cmath>

namespace binosplat::builtin {

namespace {

glm::quat makeIdentity() { return glm::identity<glm::quat>(); }

void addDisc(Scene& scene, const glm::vec3& centre, const glm::quat& rotation, const glm::vec2& scales,
             float opacity, const glm::vec3& colour) {
    scene.positions.push_back(centre);
    scene.rotations.push_back(rotation);
    scene.scales.push_back(scales);
    scene.opacities.push_back(opacity);
    const glm::vec3 sh = shFromColour(colour);
    scene.sh.insert(scene.sh.end(), {sh.r, sh.g, sh.b});
}

// 121 x 121 discs 0.05 apart over x and y from -3 to 3, facing the eye.
template <typename Colour>
void addWall(Scene& scene, float z, Colour colour) {
    for (int j = 0; j <= 120; ++j) {
        for (int i = 0; i <= 120; ++i) {
            const float x = -3.0f + 0.05f * static_cast<float>(i), y = -3.0f + 0.05f * static_cast<float>(j);
            addDisc(scene, {x, y, z}, makeIdentity(), {0.04f, 0.04f}, 0.95f, colour(x, y));
        }
    }
}

}  // namespace

Scene makeOneSplat() {
    Scene scene;
    addDisc(scene, {0.0f, 0.0f, 2.0f}, makeIdentity(), {0.2f, 0.1f}, 0.8f, {0.9f, 0.6f, 0.3f});
    return scene;
}

Scene makeSlantedWall() {
    // t_u = (1, 0, 1)/sqrt(2), t_v = y, t_w = t_u x t_v = (-1, 0, 1)/sqrt(2): a turn by -45 degrees about y.
    constexpr float kStep = 0.1f;
    const float along = std::sqrt(0.5f);
    const glm::quat rotation = glm::angleAxis(glm::radians(-45.0f), glm::vec3(0.0f, 1.0f, 0.0f));
    Scene scene;
    for (int j = 0; j <= 40; ++j) {
        for (int i = 0; i <= 40; ++i) {
            const float s = kStep * static_cast<float>(i - 20), y = kStep * static_cast<float>(j - 20);
            const glm::vec3 colour(0.2f + 0.6f * static_cast<float>(i) / 40.0f,
                                   0.2f + 0.6f * static_cast<float>(j) / 40.0f, 0.5f);
            addDisc(scene, {along * s, y, 4.0f + along * s}, rotation, {0.08f, 0.08f}, 0.95f, colour);
        }
    }
    return scene;
}

Scene makeTwoLayers() {
    Scene scene;
    addDisc(scene, {0.0f, 0.0f, 2.0f}, makeIdentity(), {0.5f, 0.5f}, 0.5f, glm::vec3(0.8f));
    addDisc(scene, {0.0f, 0.0f, 4.0f}, makeIdentity(), {1.0f, 1.0f}, 0.9f, {0.1f, 0.2f, 0.6f});
    return scene;
}

Scene makeStepEdge() {
    Scene scene;
    for (int j = 0; j <= 60; ++j) {
        for (int i = 0; i < 30; ++i) {
            const float x = -1.5f + 0.05f * static_cast<float>(i), y = -1.5f + 0.05f * static_cast<float>(j);
            addDisc(scene, {x, y, 2.0f}, makeIdentity(), {0.04f, 0.04f}, 0.95f, glm::vec3(0.75f));
        }
    }
    addWall(scene, 4.0f, [](float x, float y) {
        const int cell = static_cast<int>(std::floor(2.0f * x)) + static_cast<int>(std::floor(2.0f * y));
        return glm::vec3(cell % 2 == 0 ? 0.25f : 0.4f);
    });
    return scene;
}

Scene makeFence() {
    Scene scene;
    for (int i = 0; i <= 8; ++i) {
        for (int j = 0; j <= 80; ++j) {
            const glm::vec3 centre(-0.8f + 0.2f * static_cast<float>(i),
                                   -1.0f + 0.025f * static_cast<float>(j), 1.0f);
            addDisc(scene, centre, makeIdentity(), {0.006f, 0.02f}, 0.95f, {0.5f, 0.3f, 0.15f});
        }
    }
    addWall(scene, 3.0f, [](float x, float y) {
        return glm::vec3(0.3f + 0.1f * std::sin(2.0f * x), 0.5f, 0.6f + 0.1f * std::sin(3.0f * y));
    });
    return scene;
}

}  // namespace binosplat::builtin
