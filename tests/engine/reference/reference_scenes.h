// Scenes made by hand for the twin's tests, and a renderer without any of its bounds, bins or formulas to hold it against.
#pragma once

#include "engine/reference/reference.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>

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
        for (int channel = 0; channel < 3; ++channel) { scene.sh.push_back((splat.colour[channel] - 0.5f) / 0.28209479177387814f); }
    }
    return scene;
}

// At the origin along z, focal length 100 px, the axis through the centre of the middle pixel of an odd size.
inline Eye makeEye(glm::uvec2 size_px) { return {Pose{}, {100.0, 100.0, 0.5 * size_px.x, 0.5 * size_px.y}, size_px}; }

// Random splats about an eye at the origin: near and far, large and thin, behind, through the near plane, off the image.
inline Scene makeCloud(int count, unsigned seed) {
    std::mt19937 random(seed);
    const auto draw = [&](float low, float high) { return low + (high - low) * static_cast<float>(random() >> 8) / 16777216.0f; };
    std::vector<Splat> splats;
    for (int i = 0; i < count; ++i) {
        Splat splat;
        splat.position = {draw(-2.0f, 2.0f), draw(-2.0f, 2.0f), draw(-0.5f, 4.0f)};
        splat.rotation = glm::normalize(glm::quat(draw(-1.0f, 1.0f), draw(-1.0f, 1.0f), draw(-1.0f, 1.0f), draw(-1.0f, 1.0f)));
        splat.scale = {std::exp(draw(-6.0f, 0.5f)), std::exp(draw(-6.0f, 0.5f))};
        splat.opacity = draw(0.0f, 1.0f);
        splat.colour = {draw(0.0f, 1.0f), draw(0.0f, 1.0f), draw(0.0f, 1.0f)};
        splats.push_back(splat);
    }
    return makeScene(splats);
}

// An eye with nothing special about it: turned, moved, asymmetric.
inline Eye makeOddEye(glm::uvec2 size_px) {
    Eye eye = makeEye(size_px);
    eye.world_from_camera = {glm::normalize(glm::dquat(0.98, 0.05, -0.1, 0.08)), {0.1, -0.2, -0.3}};
    eye.intrinsics = {60.0, 75.0, 0.3 * size_px.x, 0.6 * size_px.y};
    return eye;
}

struct PlainHit {
    double rho, depth, alpha;
};

// A pixel's hit as 2DGS, section 4, defines it, by solving u a + v b + c = z ray.
inline std::optional<PlainHit> hitPlainly(const Scene& scene, std::size_t i, const Eye& eye, glm::dvec2 pixel, double near) {
    const glm::dmat3 camera_from_world = glm::mat3_cast(glm::conjugate(eye.world_from_camera.orientation));
    const glm::quat& q = scene.rotations[i];
    const glm::dmat3 disc = glm::mat3_cast(glm::normalize(glm::dquat(q.w, q.x, q.y, q.z)));
    const glm::dvec3 a = camera_from_world * disc[0] * static_cast<double>(scene.scales[i].x);
    const glm::dvec3 b = camera_from_world * disc[1] * static_cast<double>(scene.scales[i].y);
    const glm::dvec3 c = camera_from_world * (glm::dvec3(scene.positions[i]) - eye.world_from_camera.position);
    const Intrinsics& k = eye.intrinsics;
    const glm::dvec3 ray((pixel.x - k.cx) / k.fx, (pixel.y - k.cy) / k.fy, 1.0);
    const double cut = 2.0 * std::log(255.0 * static_cast<double>(scene.opacities[i]));
    PlainHit hit{cut, 0.0, 0.0};
    bool met = false;
    const glm::dvec3 solution = glm::inverse(glm::dmat3(a, b, c)) * ray;
    const double u = solution.x / solution.z, v = solution.y / solution.z, z = 1.0 / solution.z;
    if (z >= near && u * u + v * v < hit.rho) {
        hit = {u * u + v * v, z, 0.0};
        met = true;
    }
    if (c.z > near) {
        const glm::dvec2 offset(pixel.x - k.fx * c.x / c.z - k.cx, pixel.y - k.fy * c.y / c.z - k.cy);
        if (2.0 * glm::dot(offset, offset) < hit.rho) {
            hit = {2.0 * glm::dot(offset, offset), c.z, 0.0};
            met = true;
        }
    }
    if (!met) { return std::nullopt; }
    hit.alpha = std::min(0.99, static_cast<double>(scene.opacities[i]) * std::exp(-0.5 * hit.rho));
    return hit;
}

// Every splat at every pixel. SH degree 0.
inline reference::Picture renderPlainly(const Scene& scene, const Eye& eye, const reference::Settings& settings) {
    const Pose camera_from_world = inverse(eye.world_from_camera);
    const auto depth = [&](std::size_t i) { return transform(camera_from_world, glm::dvec3(scene.positions[i])).z; };
    std::vector<std::size_t> order(scene.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return depth(i) < depth(j); });
    reference::Picture picture;
    picture.size_px = eye.size_px;
    for (std::uint32_t y = 0; y < eye.size_px.y; ++y) {
        for (std::uint32_t x = 0; x < eye.size_px.x; ++x) {
            double transmittance = 1.0;
            glm::dvec4 sum(0.0);
            double sum_z = 0.0, sum_inverse = 0.0, sum_inverse_squared = 0.0;
            for (const std::size_t i : order) {
                const auto hit = hitPlainly(scene, i, eye, {x + 0.5, y + 0.5}, settings.near);
                if (!hit) { continue; }
                if (transmittance * (1.0 - hit->alpha) < 1e-4) { break; }
                const double w = hit->alpha * transmittance;
                for (int channel = 0; channel < 3; ++channel) {
                    const double dc = static_cast<double>(scene.sh[3 * i + static_cast<std::size_t>(channel)]);
                    sum[channel] += w * std::max(0.0, 0.5 + 0.28209479177387814 * dc);
                }
                sum.w += w;
                sum_z += w * hit->depth;
                sum_inverse += w / hit->depth;
                sum_inverse_squared += w / (hit->depth * hit->depth);
                transmittance *= 1.0 - hit->alpha;
            }
            picture.rgba.push_back(sum + transmittance * glm::dvec4(settings.background, 0.0));
            picture.depth.push_back(sum_z);
            picture.inverse_depth.push_back(sum_inverse);
            picture.inverse_depth_squared.push_back(sum_inverse_squared);
        }
    }
    return picture;
}

}  // namespace binosplat::test
