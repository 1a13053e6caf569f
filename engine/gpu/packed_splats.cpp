// Packs splats, and computes the bounds of pages of them.
#include "engine/gpu/packed_splats.h"

#include "engine/error.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

namespace binosplat {
namespace {

std::uint64_t shWords(int sh_degree) {
    return static_cast<std::uint64_t>(3 * (shCoefficientCount(sh_degree) - 1) + 1) / 2;
}

// Half floats end at 65504; larger values are clamped to stay finite.
std::uint32_t packHalves(float low, float high) {
    return glm::packHalf2x16(glm::clamp(glm::vec2(low, high), glm::vec2(-65504.0f), glm::vec2(65504.0f)));
}

// The rotation as stored on the device: x, y, z, w of unit length. Empty for a splat that cannot be shown.
std::optional<glm::vec4> rotationToShow(const Scene& scene, std::uint64_t splat) {
    const glm::vec3& p = scene.positions[splat];
    const glm::vec2& scale = scene.scales[splat];
    const auto values = static_cast<std::uint64_t>(3 * shCoefficientCount(scene.sh_degree));
    // v * 0 is 0 for a finite v and NaN otherwise, and a sum keeps a NaN.
    float zero = (p.x + p.y + p.z) * 0.0f + (scale.x + scale.y) * 0.0f + scene.opacities[splat] * 0.0f;
    if (scene.isGaussian3d()) { zero += scene.thicknesses[splat] * 0.0f; }
    for (std::uint64_t i = splat * values; i < (splat + 1) * values; ++i) { zero += scene.sh[i] * 0.0f; }
    const glm::quat& q = scene.rotations[splat];
    const glm::dvec4 rotation(q.x, q.y, q.z, q.w);
    const double length = glm::length(rotation);
    if (!(zero == 0.0f && length > 0.0 && std::isfinite(length))) { return std::nullopt; }
    return glm::vec4(rotation / length);
}

constexpr double kHair = 1.0 + 1e-5, kRounding = 1e-5;

// How far from its centre a splat of this opacity is visible, in scales.
double reachOf(float opacity) {
    return kHair * std::sqrt(std::max(2.0 * std::log(255.0 * static_cast<double>(opacity)), 0.0) + kRounding);
}

}  // namespace

glm::dvec3 halfExtentOf(const glm::quat& rotation, const glm::vec3& scales, float opacity) {
    const glm::dmat3 axes = glm::mat3_cast(glm::dquat(rotation.w, rotation.x, rotation.y, rotation.z));
    const glm::dvec3 u = static_cast<double>(scales.x) * axes[0], v = static_cast<double>(scales.y) * axes[1],
                     w = static_cast<double>(scales.z) * axes[2];
    return reachOf(opacity) * glm::sqrt(u * u + v * v + w * w);
}

void PageBounds::add(const glm::vec3& centre, const glm::quat& rotation, const glm::vec3& scales,
                     float opacity) {
    if (!(opacity >= gpu::kMinAlpha)) { return; }
    const glm::dvec3 half = halfExtentOf(rotation, scales, opacity), at(centre);
    low_ = glm::min(low_, at - half);
    high_ = glm::max(high_, at + half);
    const glm::dvec3 reaches = reachOf(opacity) * glm::abs(glm::dvec3(scales));
    reach_ = std::max({reach_, reaches.x, reaches.y, reaches.z});
    ++shown_;
}

gpu::ScenePage PageBounds::page() const {
    if (shown_ == 0) { return {}; }
    // As floats, outwards.
    constexpr float kFar = std::numeric_limits<float>::infinity();
    gpu::ScenePage page{
        .low = {}, .reach = std::nextafter(static_cast<float>(reach_), kFar), .high = {}, .count = shown_};
    for (int axis = 0; axis < 3; ++axis) {
        page.low[axis] = std::nextafter(static_cast<float>(low_[axis]), -kFar);
        page.high[axis] = std::nextafter(static_cast<float>(high_[axis]), kFar);
    }
    return page;
}

SceneTraits traitsOf(const Scene& scene) {
    return {.sh_degree = scene.sh_degree,
            .splat_kind = scene.isGaussian3d() ? gpu::kGaussians : gpu::kDiscs,
            .is_dimmed = scene.isGaussian3d() && scene.antialiased,
            .usual_order = scene.by_distance ? Order::kDistance : Order::kDepth,
            .is_light = scene.is_linear};
}

std::uint64_t deviceBytesPerSplat(int sh_degree, bool gaussian_3d) {
    return (gaussian_3d ? 52 : 48) + shWords(sh_degree) * sizeof(std::uint32_t);
}

ChunkLayout::ChunkLayout(std::uint64_t capacity, const SceneTraits& traits)
    : sh_bytes_per_splat(shWords(traits.sh_degree) * sizeof(std::uint32_t)) {
    const auto place = [&](std::uint64_t bytes_per_splat) {
        const std::uint64_t at = bytes;
        bytes += (capacity * bytes_per_splat + 15) / 16 * 16;
        return at;
    };
    sh_degree = static_cast<std::uint32_t>(traits.sh_degree);
    positions = place(sizeof(glm::vec3));
    rotations = place(sizeof(glm::vec4));
    scales = place(sizeof(glm::vec2));
    thicknesses = place(traits.isGaussian3d() ? sizeof(float) : 0);
    opacities = place(sizeof(float));
    base_colours = place(sizeof(glm::uvec2));
    sh = place(sh_bytes_per_splat);
}

gpu::SceneChunk ChunkLayout::chunkAt(const Buffer& buffer, std::uint64_t offset_bytes, float fade) const {
    return {buffer.address<gpu::vec3>(offset_bytes + positions),
            buffer.address<gpu::vec4>(offset_bytes + rotations),
            buffer.address<gpu::vec2>(offset_bytes + scales),
            buffer.address<float>(offset_bytes + thicknesses),
            buffer.address<float>(offset_bytes + opacities),
            buffer.address<gpu::uvec2>(offset_bytes + base_colours),
            buffer.address<std::uint32_t>(offset_bytes + sh),
            {},
            fade,
            sh_degree};
}

void packSplats(const Scene& scene, std::uint64_t first, std::uint64_t count, const SceneTraits& traits,
                const ChunkLayout& layout, std::uint8_t* to, PageBounds* bounds) {
    const auto put = [&]<typename T>(std::uint64_t array, std::uint64_t i, const T& value) {
        std::memcpy(to + array + i * sizeof(T), &value, sizeof(T));
    };
    const auto coefficients = static_cast<std::uint64_t>(shCoefficientCount(scene.sh_degree));
    const std::uint64_t sh_words = layout.sh_bytes_per_splat / sizeof(std::uint32_t);
    const auto kept =
        static_cast<std::uint64_t>(shCoefficientCount(std::min(scene.sh_degree, traits.sh_degree)));
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t splat = first + i;
        const std::optional<glm::vec4> rotation = rotationToShow(scene, splat);
        put(layout.positions, i, scene.positions[splat]);
        put(layout.rotations, i, rotation.value_or(glm::vec4(0.0f, 0.0f, 0.0f, 1.0f)));
        put(layout.scales, i, scene.scales[splat]);
        if (traits.isGaussian3d()) { put(layout.thicknesses, i, scene.thicknesses[splat]); }
        put(layout.opacities, i, rotation ? scene.opacities[splat] : 0.0f);
        if (rotation && bounds != nullptr) {
            const glm::vec3 scales(scene.scales[splat],
                                   scene.isGaussian3d() ? scene.thicknesses[splat] : 0.0f);
            bounds->add(scene.positions[splat], glm::quat(rotation->w, rotation->x, rotation->y, rotation->z),
                        scales, scene.opacities[splat]);
        }
        const float* sh = scene.sh.data() + splat * coefficients * 3;
        put(layout.base_colours, i, glm::uvec2(packHalves(sh[0], sh[1]), packHalves(sh[2], 0.0f)));
        const auto half = [&](std::uint64_t h) { return h < 3 * (kept - 1) ? sh[3 + h] : 0.0f; };
        for (std::uint64_t w = 0; w < sh_words; ++w) {
            put(layout.sh, i * sh_words + w, packHalves(half(2 * w), half(2 * w + 1)));
        }
    }
}

PackedPages::PackedPages(const Scene& scene, std::size_t first, std::size_t count, const SceneTraits& traits)
    : splat_count_(static_cast<std::uint32_t>(count)) {
    check(count == 0 || scene.isGaussian3d() == traits.isGaussian3d(),
          "{}: splats of {} scales, the scene's others have {}", scene.name, scene.isGaussian3d() ? 3 : 2,
          traits.isGaussian3d() ? 3 : 2);
    const ChunkLayout layout(gpu::kPageSplats, traits);
    const std::size_t pages = (count + gpu::kPageSplats - 1) / gpu::kPageSplats;
    bytes_.resize(pages * layout.bytes);  // zeros: an opacity of 0 is never visible
    for (std::size_t page = 0; page < pages; ++page) {
        const std::size_t from = first + page * gpu::kPageSplats,
                          splats = std::min<std::size_t>(gpu::kPageSplats, first + count - from);
        PageBounds bounds;
        packSplats(scene, from, splats, traits, layout, bytes_.data() + page * layout.bytes, &bounds);
        pages_.push_back(bounds.page());
    }
}

}  // namespace binosplat
