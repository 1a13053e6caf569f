// newcomers: splats that the target sees and the source does not, by the tiles that hold them.
#include "engine/twin/splat.h"
#include "engine/twin/stereo.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace binosplat::reference {
namespace {

constexpr double kTilePixels = kTileSize * kTileSize;
// With this much, a tile is rendered anyway: it is more than a fixed-point sum holds.
constexpr double kMostTileError = 2048.0 - 0x1p-20;
// A wall that continues beyond the border must not count as in front of itself.
constexpr double kInFrontRatio = 1.01;

// The integral of exp(-rho) over the image, i.e. of alpha^2 / o^2: the disc's, pi sigma_u sigma_v, and the
// low-pass's.
double squareCoverage(const ProjectedSplat& splat) {
    if (splat.gaussian) { return std::numbers::pi / (splat.plane_from_pixel.x * splat.plane_from_pixel.z); }
    const double low_pass = std::numbers::pi / kLowPassFactor;
    if (!splat.disc) { return low_pass; }
    const double jacobian = splat.plane_from_pixel.x * std::abs(splat.plane_from_pixel.z) /
                            (splat.inverse_depth * splat.inverse_depth);
    return low_pass + std::numbers::pi / jacobian;
}

std::vector<std::uint32_t> countTiles(std::span<const TilePair> pairs, std::size_t splats) {
    std::vector<std::uint32_t> counts(splats, 0);
    for (const TilePair& pair : pairs) { ++counts[pair.splat]; }
    return counts;
}

}  // namespace

std::size_t addNewcomers(std::vector<double>& errors, std::span<const ProjectedSplat> target_splats,
                         std::span<const TilePair> target_pairs, std::span<const TilePair> source_pairs,
                         const Picture& dominant, std::span<const TileKind> kinds,
                         const StereoSettings& settings) {
    const glm::uvec2 size_px = dominant.size_px;
    // True if the centre, clamped to the image, is nearer than the middle of its tile; always true if the
    // tile is not reprojected.
    const auto standsInFront = [&](const ProjectedSplat& splat) {
        const glm::uvec2 at(glm::clamp(splat.reference_px, glm::dvec2(0.0), glm::dvec2(size_px) - 1.0));
        const std::size_t tile =
            at.y / kTileSize * ((size_px.x + kTileSize - 1) / kTileSize) + at.x / kTileSize;
        const auto middle = movingAtMiddle(dominant, tile, settings);
        return kinds[tile] != TileKind::kNone || !middle ||
               1.0 / splat.depth > kInFrontRatio * middle->inverse_depth;
    };
    const std::vector<std::uint32_t> in_target = countTiles(target_pairs, target_splats.size()),
                                     in_source = countTiles(source_pairs, target_splats.size());
    const auto isNewcomer = [&](std::size_t i) {
        const ProjectedSplat& splat = target_splats[i];
        return in_target[i] > 0 && in_source[i] == 0 && (!splat.low_pass || standsInFront(splat));
    };
    std::size_t newcomers = 0;
    for (std::size_t i = 0; i < target_splats.size(); ++i) { newcomers += isNewcomer(i) ? 1 : 0; }
    for (const TilePair& pair : target_pairs) {
        if (kinds[pair.tile] != TileKind::kNone || !isNewcomer(pair.splat)) { continue; }
        const ProjectedSplat& splat = target_splats[pair.splat];
        // A splat's part of a tile is the tile's share of the box of tiles around the splat.
        const glm::ivec4& box = splat.box_px;
        const auto tilesAcross = [](int begin, int end) {
            return static_cast<double>((end - 1) / kTileSize - begin / kTileSize + 1);
        };
        const double shared_by = tilesAcross(box.x, box.z) * tilesAcross(box.y, box.w);
        // A disc that comes through the near plane may cover anything.
        const double pixels =
            splat.low_pass ? std::min(squareCoverage(splat) / shared_by, kTilePixels) : kTilePixels;
        const double error =
            settings.newcomer_error * settings.newcomer_error * splat.opacity * splat.opacity * pixels;
        errors[pair.tile] = std::min(errors[pair.tile] + error, kMostTileError);
    }
    return newcomers;
}

}  // namespace binosplat::reference
