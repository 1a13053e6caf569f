// Bounds of a splat's picture: extremes of a conic clipped at the near plane, and its chord in one row of
// pixels.
#include "engine/twin/reach.h"

#include <algorithm>
#include <utility>

namespace binosplat::reference {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Bounds are widened by this much against rounding; `meet` decides about each pixel.
constexpr double kSlackPx = 1e-6;

// An interval of pixel coordinates; empty at first.
struct Interval {
    double low = kInfinity, high = -kInfinity;
    void add(double value) {
        // A NaN stands for "unknown" and opens the interval.
        low = std::isnan(value) ? -kInfinity : std::min(low, value);
        high = std::isnan(value) ? kInfinity : std::max(high, value);
    }
};

// Pixels with centres in [low, high], clipped to [first, last).
Span pixelsIn(double low, double high, int first, int last) {
    if (!(low <= high)) { return {first, first}; }
    const double begin = std::ceil(low - 0.5 - kSlackPx), end = std::floor(high - 0.5 + kSlackPx) + 1.0;
    const auto clip = [&](double x) {
        return static_cast<int>(std::clamp(x, static_cast<double>(first), static_cast<double>(last)));
    };
    return {clip(begin), clip(end)};
}

// Extremes of one pixel coordinate, relative to the origin's, over the part of the disc with z >= near. `row`
// is the coordinate's row. They are where a line of constant coordinate L = row - x w touches the circle u^2
// + v^2 = cut, that is L.z^2 = cut (L.x^2 + L.y^2), or at the ends of the chord z = near.
Interval extremesOfDisc(const glm::dvec3& row, const glm::dvec3& w, double cut, double near) {
    Interval result;
    const double tilt = std::hypot(w.x, w.y), reach = std::sqrt(cut);
    if (w.z + reach * tilt < near) { return result; }
    const bool crosses = w.z - reach * tilt < near;
    // Quadratic in x with the form <p, q> = p.z q.z - cut (p.x q.x + p.y q.y). Lagrange's identity keeps the
    // digits of its discriminant, where <row, w>^2 - <row, row> <w, w> would cancel.
    const glm::dvec3 m = glm::cross(row, w);
    const double square = w.z * w.z - cut * tilt * tilt;
    const double half = row.z * w.z - cut * (row.x * w.x + row.y * w.y);
    const double constant = row.z * row.z - cut * (row.x * row.x + row.y * row.y);
    const double discriminant = cut * (m.x * m.x + m.y * m.y - cut * m.z * m.z);
    if (discriminant >= 0.0) {
        const double q = half + std::copysign(std::sqrt(discriminant), half);
        // The two roots, neither as a difference of near equals.
        for (const double x : {q / square, q != 0.0 ? constant / q : 0.0}) {
            const glm::dvec3 line = row - x * w;
            const double scale = -line.z / (line.x * line.x + line.y * line.y);
            const double z = scale * (line.x * w.x + line.y * w.y) + w.z;
            if (!crosses || z >= near) { result.add(x); }
        }
    }
    if (crosses) {
        const double along = (near - w.z) / tilt, across = std::sqrt(std::max(0.0, cut - along * along));
        for (const double side : {-across, across}) {
            const double u = (along * w.x - side * w.y) / tilt, v = (along * w.y + side * w.x) / tilt;
            result.add((row.x * u + row.y * v + row.z) / near);
        }
    }
    return result;
}

// The disc's chord in row `y`: u/z = p + a x, v/z = q + b x, 1/z = w + c x, and the disc is where
// (p + a x)^2 + (q + b x)^2 < cut (w + c x)^2 and 0 < w + c x <= 1 / near.
Span chordOfDisc(const RayPlane& plane, int y, int x0, int x1) {
    const glm::dvec3 start = plane.at_origin + (y + 0.5 - plane.origin_px.y) * plane.along_y;
    const glm::dvec3& step = plane.along_x;
    const glm::dvec3 m = glm::cross(start, step);
    const double square = step.x * step.x + step.y * step.y - plane.cut * step.z * step.z;
    const double half = start.x * step.x + start.y * step.y - plane.cut * start.z * step.z;
    const double constant = start.x * start.x + start.y * start.y - plane.cut * start.z * start.z;
    // By Lagrange's identity again; the margin added keeps rows that are just touched, where the root has
    // half the digits.
    const double discriminant = plane.cut * (m.x * m.x + m.y * m.y) * (1.0 + 1e-12) - m.z * m.z;
    double low = -kInfinity, high = kInfinity;
    if (discriminant >= 0.0) {
        const double sum = -half - std::copysign(std::sqrt(discriminant), half);
        const double one = sum / square, other = sum != 0.0 ? constant / sum : one;
        if (square > 0.0) {
            low = std::min(one, other), high = std::max(one, other);
        } else if (square < 0.0) {
            // Two rays; the one behind the eye is a mirror image.
            if (step.z > 0.0) { low = std::max(one, other); }
            if (step.z < 0.0) { high = std::min(one, other); }
        }
    } else if (square > 0.0) {
        return {x0, x0};
    }
    if (step.z != 0.0) {
        const double horizon = -start.z / step.z, nearest = (1.0 / plane.near - start.z) / step.z;
        low = std::max(low, std::min(horizon, nearest));
        high = std::min(high, std::max(horizon, nearest));
    }
    if (std::isnan(low) || std::isnan(high)) { return {x0, x1}; }
    return pixelsIn(low + plane.origin_px.x, high + plane.origin_px.x, x0, x1);
}

}  // namespace

