// Sizes are those of the passes' arguments in shaders/shared/passes.h, named in the order they have there.
#include "engine/baselines/warp_traffic.h"

namespace binosplat {
namespace {

constexpr double kWord = sizeof(gpu::uint), kPixelsOfTile = gpu::kTileSize * gpu::kTileSize;

// Words of a tile, by pixel.
constexpr double perTile(double words) { return words * kWord / kPixelsOfTile; }

}  // namespace

Traffic warpTraffic(const WarpFacts& facts) {
    const bool predict = facts.settings.choice == TileChoice::kPredicted,
               paper = facts.settings.choice == TileChoice::kPaper;
    const bool components = paper && facts.settings.center_rois;
    const double pixels = double{1} * facts.size_px.x * facts.size_px.y, tiles = pixels / kPixelsOfTile;
    const double colour = facts.half_floats ? sizeof(gpu::uvec2) : sizeof(gpu::vec4);
    // For odd rows that are warped like even ones, nothing is read or written before they are resampled.
    const double rows = facts.even_rows ? 0.5 : 1.0, moving = rows * kWord, arrival = rows * kWord;
    const double depth = facts.target_depth ? sizeof(float) : 0.0, pixel_class = 0.25;
    // Only predicted leaves tiles out before it reprojects anything.
    const double moved = !predict                    ? 1.0
                         : facts.counters.moves == 0 ? 0.0
                                                     : facts.counters.reprojected_tiles / tiles;
    const double any_moved = moved > 0.0 ? 1.0 : 0.0;

    const double summed = (facts.sums_even_rows ? 0.5 : 1.0) * kWord;  // and as many arrivals cleared
    Traffic traffic{{"dominant rasterize, for moving", !facts.may_move    ? 0.0
                                                       : facts.moves_rows ? summed
                                                                          : 2 * summed}};
    if (predict) {
        // moving, ranges; kinds (in and out), costs, errors, depths, a bit of the mask
        traffic.emplace_back("weigh", perTile(1 + 2 + 2 + 1 + 1 + 1 + 1.0 / 32));
    }
    if (paper) {
        traffic.emplace_back("depth_bounds", (colour + moving) / 2);  // of every other row
        traffic.emplace_back("edge_rois", perTile(2));
    }
    if (!facts.moves_rows) { traffic.emplace_back("reproject", any_moved * (moving + 2 * arrival)); }
    // A row of pixels reads its tiles' kinds; every other row adds to their errors.
    const double of_rows = perTile(gpu::kTileSize * (predict ? 2 : 1));
    // Places that even rows leave for odd ones are written and read.
    const double place = facts.even_rows ? kWord + (depth > 0.0 ? kWord : 0.0) : 0.0;
    traffic.emplace_back("resample",
                         any_moved * (arrival + of_rows + (facts.classes || components ? pixel_class : 0.0)) +
                             moved * (2 * colour + depth + place));
    if (predict) {
        // counts of tiles; the rest of what newcomers reads is negligible
        traffic.emplace_back("newcomers", any_moved * kWord * facts.visible / pixels);
    }
    if (components) { traffic.emplace_back("components", 3 * pixel_class); }
    if (predict) {
        traffic.emplace_back("price", perTile(4));  // kinds, costs, errors; prices
    }
    if (paper || predict) {
        // kinds (in and out), prices, costs; the list and the mask. A workgroup also sums the prices of at
        // most half of the tiles.
        traffic.emplace_back("select",
                             perTile(6) + (predict ? perTile(1) * tiles / (2 * gpu::kWarpGroup) : 0.0));
    }
    double sum = 0.0;
    for (const auto& [pass, bytes] : traffic) { sum += bytes; }
    traffic.emplace_back("all", sum);
    return traffic;
}

}  // namespace binosplat
