// Scenes made by hand for the twin's tests.
#pragma once

#include "engine/twin/reference.h"
#include "tests/suite.h"

namespace binosplat::test {

struct Splat {
    glm::vec3 position{0.0f, 0.0f, 2.0f};
    glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};
    glm::vec2 scale{0.2f};
    float opacity = 0.8f;
    glm::vec3 colour{0.5f};
};

inline Scene makeScene(const std::vector<Splat>& splats) {
    Scene scene;
    scene.name = "test";
    for (const Splat& splat : splats) {
        scene.positions.push_back(splat.position);
        scene.rotations.push_back(splat.rotation);
        scene.scales.push_back(splat.scale);
        scene.opacities.push_back(splat.opacity);
        // colour = 0.5 + sqrt(1/pi)/2 f_dc
        for (int channel = 0; channel < 3; ++channel) {
            scene.sh.push_back((splat.colour[channel] - 0.5f) / 0.28209479177387814f);
        }
    }
    return scene;
}

// At the origin, along z, with a focal length of 100 px and the axis through the centre of the middle pixel
// of an odd size.
inline Eye makeEye(glm::uvec2 size_px) {
    return {Pose{}, {100.0, 100.0, 0.5 * size_px.x, 0.5 * size_px.y}, size_px};
}

// 0.1 apart, so that pixels move 10 px to the left per unit of inverse depth.
inline std::array<Eye, 2> parallelEyes(glm::uvec2 size_px) { return stereoPair(makeEye(size_px), 0.1); }

// Random splats around an eye at the origin: near and far, large and thin, behind it, through the near plane,
// outside the picture.
inline Scene makeCloud(int count, unsigned seed) {
    std::mt19937 random(seed);
    const auto draw = [&](float low, float high) {
        return low + (high - low) * static_cast<float>(drawUnit(random));
    };
    std::vector<Splat> splats;
    for (int i = 0; i < count; ++i) {
        Splat splat;
        splat.position = {draw(-2.0f, 2.0f), draw(-2.0f, 2.0f), draw(-0.5f, 4.0f)};
        splat.rotation = glm::normalize(
            glm::quat(draw(-1.0f, 1.0f), draw(-1.0f, 1.0f), draw(-1.0f, 1.0f), draw(-1.0f, 1.0f)));
        splat.scale = {std::exp(draw(-6.0f, 0.5f)), std::exp(draw(-6.0f, 0.5f))};
        splat.opacity = draw(0.0f, 1.0f);
        splat.colour = {draw(0.0f, 1.0f), draw(0.0f, 1.0f), draw(0.0f, 1.0f)};
        splats.push_back(splat);
    }
    return makeScene(splats);
}

// An ordinary eye: turned, moved, asymmetric.
inline Eye makeOddEye(glm::uvec2 size_px) {
    Eye eye = makeEye(size_px);
    eye.world_from_camera = {glm::normalize(glm::dquat(0.98, 0.05, -0.1, 0.08)), {0.1, -0.2, -0.3}};
    eye.intrinsics = {60.0, 75.0, 0.3 * size_px.x, 0.6 * size_px.y};
    return eye;
}

}  // namespace binosplat::test