glm::ivec4 boxOfReach(const ProjectedSplat& splat, const Settings& settings, glm::uvec2 size_px) {
    Interval x, y;
    if (splat.gaussian) {
        for (const double side : {-1.0, 1.0}) {
            x.add(splat.reference_px.x + side * splat.reach_px.x);
            y.add(splat.reference_px.y + side * splat.reach_px.y);
        }
    } else if (splat.disc) {
        const PixelRows rows = pixelRows(splat, size_px);
        x = extremesOfDisc(rows.u, rows.w, splat.cut, settings.near);
        y = extremesOfDisc(rows.v, rows.w, splat.cut, settings.near);
        x = {x.low + rows.origin_px.x, x.high + rows.origin_px.x};
        y = {y.low + rows.origin_px.y, y.high + rows.origin_px.y};
    }
    if (splat.low_pass && !splat.gaussian) {
        const double radius = std::sqrt(splat.cut / splat.low_pass_factor);
        for (const double side : {-radius, radius}) {
            x.add(splat.reference_px.x + side);
            y.add(splat.reference_px.y + side);
        }
    }
    const Span columns = pixelsIn(x.low, x.high, 0, static_cast<int>(size_px.x));
    const Span lines = pixelsIn(y.low, y.high, 0, static_cast<int>(size_px.y));
    if (columns.begin >= columns.end || lines.begin >= lines.end) { return {0, 0, 0, 0}; }
    return {columns.begin, lines.begin, columns.end, lines.end};
}

namespace {

std::uint64_t countTilesOfSquare(const glm::dvec2& centre, double radius, glm::uvec2 size_px) {
    const glm::dvec2 grid(tileGrid(size_px));
    const auto countTiles = [&](double middle, double last) {
        const double begin = std::clamp(std::floor((middle - radius) / kTileSize), 0.0, last);
        const double end = std::clamp(std::floor((middle + radius + kTileSize - 1) / kTileSize), 0.0, last);
        return end > begin ? static_cast<std::uint64_t>(end - begin) : std::uint64_t{0};
    };
    if (!std::isfinite(centre.x) || !std::isfinite(centre.y) || !std::isfinite(radius)) {
        return static_cast<std::uint64_t>(grid.x * grid.y);
    }
    return countTiles(centre.x, grid.x) * countTiles(centre.y, grid.y);
}

}  // namespace

std::uint64_t countSquareBoxTiles(const ProjectedSplat& splat, const Settings& settings, glm::uvec2 size_px) {
    if (!(splat.depth > settings.near)) { return 0; }
    constexpr double kSigmas = 3.0;
    if (splat.gaussian) {
        const glm::dvec2 variance = splat.reach_px * splat.reach_px / splat.cut;
        // xy = -B/A yy, from the form.
        const double xy = -splat.plane_from_pixel.y / splat.plane_from_pixel.x * variance.y;
        const double longest =
            0.5 * (variance.x + variance.y) + std::hypot(0.5 * (variance.x - variance.y), xy);
        return countTilesOfSquare(splat.reference_px, std::ceil(kSigmas * std::sqrt(longest)), size_px);
    }
    // The public rasterizer's box, flaws included: the conic at 3 sigma, at least 3 sigma of the low-pass.
    const glm::dvec3 signs(kSigmas * kSigmas, kSigmas * kSigmas, -1.0);
    const glm::dvec3& w = splat.row_w;
    const glm::dvec3 f = signs / glm::dot(signs, w * w);
    const glm::dvec2 centre(glm::dot(f, splat.row_u * w), glm::dot(f, splat.row_v * w));
    const double extent_x = centre.x * centre.x - glm::dot(f, splat.row_u * splat.row_u);
    const double extent_y = centre.y * centre.y - glm::dot(f, splat.row_v * splat.row_v);
    const double radius =
        std::ceil(std::max(std::sqrt(std::max({extent_x, extent_y, 1e-4})), kSigmas * std::sqrt(0.5)));
    return countTilesOfSquare(centre, radius, size_px);
}

std::array<Span, 2> runsOfReach(const RayPlane& plane, int y, int x0, int x1) {
    const Span none{x0, x0};
    // Testing so few pixels is faster than bounding them.
    if (x1 - x0 <= 4) { return {Span{x0, x1}, none}; }
    Span disc = plane.disc ? chordOfDisc(plane, y, x0, x1) : none;
    if (!plane.low_pass) { return {disc, none}; }
    const double dy = y + 0.5 - plane.centre_px.y;
    const double half = std::sqrt(plane.cut / plane.low_pass_factor - dy * dy);
    Span circle = pixelsIn(plane.centre_px.x - half, plane.centre_px.x + half, x0, x1);
    if (circle.begin >= circle.end) { return {disc, none}; }
    if (disc.begin >= disc.end) { return {circle, none}; }
    if (circle.begin < disc.begin) { std::swap(circle, disc); }
    if (circle.begin <= disc.end) { return {Span{disc.begin, std::max(disc.end, circle.end)}, none}; }
    return {disc, circle};
}

}  // namespace binosplat::reference
