// Dominant pictures and pairs of eyes with which the stereo passes are tested, and the twin's arrays in the
// device's format.
#pragma once

#include "app/scores/metrics.h"
#include "engine/twin/stereo.h"
#include "tests/engine/frame/affiliated_frames.h"

#include <glm/gtc/packing.hpp>

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
    settings.choice = twin.choice;
    settings.depth_choice = depthChoiceOf(twin.depth_choice);
    settings.forward = twin.forward;
    settings.gap_px = static_cast<gpu::uint>(twin.gap_px);
    settings.margin_px = static_cast<gpu::uint>(twin.margin_px);
    settings.edge_samples = static_cast<gpu::uint>(twin.edge_samples);
    settings.tight_edges = twin.tight_edges;
    settings.center_rois = twin.center_rois;
    settings.budget = twin.budget;
    settings.move_cost = twin.move_cost;
    settings.hole_error = twin.hole_error;
    settings.newcomer_error = twin.newcomer_error;
    return settings;
}

// A frame in which one eye is reprojected from the other, and the twin's.
struct MadeWithTwin {
    AffiliatedFrame made;
    Image depth;  // of the affiliated eye, if it was kept
    reference::StereoPictures twin;
    std::vector<std::uint32_t> same_kind;  // tiles of which both make the same kind; these look alike, too
};
inline MadeWithTwin makeWithTwin(StereoFrame& frame, const Scene& scene, const std::array<Eye, 2>& eyes,
                                 const reference::StereoSettings& twin_settings,
                                 const FrameSettings& settings) {
    const Side dominant = settings.dominant, other = dominant == kLeft ? kRight : kLeft;
    AffiliatedFrame made = makeAffiliated(frame, eyes, settings);
    MadeWithTwin both{std::move(made),
                      settings.keep_both_depths ? frame.readDepth(other) : Image{},
                      reference::renderStereo(scene, {eyes[dominant], eyes[other]}, twin_settings,
                                              {.background = settings.background}),
                      {}};
    for (std::size_t t = 0; t < both.twin.tile_kinds.size(); ++t) {
        const auto kind = static_cast<std::uint32_t>(both.twin.tile_kinds[t]);
        both.same_kind.push_back(both.made.tile_kinds[t] == kind ? 1 : 0);
    }
    const Image expected = keepTiles(toImage(eyes[0].size_px, both.twin.affiliated), both.same_kind);
    const Difference difference = compare(keepTiles(both.made.pictures[other], both.same_kind), expected, 4);
    CHECK(difference.psnrDb() >= 80.0);      // measured: 84.5 and more; of 3D Gaussians 81.3
    CHECK(difference.shareOff() <= 0.0001);  // measured: none
    CHECK(compare(both.made.pictures[dominant], toImage(both.twin.dominant), 4).psnrDb() >= 80.0);
    return both;
}

// A moving pixel and an arrival in the device's format: one word (shaders/lib/moving_pixel.glsl).
inline gpu::uint packMoving(double inverse_depth, bool landed, gpu::uint spread) {
    return ((((std::bit_cast<gpu::uint>(static_cast<float>(inverse_depth)) + 16) >> 5) + 1) << 6) |
           (landed ? 32u : 0u) | spread;
}
inline gpu::uint packMoving(const std::optional<reference::MovingPixel>& pixel) {
    return pixel ? packMoving(pixel->inverse_depth, true, pixel->spread) : 0;
}
inline gpu::uint packArrival(const reference::Arrival& arrival) {
    if (arrival.way == reference::Arrival::kNone) { return 0; }
    return packMoving(arrival.inverse_depth, arrival.way == reference::Arrival::kLanded, arrival.spread);
}
inline reference::Arrival unpackArrival(gpu::uint word) {
    if (word == 0) { return {}; }
    return {(word & 32) != 0 ? reference::Arrival::kLanded : reference::Arrival::kBetween,
            static_cast<double>(std::bit_cast<float>(((word >> 6) - 1) << 5)), word & 31, 0};
}

// Both start from what the device can store.
inline void roundToFloat(reference::Picture& picture) {
    for (glm::dvec4& value : picture.rgba) { value = glm::dvec4(glm::vec4(value)); }
    for (auto* plane : {&picture.depth, &picture.inverse_depth, &picture.inverse_depth_squared}) {
        for (double& value : *plane) { value = static_cast<double>(static_cast<float>(value)); }
    }
}

