// A scene as each stage of the twin leaves it, and what the device needs to continue from any of them.
#pragma once

#include "engine/gpu/gpu_scene.h"
#include "engine/passes/eye_view.h"
#include "tests/engine/frame/gpu_scenes.h"
#include "tests/engine/gpu/gpu_fixture.h"

#include <glm/gtc/packing.hpp>

namespace binosplat::test {

// Outputs of the twin's passes, in frame order.
struct TwinStages {
    TwinStages(const ViewedScene& view, const reference::Settings& settings)
        : visible(reference::cull(view.scene, {&view.eye, 1}, settings)),
          compacted(reference::compact(view.scene, visible, view.eye, settings)),
          order(reference::sortDepth(compacted, settings)),
          splats(reference::project(view.scene, order, view.eye, settings)),
          pairs(reference::bin(splats, view.eye.size_px, settings)),
          sorted_pairs(pairs) {
        reference::sortTiles(sorted_pairs, settings);
        ranges = reference::tileRanges(sorted_pairs, view.eye.size_px);
    }

    std::vector<std::uint8_t> visible;
    reference::Visible compacted;
    std::vector<std::uint32_t> order;
    std::vector<reference::ProjectedSplat> splats;
    std::vector<reference::TilePair> pairs, sorted_pairs;
    std::vector<reference::TileRange> ranges;
};

// Scenes of all kinds, and what the twin makes of them.
struct StagedScene {
    ViewedScene view;
    TwinStages twin{view, {}};
};
inline const std::vector<StagedScene>& stagedScenes() {
    static const std::vector<StagedScene> scenes{{viewBuiltin("builtin:atelier", {256, 256}, 20000)},
                                                 {viewBuiltin("builtin:fence", {250, 190})},
                                                 {viewBuiltin("builtin:slanted-wall", {256, 256})},
                                                 {viewCloud({200, 150})},
                                                 {viewGaussians({200, 150}, false)},
                                                 {viewGaussians({200, 150}, true)}};
    return scenes;
}

inline Buffer uploadEyes(Gpu& gpu, const std::vector<Eye>& eyes, double near) {
    std::vector<gpu::EyeView> views;
    for (const Eye& eye : eyes) { views.push_back(viewOf(eye, near)); }
    return gpu.upload("eyes", views);
}

// A scene and its eyes on the device.
struct SceneOnDevice {
    SceneOnDevice(Gpu& gpu, const Scene& host_scene, const std::vector<Eye>& host_eyes, double near)
        : scene(gpu.context(), host_scene), eyes(uploadEyes(gpu, host_eyes, near)) {}

