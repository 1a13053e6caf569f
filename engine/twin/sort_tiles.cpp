// sort_tiles: pairs by tile, the order of depth kept within, and where each tile's pairs lie.
#include "engine/parallel.h"
#include "engine/twin/splat.h"

namespace binosplat::reference {

void sortTiles(std::vector<TilePair>& pairs, const Settings& settings) {
    std::uint32_t last_tile = 0;
    for (const TilePair& pair : pairs) { last_tile = std::max(last_tile, pair.tile); }
    std::vector<TilePair> sorted(pairs.size());
    sortByBucket(std::span<const TilePair>(pairs), std::span(sorted), std::size_t{last_tile} + 1,
                 settings.threads, [](const TilePair& pair) { return std::size_t{pair.tile}; });
    pairs = std::move(sorted);
}

std::vector<TileRange> tileRanges(std::span<const TilePair> pairs, glm::uvec2 size_px) {
    const glm::uvec2 grid = tileGrid(size_px);
    std::vector<TileRange> ranges(std::size_t{grid.x} * grid.y);
    std::uint32_t next = 0;
    for (std::uint32_t tile = 0; tile < ranges.size(); ++tile) {
        ranges[tile].begin = next;
        while (next < pairs.size() && pairs[next].tile == tile) { ++next; }
        ranges[tile].end = next;
    }
    return ranges;
}

}  // namespace binosplat::reference
