// Twin of resample: finds a place in the source's picture for every pixel of the target.
#include "engine/twin/eye_change.h"
#include "engine/twin/splat.h"

#include <algorithm>

namespace binosplat::reference {
namespace {

// A pixel that nothing reached, between the reached pixels `left` and `right` of its row; -1: none.
Resolved resolveUncovered(std::span<const Arrival> row, int x, int left, int right, double disparity_px,
                          const StereoSettings& settings) {
    const bool inside = left >= 0 && right >= 0;
    const int run = right - left - 1;
    const PixelClass pixel_class = inside && run <= settings.gap_px ? PixelClass::kGap : PixelClass::kHole;
    const auto depthAt = [&](int column) { return row[static_cast<std::size_t>(column)].inverse_depth; };
    // A slanted surface: neighbours separate by no more than the length of the run. The paper always
    // interpolates.
    const bool slants = pixel_class == PixelClass::kGap &&
                        std::abs(depthAt(right) - depthAt(left)) * disparity_px <= run + 1.0;
    if (slants || (settings.forward && inside)) {
        const double share = static_cast<double>(x - left) / (right - left);
        return {pixel_class, static_cast<std::uint32_t>(x),
                (1.0 - share) * depthAt(left) + share * depthAt(right), 0};
    }
    // Uncovered content is behind, so the farther neighbour is repeated, or the left one if both are equal,
    // such as the two sides of a wall.
    if (left < 0 && right < 0) { return {pixel_class, static_cast<std::uint32_t>(x), 0.0, 0}; }
    const bool is_left =
        right < 0 || (left >= 0 && roundedDepth(depthAt(left)) <= roundedDepth(depthAt(right)));
    const int farther = is_left ? left : right;
    return {pixel_class, static_cast<std::uint32_t>(farther), depthAt(farther), 0};
}

}  // namespace

std::vector<Resolved> resolve(std::span<const Arrival> arrivals, const EyePair& eyes,
                              const StereoSettings& settings) {
    const EyeChange change(eyes.target, eyes.source);
    const int width = static_cast<int>(eyes.target.size_px.x);
    std::vector<Resolved> resolved;
    resolved.reserve(arrivals.size());
    for (int y = 0; y < static_cast<int>(eyes.target.size_px.y); ++y) {
        const auto row =
            arrivals.subspan(static_cast<std::size_t>(y * width), static_cast<std::size_t>(width));
        const auto reached = [&](int x) { return row[static_cast<std::size_t>(x)].way != Arrival::kNone; };
        for (int x = 0; x < width; ++x) {
            const Arrival& arrival = row[static_cast<std::size_t>(x)];
            if (arrival.way != Arrival::kNone) {
                const PixelClass pixel_class =
                    arrival.way == Arrival::kLanded ? PixelClass::kCovered : PixelClass::kGap;
                resolved.push_back(
                    {pixel_class, static_cast<std::uint32_t>(x), arrival.inverse_depth, arrival.spread});
                continue;
            }
            int left = x, right = x;
            while (left >= 0 && !reached(left)) { --left; }
            while (right < width && !reached(right)) { ++right; }
            const double disparity_px = glm::length(change.disparity({x + 0.5, y + 0.5}));
            resolved.push_back(
                resolveUncovered(row, x, left, right < width ? right : -1, disparity_px, settings));
        }
    }
    return resolved;
}

void moveOddRowsAlike(std::vector<Resolved>& resolved, glm::uvec2 size_px) {
    for (std::size_t y = 1; y < size_px.y; y += 2) {
        for (std::size_t x = 0; x < size_px.x; ++x) {
            Resolved& pixel = resolved[y * size_px.x + x];
            pixel = resolved[(y - 1) * size_px.x + x];
            pixel.rows_up = pixel.column != x ? 1 : 0;
        }
    }
}

}  // namespace binosplat::reference
