// One eye in full and the other from it: all stereo passes, in frame order.
#include "engine/reference/splat.h"
#include "engine/reference/stereo.h"

#include <algorithm>
#include <utility>

namespace binosplat::reference {
namespace {

// Splats both eyes see, as one of them sees them; pairs by splat.
struct EyeSplats {
    EyeSplats(const Scene& scene, std::span<const std::uint32_t> order, const Eye& eye, const Settings& settings)
        : splats(project(scene, order, eye, settings)), pairs(bin(splats, eye.size_px, settings)) {}

    std::vector<ProjectedSplat> splats;
    std::vector<TilePair> pairs;
};

Picture rasterizePairs(const EyeSplats& seen, std::vector<TilePair> pairs, const Eye& eye, const Settings& settings) {
    sortTiles(pairs, settings);
    return rasterize(seen.splats, pairs, tileRanges(pairs, eye.size_px), eye, settings);
}

// Renders the marked tiles over what is there.
void patch(StereoPictures& pictures, const Scene& scene, const Visible& visible, const Eye& eye, Settings settings) {
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

StereoPictures renderStereo(const Scene& scene, const EyePair& eyes, const StereoSettings& stereo, Settings settings) {
    settings.inverse_depth_moments = true;
    const glm::uvec2 size_px = eyes.source.size_px, tiles = tileGrid(size_px);
    const auto visible = cull(scene, std::array{eyes.source, eyes.target}, settings);
    const auto order = sortDepth(compact(scene, visible, eyes.source, settings), settings);
    EyeSplats source(scene, order, eyes.source, settings);
    hidePairs(source.pairs, stereo.source_hidden);

    StereoPictures pictures;
    pictures.dominant = rasterizePairs(source, source.pairs, eyes.source, settings);
    pictures.resolved = resolve(reproject(pictures.dominant, eyes, stereo), eyes, stereo);
    pictures.tile_kinds.resize(std::size_t{tiles.x} * tiles.y, TileKind::kNone);
    if (stereo.method == StereoMethod::kPaper) {
        const InverseDepthBounds bounds = findInverseDepthBounds(boundDepths(pictures.dominant, stereo.depth_choice));
        pictures.tile_kinds = markEdges(findBorders(bounds, eyes, stereo), size_px);
        markHidden(pictures.tile_kinds, stereo);
        if (stereo.center_rois) { markComponents(pictures.resolved, pictures.tile_kinds, size_px, stereo.margin_px); }
        markBehindHidden(pictures.tile_kinds, eyes, stereo);
    } else if (stereo.method == StereoMethod::kPredicted) {
        std::vector<double> errors = expectErrors(pictures.resolved, pictures.dominant, eyes, stereo);
        const EyeSplats target(scene, order, eyes.target, settings);
        addNewcomers(errors, target.splats, target.pairs, source.pairs, pictures.resolved, size_px, stereo.newcomer_error);
        pictures.tile_kinds = markUnseen(eyes, stereo.gap_px);
        markHidden(pictures.tile_kinds, stereo);
        markBehindHidden(pictures.tile_kinds, eyes, stereo);
        const auto shown =
            static_cast<double>(std::ranges::count_if(pictures.tile_kinds, [](TileKind k) { return k != TileKind::kHidden; }));
        select(pictures.tile_kinds, errors, static_cast<std::size_t>(stereo.budget * shown));
        pictures.tile_errors = std::move(errors);
    } else {
        markHidden(pictures.tile_kinds, stereo);
    }
    pictures.affiliated = resample(pictures.dominant, pictures.resolved, pictures.tile_kinds, eyes, settings.background);
    pictures.affiliated_depth = resampleDepths(pictures.affiliated, pictures.resolved, pictures.tile_kinds, size_px);
    patch(pictures, scene, compact(scene, visible, eyes.target, settings), eyes.target, settings);
    return pictures;
}

}  // namespace binosplat::reference
