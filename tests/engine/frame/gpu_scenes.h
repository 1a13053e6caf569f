// Scenes and eyes for GPU tests, and the twin's pictures as images.
#pragma once

#include "engine/builtin/procedural.h"
#include "engine/picture/image.h"
#include "shaders/shared/constants.h"
#include "tests/engine/twin/reference_scenes.h"

namespace binosplat::test {

struct ViewedScene {
    std::string name;
    Scene scene;
    Eye eye;
};

inline Eye eyeOf(const View& view, glm::uvec2 size_px) {
    return {lookAt(view.eye, view.look, view.up), intrinsicsFromFovX(glm::radians(view.fov_x_deg), size_px),
            size_px};
}

// The eye after a turn about its own up axis.
inline Eye turned(Eye eye, double radians) {
    eye.world_from_camera.orientation =
        eye.world_from_camera.orientation * glm::angleAxis(radians, glm::dvec3(0, 1, 0));
    return eye;
}

inline std::size_t tileCount(glm::uvec2 size_px) {
    return std::size_t{(size_px.x + 15) / 16} * ((size_px.y + 15) / 16);
}
inline std::size_t tileOf(std::size_t pixel, glm::uvec2 size_px) {
    return pixel / size_px.x / 16 * ((size_px.x + 15) / 16) + pixel % size_px.x / 16;
}

// Each is made only once, since baking the atelier's light takes longer than many tests.
inline ViewedScene viewBuiltin(const std::string& name, glm::uvec2 size_px, std::uint64_t splats = 0) {
    static std::map<std::pair<std::string, std::uint64_t>, Scene> made;
    auto found = made.find({name, splats});
    if (found == made.end()) {
        found = made.emplace(std::pair(name, splats), makeBuiltin(name, splats)).first;
    }
    return {name, found->second, eyeOf(*builtinView(name), size_px)};
}

inline ViewedScene viewAtelier(glm::uvec2 size_px = {128, 128}) {
    return viewBuiltin("builtin:atelier", size_px, 20000);
}

// The same as a headset sees it, at wide angles.
inline ViewedScene viewWide(glm::uvec2 size_px, std::uint64_t splats = 20000) {
    ViewedScene view = viewBuiltin("builtin:atelier", size_px, splats);
    view.eye.intrinsics = intrinsicsFromAngles({-0.9, 0.8, 0.75, -0.85}, size_px);
    return view;
}

// A cloud around the eye: near and far, through the near plane, thin and long, huge, tiny, and edge-on to
// 1e-7 rad.
inline ViewedScene viewCloud(glm::uvec2 size_px) {
    const Eye eye = makeOddEye(size_px);
    Scene scene = makeCloud(1500, 3);
    std::mt19937 random(4);
    const auto draw = [&] { return drawUnit(random); };
    for (std::size_t i = 0; i < 300; ++i) {
        // t_u is along the line of sight except for a small angle, so the plane almost contains the eye.
        const glm::dvec3 sight =
            glm::normalize(glm::dvec3(scene.positions[i]) - eye.world_from_camera.position);
        const glm::dvec3 across = glm::normalize(glm::cross(sight, glm::dvec3(draw(), draw(), -draw())));
        const glm::dvec3 normal = glm::normalize(across + std::pow(10.0, -1.0 - 6.0 * draw()) * sight);
        const glm::dvec3 u = glm::normalize(sight - glm::dot(sight, normal) * normal);
        scene.rotations[i] = glm::quat(glm::quat_cast(glm::dmat3(u, glm::cross(normal, u), normal)));
    }
    for (std::size_t i = 300; i < 340; ++i) { scene.scales[i] *= 100.0f; }
    for (std::size_t i = 340; i < 380; ++i) { scene.scales[i] *= 0.001f; }
    return {"cloud", std::move(scene), eye};
}

// For the constant kSplatKind of passes for which dimming makes no difference.
inline std::uint32_t shapeOf(const Scene& scene) {
    return scene.isGaussian3d() ? gpu::kGaussians : gpu::kDiscs;
}

// The same as 3D Gaussians, from as thick as their second axis to flat, with needles of 1e6. Some are within
// reach of the near plane or beside the eye, where the linear projection breaks down; some have opacities
// that dimming takes below 1/255.
inline ViewedScene viewGaussians(glm::uvec2 size_px, bool antialiased) {
    ViewedScene view = viewCloud(size_px);
    view.name = antialiased ? "antialiased Gaussians" : "Gaussians";
    view.scene.antialiased = antialiased;
    std::mt19937 random(5);
    for (std::size_t i = 380; i < 400; ++i) { view.scene.scales[i] = {1e-6f, 1.0f}; }
    for (const glm::vec2& scale : view.scene.scales) {
        const auto share = static_cast<float>(drawUnit(random));
        view.scene.thicknesses.push_back(std::min(scale.x, scale.y) * (share < 0.1f ? 0.0f : share));
    }
    return view;
}

inline Image toImage(glm::uvec2 size_px, const std::vector<glm::dvec4>& colours) {
    Image image{size_px, 4, {}};
    for (const glm::dvec4& value : colours) {
        for (int channel = 0; channel < 4; ++channel) {
            image.values.push_back(static_cast<float>(value[channel]));
        }
    }
    return image;
}
inline Image toImage(const reference::Picture& picture) { return toImage(picture.size_px, picture.rgba); }

// An image with one channel for each of the given values.
template <typename... Values>
Image toImage(glm::uvec2 size_px, const Values&... channels) {
    Image image{size_px, static_cast<int>(sizeof...(channels)), {}};
    for (std::size_t i = 0; i < image.pixelCount(); ++i) {
        (image.values.push_back(static_cast<float>(channels[i])), ...);
    }
    return image;
}

}  // namespace binosplat::test
