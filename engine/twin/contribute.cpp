// contribute: blends again, and keeps an account for each splat.
#include "engine/twin/contribute.h"
#include "engine/twin/blend.h"

namespace binosplat::reference {

namespace {

constexpr double kMostBehind = 4.0;

// What a pixel shows, and what it should show.
struct PixelWish {
    glm::dvec3 shown, missing;
};

// `before`: the pixel's transmittance in front of the splat.
void account(Contribution& sums, const ProjectedSplat& splat, const Hit& hit, bool on_disc, double before,
             const PixelState& pixel, const PixelWish& wish) {
    const double weight = before - pixel.transmittance;
    sums.weight += weight;
    sums.missing += weight * wish.missing;
    if (splat.opacity * std::exp(-0.5 * hit.rho) >= kMaxAlpha) { return; }
    const glm::dvec3 behind = (wish.shown - pixel.colour) / pixel.transmittance;
    const glm::dvec3 off = splat.colour - glm::clamp(behind, -kMostBehind, kMostBehind);
    const double pull = weight * glm::dot(off, wish.missing), hold = weight * glm::dot(off, off),
                 growth = on_disc ? hit.rho : 0.0;
    sums.opacity_pull += pull;
    sums.opacity_hold += hold;
    sums.size_pull += growth * pull;
    sums.size_hold += growth * growth * hold;
}

}  // namespace

std::vector<Contribution> contribute(std::span<const ProjectedSplat> splats, std::span<const TilePair> pairs,
                                     std::span<const TileRange> ranges, const Eye& eye,
                                     const Settings& settings, const Picture& shown,
                                     std::span<const glm::dvec3> wanted) {
    std::vector<Contribution> sums(splats.size());
    for (std::size_t index = 0; index < ranges.size(); ++index) {
        const Tile tile(index, eye.size_px);
        for (int y = tile.begin_px.y; y < tile.end_px.y; ++y) {
            for (int x = tile.begin_px.x; x < tile.end_px.x; ++x) {
                const std::size_t at =
                    static_cast<std::size_t>(y) * eye.size_px.x + static_cast<std::size_t>(x);
                const glm::dvec3 is(shown.rgba[at]);
                const PixelWish wish{is, wanted[at] - is};
                PixelState pixel;
                for (std::uint32_t i = ranges[index].begin; i < ranges[index].end && pixel.open; ++i) {
                    const ProjectedSplat& splat = splats[pairs[i].splat];
                    const RayPlane plane = rayPlane(splat, eye.size_px, settings.near);
                    Hit hit;
                    const double before = pixel.transmittance;
                    if (!meet(plane, {x + 0.5, y + 0.5}, hit) || !blend(pixel, splat, hit, false)) {
                        continue;
                    }
                    const glm::dvec2 d = glm::dvec2(x + 0.5, y + 0.5) - plane.centre_px;
                    const bool on_disc = !plane.low_pass || hit.rho < plane.low_pass_factor * glm::dot(d, d);
                    account(sums[pairs[i].splat], splat, hit, on_disc, before, pixel, wish);
                }
            }
        }
    }
    return sums;
}

}  // namespace binosplat::reference
