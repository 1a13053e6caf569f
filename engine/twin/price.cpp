// Twin of price: the worth of removing a tile's error by rendering it, relative to the tile's cost.
#include "engine/twin/splat.h"
#include "engine/twin/stereo.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace binosplat::reference {

std::vector<std::optional<std::uint32_t>> price(std::span<const TileKind> kinds,
                                                std::span<const double> errors,
                                                std::span<const std::uint64_t> costs,
                                                std::span<const double> seen_shares) {
    // A hundredth of the whole range in each pixel of a tile.
    constexpr double kLeastSeen = 0.01 * 0.01 * kTileSize * kTileSize;
    constexpr double kMostSteps = 0x1p31 - 1.0, kBinsPerOctave = 16.0, kFirstOctave = -23.0, kBins = 1023.0;
    std::vector<std::optional<std::uint32_t>> prices(kinds.size());
    for (std::size_t t = 0; t < kinds.size(); ++t) {
        const double steps = std::min(std::floor(errors[t] * 0x1p20), kMostSteps);
        if (kinds[t] != TileKind::kNone || !(steps > 0.0)) { continue; }
        const double share = seen_shares.empty() ? 1.0 : seen_shares[t];
        if (share < 1.0 && share * steps < kLeastSeen * 0x1p20) { continue; }
        // The bins of an octave are equally wide.
        int octave = 0;
        const double within = 2.0 * std::frexp(share * steps / static_cast<double>(costs[t]), &octave) - 1.0;
        const double bin = kBinsPerOctave * (octave - 1 - kFirstOctave) + std::floor(kBinsPerOctave * within);
        prices[t] = static_cast<std::uint32_t>(std::clamp(bin, 0.0, kBins - 1.0));
    }
    return prices;
}

std::vector<double> findSeenShares(const Eye& target, const Gaze& gaze) {
    const Intrinsics& lens = target.intrinsics;
    const glm::uvec2 tiles = tileGrid(target.size_px);
    const glm::dvec3 towards = glm::normalize(gaze.direction);
    const double pixel_deg = glm::degrees(1.0 / std::min(lens.fx, lens.fy));
    std::vector<double> shares;
    for (unsigned y = 0; y < tiles.y; ++y) {
        for (unsigned x = 0; x < tiles.x; ++x) {
            const glm::dvec2 middle_px = (glm::dvec2(x, y) + 0.5) * static_cast<double>(kTileSize);
            const glm::dvec3 ray((middle_px.x - lens.cx) / lens.fx, (middle_px.y - lens.cy) / lens.fy, 1.0);
            const double angle_deg =
                glm::degrees(std::acos(std::clamp(glm::dot(glm::normalize(ray), towards), -1.0, 1.0)));
            const double finest_deg =
                1.0 / 48.0 + 0.022 * std::max(angle_deg - glm::degrees(gaze.clear_rad), 0.0);
            shares.push_back(std::pow(std::min(2.0 * pixel_deg / finest_deg, 1.0), 2.0));
        }
    }
    return shares;
}

}  // namespace binosplat::reference