// The same where the device stores one word per pixel, with this depth and this spread.
inline void roundToWords(reference::Picture& picture, const reference::StereoSettings& settings) {
    roundToFloat(picture);
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
        const reference::Arrival held =
            unpackArrival(packMoving(reference::movingPixel(picture, i, settings)));
        const double weight = picture.rgba[i].w, w = held.inverse_depth,
                     spread = reference::spreadOf(held.spread);
        picture.depth[i] = held.way != reference::Arrival::kNone && w > 0.0 ? weight / w : -weight;
        picture.inverse_depth[i] = held.way != reference::Arrival::kNone ? weight * w : -weight;
        picture.inverse_depth_squared[i] = weight * w * w * (1.0 + spread * spread);
    }
}

// Colours as the device's half floats store them, and back.
inline std::vector<gpu::uvec2> packHalves(const std::vector<gpu::vec4>& colours) {
    std::vector<gpu::uvec2> halves;
    for (const gpu::vec4& c : colours) {
        halves.emplace_back(glm::packHalf2x16({c.x, c.y}), glm::packHalf2x16({c.z, c.w}));
    }
    return halves;
}
inline std::vector<gpu::vec4> unpackHalves(const std::vector<gpu::uvec2>& halves) {
    std::vector<gpu::vec4> colours;
    for (const gpu::uvec2& packed : halves) {
        colours.emplace_back(glm::unpackHalf2x16(packed.x), glm::unpackHalf2x16(packed.y));
    }
    return colours;
}

// The same where colours are half floats. Depths stay as they are.
inline void roundToHalves(reference::Picture& picture) {
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
        const double before = picture.rgba[i].w;
        for (int channel = 0; channel < 4; ++channel) {
            double& value = picture.rgba[i][channel];
            value = static_cast<double>(glm::unpackHalf1x16(glm::packHalf1x16(static_cast<float>(value))));
        }
        const double scale = before > 0.0 ? picture.rgba[i].w / before : 1.0;
        for (auto* plane : {&picture.depth, &picture.inverse_depth, &picture.inverse_depth_squared}) {
            (*plane)[i] *= scale;
        }
    }
}

inline reference::EyePair pairOf(const std::array<Eye, 2>& eyes, Side dominant = kLeft) {
    return {eyes[dominant], eyes[1 - dominant]};
}

inline StereoCase makeCase(const std::string& name, const Scene& scene, const std::array<Eye, 2>& eyes,
                           Side dominant) {
    StereoCase c{name + (dominant == kLeft ? ", from the left" : ", from the right"),
                 scene,
                 pairOf(eyes, dominant),
                 {},
                 {}};
    c.dominant = reference::render(scene, c.eyes.source, {.inverse_depth_moments = true});
    roundToWords(c.dominant, c.settings);
    return c;
}

// A pixel of a picture that is computed: its depths differ by that share of it.
struct ComputedPixel {
    glm::dvec4 rgba{0.0};
    double inverse_depth = 0.0, spread = 0.0;
};
template <typename At>
StereoCase computeCase(const reference::EyePair& eyes, const At& at) {
    const glm::uvec2 size_px = eyes.source.size_px;
    StereoCase c{"computed", {}, eyes, {size_px, {}, {}, {}, {}}, {}};
    for (std::uint32_t i = 0; i < size_px.x * size_px.y; ++i) {
        const ComputedPixel pixel = at(i % size_px.x, i / size_px.x);
        const double w = pixel.inverse_depth;
        c.dominant.rgba.push_back(pixel.rgba);
        c.dominant.depth.push_back(0.0);
        c.dominant.inverse_depth.push_back(w);
        c.dominant.inverse_depth_squared.push_back(w * w * (1.0 + pixel.spread * pixel.spread));
    }
    roundToWords(c.dominant, c.settings);
    return c;
}
// Nothing is seen.
inline StereoCase computeEmpty(const reference::EyePair& eyes) {
    return computeCase(eyes, [](auto, auto) { return ComputedPixel{}; });
}

