// rasterize: blending, front to back, one tile at a time.
#include "engine/parallel.h"
#include "engine/twin/blend.h"
#include "engine/twin/reach.h"

#include <limits>

namespace binosplat::reference {
namespace {

constexpr double kNoMesh = std::numeric_limits<double>::infinity();

void blendTile(Tile& tile, std::span<const ProjectedSplat> splats, std::span<const TilePair> pairs,
               glm::uvec2 size_px, const Settings& settings) {
    int open_count = (tile.end_px.x - tile.begin_px.x) * (tile.end_px.y - tile.begin_px.y);
    for (const TilePair& pair : pairs) {
        if (open_count == 0) { return; }
        const ProjectedSplat& splat = splats[pair.splat];
        const RayPlane plane = rayPlane(splat, size_px, settings.near);
        const int x0 = std::max(splat.box_px.x, tile.begin_px.x),
                  x1 = std::min(splat.box_px.z, tile.end_px.x);
        const int y0 = std::max(splat.box_px.y, tile.begin_px.y),
                  y1 = std::min(splat.box_px.w, tile.end_px.y);
        for (int y = y0; y < y1; ++y) {
            for (const Span& run : runsOfReach(plane, y, x0, x1)) {
                for (int x = run.begin; x < run.end; ++x) {
                    PixelState& pixel = tile.at(x, y);
                    Hit hit;
                    const auto at = static_cast<std::size_t>(y) * size_px.x + static_cast<std::size_t>(x);
                    const double behind = settings.mesh_depths.empty() ? kNoMesh : settings.mesh_depths[at];
                    if (pixel.open && meet(plane, {x + 0.5, y + 0.5}, hit) && hit.depth < behind &&
                        !blend(pixel, splat, hit, settings.inverse_depth_moments)) {
                        --open_count;
                    }
                }
            }
        }
    }
}

}  // namespace

Picture rasterize(std::span<const ProjectedSplat> splats, std::span<const TilePair> pairs,
                  std::span<const TileRange> ranges, const Eye& eye, const Settings& settings) {
    Picture picture = makePicture(eye.size_px, settings);
    forBlocks(ranges.size(), 1, settings.threads, [&](std::size_t index, std::size_t) {
        Tile tile(index, eye.size_px);
        const TileRange range = ranges[index];
        blendTile(tile, splats, pairs.subspan(range.begin, range.end - range.begin), eye.size_px, settings);
        tile.write(picture, settings);
    });
    return picture;
}

}  // namespace binosplat::reference
