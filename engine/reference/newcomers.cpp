// 8e: splats that the target sees and the source does not, by the tiles they stand in.
#include "engine/reference/splat.h"
#include "engine/reference/stereo.h"

#include <algorithm>
#include <numbers>

namespace binosplat::reference {
namespace {

constexpr double kTilePixels = kTileSize * kTileSize;
constexpr double kInFrontRatio = 1.01;  // a wall that goes on beyond the border does not stand in front of itself

// The integral of exp(-rho) over the image, i.e. of alpha^2 / o^2: the disc's, pi sigma_u sigma_v, and the low-pass's.
double squareCoverage(const ProjectedSplat& splat) {
    if (splat.gaussian) { return std::numbers::pi / (splat.plane_from_pixel.x * splat.plane_from_pixel.z); }
    const double low_pass = std::numbers::pi / kLowPassFactor;
    if (!splat.disc) { return low_pass; }
    const double jacobian = splat.plane_from_pixel.x * std::abs(splat.plane_from_pixel.z) / (splat.inverse_depth * splat.inverse_depth);
    return low_pass + std::numbers::pi / jacobian;
}

// What the target has been given so far.
struct Reached {
    std::span<const Arrival> arrivals;
    std::span<const TileKind> kinds;
    glm::ivec2 size_px;

    [[nodiscard]] bool isMoved(const glm::ivec2& at) const {
        const int columns = (size_px.x + kTileSize - 1) / kTileSize;
        return kinds[static_cast<std::size_t>(at.y / kTileSize * columns + at.x / kTileSize)] == TileKind::kNone;
    }
    // Where nothing arrived, that of the farther of the two beside it.
    [[nodiscard]] double inverseDepth(const glm::ivec2& at) const {
        const auto row = arrivals.subspan(static_cast<std::size_t>(at.y * size_px.x), static_cast<std::size_t>(size_px.x));
        std::optional<double> farther;
        for (const int step : {-1, 1}) {
            int x = at.x;
            while (x >= 0 && x < size_px.x && row[static_cast<std::size_t>(x)].way == Arrival::kNone) { x += step; }
            if (x < 0 || x >= size_px.x) { continue; }
            const double here = row[static_cast<std::size_t>(x)].inverse_depth;
            farther = farther ? std::min(*farther, here) : here;
        }
        return farther.value_or(0.0);
    }
};

// Whether the centre, held to the image, is nearer than what was reprojected there; where nothing will be, it is.
bool standsInFront(const ProjectedSplat& splat, const Reached& reached) {
    const glm::ivec2 at(glm::floor(glm::clamp(splat.reference_px, glm::dvec2(0.0), glm::dvec2(reached.size_px) - 1.0)));
    return !reached.isMoved(at) || 1.0 / splat.depth > kInFrontRatio * reached.inverseDepth(at);
}

std::vector<std::uint32_t> countTiles(std::span<const TilePair> pairs, std::size_t splats) {
    std::vector<std::uint32_t> counts(splats, 0);
    for (const TilePair& pair : pairs) { ++counts[pair.splat]; }
    return counts;
}

}  // namespace

std::size_t addNewcomers(std::vector<double>& errors, std::span<const ProjectedSplat> target_splats, std::span<const TilePair> target_pairs,
                         std::span<const TilePair> source_pairs, std::span<const Arrival> arrivals, std::span<const TileKind> kinds,
                         glm::uvec2 size_px, double newcomer_error) {
    const Reached reached{arrivals, kinds, glm::ivec2(size_px)};
    const std::vector<std::uint32_t> in_target = countTiles(target_pairs, target_splats.size()),
                                     in_source = countTiles(source_pairs, target_splats.size());
    const auto isNewcomer = [&](std::size_t i) {
        const ProjectedSplat& splat = target_splats[i];
        return in_target[i] > 0 && in_source[i] == 0 && (!splat.low_pass || standsInFront(splat, reached));
    };
    std::size_t newcomers = 0;
    for (std::size_t i = 0; i < target_splats.size(); ++i) { newcomers += isNewcomer(i) ? 1 : 0; }
    for (const TilePair& pair : target_pairs) {
        if (kinds[pair.tile] != TileKind::kNone || !isNewcomer(pair.splat)) { continue; }
        const ProjectedSplat& splat = target_splats[pair.splat];
        // A splat's part of a tile is its share of the box of tiles about it.
        const glm::ivec4& box = splat.box_px;
        const auto tilesAcross = [](int begin, int end) { return static_cast<double>((end - 1) / kTileSize - begin / kTileSize + 1); };
        const double shared_by = tilesAcross(box.x, box.z) * tilesAcross(box.y, box.w);
        // A disc that comes through the near plane may cover anything.
        const double pixels = splat.low_pass ? std::min(squareCoverage(splat) / shared_by, kTilePixels) : kTilePixels;
        errors[pair.tile] += newcomer_error * newcomer_error * splat.opacity * splat.opacity * pixels;
    }
    return newcomers;
}

}  // namespace binosplat::reference