// Rectified, asymmetric and canted eyes, either of them dominant; far and near content, small and odd
// pictures. Made once.
inline const std::vector<StereoCase>& makeStereoCases() {
    static const std::vector<StereoCase> cases = [] {
        std::vector<StereoCase> made;
        const auto add = [&](const std::string& name, const ViewedScene& view,
                             const std::array<Eye, 2>& eyes) {
            for (const Side dominant : {kLeft, kRight}) {
                made.push_back(makeCase(name, view.scene, eyes, dominant));
            }
        };
        const ViewedScene room = viewBuiltin("builtin:atelier", {128, 96}, 20000),
                          small = viewBuiltin("builtin:atelier", {17, 33}, 2000);
        const ViewedScene fence = viewBuiltin("builtin:fence", {128, 96}),
                          wide = viewBuiltin("builtin:fence", {531, 9});
        add("room", room, stereoPair(room.eye, 0.063));
        add("room, asymmetric", room, headsetEyes(room.eye, 0.0));
        add("room, canted", room, headsetEyes(room.eye, glm::radians(5.0)));
        add("fence", fence, stereoPair(fence.eye, 0.12));
        add("fence, canted", fence, headsetEyes(fence.eye, glm::radians(5.0), 0.12));
        // Rows longer than four workgroups, with holes across their borders.
        add("wide", wide, stereoPair(wide.eye, 0.25));
        add("small", small, stereoPair(small.eye, 0.2));
        add("small, canted", small, headsetEyes(small.eye, glm::radians(5.0), 0.2));
        return made;
    }();
    return cases;
}

inline std::vector<gpu::vec4> coloursOf(const reference::Picture& picture) {
    return {picture.rgba.begin(), picture.rgba.end()};
}
inline std::vector<gpu::uint> movingOf(const reference::Picture& picture,
                                       const reference::StereoSettings& settings) {
    std::vector<gpu::uint> words;
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
        words.push_back(packMoving(reference::movingPixel(picture, i, settings)));
    }
    return words;
}

inline std::vector<gpu::uint> kindsOf(const std::vector<reference::TileKind>& kinds) {
    std::vector<gpu::uint> values;
    for (const reference::TileKind kind : kinds) { values.push_back(static_cast<gpu::uint>(kind)); }
    return values;
}
inline std::vector<reference::TileKind> kindsOf(const std::vector<gpu::uint>& values) {
    std::vector<reference::TileKind> kinds;
    for (const gpu::uint value : values) { kinds.push_back(static_cast<reference::TileKind>(value)); }
    return kinds;
}

// From one byte per tile, which is 1 if the tile counts, to a mask of bits (shaders/lib/tile_mask.glsl).
inline std::vector<gpu::uint> maskOf(const std::vector<std::uint8_t>& tiles, glm::uvec2 size_tiles) {
    const std::size_t row_words = (size_tiles.x + 31) / 32;
    std::vector<gpu::uint> mask(row_words * size_tiles.y, 0);
    for (std::size_t t = 0; t < tiles.size(); ++t) {
        const std::size_t x = t % size_tiles.x;
        if (tiles[t] != 0) { mask[t / size_tiles.x * row_words + x / 32] |= 1u << (x % 32); }
    }
    return mask;
}

inline bool isNear(double a, double b, double relative, double absolute) {
    return std::abs(a - b) <= relative * std::max(std::abs(a), std::abs(b)) + absolute;
}

// What the twin's reproject leaves, in the device's format, and the same for the twin again.
struct Arrived {
    explicit Arrived(const StereoCase& c) {
        for (const reference::Arrival& arrival : reference::reproject(c.dominant, c.eyes, c.settings)) {
            words.push_back(packArrival(arrival));
            arrivals.push_back(unpackArrival(words.back()));
            arrivals.back().source = arrival.source;
        }
    }
    std::vector<gpu::uint> words;
    std::vector<reference::Arrival> arrivals;
};

// What weigh tells newcomers about each tile.
inline std::vector<gpu::uint> depthsOfTiles(const StereoCase& c) {
    std::vector<gpu::uint> depths(tileCount(c.sizePx()));
    for (std::size_t t = 0; t < depths.size(); ++t) {
        depths[t] = packMoving(reference::movingAtMiddle(c.dominant, t, c.settings));
    }
    return depths;
}

// Every third tile has one of these kinds.
inline std::vector<reference::TileKind> markSome(std::size_t tiles) {
    std::vector<reference::TileKind> kinds(tiles, reference::TileKind::kNone);
    for (std::size_t t = 0; t < tiles; t += 3) { kinds[t] = static_cast<reference::TileKind>(1 + t % 5); }
    return kinds;
}

inline double share(std::size_t part, std::size_t whole) {
    return static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace binosplat::test
