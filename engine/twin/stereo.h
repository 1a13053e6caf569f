// The float64 twins of the stereo passes: same names, same order, no shared arithmetic. Each function is one
// pass of shaders/warp and shaders/choose or a part of one; `renderStereo` runs them all. Source:
// docs/how-it-works.md; paper, sections 3.4 and 3.5. Places are pixels of an image, (0.5, 0.5) the centre of
// the first; pixels and tiles are listed by rows.
#pragma once

#include "engine/mode.h"
#include "engine/twin/reference.h"

#include <optional>

namespace binosplat::reference {

enum class DepthChoice { kSum, kMean, kInverse };                // D, D/A, A/I
enum class PixelClass : std::uint8_t { kCovered, kGap, kHole };  // what made a pixel
// Why a tile is rendered. kNone: it is not, its pixels are reprojected; kHidden: neither, it is never seen.
enum class TileKind : std::uint8_t { kNone, kEdge, kCenter, kPredicted, kHidden, kCheap };

// Where an eye looks: a direction in its own axes, and how far around it, in radians, everything counts in
// full.
struct Gaze {
    glm::dvec3 direction;
    double clear_rad;
};

struct StereoSettings {
    TileChoice choice = TileChoice::kPredicted;  // not kAll
    DepthChoice depth_choice = DepthChoice::kInverse;
    bool forward = false;  // colours are copied, not sampled
    int gap_px = 2;
    int margin_px = 32;
    int edge_samples = 64;
    bool tight_edges = false;
    bool center_rois = false;
    double budget = 0.2;          // share of an eye's work that is spent on tiles with an error
    std::uint32_t move_cost = 0;  // of reprojecting a tile, in pairs; tiles with no more pairs are rendered
    double hole_error = 1.0, newcomer_error = 0.3;
    // Tiles that are never seen: a byte per tile, 1 for these; empty: none. The source has no picture there.
    std::vector<std::uint8_t> source_hidden = {}, target_hidden = {};
    std::optional<Gaze> target_gaze = {};
};

// Two eyes of the same size: the source's picture is reprojected to the target.
struct EyePair {
    Eye source, target;
};

// rasterize: a pixel's depth according to the source's picture; 0 (infinitely far) where nothing was blended.
double chooseInverseDepth(const Picture& dominant, std::size_t pixel, DepthChoice choice);
// Also rasterize: the spread of the depths that a pixel blends, as a share of the chosen depth, in steps of
// half an octave: 0 for none, 1 for 2^-13, up to 31 for 2^2.
std::uint32_t spreadCode(double spread);
double spreadOf(std::uint32_t code);
// Also rasterize: a pixel as it is reprojected; empty if its depth is invalid.
struct MovingPixel {
    double inverse_depth;
    std::uint32_t spread;  // a code
};
std::optional<MovingPixel> movingPixel(const Picture& dominant, std::size_t pixel,
                                       const StereoSettings& settings);

// weigh: which tiles are rendered before anything is known about errors, and the cost of each, in pairs of
// the source's.
struct Weighed {
    std::vector<TileKind> kinds;
    std::vector<std::uint64_t> costs;
    std::uint64_t picture_cost, saved_cost;  // of all tiles that are shown; saved by reprojecting tiles
    bool moves;                              // true if any tile is reprojected
};
Weighed weigh(const Picture& dominant, std::span<const TileRange> dominant_ranges, const EyePair& eyes,
              const StereoSettings& settings);
// Also weigh: what the source sees in the middle of this tile.
std::optional<MovingPixel> movingAtMiddle(const Picture& dominant, std::size_t tile,
                                          const StereoSettings& settings);
// Also weigh: the tiles that reach beyond the source's view by more than a gap even if everything is
// infinitely far (kEdge).
std::vector<TileKind> markUnseen(const EyePair& eyes, int gap_px);
// Also weigh: marks the target's hidden tiles, whatever they were before.
void markHidden(std::vector<TileKind>& kinds, const StereoSettings& settings);
// Also weigh, and edge_rois: unmarked tiles that would need something hidden from the source even if
// everything is infinitely far (kEdge).
void markBehindHidden(std::vector<TileKind>& kinds, const EyePair& eyes, const StereoSettings& settings);

// depth_bounds: how many pixels of every other row with alpha above 1/2 have a depth in [2^(b/32 - 16), 2^((b
// + 1)/32 - 16)), for b from 0 to 1023; anything nearer or farther counts as the first or the last.
std::vector<std::uint32_t> boundDepths(const Picture& dominant, DepthChoice choice);

// edge_rois: the inverse depths without one pixel in 200 at either end; the widths of the borders that the
// source does not see; and the tiles that touch these borders.
struct InverseDepthBounds {
    double far, near;
};
InverseDepthBounds findInverseDepthBounds(std::span<const std::uint32_t> bins);
struct Borders {
    int left, top, right, bottom;
    bool operator==(const Borders&) const = default;
};
Borders findBorders(const InverseDepthBounds& bounds, const EyePair& eyes, const StereoSettings& settings);
std::vector<TileKind> markEdges(const Borders& borders, glm::uvec2 size_px);

// reproject: what reached a pixel of the target: the nearest. Of equal depths, one that landed there wins
// over one interpolated between two neighbours, and then the one with the greater spread. Depths are equal if
// they round to the same, see roundedDepth.
struct Arrival {
    enum Way : std::uint8_t { kNone, kBetween, kLanded };
    Way way = kNone;
    double inverse_depth = 0.0;  // of the target's
    // A code, see spreadCode. If colours are copied: 1 for an odd column of the source, and 2 for an odd row.
    std::uint32_t spread = 0;
    std::size_t source = 0;  // if colours are copied: the pixel that landed
};
std::vector<Arrival> reproject(const Picture& dominant, const EyePair& eyes, const StereoSettings& settings);
// To 19 bits, the precision with which the device compares inverse depths.
double roundedDepth(double inverse_depth);

// resample: the place of each pixel of the target in the source's picture: that of the pixel at `column` of
// its row, at that depth.
struct Resolved {
    PixelClass pixel_class;
    std::uint32_t column;
    double inverse_depth;
    std::uint32_t spread;       // a code; 0 where nothing arrived
    std::uint32_t rows_up = 0;  // of the source, above its own
};
std::vector<Resolved> resolve(std::span<const Arrival> arrivals, const EyePair& eyes,
                              const StereoSettings& settings);
// Also resample, if errors are predicted and pixels keep their rows: an odd row takes over the places of the
// even one above it, seen in its own row of the source; a pixel that repeats another column's does so from
// the even row.
void moveOddRowsAlike(std::vector<Resolved>& resolved, glm::uvec2 size_px);
// Also resample: colours by Catmull and Rom's cubic (1974), not below 0; zero in marked tiles, but background
// in hidden ones.
std::vector<glm::dvec4> resample(const Picture& dominant, std::span<const Resolved> resolved,
                                 std::span<const TileKind> kinds, const EyePair& eyes,
                                 const glm::dvec3& background = glm::dvec3(0.0));
// Also resample, if colours are copied (`settings.forward`; paper, section 3.1, stages 2 and 4): the pixel
// that arrived, unchanged, and between two in a row their linear interpolation.
std::vector<glm::dvec4> copyColours(const Picture& dominant, std::span<const Arrival> arrivals,
                                    std::span<const TileKind> kinds, const EyePair& eyes,
                                    const glm::dvec3& background = glm::dvec3(0.0));
// Also resample: D of these pixels, their alpha over their inverse depth; 0 if that is infinitely far, and in
// marked tiles.
std::vector<double> resampleDepths(std::span<const glm::dvec4> colours, std::span<const Resolved> resolved,
                                   std::span<const TileKind> kinds, glm::uvec2 size_px);
// Also resample: the expected squared error of each unmarked tile: of holes, of pixels whose depth is
// uncertain, and of sampling.
std::vector<double> expectErrors(std::span<const Resolved> resolved, std::span<const Arrival> arrivals,
                                 const Picture& dominant, std::span<const TileKind> kinds,
                                 const EyePair& eyes, const StereoSettings& settings);

// newcomers: adds the expected errors of splats that only the target sees to unmarked tiles, if their centre
// is nearer than what the source sees in the middle of its tile. Splats are in one order, pairs are by splat.
// Returns the number of such splats.
std::size_t addNewcomers(std::vector<double>& errors, std::span<const ProjectedSplat> target_splats,
                         std::span<const TilePair> target_pairs, std::span<const TilePair> source_pairs,
                         const Picture& dominant, std::span<const TileKind> kinds,
                         const StereoSettings& settings);

// components: holes in unmarked tiles, grouped if they touch, including at corners; marks the tiles of each
// group's box, grown by the margin. With more groups than `most_boxes` every pixel is a group of its own.
// Returns the number of groups.
std::size_t markComponents(std::span<const Resolved> resolved, std::vector<TileKind>& kinds,
                           glm::uvec2 size_px, int margin_px, std::size_t most_boxes = SIZE_MAX);

// price: which sixteenth of an octave of error per pair each unmarked tile is in, from 2^-43 upwards; empty
// for tiles without an error. `seen_shares`: the share of each tile's squared error that the eye sees; empty:
// all of it. Also empty for a tile that is seen only in part and whose seen error is not noticed.
std::vector<std::optional<std::uint32_t>> price(std::span<const TileKind> kinds,
                                                std::span<const double> errors,
                                                std::span<const std::uint64_t> costs,
                                                std::span<const double> seen_shares = {});
// Also price: the finest cycle that an eye resolves is w0 + m e, with w0 = 1/48 degree and m = 0.022, at an
// angle e from its gaze (Guenter, Finch, Drucker, Tan, Snyder, Foveated 3D Graphics, 2012); a picture has
// cycles of two pixels and longer. The share that the eye sees of an error spread over all of these is the
// square of their quotient, for each tile's middle.
std::vector<double> findSeenShares(const Eye& target, const Gaze& gaze);

// select: from the highest price down, the first of equals first, the tiles that together cost no more than
// `budget_cost`. `whole_prices`: the prices if all errors were seen whole; empty: the same. The budget ends
// where it would with these, and tiles worth less than that are not rendered.
void select(std::vector<TileKind>& kinds, std::span<const std::optional<std::uint32_t>> prices,
            std::span<const std::uint64_t> costs, std::uint64_t budget_cost,
            std::span<const std::optional<std::uint32_t>> whole_prices = {});

// resample again, if the tiles' `seen_shares` are known: where the eye sees at most a quarter of an error,
// its finest cycle covers four pixels, and an odd row of an unmarked tile is the mean of those above and
// below, with the upper one's classes. The last row of a tile or of the picture stays as it is.
void averageRows(std::vector<glm::dvec4>& colours, std::vector<double>& depths,
                 std::vector<Resolved>& resolved, std::span<const TileKind> kinds,
                 std::span<const double> seen_shares, glm::uvec2 size_px);

// All passes: both eyes' pictures, source first.
struct StereoPictures {
    Picture dominant;
    std::vector<glm::dvec4> affiliated;
    std::vector<double> affiliated_depth;  // D
    std::vector<TileKind> tile_kinds;
    std::vector<double> tile_errors;        // of kPredicted
    std::vector<std::uint64_t> tile_costs;  // of kPredicted
    std::vector<Resolved> resolved;
};
StereoPictures renderStereo(const Scene& scene, const EyePair& eyes, const StereoSettings& stereo,
                            Settings settings);

}  // namespace binosplat::reference
