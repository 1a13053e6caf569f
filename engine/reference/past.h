// The float64 twins of reuse over time: an eye's picture from its own last one, and the tiles that are rendered again. Places are pixels of
// a picture, (0.5, 0.5) the centre of the first; pixels and tiles are listed by rows. No kernel exists for these yet.
#pragma once

#include "engine/reference/reference.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace binosplat::reference {

// What an eye showed in the frame before, and what is known of it.
struct Past {
    Eye eye;
    std::vector<glm::dvec4> rgba;
    std::vector<double>
        inverse_depths;               // I/A of each pixel, or what it was when the pixel was last rendered, moved along; 0: infinitely far
    std::vector<double> cell_errors;  // by cells of half a tile: the amplitude of the expected error, root of the mean square
    std::vector<std::uint32_t> ages;  // by tile: frames since it was rendered
};

// Weights of the samples at -2 ... 3 for a place `t` (0 to 1) after sample 0: Lagrange's polynomial through all six. They sum to 1, and no
// frequency comes out stronger than it went in, at any t, so that a picture may be resampled again and again.
std::array<double, 6> lagrangeWeights(double t);

// Where the past shows what a pixel of `eye` sees.
struct FoundInPast {
    glm::dvec2 place_px;
    double inverse_depth;  // as the pixel sees it
};
// Backwards, by a fixed point from the nearest and from the farthest depth around (Bowles et al. 2012, Iterative Image Warping). A place
// counts only if the past's pixel there, moved forwards, comes within half a pixel of where it is wanted, which a place that is hidden in
// the past does not; of two that count the nearer is it. Empty: the past did not see it.
std::vector<std::optional<FoundInPast>> findInPast(const Past& past, const Eye& eye, int threads = 2);

// The past as `eye` sees it: colours, depths, and errors grown by what this step is expected to lose. Pixels that the past did not see are
// those of the nearest place that was looked at, and count with the greatest error.
struct WarpedPast {
    Past picture;  // ages are one more
    std::size_t unseen_pixels = 0;
};
WarpedPast warpPast(const Past& past, const Eye& eye, int threads = 2);

// The tiles that are rendered again: by expected squared error times age for each pair, until they have cost `budget_pairs`. A tile that is
// dearer than the budget has its turn when it is worth most. `costs`: pairs of each tile.
std::vector<std::uint8_t> chooseTiles(const Past& warped, std::span<const std::uint64_t> costs, std::uint64_t budget_pairs);

// Puts the chosen tiles of `full`, a picture of the same eye with its moments of inverse depth, over what was warped.
void renderChosen(Past& warped, const Picture& full, std::span<const std::uint8_t> chosen);

// A picture that was rendered whole.
Past pastOf(const Eye& eye, const Picture& full);

}  // namespace binosplat::reference
