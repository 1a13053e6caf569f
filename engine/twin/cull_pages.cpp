// cull_pages: a page's box has a corner on the inner side of each plane of the view, or nothing in it is
// visible. The low-pass widens the view by its reach on the screen, with 2 ln 255, the greatest cut possible.
// A 3D Gaussian on the screen is as wide as its ellipsoid along f (1, 0, -slope), with the slope held to 0.3
// of half the picture beside it (splat.h). If it is beside the picture, this is its reach along the plane's
// own normal plus as much of its reach in depth.
#include "engine/twin/splat.h"

#include <array>

namespace binosplat::reference {
namespace {

using Corners = std::array<glm::dvec3, 8>;

Corners cornersOf(const Page& page, const EyeFrame& frame) {
    Corners corners;
    for (std::size_t c = 0; c < corners.size(); ++c) {
        const glm::dvec3 at((c & 1) != 0 ? page.high.x : page.low.x, (c & 2) != 0 ? page.high.y : page.low.y,
                            (c & 4) != 0 ? page.high.z : page.low.z);
        corners[c] = frame.camera_from_world * (at - frame.position_world);
    }
    return corners;
}

bool mayShow(const Page& page, bool gaussians, const EyeFrame& frame, double near, double slack) {
    const double cut = 2.0 * std::log(255.0);
    const double wider_px =
        (gaussians ? std::sqrt(cut * kScreenVariance) + 1.0 / 64.0 : std::sqrt(cut / kLowPassFactor)) *
        frame.own_pixel_px;
    const Corners corners = cornersOf(page, frame);
    double farthest = 0.0;
    for (const glm::dvec3& c : corners) { farthest = std::max(farthest, glm::length(c)); }
    // True if the whole box lies beyond a plane through the eye, by at least `more`.
    const auto isBeyond = [&](const glm::dvec3& normal, double more) {
        return std::ranges::all_of(corners, [&](const glm::dvec3& c) {
            return glm::dot(normal, c) + more + slack * farthest * glm::length(normal) < 0.0;
        });
    };
    if (isBeyond({0.0, 0.0, 1.0}, -near)) { return false; }
    const Intrinsics& k = frame.intrinsics;
    const auto isBeside = [&](const glm::dvec3& normal, double size) {
        const double more = gaussians ? (0.15 * size + wider_px) * page.reach : 0.0;
        return isBeyond(normal, more) && isBeyond(normal + glm::dvec3(0.0, 0.0, wider_px), more);
    };
    return !isBeside({k.fx, 0.0, k.cx}, frame.size_px.x) &&
           !isBeside({-k.fx, 0.0, frame.size_px.x - k.cx}, frame.size_px.x) &&
           !isBeside({0.0, k.fy, k.cy}, frame.size_px.y) &&
           !isBeside({0.0, -k.fy, frame.size_px.y - k.cy}, frame.size_px.y);
}

}  // namespace

Page boundPage(const Scene& scene, std::size_t first, std::size_t count) {
    Page page{.low = glm::dvec3(std::numeric_limits<double>::infinity()), .high = {}};
    page.high = -page.low;
    const EyeFrame world(Eye{});
    for (std::size_t i = first; i < first + count; ++i) {
        const std::optional<CameraSplat> splat = toCamera(scene, i, world);
        if (!splat) { continue; }
        const double radius = std::sqrt(splat->cut);
        const glm::dvec3 half =
            radius * glm::sqrt(splat->a * splat->a + splat->b * splat->b + splat->w * splat->w);
        page.low = glm::min(page.low, splat->c - half);
        page.high = glm::max(page.high, splat->c + half);
        page.reach = std::max(page.reach, radius * std::max({glm::length(splat->a), glm::length(splat->b),
                                                             glm::length(splat->w)}));
        ++page.count;
    }
    return page;
}

std::vector<std::uint8_t> cullPages(std::span<const Page> pages, bool gaussians, std::span<const Eye> eyes,
                                    const Settings& settings, double slack) {
    std::vector<std::uint8_t> visible(pages.size(), 0);
    for (const Eye& eye : eyes) {
        const EyeFrame frame(eye);
        for (std::size_t p = 0; p < pages.size(); ++p) {
            if (pages[p].count > 0 && mayShow(pages[p], gaussians, frame, settings.near, slack)) {
                visible[p] = 1;
            }
        }
    }
    return visible;
}

}  // namespace binosplat::reference
