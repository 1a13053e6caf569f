// Renders one eye in full and makes the other from it: all stereo passes, in frame order.
#include "engine/twin/eye_change.h"
#include "engine/twin/splat.h"
#include "engine/twin/stereo.h"

#include <algorithm>
#include <utility>

namespace binosplat::reference {
namespace {

// Splats that both eyes see, as one of them sees them; pairs by splat.
struct EyeSplats {
    EyeSplats(const Scene& scene, std::span<const std::uint32_t> order, const Eye& eye,
              const Settings& settings)
        : splats(project(scene, order, eye, settings)), pairs(bin(splats, eye.size_px, settings)) {}

    std::vector<ProjectedSplat> splats;
    std::vector<TilePair> pairs;
};

Picture rasterizePairs(const EyeSplats& seen, std::vector<TilePair> pairs, const Eye& eye,
                       const Settings& settings) {
    sortTiles(pairs, settings);
    return rasterize(seen.splats, pairs, tileRanges(pairs, eye.size_px), eye, settings);
}

std::vector<TileRange> tilesOfPairs(std::vector<TilePair> pairs, glm::uvec2 size_px) {
    sortTiles(pairs);
    return tileRanges(pairs, size_px);
}

// Renders the marked tiles over the existing picture.
void patch(StereoPictures& pictures, const Scene& scene, const Visible& visible, const Eye& eye,
           Settings settings) {
    const EyeSplats seen(scene, sortDepth(visible, settings), eye, settings);
    std::vector<TilePair> pairs = seen.pairs;
    const auto isAgain = [](TileKind kind) { return kind != TileKind::kNone && kind != TileKind::kHidden; };
    std::erase_if(pairs, [&](const TilePair& pair) { return !isAgain(pictures.tile_kinds[pair.tile]); });
    settings.inverse_depth_moments = false;
    const Picture again = rasterizePairs(seen, std::move(pairs), eye, settings);
    const std::size_t width = eye.size_px.x, columns = tileGrid(eye.size_px).x;
    for (std::size_t i = 0; i < pictures.affiliated.size(); ++i) {
        if (isAgain(pictures.tile_kinds[i / width / kTileSize * columns + i % width / kTileSize])) {
            pictures.affiliated[i] = again.rgba[i];
            pictures.affiliated_depth[i] = again.depth[i];
        }
    }
}

}  // namespace

StereoPictures renderStereo(const Scene& scene, const EyePair& eyes, const StereoSettings& stereo,
                            Settings settings) {
    settings.inverse_depth_moments = true;
    settings.is_light = scene.is_linear;
    const glm::uvec2 size_px = eyes.source.size_px, tiles = tileGrid(size_px);
    const auto visible = cull(scene, std::array{eyes.source, eyes.target}, settings);
    const auto order = sortDepth(compact(scene, visible, eyes.source, settings), settings);
    EyeSplats source(scene, order, eyes.source, settings);
    hidePairs(source.pairs, stereo.source_hidden);

    StereoPictures pictures;
    pictures.dominant = rasterizePairs(source, source.pairs, eyes.source, settings);
    pictures.tile_kinds.resize(std::size_t{tiles.x} * tiles.y, TileKind::kNone);
    const bool predicts = stereo.choice == TileChoice::kPredicted;
    std::uint64_t budget_cost = 0;
    if (predicts) {
        Weighed weighed = weigh(pictures.dominant, tilesOfPairs(source.pairs, size_px), eyes, stereo);
        budget_cost = static_cast<std::uint64_t>(stereo.budget * static_cast<double>(weighed.picture_cost));
        pictures.tile_kinds = std::move(weighed.kinds);
        pictures.tile_costs = std::move(weighed.costs);
    } else if (stereo.choice == TileChoice::kPaper) {
        const InverseDepthBounds bounds =
            findInverseDepthBounds(boundDepths(pictures.dominant, stereo.depth_choice));
        pictures.tile_kinds = markEdges(findBorders(bounds, eyes, stereo), size_px);
        markHidden(pictures.tile_kinds, stereo);
        markBehindHidden(pictures.tile_kinds, eyes, stereo);
    } else {
        markHidden(pictures.tile_kinds, stereo);
    }

    const std::vector<Arrival> arrivals = reproject(pictures.dominant, eyes, stereo);
    pictures.resolved = resolve(arrivals, eyes, stereo);
    if (predicts && EyeChange(eyes.target, eyes.source).keepsRows()) {
        moveOddRowsAlike(pictures.resolved, size_px);
    }
    pictures.affiliated =
        stereo.forward
            ? copyColours(pictures.dominant, arrivals, pictures.tile_kinds, eyes, settings.background)
            : resample(pictures.dominant, pictures.resolved, pictures.tile_kinds, eyes, settings.background);
    pictures.affiliated_depth =
        resampleDepths(pictures.affiliated, pictures.resolved, pictures.tile_kinds, size_px);
    if (predicts) {
        std::vector<double>& errors = pictures.tile_errors;
        errors =
            expectErrors(pictures.resolved, arrivals, pictures.dominant, pictures.tile_kinds, eyes, stereo);
        const EyeSplats target(scene, order, eyes.target, settings);
        addNewcomers(errors, target.splats, target.pairs, source.pairs, pictures.dominant,
                     pictures.tile_kinds, stereo);
        const std::vector<double> shares =
            stereo.target_gaze ? findSeenShares(eyes.target, *stereo.target_gaze) : std::vector<double>();
        const auto whole_prices = price(pictures.tile_kinds, errors, pictures.tile_costs);
        select(pictures.tile_kinds, price(pictures.tile_kinds, errors, pictures.tile_costs, shares),
               pictures.tile_costs, budget_cost, whole_prices);
        if (stereo.target_gaze) {
            averageRows(pictures.affiliated, pictures.affiliated_depth, pictures.resolved,
                        pictures.tile_kinds, shares, size_px);
        }
    } else if (stereo.choice == TileChoice::kPaper && stereo.center_rois) {
        markComponents(pictures.resolved, pictures.tile_kinds, size_px, stereo.margin_px);
    }
    patch(pictures, scene, compact(scene, visible, eyes.target, settings), eyes.target, settings);
    return pictures;
}

}  // namespace binosplat::reference
