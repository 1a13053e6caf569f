// Separable filters in bands of rows, so that the rows between the two directions stay in the cache.
#include "app/scores/planes.h"

#include "engine/error.h"
#include "engine/parallel.h"

#include <algorithm>
#include <cmath>

namespace binosplat {

namespace {

// Rows per band: a band of 64 rows with a kernel of 19 filters 28 % of its rows twice.
constexpr std::size_t kBandRows = 64;

// For each position along a side, what the weights inside the picture must be multiplied by.
std::vector<float> cutWindowScales(const Weights& kernel, std::size_t side) {
    const auto radius = static_cast<std::ptrdiff_t>(kernel.size() / 2),
               count = static_cast<std::ptrdiff_t>(side);
    std::vector<float> scales(side);
    for (std::ptrdiff_t at = 0; at < count; ++at) {
        double all = 0.0, inside = 0.0;
        for (std::ptrdiff_t i = -radius; i <= radius; ++i) {
            const double weight = static_cast<double>(kernel[static_cast<std::size_t>(i + radius)]);
            all += weight;
            inside += at + i >= 0 && at + i < count ? weight : 0.0;
        }
        scales[static_cast<std::size_t>(at)] = static_cast<float>(all / inside);
    }
    return scales;
}

void addScaled(float* out, const float* in, float weight, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) { out[i] += weight * in[i]; }
}

// One row of `width` values; `padded` is room for width + kernel size values.
void filterRow(const float* in, float* out, std::size_t width, const Weights& kernel, Border border,
               std::vector<float>& padded) {
    const std::size_t radius = kernel.size() / 2;
    const bool clamps = border == Border::kClamp;
    std::fill_n(padded.begin(), radius, clamps ? in[0] : 0.0f);
    std::copy_n(in, width, padded.begin() + static_cast<std::ptrdiff_t>(radius));
    std::fill_n(padded.begin() + static_cast<std::ptrdiff_t>(radius + width), radius,
                clamps ? in[width - 1] : 0.0f);
    std::fill_n(out, width, 0.0f);
    for (std::size_t i = 0; i < kernel.size(); ++i) { addScaled(out, padded.data() + i, kernel[i], width); }
}

}  // namespace

Weights gaussianKernel(double sigma, int radius) {
    std::vector<double> weights;
    double sum = 0.0;
    for (int x = -radius; x <= radius; ++x) {
        sum += weights.emplace_back(std::exp(-x * x / (2.0 * sigma * sigma)));
    }
    Weights kernel;
    for (const double weight : weights) { kernel.push_back(static_cast<float>(weight / sum)); }
    return kernel;
}

Plane filterPlane(const Plane& in, const Weights& across, const Weights& down, Border border, int threads) {
    const std::size_t width = in.size_px.x, height = in.size_px.y, radius = down.size() / 2;
    Plane out{in.size_px, std::vector<float>(width * height, 0.0f)};
    if (width == 0) { return out; }
    const bool cuts = border == Border::kCutWindow;
    const std::vector<float> scale_x = cuts ? cutWindowScales(across, width) : std::vector<float>{};
    const std::vector<float> scale_y = cuts ? cutWindowScales(down, height) : std::vector<float>{};

    forBlocks(height, kBandRows, threads, [&](std::size_t begin, std::size_t end) {
        // Rows first_row to last_row exist; rows beyond are the nearest one, or nothing.
        const std::size_t first_row = begin > radius ? begin - radius : 0,
                          last_row = std::min(height, end + radius);
        std::vector<float> padded(width + across.size()), rows((last_row - first_row) * width);
        for (std::size_t y = first_row; y < last_row; ++y) {
            filterRow(in.values.data() + y * width, rows.data() + (y - first_row) * width, width, across,
                      border, padded);
        }
        for (std::size_t y = begin; y < end; ++y) {
            float* row = out.values.data() + y * width;
            for (std::size_t i = 0; i < down.size(); ++i) {
                const auto from = static_cast<std::ptrdiff_t>(y + i) - static_cast<std::ptrdiff_t>(radius);
                const auto inside =
                    std::clamp<std::ptrdiff_t>(from, 0, static_cast<std::ptrdiff_t>(height) - 1);
                if (from != inside && border != Border::kClamp) { continue; }
                addScaled(row, rows.data() + (static_cast<std::size_t>(inside) - first_row) * width, down[i],
                          width);
            }
            for (std::size_t x = 0; cuts && x < width; ++x) { row[x] *= scale_x[x] * scale_y[y]; }
        }
    });
    return out;
}

std::optional<double> PixelScores::mean() const {
    double sum = 0.0;
    for (const float value : values) { sum += static_cast<double>(value); }
    return values.empty() ? std::nullopt : std::optional(sum / static_cast<double>(values.size()));
}

std::optional<double> PixelScores::meanWhere(std::span<const std::uint8_t> classes,
                                             std::uint8_t chosen) const {
    check(classes.size() == values.size(), "{} pixel classes for {} pixels, must be as many", classes.size(),
          values.size());
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t pixel = 0; pixel < values.size(); ++pixel) {
        sum += classes[pixel] == chosen ? static_cast<double>(values[pixel]) : 0.0;
        count += classes[pixel] == chosen ? 1 : 0;
    }
    return count == 0 ? std::nullopt : std::optional(sum / static_cast<double>(count));
}

void requireComparable(const Image& a, const Image& b) {
    check(a.size_px == b.size_px, "cannot compare a picture of {}x{} pixels with one of {}x{}", a.size_px.x,
          a.size_px.y, b.size_px.x, b.size_px.y);
    check(a.channels >= 3 && b.channels >= 3,
          "cannot compare pictures with {} and {} channels, must have 3 or more", a.channels, b.channels);
}

}  // namespace binosplat
