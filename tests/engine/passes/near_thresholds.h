// How near a pixel of the twin comes to a threshold of blending. Rounding moves a value across a threshold now and then, whatever
// the precision, and then a hit counts in full or not at all: alpha at 1/255 (a weight of up to 4e-3), transmittance at 1e-4 (a
// weight of up to 1e-2, since alpha is at most 0.99), a hit at the near plane, or the disc's own depth instead of its centre's. A 3D
// Gaussian has one depth, and no second one of a low-pass. Two hits also change places where their centres' depths, which they are
// sorted by, are one within rounding: ten units in the last place stand for the 1e-5 of the others.
#pragma once

#include "engine/reference/reach.h"
#include "tests/engine/passes/pass_stages.h"

#include <algorithm>
#include <cmath>

namespace binosplat::test {

struct Threshold {
    const char* name = "none";
    double distance = 1.0;  // relative
    void meet(const char* threshold, double relative_distance) {
        if (std::abs(relative_distance) < distance) { *this = {threshold, std::abs(relative_distance)}; }
    }
};

// The threshold that pixel `i` of the twin comes nearest to.
inline Threshold nearestThreshold(const TwinStages& twin, const Eye& eye, const reference::Settings& settings, std::size_t i) {
    const glm::uvec2 pixel(i % eye.size_px.x, i / eye.size_px.x);
    const glm::dvec2 pixel_px = glm::dvec2(pixel) + 0.5;
    const std::uint32_t columns = (eye.size_px.x + gpu::kTileSize - 1) / gpu::kTileSize;
    const reference::TileRange range = twin.ranges[std::size_t{pixel.y / gpu::kTileSize} * columns + pixel.x / gpu::kTileSize];
    Threshold nearest;
    double transmittance = 1.0, depth_before = 0.0;
    for (std::uint32_t at = range.begin; at < range.end; ++at) {
        const reference::ProjectedSplat& splat = twin.splats[twin.sorted_pairs[at].splat];
        reference::RayPlane plane = reference::rayPlane(splat, eye.size_px, settings.near);
        plane.cut += 0.1;  // hits a little below 1/255 as well
        reference::RayPlane disc = plane, low_pass = plane;
        disc.low_pass = low_pass.disc = false;
        reference::Hit hit, hit_disc, hit_low_pass;
        if (!reference::meet(plane, pixel_px, hit)) { continue; }
        if (reference::meet(disc, pixel_px, hit_disc)) {
            nearest.meet("near", hit_disc.depth / settings.near - 1.0);
            if (reference::meet(low_pass, pixel_px, hit_low_pass)) { nearest.meet("low-pass", hit_low_pass.rho / hit_disc.rho - 1.0); }
        }
        const double alpha = std::min(0.99, splat.opacity * std::exp(-0.5 * hit.rho));
        nearest.meet("alpha", alpha * 255.0 - 1.0);
        if (alpha < 1.0 / 255.0) { continue; }
        nearest.meet("order", 10.0 * (depth_before / splat.depth - 1.0));
        depth_before = splat.depth;
        const double after = transmittance * (1.0 - alpha);
        nearest.meet("transmittance", after / 1e-4 - 1.0);
        if (after < 1e-4) { break; }
        transmittance = after;
    }
    return nearest;
}

}  // namespace binosplat::test
