// 8b: a place in the source's picture for every pixel of the target, and the error to expect of it.
#include "engine/reference/eye_change.h"
#include "engine/reference/splat.h"

#include <algorithm>

namespace binosplat::reference {
namespace {

constexpr double kMaxSpreadPx = 4.0;
constexpr double kMaxPixelError = 4.0, kLeastHoleError = 1e-4;

// A pixel that nothing reached, between the pixels `left` and `right` of its row that something did; -1: there is none.
Resolved resolveUncovered(std::span<const Arrival> row, int x, int left, int right, double disparity_px, int gap_px) {
    const bool inside = left >= 0 && right >= 0;
    const int run = right - left - 1;
    const PixelClass pixel_class = inside && run <= gap_px ? PixelClass::kGap : PixelClass::kHole;
    const auto depthAt = [&](int column) { return row[static_cast<std::size_t>(column)].inverse_depth; };
    // A surface that slants: neighbours part no further than the run is long.
    if (pixel_class == PixelClass::kGap && std::abs(depthAt(right) - depthAt(left)) * disparity_px <= run + 1.0) {
        const double share = static_cast<double>(x - left) / (right - left);
        return {pixel_class, static_cast<std::uint32_t>(x), (1.0 - share) * depthAt(left) + share * depthAt(right)};
    }
    // What was hidden lies behind: the farther neighbour, the left one of equals.
    if (left < 0 && right < 0) { return {pixel_class, static_cast<std::uint32_t>(x), 0.0}; }
    const int farther = left < 0 ? right : right < 0 ? left : depthAt(left) <= depthAt(right) ? left : right;
    return {pixel_class, static_cast<std::uint32_t>(farther), depthAt(farther)};
}

glm::dvec3 colourAt(const Picture& picture, const glm::ivec2& pixel) {
    const glm::ivec2 last = glm::ivec2(picture.size_px) - 1, at = glm::clamp(pixel, glm::ivec2(0), last);
    return glm::dvec3(picture.rgba[static_cast<std::size_t>(at.y * (last.x + 1) + at.x)]);
}

// How much the picture changes from `source` to `distance_px` beside it, squared: as much as what a hole hides may differ from what it
// repeats.
double holeError(const Picture& dominant, const glm::ivec2& source, int distance_px, double weight) {
    const glm::dvec3 change = weight * (colourAt(dominant, source + glm::ivec2(distance_px, 0)) - colourAt(dominant, source));
    return glm::dot(change, change) + kLeastHoleError;
}

// Squared disparity spread of a pixel of the source times the squared change of the picture along the disparity, a mean over the channels.
double mixedDepthError(const Picture& dominant, const EyeChange& target_from_source, const glm::ivec2& source) {
    const glm::ivec2 last = glm::ivec2(dominant.size_px) - 1;
    const auto i = static_cast<std::size_t>(source.y * (last.x + 1) + source.x);
    const double weight = dominant.rgba[i].w;
    const glm::dvec2 disparity = target_from_source.disparity(glm::dvec2(source) + 0.5);
    const double length = glm::length(disparity);
    if (weight <= 0.0 || length == 0.0) { return 0.0; }
    const double mean = dominant.inverse_depth[i] / weight;
    const double variance = std::max(dominant.inverse_depth_squared[i] / weight - mean * mean, 0.0);
    const double spread_px = std::min(length * std::sqrt(variance), kMaxSpreadPx);
    const glm::dvec3 across = (colourAt(dominant, source + glm::ivec2(1, 0)) - colourAt(dominant, source - glm::ivec2(1, 0))) / 2.0;
    const glm::dvec3 down = (colourAt(dominant, source + glm::ivec2(0, 1)) - colourAt(dominant, source - glm::ivec2(0, 1))) / 2.0;
    const glm::dvec3 change = (disparity.x * across + disparity.y * down) / length;
    return spread_px * spread_px * glm::dot(change, change) / 3.0;
}

}  // namespace

std::vector<Resolved> resolve(std::span<const Arrival> arrivals, const EyePair& eyes, const StereoSettings& settings) {
    const EyeChange change(eyes.target, eyes.source);
    const int width = static_cast<int>(eyes.target.size_px.x);
    std::vector<Resolved> resolved;
    resolved.reserve(arrivals.size());
    for (int y = 0; y < static_cast<int>(eyes.target.size_px.y); ++y) {
        const auto row = arrivals.subspan(static_cast<std::size_t>(y * width), static_cast<std::size_t>(width));
        const auto reached = [&](int x) { return row[static_cast<std::size_t>(x)].way != Arrival::kNone; };
        for (int x = 0; x < width; ++x) {
            const Arrival& arrival = row[static_cast<std::size_t>(x)];
            if (arrival.way != Arrival::kNone) {
                const PixelClass pixel_class = arrival.way == Arrival::kLanded ? PixelClass::kCovered : PixelClass::kGap;
                resolved.push_back({pixel_class, static_cast<std::uint32_t>(x), arrival.inverse_depth});
                continue;
            }
            int left = x, right = x;
            while (left >= 0 && !reached(left)) { --left; }
            while (right < width && !reached(right)) { ++right; }
            const double disparity_px = glm::length(change.disparity({x + 0.5, y + 0.5}));
            resolved.push_back(resolveUncovered(row, x, left, right < width ? right : -1, disparity_px, settings.gap_px));
        }
    }
    return resolved;
}

std::vector<double> expectErrors(std::span<const Resolved> resolved, const Picture& dominant, const EyePair& eyes,
                                 const StereoSettings& settings) {
    const EyeChange target_from_source(eyes.target, eyes.source), source_from_target(eyes.source, eyes.target);
    const glm::ivec2 size(eyes.target.size_px);
    const glm::uvec2 tiles = tileGrid(eyes.target.size_px);
    std::vector<double> errors(std::size_t{tiles.x} * tiles.y, 0.0);
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const Resolved& pixel = resolved[static_cast<std::size_t>(y * size.x + x)];
            const std::size_t tile = static_cast<std::size_t>(y / kTileSize) * tiles.x + static_cast<std::size_t>(x / kTileSize);
            if (!settings.target_hidden.empty() && settings.target_hidden[tile] != 0) { continue; }
            const bool hole = pixel.pixel_class == PixelClass::kHole;
            if (!hole && y % 2 != 0) { continue; }  // rows are sampled in pairs
            const int column = static_cast<int>(pixel.column);
            const glm::dvec2 place = source_from_target.move({(hole ? column : x) + 0.5, y + 0.5}, pixel.inverse_depth).place_px;
            const glm::dvec2 in_reach = glm::clamp(glm::floor(place), glm::dvec2(-1e6), glm::dvec2(1e6));
            const double error =
                hole ? holeError(dominant, glm::ivec2(in_reach), column - x, settings.hole_error)
                     : 2.0 * mixedDepthError(dominant, target_from_source, glm::clamp(glm::ivec2(in_reach), glm::ivec2(0), size - 1));
            errors[tile] += std::min(error, kMaxPixelError);
        }
    }
    return errors;
}

}  // namespace binosplat::reference
