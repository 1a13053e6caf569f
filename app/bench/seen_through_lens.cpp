// A headset's lenses, and the eyes behind them.
#include "app/bench/seen_through_lens.h"

#include "engine/twin/coarse.h"

#include <algorithm>
#include <cmath>

namespace binosplat {
namespace {

static_assert(Sight::kNoTile == LensView::kNowhere);

// For each tile of the lenses' grid.
std::vector<double> sharesOf(const LensView& lens, int side, const glm::dvec3& lens_centre) {
    constexpr auto tile = static_cast<double>(gpu::kTileSize);
    const glm::uvec2 tiles = lens.sizePx() / gpu::kTileSize;
    std::vector<double> shares;
    for (unsigned y = 0; y < tiles.y; ++y) {
        for (unsigned x = 0; x < tiles.x; ++x) {
            const glm::dvec2 middle_px = tile * (glm::dvec2(x, y) + 0.5);
            const double cosine = glm::dot(lens.directionAt(middle_px, side), glm::normalize(lens_centre));
            const double angle_rad = std::acos(std::clamp(cosine, -1.0, 1.0));
            shares.push_back(
                reference::seenShare(lens.solidAngleAt(middle_px), angle_rad, glm::radians(kEyesTurn_deg)));
        }
    }
    return shares;
}

}  // namespace

SeenThroughLens::SeenThroughLens(const Cameras& cameras) : lens_(cameras.eyes, cameras.lens_centres) {
    for (const int side : {kLeft, kRight}) {
        const auto s = static_cast<std::size_t>(side);
        sights_[s] = {lens_.tilesOf(side), sharesOf(lens_, side, cameras.lens_centres[s])};
    }
}

std::array<Image, 2> SeenThroughLens::show(const std::array<Image, 2>& pictures) const {
    return {lens_.show(asShown(pictures[kLeft]), kLeft), lens_.show(asShown(pictures[kRight]), kRight)};
}

}  // namespace binosplat
