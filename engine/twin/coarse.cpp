// Twin of rasterize for coarse tiles.
#include "engine/twin/coarse.h"

#include "engine/parallel.h"
#include "engine/twin/blend.h"

#include <cmath>

namespace binosplat::reference {
namespace {

double angleTo(const Eye& eye, const Gaze& gaze, const glm::dvec2& place_px) {
    const Intrinsics& lens = eye.intrinsics;
    const glm::dvec3 ray((place_px.x - lens.cx) / lens.fx, (place_px.y - lens.cy) / lens.fy, 1.0);
    return std::acos(std::clamp(glm::dot(glm::normalize(ray), glm::normalize(gaze.direction)), -1.0, 1.0));
}

// Catmull and Rom's kernel, by the distance from a sample.
double cubic(double distance) {
    const double d = std::abs(distance);
    if (d >= 2.0) { return 0.0; }
    return d < 1.0 ? 1.0 + d * d * (1.5 * d - 2.5) : 2.0 + d * (-4.0 + d * (2.5 - 0.5 * d));
}

// The value at `place` among samples at 0, 1, 2 ... 7, and at -1 and 8, to which parabolas are continued.
template <typename At>
glm::dvec4 alongAxis(double place, const At& at) {
    glm::dvec4 sum(0.0);
    for (int i = -1; i <= kTileSamples; ++i) {
        const int last = kTileSamples - 1;
        const glm::dvec4 value = i < 0               ? 3.0 * at(0) - 3.0 * at(1) + at(2)
                                 : i >= kTileSamples ? 3.0 * at(last) - 3.0 * at(last - 1) + at(last - 2)
                                                     : at(i);
        sum += cubic(place - i) * value;
    }
    return sum;
}

std::size_t sampleIndex(int x, int y) { return static_cast<std::size_t>(y * kTileSamples + x); }

// What the samples of a tile see.
using Samples = std::array<PixelState, static_cast<std::size_t>(kTileSamples) * kTileSamples>;

Samples blendSamples(const Tile& tile, std::span<const ProjectedSplat> splats,
                     std::span<const TilePair> pairs, glm::uvec2 size_px, const Settings& settings) {
    const double apart = static_cast<double>(kTileSize - 1) / (kTileSamples - 1);
    Samples samples;
    for (const TilePair& pair : pairs) {
        const ProjectedSplat& splat = splats[pair.splat];
        const RayPlane plane = rayPlane(splat, size_px, settings.near);
        for (int y = 0; y < kTileSamples; ++y) {
            for (int x = 0; x < kTileSamples; ++x) {
                PixelState& sample = samples[sampleIndex(x, y)];
                Hit hit;
                const glm::dvec2 place_px = glm::dvec2(tile.begin_px) + 0.5 + apart * glm::dvec2(x, y);
                if (sample.open && meet(plane, place_px, hit)) {
                    blend(sample, splat, hit, settings.inverse_depth_moments);
                }
            }
        }
    }
    return samples;
}

void fillTile(const Tile& tile, const Samples& samples, std::span<const glm::dvec4> colours,
              Picture& picture) {
    for (int y = 0; y < kTileSize; ++y) {
        for (int x = 0; x < kTileSize; ++x) {
            const std::size_t i = static_cast<std::size_t>(tile.begin_px.y + y) * picture.size_px.x +
                                  static_cast<std::size_t>(tile.begin_px.x + x);
            const PixelState& nearest = samples[sampleIndex(x / 2, y / 2)];
            glm::dvec4& pixel = picture.rgba[i];
            pixel = glm::max(fillAt(colours, {x, y}), glm::dvec4(0.0));
            pixel.a = std::min(pixel.a, 1.0);
            const double share = nearest.weight > 0.0 ? pixel.a / nearest.weight : 0.0;
            picture.depth[i] = share * nearest.depth;
            if (picture.inverse_depth.empty()) { continue; }
            picture.inverse_depth[i] = share * nearest.inverse_depth;
            picture.inverse_depth_squared[i] = share * nearest.inverse_depth_squared;
        }
    }
}

}  // namespace

double seenShare(double pixel_sr, double angle_rad, double clear_rad) {
    const double finest_rad = glm::radians(1.0 / 48.0) + 0.022 * std::max(angle_rad - clear_rad, 0.0);
    return std::min(1.0, 2.0 * 2.0 * pixel_sr / (finest_rad * finest_rad));
}

std::vector<double> findSharesThere(const Eye& eye, const Gaze& gaze) {
    const glm::ivec2 tiles(tileGrid(eye.size_px));
    const Intrinsics& lens = eye.intrinsics;
    std::vector<double> shares;
    for (int y = 0; y < tiles.y; ++y) {
        for (int x = 0; x < tiles.x; ++x) {
            const glm::dvec2 place_px = static_cast<double>(kTileSize) * (glm::dvec2(x, y) + 0.5);
            const double tan_x = (place_px.x - lens.cx) / lens.fx, tan_y = (place_px.y - lens.cy) / lens.fy;
            const double cosine = 1.0 / std::sqrt(1.0 + tan_x * tan_x + tan_y * tan_y);
            const double pixel_sr = cosine * cosine * cosine / (lens.fx * lens.fy);
            shares.push_back(seenShare(pixel_sr, angleTo(eye, gaze, place_px), gaze.clear_rad));
        }
    }
    return shares;
}

std::vector<std::uint8_t> findBeyond(const Eye& eye, const Gaze& gaze) {
    std::vector<std::uint8_t> beyond;
    for (const double share : findSharesThere(eye, gaze)) { beyond.push_back(share <= 0.25 ? 1 : 0); }
    return beyond;
}

glm::dvec4 fillAt(std::span<const glm::dvec4> samples, glm::ivec2 pixel) {
    const glm::dvec2 place =
        glm::dvec2(pixel) * static_cast<double>(kTileSamples - 1) / static_cast<double>(kTileSize - 1);
    return alongAxis(place.y, [&](int y) {
        return alongAxis(place.x, [&](int x) { return samples[sampleIndex(x, y)]; });
    });
}

double expectLoss(std::span<const glm::dvec4> samples) {
    constexpr double kLoss = 0.3, kMost = 4.0, kBorders = 8.0 / 6.0;
    const auto second = [&](int x, int y, int step_x, int step_y) {
        if (std::min(x - step_x, y - step_y) < 0 || std::max(x + step_x, y + step_y) >= kTileSamples) {
            return 0.0;
        }
        const glm::dvec3 difference(samples[sampleIndex(x - step_x, y - step_y)] -
                                    2.0 * samples[sampleIndex(x, y)] +
                                    samples[sampleIndex(x + step_x, y + step_y)]);
        return glm::dot(difference, difference);
    };
    double loss = 0.0;
    for (int y = 0; y < kTileSamples; ++y) {
        for (int x = 0; x < kTileSamples; ++x) {
            loss += std::min(kBorders * (second(x, y, 1, 0) + second(x, y, 0, 1)), kMost);
        }
    }
    return kLoss * loss;
}

CoarsePicture rasterizeCoarse(std::span<const ProjectedSplat> splats, std::span<const TilePair> pairs,
                              std::span<const TileRange> ranges, const Eye& eye, const Gaze& gaze,
                              const Settings& settings) {
    constexpr double kLeastSeen = 0.01 * 0.01 * kTileSize * kTileSize;
    const std::vector<double> shares = findSharesThere(eye, gaze);
    const std::vector<std::uint8_t> beyond = findBeyond(eye, gaze);
    CoarsePicture made{rasterize(splats, pairs, ranges, eye, settings),
                       std::vector<std::uint8_t>(ranges.size(), 0),
                       std::vector<std::uint8_t>(ranges.size(), 0), std::vector<double>(ranges.size(), 0.0)};
    forBlocks(ranges.size(), 1, settings.threads, [&](std::size_t t, std::size_t) {
        const Tile tile(t, eye.size_px);
        const TileRange range = ranges[t];
        if (beyond[t] == 0 || range.begin == range.end ||
            tile.end_px - tile.begin_px != glm::ivec2(kTileSize)) {
            return;
        }
        const Samples samples = blendSamples(
            tile, splats, pairs.subspan(range.begin, range.end - range.begin), eye.size_px, settings);
        std::vector<glm::dvec4> colours;
        for (const PixelState& sample : samples) { colours.push_back(shownOf(sample, settings)); }
        made.tried[t] = 1;
        made.losses[t] = expectLoss(colours);
        if (shares[t] * made.losses[t] >= kLeastSeen) { return; }
        made.coarse[t] = 1;
        fillTile(tile, samples, colours, made.picture);
    });
    return made;
}

CoarsePicture renderCoarse(const Scene& scene, const Eye& eye, const Gaze& gaze, const Settings& asked,
                           std::span<const std::uint8_t> hidden) {
    Settings settings = asked;
    settings.is_light = scene.is_linear;
    const auto visible = cull(scene, {&eye, 1}, settings);
    const auto splats =
        project(scene, sortDepth(compact(scene, visible, eye, settings), settings), eye, settings);
    auto pairs = bin(splats, eye.size_px, settings);
    hidePairs(pairs, hidden);
    sortTiles(pairs, settings);
    return rasterizeCoarse(splats, pairs, tileRanges(pairs, eye.size_px), eye, gaze, settings);
}

}  // namespace binosplat::reference
