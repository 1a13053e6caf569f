// The float64 twins of reuse over time: an eye's picture from its history, its expected error, and the tiles
// that are rendered again for it. Places are pixels of a picture, with (0.5, 0.5) the centre of the first;
// pixels, blocks and tiles are listed by rows. Squared errors are sums over three channels; amplitudes of
// errors are the root of a mean over pixels and channels.
#pragma once

#include "engine/twin/stereo.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace binosplat::reference {

// What later pictures need to know about a tile of the picture from which they are made.
struct HistoryTile {
    std::uint64_t cost = 0;  // in pairs, when it was last rendered
    std::uint32_t age = 0;   // frames since it was rendered
    // By quarters, row by row:
    std::array<double, 4> growth = {};  // of the error's amplitude per frame, as measured then; 0: unknown
    std::array<double, 4> errors = {};  // amplitudes of the expected error
    // Squared errors that this frame's warp is expected to add to a quarter, summed over its pixels.
    std::array<double, 4> grown = {};
    double lost = 0.0;                    // for a coarse tile: the amplitude of its loss
    std::array<unsigned, 4> unseen = {};  // by quarters: pixels that the history did not see
    double squared_gradient = 0.0;        // of the tile's picture, summed over pixels and channels
};

// A picture of an eye, and what later ones need to know about it.
struct History {
    Eye eye;
    std::vector<glm::dvec4> rgba;
    std::vector<std::optional<MovingPixel>> pixels;  // empty: it goes nowhere
    std::vector<HistoryTile> tiles;
    // By tile: 1 for those that have never been seen; empty: all have been.
    std::vector<std::uint8_t> hidden = {};
};

// rasterize: the history that a full render leaves, from its moments of inverse depth. `costs`: pairs of each
// tile.
History historyOf(const Eye& eye, const Picture& full, std::span<const std::uint64_t> costs);

// Weights of the samples at -2 ... 3 for a place `t` (0 to 1) after sample 0: Lagrange's polynomial through
// all six, plus (4 t (1 - t))^2 times 0.024 of the fourth and 0.02 of the second differences around sample 0
// and sample 1, in the shares 1 - t and t. They add up to 1, and do not amplify any frequency, at any t, so a
// picture may be resampled again and again.
std::array<double, 6> sixTapWeights(double t);

// warp_history and warp_pixels: the history as `eye` sees it, and the expected errors of its tiles.
//
// A block of 4x8 pixels comes whole from a block of the history, if its pixels lie there as in a picture that
// is shifted and slightly turned. Each pixel then has the depth of the pixel equally far from that block's
// corner, and is sampled with six taps each way. The pixels of other blocks are searched for one by one,
// backwards, by a fixed point from the nearest and from the farthest depth around (Bowles et al. 2012,
// Iterative Image Warping), and sampled with four taps. Such a search always finds something, so a place
// counts only if the history's pixel there, moved forwards, meets the wanted pixel; of two places that count,
// the nearer is taken. If the eyes are so far apart that near content may come from beyond a block's
// neighbours, as when the history is the other eye's picture, the nearest content that comes along that way
// is searched for first. A pixel that blends two depths moves with the nearer one: its place is looked up
// once more with the nearest depth around what was found, and counts if what lies there does blend.
struct WarpedHistory {
    History picture;
    std::vector<std::uint8_t> one_by_one;  // by blocks: 1 if its pixels are made one by one
    std::vector<std::uint8_t> unseen;      // by pixels: 1 if the history did not see it
};
// `hidden`: a byte a tile of the picture being made, 1 for tiles that are hidden: these are not made, and are
// background; empty: none is. `near`: nothing nearer is visible.
WarpedHistory warpHistory(const History& history, const Eye& eye, std::span<const std::uint8_t> hidden = {},
                          const glm::dvec3& background = glm::dvec3(0.0), double near = 0.2);

// mark_changed: where something changed in the scene since the history was made, the quarters of tiles that
// meet the rectangle (half open) are off by that much more amplitude, up to a limit.
struct ChangedRect {
    glm::uvec2 begin_px, end_px;
    double error;
};
void markChanged(std::span<HistoryTile> tiles, glm::uvec2 size_px, std::span<const ChangedRect> rects);

// price: adds the expected error of this frame's warp to the errors of tiles. What is blurred already is
// blurred more, so it adds up as an amplitude. Half of it is the measured growth, if there is one and most of
// the quarter was seen. A quarter of which half was not seen is new, and is expected to be off by an
// amplitude of a half.
void growErrors(std::span<HistoryTile> tiles);
// Also price: the loss of a coarse tile counts as an error of all its quarters as soon as a hundredth would
// be seen in each pixel. `share`: the share of an error that the eye sees (findSharesThere).
HistoryTile withLoss(const HistoryTile& tile, double share);
// Also price: the worth of rendering a tile: the squared error of all its pixels, times the frames since it
// was rendered. For an error that grows from frame to frame this is the area under its growth, which
// rendering saves (Whittle's index).
double worthOf(const HistoryTile& tile);
// price, under a bound of errors: classes of a tile's price. First come tiles with a quarter of whose pixels
// the history did not see, then those with a quarter that is off by more than `error_bound`, an amplitude.
// Contrast masks errors: the bound of a tile whose gradient is less than 1/20 on average (root mean square)
// is lower in proportion, down to 0.6 of it.
inline constexpr std::uint32_t kOverPrice = 512, kNewPrice = 1023;
std::uint32_t priceUnderBound(std::uint32_t price, const HistoryTile& tile, double error_bound);
// Also price: the cost of a tile: its pairs, a workgroup, and writing its pixels.
std::uint64_t costOf(const HistoryTile& tile);

// select, if the tiles of several pictures share a budget, in their order: from the highest price down, the
// first of equals first. The tile in which the budget ends is rendered as well, so that one that costs more
// than the whole budget gets its turn.
struct PricedTiles {
    std::vector<TileKind>& kinds;
    std::span<const std::optional<std::uint32_t>> prices;
    std::span<const std::uint64_t> costs;
};
void selectTogether(std::span<const PricedTiles> pictures, std::uint64_t budget_cost);
// price, under a bound of errors: the budget is the cost of tiles above the bound and a twentieth of all
// work, at most `budget_cost` except for tiles of kNewPrice.
std::uint64_t budgetUnderBound(std::span<const PricedTiles> pictures, std::uint64_t budget_cost,
                               std::uint64_t picture_cost);

// rasterize and tile_ranges: puts the tiles of `full` that are rendered over the reprojected ones. Their
// error becomes known, and is measured per frame since they were last rendered, except for tiles without
// pairs or that had never been seen. `costs`: pairs of each tile. Returns squared errors of those that
// existed before, over what had been seen: as expected, and as found.
struct SquaresOfTiles {
    double expected = 0.0, found = 0.0;
};
SquaresOfTiles renderTiles(History& warped, const Picture& full, std::span<const std::uint64_t> costs,
                           std::span<const TileKind> kinds);
// Also rasterize: what the tile's pixels would lose if they were twice as wide, as in the picture `wider`,
// times the frames since it was rendered, at most 32.
double widerSquares(const HistoryTile& tile, const Picture& full, const Picture& wider, std::size_t index,
                    glm::uvec2 size_px);
// A splat as these see it, in whichever tile it is. `dimmed`: 3D Gaussians are by their low-pass.
ProjectedSplat asSeenWider(const ProjectedSplat& splat, glm::uvec2 size_px, bool dimmed);
// select: the squared errors expected of tiles that are not rendered.
double leftSquares(std::span<const HistoryTile> tiles, std::span<const TileKind> kinds);

}  // namespace binosplat::reference
