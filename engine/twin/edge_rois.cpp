// edge_rois: the borders of the target that the source does not see (paper, section 3.5, step 1).
#include "engine/twin/eye_change.h"
#include "engine/twin/splat.h"

#include <algorithm>
#include <limits>

namespace binosplat::reference {
namespace {

// Where samples along one edge land, in the paper's pixels: 0 at the centre of the first.
struct Landed {
    glm::dvec2 least{std::numeric_limits<double>::infinity()};
    glm::dvec2 greatest{-std::numeric_limits<double>::infinity()};
};

Landed sampleEdge(const EyeChange& change, const glm::dvec2& first_px, const glm::dvec2& step_px,
                  const InverseDepthBounds& bounds, int samples) {
    Landed landed;
    for (int i = 0; i < samples; ++i) {
        for (const double inverse_depth : {bounds.far, bounds.near}) {
            const EyeChange::Moved moved = change.move(first_px + (i + 0.5) * step_px, inverse_depth);
            if (!moved.in_front) { continue; }
            // Rounded to 2^-14 px, as fine as single precision in a wide picture, so that an edge that does
            // not move stays at 0.
            const glm::dvec2 place = glm::round((moved.place_px - 0.5) * 0x1p14) * 0x1p-14;
            landed.least = glm::min(landed.least, place);
            landed.greatest = glm::max(landed.greatest, place);
        }
    }
    return landed;
}

// The paper's left_w and top_h; highBorder: right_w and bottom_h.
int lowBorder(double least, int margin, int size) {
    return least > 0.0
               ? static_cast<int>(std::clamp(std::ceil(least) + margin, 0.0, static_cast<double>(size / 2)))
               : 0;
}
int highBorder(double greatest, int margin, int size) {
    return greatest < size - 1 ? static_cast<int>(std::clamp(size - 1 - std::floor(greatest) + margin, 0.0,
                                                             static_cast<double>(size / 2)))
                               : 0;
}

}  // namespace

InverseDepthBounds findInverseDepthBounds(std::span<const std::uint32_t> bins) {
    std::uint64_t total = 0;
    for (const std::uint32_t count : bins) { total += count; }
    if (total == 0) { return {0.0, 0.0}; }
    const std::uint64_t outliers = total / 200;
    const auto inverseDepthAt = [](std::size_t edge) {
        return std::exp2(16.0 - static_cast<double>(edge) / 32.0);
    };
    // The near edge of the bin with the first pixel after the outliers, and the far edge of the bin with the
    // last one before them.
    const auto binOf = [&](std::uint64_t rank) {
        std::size_t bin = 0;
        for (std::uint64_t before = bins[0]; before <= rank; before += bins[bin]) { ++bin; }
        return bin;
    };
    return {inverseDepthAt(binOf(total - outliers - 1) + 1), inverseDepthAt(binOf(outliers))};
}

Borders findBorders(const InverseDepthBounds& bounds, const EyePair& eyes, const StereoSettings& settings) {
    const EyeChange change(eyes.target, eyes.source);
    const glm::ivec2 size(eyes.source.size_px);
    const glm::dvec2 across(static_cast<double>(size.x) / settings.edge_samples, 0.0),
        down(0.0, static_cast<double>(size.y) / settings.edge_samples);
    const Landed left = sampleEdge(change, {0.5, 0.0}, down, bounds, settings.edge_samples);
    const Landed top = sampleEdge(change, {0.0, 0.5}, across, bounds, settings.edge_samples);
    const Landed right = sampleEdge(change, {size.x - 0.5, 0.0}, down, bounds, settings.edge_samples);
    const Landed bottom = sampleEdge(change, {0.0, size.y - 0.5}, across, bounds, settings.edge_samples);
    // The paper takes the extremes of all samples: as far as the farthest content needs. Tight ones use each
    // edge's own samples, inwards.
    glm::dvec2 least = glm::min(glm::min(left.least, top.least), glm::min(right.least, bottom.least));
    glm::dvec2 greatest =
        glm::max(glm::max(left.greatest, top.greatest), glm::max(right.greatest, bottom.greatest));
    if (settings.tight_edges) {
        least = {left.greatest.x, top.greatest.y};
        greatest = {right.least.x, bottom.least.y};
    }
    const int margin = settings.margin_px;
    return {lowBorder(least.x, margin, size.x), lowBorder(least.y, margin, size.y),
            highBorder(greatest.x, margin, size.x), highBorder(greatest.y, margin, size.y)};
}

std::vector<TileKind> markEdges(const Borders& borders, glm::uvec2 size_px) {
    const glm::uvec2 tiles = tileGrid(size_px);
    std::vector<TileKind> kinds(std::size_t{tiles.x} * tiles.y, TileKind::kNone);
    for (int y = 0; y < static_cast<int>(size_px.y); ++y) {
        for (int x = 0; x < static_cast<int>(size_px.x); ++x) {
            const bool inside = x >= borders.left && y >= borders.top &&
                                x < static_cast<int>(size_px.x) - borders.right &&
                                y < static_cast<int>(size_px.y) - borders.bottom;
            if (!inside) {
                kinds[static_cast<std::size_t>(y / kTileSize) * tiles.x +
                      static_cast<std::size_t>(x / kTileSize)] = TileKind::kEdge;
            }
        }
    }
    return kinds;
}

}  // namespace binosplat::reference
