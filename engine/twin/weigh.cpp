// Twin of weigh: finds the tiles that the source does not see, those that are never seen, and those that cost
// less to render than to reproject.
#include "engine/twin/eye_change.h"
#include "engine/twin/splat.h"

#include <algorithm>

namespace binosplat::reference {
namespace {

// A tile costs this many pairs in addition to its own; its cost is capped at what its word can hold.
constexpr std::uint64_t kTilePairs = 16, kMaxTileCost = (1u << 21) - 1;
// Reprojecting has a cost even if no tile is reprojected: that of reprojecting all tiles, divided by this.
constexpr std::uint64_t kMoveSharedPart = 2;

// The pixel in the middle of a tile, in an even row, since odd rows may lack depths.
glm::uvec2 middleOf(std::size_t tile, glm::uvec2 size_px) {
    const std::uint32_t columns = tileGrid(size_px).x;
    const glm::uvec2 at(tile % columns, tile / columns);
    return glm::min(at * unsigned{kTileSize} + unsigned{kTileSize / 2}, size_px - 1u) & glm::uvec2(~0u, ~1u);
}

// The source tile from which the middle of a target tile comes, if it has the depth that the source has
// there.
std::size_t sourceTile(const Picture& dominant, const EyeChange& source_from_target, std::size_t tile,
                       const StereoSettings& settings) {
    const glm::uvec2 size_px = dominant.size_px;
    const auto pixel = movingAtMiddle(dominant, tile, settings);
    const glm::dvec2 middle_px = glm::dvec2(middleOf(tile, size_px)) + 0.5;
    const auto moved = source_from_target.move(middle_px, pixel ? pixel->inverse_depth : 0.0);
    const bool somewhere = moved.in_front && !std::isnan(moved.place_px.x) && !std::isnan(moved.place_px.y);
    const glm::dvec2 place =
        glm::clamp(somewhere ? moved.place_px : middle_px, glm::dvec2(0.0), glm::dvec2(size_px) - 1.0);
    const glm::uvec2 source = glm::uvec2(place) / unsigned{kTileSize};
    return std::size_t{source.y} * tileGrid(size_px).x + source.x;
}

}  // namespace

std::optional<MovingPixel> movingAtMiddle(const Picture& dominant, std::size_t tile,
                                          const StereoSettings& settings) {
    const glm::uvec2 middle = middleOf(tile, dominant.size_px);
    return movingPixel(dominant, std::size_t{middle.y} * dominant.size_px.x + middle.x, settings);
}

Weighed weigh(const Picture& dominant, std::span<const TileRange> dominant_ranges, const EyePair& eyes,
              const StereoSettings& settings) {
    const EyeChange source_from_target(eyes.source, eyes.target);
    Weighed weighed{markUnseen(eyes, settings.gap_px), {}, 0, 0, false};
    markHidden(weighed.kinds, settings);
    markBehindHidden(weighed.kinds, eyes, settings);
    std::uint64_t shown = 0;
    for (std::uint32_t t = 0; t < weighed.kinds.size(); ++t) {
        const TileRange& range = dominant_ranges[sourceTile(dominant, source_from_target, t, settings)];
        const std::uint64_t pairs = range.end - range.begin;
        weighed.costs.push_back(std::min(pairs + kTilePairs, kMaxTileCost));
        if (weighed.kinds[t] == TileKind::kHidden) { continue; }
        ++shown;
        weighed.picture_cost += weighed.costs[t];
        if (weighed.kinds[t] != TileKind::kNone) { continue; }
        if (pairs <= settings.move_cost) {
            weighed.kinds[t] = TileKind::kCheap;
        } else {
            weighed.saved_cost += pairs - settings.move_cost;
        }
    }
    // The savings must cover the part of the cost that does not depend on tiles, and the budget for patching.
    const auto mending =
        static_cast<std::uint64_t>(settings.budget * static_cast<double>(weighed.picture_cost));
    weighed.moves = weighed.saved_cost > mending + settings.move_cost * shown / kMoveSharedPart;
    if (!weighed.moves) { std::ranges::replace(weighed.kinds, TileKind::kNone, TileKind::kCheap); }
    return weighed;
}

std::vector<TileKind> markUnseen(const EyePair& eyes, int gap_px) {
    const EyeChange source_from_target(eyes.source, eyes.target);
    const glm::uvec2 size_px = eyes.target.size_px, tiles = tileGrid(size_px);
    const glm::dvec2 limit = glm::dvec2(eyes.source.size_px) + static_cast<double>(gap_px);
    const auto isSeen = [&](const glm::uvec2& pixel) {
        const auto moved = source_from_target.move(glm::dvec2(pixel) + 0.5, 0.0);
        const glm::dvec2 place = moved.place_px;
        return moved.in_front && place.x >= -gap_px && place.y >= -gap_px && place.x <= limit.x &&
               place.y <= limit.y;
    };
    std::vector<TileKind> kinds;
    for (unsigned y = 0; y < tiles.y; ++y) {
        for (unsigned x = 0; x < tiles.x; ++x) {
            const glm::uvec2 first = glm::uvec2(x, y) * unsigned{kTileSize};
            const glm::uvec2 last = glm::min(first + unsigned{kTileSize}, size_px) - 1u;
            const bool seen =
                isSeen(first) && isSeen(last) && isSeen({first.x, last.y}) && isSeen({last.x, first.y});
            kinds.push_back(seen ? TileKind::kNone : TileKind::kEdge);
        }
    }
    return kinds;
}

void markHidden(std::vector<TileKind>& kinds, const StereoSettings& settings) {
    for (std::size_t tile = 0; tile < settings.target_hidden.size(); ++tile) {
        if (settings.target_hidden[tile] != 0) { kinds[tile] = TileKind::kHidden; }
    }
}

void markBehindHidden(std::vector<TileKind>& kinds, const EyePair& eyes, const StereoSettings& settings) {
    if (settings.source_hidden.empty()) { return; }
    const EyeChange source_from_target(eyes.source, eyes.target);
    const glm::uvec2 size_px = eyes.target.size_px, tiles = tileGrid(size_px);
    const auto isBehind = [&](const glm::uvec2& pixel) {
        const auto moved = source_from_target.move(glm::dvec2(pixel) + 0.5, 0.0);
        const glm::dvec2 at = moved.place_px,
                         limit = glm::dvec2(size_px) + static_cast<double>(settings.gap_px);
        if (!moved.in_front || at.x < -settings.gap_px || at.y < -settings.gap_px || at.x > limit.x ||
            at.y > limit.y) {
            return false;
        }
        const glm::uvec2 source =
            glm::uvec2(glm::clamp(at, glm::dvec2(0.0), glm::dvec2(size_px) - 1.0)) / unsigned{kTileSize};
        return settings.source_hidden[source.y * tiles.x + source.x] != 0;
    };
    for (unsigned tile = 0; tile < tiles.x * tiles.y; ++tile) {
        if (kinds[tile] != TileKind::kNone) { continue; }
        const glm::uvec2 first = glm::uvec2(tile % tiles.x, tile / tiles.x) * unsigned{kTileSize};
        const glm::uvec2 last = glm::min(first + unsigned{kTileSize}, size_px) - 1u;
        if (isBehind(first) || isBehind(last) || isBehind({first.x, last.y}) || isBehind({last.x, first.y})) {
            kinds[tile] = TileKind::kEdge;
        }
    }
}

}  // namespace binosplat::reference