    GpuScene scene;
    Buffer eyes;
};

inline constexpr double kEpsilon = 0x1p-24;  // of a float32 rounding
// Only the distance to the eye is rounded when the device moves a splat to camera space, since the eye has 48
// bits.
inline double distanceToRound(const glm::dvec3& position, const Eye& eye) {
    return glm::length(position - eye.world_from_camera.position);
}

// The float for an integer of the order-preserving encoding.
inline float floatOfSortable(std::uint32_t bits) {
    return std::bit_cast<float>((bits >> 31) != 0 ? bits & 0x7fffffffu : ~bits);
}

// The lowest and the highest depth that a key may stand for (shaders/sort/compact.comp).
inline std::pair<float, float> depthsOfKey(std::uint32_t key, float near) {
    const std::uint32_t first_exact = std::bit_cast<std::uint32_t>(0.5f * near) | 0x80000000u;
    const std::uint32_t first_key = (first_exact >> gpu::kNearKeyShift) + 1,
                        last_key = first_key + gpu::kExactDepthKeys;
    const auto range = [](std::uint32_t first, std::uint32_t shift) {
        return std::pair(floatOfSortable(first), floatOfSortable(first + (1u << shift) - 1));
    };
    if (key < first_key) { return range(key << gpu::kNearKeyShift, gpu::kNearKeyShift); }
    if (key < last_key) { return range(first_exact + key - first_key, 0); }
    return range(first_exact + gpu::kExactDepthKeys + ((key - last_key) << gpu::kFarKeyShift),
                 gpu::kFarKeyShift);
}

// ProjectedSplat::opacity (-log2, negative if there is no reference) and ::colour (three half floats).
struct OpacityColour {
    double opacity;
    bool has_reference;
    glm::dvec3 colour;
};
inline OpacityColour unpack(const gpu::ProjectedSplat& splat) {
    const glm::vec2 red_green = glm::unpackHalf2x16(splat.colour.x);
    return {std::exp2(-std::abs(static_cast<double>(splat.opacity))), !std::signbit(splat.opacity),
            glm::dvec3(glm::vec3(red_green, glm::unpackHalf2x16(splat.colour.y).x))};
}

// ProjectedSplat::reference_px with the bits that its two floats lack: eight each, in units of half their
// last place.
inline glm::dvec2 referenceOf(const gpu::ProjectedSplat& splat) {
    const glm::vec4 rest = glm::unpackSnorm4x8(splat.colour.y);
    glm::dvec2 reference(splat.reference_px);
    for (int axis = 0; axis < 2; ++axis) {
        reference[axis] +=
            static_cast<double>(rest[2 + axis]) * std::ldexp(1.0, std::ilogb(reference[axis]) - 24);
    }
    return reference;
}

// The twin's splat in the device's format.
inline gpu::ProjectedSplat toDevice(const reference::ProjectedSplat& splat) {
    gpu::ProjectedSplat result{};
    result.reference_px = splat.low_pass ? splat.reference_px : splat.plane_offset;
    result.plane_from_pixel = splat.disc ? glm::vec3(splat.plane_from_pixel)
                                         : glm::vec3(gpu::kMaxPlaneSlope, 0.0f, gpu::kMaxPlaneSlope);
    result.perspective = splat.perspective;
    result.inverse_depth = static_cast<float>(splat.disc ? splat.inverse_depth : 1.0 / splat.depth);
    result.opacity =
        std::copysign(static_cast<float>(std::log2(splat.opacity)), splat.low_pass ? 1.0f : -1.0f);
    const glm::vec3 colour(splat.colour);
    result.colour = {glm::packHalf2x16(glm::vec2(colour)), glm::packHalf2x16(glm::vec2(colour.z, 0.0f))};
    return result;
}

// How many tiles are in a set of lib/tile_set.glsl.
inline std::uint32_t tilesIn(glm::uvec2 tile_set) {
    return (tile_set.y & 0x80000000u) != 0 ? static_cast<std::uint32_t>(std::popcount(tile_set.y & 0xffffu))
                                           : tile_set.y >> 10;
}

// What project leaves on the device for a list of splats.
struct ProjectedOnDevice {
    std::uint32_t count;
    Buffer list, order, splats, tile_sets, group_sums, pairs, target;
};

// `tile_mask`, unless null, has the bits of the tiles that count (shaders/lib/tile_mask.glsl).
inline ProjectedOnDevice projectOnDevice(Gpu& gpu, const SceneOnDevice& device,
                                         const std::vector<std::uint32_t>& order,
                                         std::uint32_t pair_capacity = UINT32_MAX,
                                         gpu::DeviceAddress<gpu::uint> tile_mask = {}) {
    const Kernel& kernel =
        gpu.kernel(ProjectKernel{.sh_degree = static_cast<std::uint32_t>(device.scene.shDegree()),
                                 .masked = tile_mask.value != 0,
                                 .splat_kind = device.scene.splatKind()});
    const std::size_t count = order.size();
    gpu::TargetState state{};
    state.tile_mask = tile_mask;
    ProjectedOnDevice result{
        static_cast<std::uint32_t>(count),
        gpu.upload("list", std::vector{makeList(count)}),
        gpu.upload("order", order),
        gpu.allocate<gpu::ProjectedSplat>("splats", count),
        gpu.allocate<glm::uvec2>("tile sets", count),
        gpu.allocate<std::uint32_t>("group sums", (count + gpu::kListBlock - 1) / gpu::kListBlock),
        gpu.upload("pairs", std::vector{gpu::ListState{}}),
        gpu.upload("target", std::vector{state})};
    const gpu::ProjectPass pass{.chunks = device.scene.chunks(),
                                .eyes = at(device.eyes),
                                .order = at(result.order),
                                .visible = at(result.list),
                                .splats = at(result.splats),
                                .tile_sets = at(result.tile_sets),
                                .group_sums = at(result.group_sums),
                                .pairs = at(result.pairs),
                                .targets = at(result.target),
                                .chunk_bits = device.scene.chunkBits(),
                                .splats_apart = 0,
                                .capacity = pair_capacity,
                                .is_dimmed = device.scene.traits().is_dimmed};
    gpu.dispatchIndirect(kernel, pass, result.list, offsetof(gpu::ListState, per_block));
    return result;
}

}  // namespace binosplat::test
