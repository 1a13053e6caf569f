// Dominant pictures and pairs of eyes that the stereo passes are tested on, and the twin's arrays as the device holds them.
#pragma once

#include "engine/passes/stereo_passes.h"
#include "engine/reference/stereo.h"
#include "tests/affiliated_frames.h"

#include <bit>
#include <string>
#include <vector>

namespace binosplat::test {

struct StereoCase {
    std::string name;
    Scene scene;
    reference::EyePair eyes;
    reference::Picture dominant;  // float32 values
    reference::StereoSettings settings;

    [[nodiscard]] glm::uvec2 sizePx() const { return eyes.source.size_px; }
};

inline gpu::uint depthChoiceOf(reference::DepthChoice choice) {
    return choice == reference::DepthChoice::kSum    ? gpu::kDepthSum
           : choice == reference::DepthChoice::kMean ? gpu::kDepthMean
                                                     : gpu::kDepthInverse;
}

inline StereoSettings settingsOf(const reference::StereoSettings& twin) {
    StereoSettings settings;
    settings.patching = twin.method == reference::StereoMethod::kPaper       ? Patching::kPaper
                        : twin.method == reference::StereoMethod::kPredicted ? Patching::kPredicted
                                                                             : Patching::kNone;
    settings.depth_choice = depthChoiceOf(twin.depth_choice);
    settings.gap_px = static_cast<gpu::uint>(twin.gap_px);
    settings.margin_px = static_cast<gpu::uint>(twin.margin_px);
    settings.edge_samples = static_cast<gpu::uint>(twin.edge_samples);
    settings.tight_edges = twin.tight_edges;
    settings.center_rois = twin.center_rois;
    settings.budget = twin.budget;
    settings.hole_error = twin.hole_error;
    settings.newcomer_error = twin.newcomer_error;
    return settings;
}

inline gpu::StereoView viewOfCase(const StereoCase& c) { return stereoViewOf(c.eyes.source, c.eyes.target, settingsOf(c.settings)); }

// Both sides start from what the device can hold.
inline void roundToFloat(reference::Picture& picture) {
    for (glm::dvec4& value : picture.rgba) { value = glm::dvec4(glm::vec4(value)); }
    for (auto* plane : {&picture.depth, &picture.inverse_depth, &picture.inverse_depth_squared}) {
        for (double& value : *plane) { value = static_cast<double>(static_cast<float>(value)); }
    }
}

inline StereoCase makeCase(const std::string& name, const Scene& scene, const std::array<Eye, 2>& eyes, Side dominant) {
    StereoCase c{name + (dominant == kLeft ? ", from the left" : ", from the right"), scene, {eyes[dominant], eyes[1 - dominant]}, {}, {}};
    c.dominant = reference::render(scene, c.eyes.source, {.inverse_depth_moments = true});
    roundToFloat(c.dominant);
    return c;
}

// Rectified, asymmetric and canted eyes, either dominant; far and near content, small and odd pictures.
inline std::vector<StereoCase> makeStereoCases() {
    std::vector<StereoCase> cases;
    const auto add = [&](const std::string& name, const ViewedScene& view, const std::array<Eye, 2>& eyes) {
        for (const Side dominant : {kLeft, kRight}) { cases.push_back(makeCase(name, view.scene, eyes, dominant)); }
    };
    const ViewedScene room = viewBuiltin("builtin:atelier", {128, 96}, 20000), small = viewBuiltin("builtin:atelier", {17, 33}, 2000);
    const ViewedScene fence = viewBuiltin("builtin:fence", {128, 96}), wide = viewBuiltin("builtin:fence", {531, 9});
    add("room", room, stereoPair(room.eye, 0.063));
    add("room, asymmetric", room, headsetEyes(room.eye, 0.0));
    add("room, canted", room, headsetEyes(room.eye, glm::radians(5.0)));
    add("fence", fence, stereoPair(fence.eye, 0.12));
    add("fence, canted", fence, headsetEyes(fence.eye, glm::radians(5.0), 0.12));
    // Rows longer than two workgroups, with holes across their borders.
    add("wide", wide, stereoPair(wide.eye, 0.25));
    add("small", small, stereoPair(small.eye, 0.2));
    add("small, canted", small, headsetEyes(small.eye, glm::radians(5.0), 0.2));
    return cases;
}

inline std::vector<gpu::vec4> coloursOf(const reference::Picture& picture) { return {picture.rgba.begin(), picture.rgba.end()}; }
inline std::vector<float> depthsOf(const reference::Picture& picture) {
    std::vector<float> depths;
    for (const double depth : picture.depth) { depths.push_back(static_cast<float>(depth)); }
    return depths;
}
// As 7_rasterize leaves them: moments, and nothing has arrived.
inline std::vector<gpu::StereoPixel> momentsOf(const reference::Picture& picture) {
    std::vector<gpu::StereoPixel> pixels;
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
        pixels.push_back({static_cast<float>(picture.inverse_depth[i]), static_cast<float>(picture.inverse_depth_squared[i]), 0, 0.0f});
    }
    return pixels;
}

inline std::vector<gpu::uint> kindsOf(const std::vector<reference::TileKind>& kinds) {
    std::vector<gpu::uint> values;
    for (const reference::TileKind kind : kinds) { values.push_back(static_cast<gpu::uint>(kind)); }
    return values;
}

// StereoPixel::nearest while pixels arrive and once they are resolved (shaders/lib/stereo.glsl), to the device and back.
inline gpu::uint packArrival(const reference::Arrival& arrival) {
    if (arrival.way == reference::Arrival::kNone) { return 0; }
    return ((std::bit_cast<gpu::uint>(static_cast<float>(arrival.inverse_depth)) + 2) & ~1u) |
           (arrival.way == reference::Arrival::kLanded ? 1u : 0u);
}
inline reference::Arrival unpackArrival(gpu::uint nearest) {
    if (nearest == 0) { return {}; }
    const auto way = (nearest & 1) != 0 ? reference::Arrival::kLanded : reference::Arrival::kBetween;
    return {way, static_cast<double>(std::bit_cast<float>((nearest & ~1u) - 2))};
}
inline gpu::uint packResolved(const reference::Resolved& resolved, bool arrived) {
    if (arrived) {
        const auto way =
            resolved.pixel_class == reference::PixelClass::kCovered ? reference::Arrival::kLanded : reference::Arrival::kBetween;
        return packArrival({way, resolved.inverse_depth});
    }
    return 0x80000000u | (static_cast<gpu::uint>(resolved.pixel_class) << 24) | resolved.column;
}
inline reference::Resolved unpackResolved(const gpu::StereoPixel& pixel, std::uint32_t x) {
    const auto depth = static_cast<double>(pixel.resolved_inverse_depth);
    if ((pixel.nearest >> 31) != 0) {
        return {static_cast<reference::PixelClass>((pixel.nearest >> 24) & 3), pixel.nearest & 0xffffffu, depth};
    }
    return {(pixel.nearest & 1) != 0 ? reference::PixelClass::kCovered : reference::PixelClass::kGap, x, depth};
}

}  // namespace binosplat::test
