// Counts the tiles that were not rendered although they are far under the bound.
#include "app/bench/bounded_tiles.h"

#include "engine/passes/frame_buffers.h"

#include <cassert>
#include <cmath>
#include <cstddef>

namespace binosplat {

BoundedTiles findBoundedTiles(std::span<const float> tile_squares, std::span<const std::uint32_t> kinds,
                              glm::uvec2 size_px, double bound_db) {
    BoundedTiles found;
    if (kinds.empty()) { return found; }
    const glm::uvec2 whole = size_px / gpu::kTileSize;
    const std::size_t row_tiles = tilesOf(size_px).x;
    assert(tile_squares.size() == std::size_t{whole.x} * whole.y);
    const double most = std::pow(10.0, -0.1 * (bound_db - kMuchUnder_db));
    for (std::size_t y = 0; y < whole.y; ++y) {
        for (std::size_t x = 0; x < whole.x; ++x) {
            if (kinds[y * row_tiles + x] != 0) { continue; }
            ++found.kept;
            found.under += static_cast<double>(tile_squares[y * whole.x + x]) > most ? 1 : 0;
        }
    }
    return found;
}

}  // namespace binosplat
