// 8g: the tiles that the source does not see, and those of the greatest expected errors; and those that nobody sees.
#include "engine/reference/eye_change.h"
#include "engine/reference/splat.h"

#include <algorithm>

namespace binosplat::reference {

std::vector<TileKind> markUnseen(const EyePair& eyes, int gap_px) {
    const EyeChange source_from_target(eyes.source, eyes.target);
    const glm::uvec2 size_px = eyes.target.size_px, tiles = tileGrid(size_px);
    const glm::dvec2 limit = glm::dvec2(eyes.source.size_px) + static_cast<double>(gap_px);
    const auto isSeen = [&](const glm::uvec2& pixel) {
        const auto moved = source_from_target.move(glm::dvec2(pixel) + 0.5, 0.0);
        const glm::dvec2 place = moved.place_px;
        return moved.in_front && place.x >= -gap_px && place.y >= -gap_px && place.x <= limit.x && place.y <= limit.y;
    };
    std::vector<TileKind> kinds;
    for (unsigned y = 0; y < tiles.y; ++y) {
        for (unsigned x = 0; x < tiles.x; ++x) {
            const glm::uvec2 first = glm::uvec2(x, y) * unsigned{kTileSize};
            const glm::uvec2 last = glm::min(first + unsigned{kTileSize}, size_px) - 1u;
            const bool seen = isSeen(first) && isSeen(last) && isSeen({first.x, last.y}) && isSeen({last.x, first.y});
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
        const glm::dvec2 at = moved.place_px, limit = glm::dvec2(size_px) + static_cast<double>(settings.gap_px);
        if (!moved.in_front || at.x < -settings.gap_px || at.y < -settings.gap_px || at.x > limit.x || at.y > limit.y) { return false; }
        const glm::uvec2 source = glm::uvec2(glm::clamp(at, glm::dvec2(0.0), glm::dvec2(size_px) - 1.0)) / unsigned{kTileSize};
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

void select(std::vector<TileKind>& kinds, std::span<const double> errors, std::size_t budget_tiles) {
    std::vector<std::size_t> order;
    for (std::size_t tile = 0; tile < errors.size(); ++tile) {
        if (kinds[tile] == TileKind::kNone && errors[tile] > 0.0) { order.push_back(tile); }
    }
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return errors[a] > errors[b]; });
    order.resize(std::min(budget_tiles, order.size()));
    for (const std::size_t tile : order) { kinds[tile] = TileKind::kPredicted; }
}

}  // namespace binosplat::reference
