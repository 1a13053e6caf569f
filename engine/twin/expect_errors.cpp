// resample: the expected error of a tile whose pixels are reprojected.
#include "engine/twin/eye_change.h"
#include "engine/twin/splat.h"

#include <algorithm>
#include <cmath>

namespace binosplat::reference {
namespace {

constexpr double kSpreadWeight = 0.5, kMaxSpreadPx = 4.0;
constexpr double kMaxPixelError = 4.0, kLeastHoleError = 1e-4;

glm::dvec3 colourAt(const Picture& picture, const glm::ivec2& pixel) {
    const glm::ivec2 last = glm::ivec2(picture.size_px) - 1, at = glm::clamp(pixel, glm::ivec2(0), last);
    return glm::dvec3(picture.rgba[static_cast<std::size_t>(at.y * (last.x + 1) + at.x)]);
}

// How much the picture changes, squared, from `source` to `distance_px` beside it: hidden content is assumed
// to differ as much from the content that is repeated.
double holeError(const Picture& dominant, const glm::ivec2& source, int distance_px, double weight) {
    const glm::dvec3 change =
        weight * (colourAt(dominant, source + glm::ivec2(distance_px, 0)) - colourAt(dominant, source));
    return glm::dot(change, change) + kLeastHoleError;
}

// Variance of the inverse depth of the pixel in column x of `row`: half the spread of what it blends, and the
// greatest step to what arrived beside it.
double uncertainty(std::span<const Arrival> row, int x, const Resolved& pixel) {
    double step = 0.0;
    for (const int beside : {x - 1, x + 1}) {
        if (beside < 0 || beside >= static_cast<int>(row.size())) { continue; }
        const Arrival& neighbour = row[static_cast<std::size_t>(beside)];
        if (neighbour.way != Arrival::kNone) {
            step = std::max(step, std::abs(neighbour.inverse_depth - pixel.inverse_depth));
        }
    }
    const double own = kSpreadWeight * spreadOf(pixel.spread) * pixel.inverse_depth;
    return own * own + step * step;
}

// The variance of a disparity times the squared change of the picture along it where the pixel came from, as
// a mean over the channels.
double uncertainDepthError(const Picture& dominant, const EyeChange& target_from_source, double variance,
                           const glm::ivec2& source) {
    const glm::dvec2 disparity = target_from_source.disparity(glm::dvec2(source) + 0.5);
    const double length = glm::length(disparity);
    if (length == 0.0) { return 0.0; }
    const double variance_px2 = std::min(variance * length * length, kMaxSpreadPx * kMaxSpreadPx);
    const glm::dvec3 across =
        (colourAt(dominant, source + glm::ivec2(1, 0)) - colourAt(dominant, source - glm::ivec2(1, 0))) / 2.0;
    const glm::dvec3 down =
        (colourAt(dominant, source + glm::ivec2(0, 1)) - colourAt(dominant, source - glm::ivec2(0, 1))) / 2.0;
    const glm::dvec3 change = (disparity.x * across + disparity.y * down) / length;
    return variance_px2 * glm::dot(change, change) / 3.0;
}

// A signal that alternates in sign from pixel to pixel along `step` with an amplitude d has third differences
// of 8 d. Halfway between two pixels all of it is lost, on a pixel nothing: squared, as a mean over the
// channels. `at`: the pixel before the place, `t`: how far the place is beyond it.
double lostBetween(const Picture& dominant, const glm::ivec2& at, const glm::ivec2& step, double t) {
    const glm::dvec3 before = colourAt(dominant, at - step), first = colourAt(dominant, at);
    const glm::dvec3 second = colourAt(dominant, at + step), after = colourAt(dominant, at + 2 * step);
    const glm::dvec3 lost = 4.0 * t * (1.0 - t) * (after - 3.0 * second + 3.0 * first - before) / 8.0;
    return glm::dot(lost, lost) / 3.0;
}

// Along the nearest row and the nearest column.
double resamplingError(const Picture& dominant, const glm::dvec2& place) {
    const glm::dvec2 last(glm::dvec2(dominant.size_px) - 1.0);
    const glm::dvec2 at = glm::clamp(place - 0.5, glm::dvec2(0.0), last), base = glm::floor(at),
                     t = at - base;
    const glm::ivec2 first(base), nearest(glm::floor(at + 0.5));
    return lostBetween(dominant, {first.x, nearest.y}, {1, 0}, t.x) +
           lostBetween(dominant, {nearest.x, first.y}, {0, 1}, t.y);
}

}  // namespace

std::vector<double> expectErrors(std::span<const Resolved> resolved, std::span<const Arrival> arrivals,
                                 const Picture& dominant, std::span<const TileKind> kinds,
                                 const EyePair& eyes, const StereoSettings& settings) {
    const EyeChange target_from_source(eyes.target, eyes.source),
        source_from_target(eyes.source, eyes.target);
    const glm::ivec2 size(eyes.target.size_px);
    const glm::uvec2 tiles = tileGrid(eyes.target.size_px);
    std::vector<double> errors(std::size_t{tiles.x} * tiles.y, 0.0);
    for (int y = 0; y < size.y; ++y) {
        const auto row =
            arrivals.subspan(static_cast<std::size_t>(y * size.x), static_cast<std::size_t>(size.x));
        for (int x = 0; x < size.x; ++x) {
            const Resolved& pixel = resolved[static_cast<std::size_t>(y * size.x + x)];
            const std::size_t tile =
                static_cast<std::size_t>(y / kTileSize) * tiles.x + static_cast<std::size_t>(x / kTileSize);
            if (kinds[tile] != TileKind::kNone) { continue; }
            if (y % 2 != 0) { continue; }  // rows are sampled in pairs
            const int column = static_cast<int>(pixel.column);
            const glm::dvec2 place =
                source_from_target.move({column + 0.5, y + 0.5}, pixel.inverse_depth).place_px;
            const glm::dvec2 in_reach = glm::clamp(glm::floor(place), glm::dvec2(-1e6), glm::dvec2(1e6));
            const double error =
                pixel.pixel_class == PixelClass::kHole
                    ? 2.0 * holeError(dominant, glm::ivec2(in_reach), column - x, settings.hole_error)
                    : 2.0 * (uncertainDepthError(dominant, target_from_source, uncertainty(row, x, pixel),
                                                 glm::clamp(glm::ivec2(in_reach), glm::ivec2(0), size - 1)) +
                             resamplingError(dominant, place));
            errors[tile] += std::min(error, kMaxPixelError);
        }
    }
    return errors;
}

}  // namespace binosplat::reference
