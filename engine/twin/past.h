// The float64 twins of reuse over time: an eye's picture from its own last one, the error to expect of it, and the tiles that are
// rendered again for it. Places are pixels of a picture, (0.5, 0.5) the centre of the first; pixels, blocks and tiles are listed by rows.
// Squared errors are sums over three channels, amplitudes of errors the root of a mean over pixels and channels.
#pragma once

#include "engine/twin/stereo.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace binosplat::reference {

// What later pictures must know of a tile of the one they are made from.
struct PastTile {
    std::uint64_t cost = 0;  // in pairs, when it was last rendered
    std::uint32_t age = 0;   // frames since then
    // By quarters, row by row:
    std::array<double, 4> growth = {};    // of the error's amplitude per frame, as measured then; 0: nothing is known
    std::array<double, 4> errors = {};    // amplitudes of the expected error
    std::array<double, 4> grown = {};     // squared errors that this frame's warp is expected to add to a quarter, summed over its pixels
    double lost = 0.0;                    // of a coarse tile: the amplitude of what it lacks
    std::array<unsigned, 4> unseen = {};  // by quarters: pixels that the past did not see
    double squared_gradient = 0.0;        // of its picture, summed over pixels and channels
};

// A picture of an eye, and what later ones need to know of it.
struct Past {
    Eye eye;
    std::vector<glm::dvec4> rgba;
    std::vector<std::optional<MovingPixel>> pixels;  // nothing: it goes nowhere
    std::vector<PastTile> tiles;
    std::vector<std::uint8_t> hidden = {};  // by tiles: 1 where nobody has seen it; empty: all was seen
};

// rasterize: a picture that was rendered whole, from its moments of inverse depth. `costs`: pairs of each tile.
Past pastOf(const Eye& eye, const Picture& full, std::span<const std::uint64_t> costs);

// Weights of the samples at -2 ... 3 for a place `t` (0 to 1) after sample 0: Lagrange's polynomial through all six. They sum to 1, and no
// frequency comes out stronger than it went in, at any t, so that a picture may be resampled again and again.
std::array<double, 6> lagrangeWeights(double t);

// warp_past and warp_pixels: the past as `eye` sees it, and the expected errors of its tiles.
//
// A block of 4x8 pixels comes from a block of the past whole, if its pixels lie there as in a picture that is shifted and a little turned:
// then each has the depth of the pixel as far from that block's corner, and is sampled with six taps each way. The pixels of other blocks
// are looked for one by one, backwards, by a fixed point from the nearest and from the farthest depth around (Bowles et al. 2012,
// Iterative Image Warping), and sampled with four. Such a search always finds something, so a place counts only if the past's pixel there,
// moved forwards, meets the pixel that it is wanted for; of two that count, the nearer is taken. If the eyes stand so far apart that near
// content may come from beyond a block's neighbours, as when the past is the other eye's picture, the nearest that comes along that way is
// looked for first. A pixel that blends two depths moves with the nearer: its place is looked up once more with the nearest depth around
// what was found, and counts if what lies there does blend.
struct WarpedPast {
    Past picture;
    std::vector<std::uint8_t> one_by_one;  // by blocks: 1 if its pixels are made so
    std::vector<std::uint8_t> unseen;      // by pixels: 1 if the past did not see it
};
// `hidden`: a byte a tile of the picture being made, 1 where nobody sees it: that is not made, and is background; empty: all are seen.
// `near`: nothing is seen before this.
WarpedPast warpPast(const Past& past, const Eye& eye, std::span<const std::uint8_t> hidden = {},
                    const glm::dvec3& background = glm::dvec3(0.0), double near = 0.2);

// mark_changed: where something changed in the scene since the past was made, the quarters of tiles that the rectangle (half open) meets
// are off by that much more amplitude, up to a limit.
struct ChangedRect {
    glm::uvec2 begin_px, end_px;
    double error;
};
void markChanged(std::span<PastTile> tiles, glm::uvec2 size_px, std::span<const ChangedRect> rects);

// price: adds the error expected of this frame's warp to the errors of tiles. What is blurred already is blurred more, so that
// it adds up as an amplitude. Half of it is the growth that was measured, if there is one and most of the quarter was seen; a quarter half
// of which was not is new, and expected to be off by an amplitude of a half.
void growErrors(std::span<PastTile> tiles);
// Also price: what a coarse tile lacks counts as an error of all its quarters as soon as a hundredth would be seen in each pixel. `share`:
// of an error, what the eye sees (findSharesThere).
PastTile withLoss(const PastTile& tile, double share);
// Also price: the worth of rendering a tile: the squared error of all its pixels, times the frames since it was rendered. For an
// error that grows by the frame that is the area under its growth, which rendering it saves (Whittle's index).
double worthOf(const PastTile& tile);
// price, under a bound of errors: of the tile's price, so that one of which the past did not see a quarter of the pixels comes first, then
// those a quarter of which is off by more than `error_bound`, an amplitude. Contrast masks errors: a tile whose gradient is less than 1/20
// on average (root of the mean square) may be off by as much less, down to 0.6 of the bound.
inline constexpr std::uint32_t kOverPrice = 512, kNewPrice = 1023;
std::uint32_t priceUnderBound(std::uint32_t price, const PastTile& tile, double error_bound);
// Also price: the cost of a tile: besides its pairs, a workgroup and the writing of its pixels.
std::uint64_t costOf(const PastTile& tile);

// select, if the tiles of several pictures have one budget, in their order: from the greatest price down, the first of equals first. The
// tile in which the budget ends is rendered as well, so that one dearer than all of it gets its turn.
struct PricedTiles {
    std::vector<TileKind>& kinds;
    std::span<const std::optional<std::uint32_t>> prices;
    std::span<const std::uint64_t> costs;
};
void selectTogether(std::span<const PricedTiles> pictures, std::uint64_t budget_cost);
// price, under a bound of errors: the budget is what tiles above the bound cost and a twentieth of all work, at most `budget_cost` but for
// those of kNewPrice.
std::uint64_t budgetUnderBound(std::span<const PricedTiles> pictures, std::uint64_t budget_cost, std::uint64_t picture_cost);

// rasterize and tile_ranges: puts the tiles of `full` that are rendered over the warped ones. Their error turns out, and is measured for
// each frame since they were last rendered; not for a tile without pairs, nor where nobody had seen it. `costs`: pairs of each
// tile. Returns squared errors of those that were there before, of what had been seen: as they were expected, and as found.
struct SquaresOfTiles {
    double expected = 0.0, found = 0.0;
};
SquaresOfTiles renderTiles(Past& warped, const Picture& full, std::span<const std::uint64_t> costs, std::span<const TileKind> kinds);
// Also rasterize: what the tile's pixels would lose as pixels twice as wide, of which `wider` is a picture, times the frames since it was
// rendered, at most 32.
double widerSquares(const PastTile& tile, const Picture& full, const Picture& wider, std::size_t index, glm::uvec2 size_px);
// A disc as these see it, in whatever tile it is.
ProjectedSplat asSeenWider(const ProjectedSplat& disc, glm::uvec2 size_px);
// select: the squared errors expected of tiles that are not rendered.
double leftSquares(std::span<const PastTile> tiles, std::span<const TileKind> kinds);

}  // namespace binosplat::reference
