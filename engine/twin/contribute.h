// How much each splat contributes to a picture, and in which direction it should change; the twin of
// shaders/splat/contribute.comp.
#pragma once

#include "engine/twin/reference.h"

namespace binosplat::reference {

// Sums over the pixels of an eye, where w is a splat's blending weight, `missing` the difference of the pixel
// from the wanted colour, and D the difference between the splat's colour and what shows through behind it.
struct Contribution {
    double weight = 0.0;                            // w
    glm::dvec3 missing{0.0};                        // w missing
    double opacity_pull = 0.0, opacity_hold = 0.0;  // w D . missing, w D . D: for more opacity
    // rho and rho^2 times the above, if the size determines rho rather than the low-pass.
    double size_pull = 0.0, size_hold = 0.0;
};

// One for each of `splats`, from the input of rasterize(), the picture that it makes of them, and a wanted
// colour for each pixel.
std::vector<Contribution> contribute(std::span<const ProjectedSplat> splats, std::span<const TilePair> pairs,
                                     std::span<const TileRange> ranges, const Eye& eye,
                                     const Settings& settings, const Picture& shown,
                                     std::span<const glm::dvec3> wanted);

}  // namespace binosplat::reference
