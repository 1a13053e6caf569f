// What each splat makes up of a picture, and which way it should go: the twin of shaders/splat/contribute.comp.
#pragma once

#include "engine/twin/reference.h"

namespace binosplat::reference {

// Sums over the pixels of an eye, w being a splat's blending weight, `missing` what the pixel lacks of what is wanted, D how far the
// splat's colour is from what shows through behind it.
struct Contribution {
    double weight = 0.0;                            // w
    glm::dvec3 missing{0.0};                        // w missing
    double opacity_pull = 0.0, opacity_hold = 0.0;  // w D . missing, w D . D: where more opacity would show
    double size_pull = 0.0, size_hold = 0.0;        // rho and rho^2 times those: where the size makes rho, not the low-pass
};

// One for each of `splats`, from what rasterize() takes, the picture that it makes of them, and a colour that is wanted for each pixel.
std::vector<Contribution> contribute(std::span<const ProjectedSplat> splats, std::span<const TilePair> pairs,
                                     std::span<const TileRange> ranges, const Eye& eye, const Settings& settings, const Picture& shown,
                                     std::span<const glm::dvec3> wanted);

}  // namespace binosplat::reference
