// 8b: a place in the source's picture for every pixel of the target, and the error to expect of it.
#include "engine/reference/eye_change.h"
#include "engine/reference/splat.h"

#include <algorithm>

namespace binosplat::reference {
namespace {

constexpr double kMaxSpreadPx = 4.0;
constexpr double kMaxPixelError = 64.0;

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

// Squared disparity spread of a pixel of the source times the squared change of the picture along the disparity, a mean over the channels.
double mixedDepthError(const Picture& dominant, const EyeChange& target_from_source, const glm::ivec2& source) {
    const glm::ivec2 last = glm::ivec2(dominant.size_px) - 1;
    const auto colourAt = [&](const glm::ivec2& pixel) {
        const glm::ivec2 at = glm::clamp(pixel, glm::ivec2(0), last);
        return glm::dvec3(dominant.rgba[static_cast<std::size_t>(at.y * (last.x + 1) + at.x)]);
    };
    const auto i = static_cast<std::size_t>(source.y * (last.x + 1) + source.x);
    const double weight = dominant.rgba[i].w;
    const glm::dvec2 disparity = target_from_source.disparity(glm::dvec2(source) + 0.5);
    const double length = glm::length(disparity);
    if (weight <= 0.0 || length == 0.0) { return 0.0; }
    const double mean = dominant.inverse_depth[i] / weight;
    const double variance = std::max(dominant.inverse_depth_squared[i] / weight - mean * mean, 0.0);
    const double spread_px = std::min(length * std::sqrt(variance), kMaxSpreadPx);
    const glm::dvec3 across = (colourAt(source + glm::ivec2(1, 0)) - colourAt(source - glm::ivec2(1, 0))) / 2.0;
    const glm::dvec3 down = (colourAt(source + glm::ivec2(0, 1)) - colourAt(source - glm::ivec2(0, 1))) / 2.0;
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
            double error = settings.hole_error * settings.hole_error;
            if (pixel.pixel_class != PixelClass::kHole) {
                // Rows are sampled in pairs.
                if (y % 2 != 0) { continue; }
                const glm::dvec2 place = source_from_target.move({x + 0.5, y + 0.5}, pixel.inverse_depth).place_px;
                error = 2.0 * mixedDepthError(dominant, target_from_source,
                                              glm::ivec2(glm::clamp(glm::floor(place), glm::dvec2(0.0), glm::dvec2(size - 1))));
            }
            errors[static_cast<std::size_t>(y / kTileSize) * tiles.x + static_cast<std::size_t>(x / kTileSize)] +=
                std::min(error, kMaxPixelError);
        }
    }
    return errors;
}

}  // namespace binosplat::reference
