// Bad tiles, lost edges, steps at the borders of tiles, and sharpness that differs between the eyes.
#include "engine/picture/visible_errors.h"

#include "engine/picture/planes.h"
#include "shaders/shared/types.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>
#include <optional>

namespace binosplat {
namespace {

constexpr std::size_t kTile = gpu::kTileSize;
// A change of the luma from pixel to pixel, above which there is an edge.
constexpr float kStrongEdge = 0.06f;
// A tile has texture if the square of its gradient is more, mean of its pixels.
constexpr double kTexture = 2e-4;
// Keeps flat tiles' sharpness finite.
constexpr double kNoTexture = 1e-6;

float shown(float value) { return std::round(255.0f * std::clamp(value, 0.0f, 1.0f)) / 255.0f; }

// One eye's picture or full render as shown.
struct Shown {
    explicit Shown(const Image& image) : width(image.size_px.x), height(image.size_px.y), luma(image.pixelCount()) {
        const auto channels = static_cast<std::size_t>(image.channels);
        for (std::size_t i = 0; i < luma.size(); ++i) {
            const float* rgb = &image.values[i * channels];
            luma[i] = 0.299f * shown(rgb[0]) + 0.587f * shown(rgb[1]) + 0.114f * shown(rgb[2]);
        }
    }
    // Central differences; 0 along the picture's border.
    [[nodiscard]] glm::vec2 gradient(std::size_t x, std::size_t y) const {
        const std::size_t at = y * width + x;
        return {x > 0 && x + 1 < width ? 0.5f * (luma[at + 1] - luma[at - 1]) : 0.0f,
                y > 0 && y + 1 < height ? 0.5f * (luma[at + width] - luma[at - width]) : 0.0f};
    }

    std::size_t width, height;
    std::vector<float> luma;
};

// Calls with each pixel of a tile.
template <typename Visit>
void overTile(std::size_t tile_x, std::size_t tile_y, Visit&& visit) {
    for (std::size_t y = tile_y * kTile; y < (tile_y + 1) * kTile; ++y) {
        for (std::size_t x = tile_x * kTile; x < (tile_x + 1) * kTile; ++x) { visit(x, y); }
    }
}

void addTiles(const Image& picture, const Image& full, std::vector<float>& squares) {
    const std::size_t width = full.size_px.x;
    const auto channels = static_cast<std::size_t>(picture.channels), full_channels = static_cast<std::size_t>(full.channels);
    for (std::size_t tile_y = 0; (tile_y + 1) * kTile <= full.size_px.y; ++tile_y) {
        for (std::size_t tile_x = 0; (tile_x + 1) * kTile <= width; ++tile_x) {
            float sum = 0.0f;
            overTile(tile_x, tile_y, [&](std::size_t x, std::size_t y) {
                for (std::size_t c = 0; c < 3; ++c) {
                    const std::size_t at = y * width + x;
                    const float off = shown(picture.values[at * channels + c]) - shown(full.values[at * full_channels + c]);
                    sum += off * off;
                }
            });
            squares.push_back(sum / (3 * kTile * kTile));
        }
    }
}

double lostEdges(const Shown& picture, const Shown& full) {
    std::size_t edges = 0, lost = 0;
    for (std::size_t y = 0; y < full.height; ++y) {
        for (std::size_t x = 0; x < full.width; ++x) {
            const glm::vec2 there = full.gradient(x, y);
            const float strength = glm::length(there);
            if (strength <= kStrongEdge) { continue; }
            ++edges;
            lost += glm::length(picture.gradient(x, y) - there) > 0.5f * strength ? 1 : 0;
        }
    }
    return edges > 0 ? static_cast<double>(lost) / static_cast<double>(edges) : 0.0;
}

// How much more an error changes across borders than within tiles, mean of both directions.
double steps(const Shown& picture, const Shown& full) {
    double mean = 0.0;
    for (const bool down : {false, true}) {
        const std::size_t stride = down ? full.width : 1;
        double sums[2] = {0.0, 0.0};  // within tiles, across borders
        std::size_t counts[2] = {0, 0};
        for (std::size_t y = down ? 1 : 0; y < full.height; ++y) {
            for (std::size_t x = down ? 0 : 1; x < full.width; ++x) {
                const std::size_t at = y * full.width + x, from = at - stride;
                const bool across = (down ? y : x) % kTile == 0;
                sums[across] += std::abs((picture.luma[at] - picture.luma[from]) - (full.luma[at] - full.luma[from]));
                ++counts[across];
            }
        }
        if (counts[0] > 0 && counts[1] > 0) {
            mean += 0.5 * (sums[1] / static_cast<double>(counts[1]) - sums[0] / static_cast<double>(counts[0]));
        }
    }
    return mean;
}

// By tiles: octaves by which the picture is sharper than its full render; nothing where that has no texture.
std::vector<std::optional<double>> sharpnessOf(const Shown& picture, const Shown& full) {
    std::vector<std::optional<double>> sharpness;
    for (std::size_t tile_y = 0; (tile_y + 1) * kTile <= full.height; ++tile_y) {
        for (std::size_t tile_x = 0; (tile_x + 1) * kTile <= full.width; ++tile_x) {
            double own = 0.0, there = 0.0;
            overTile(tile_x, tile_y, [&](std::size_t x, std::size_t y) {
                const glm::vec2 a = picture.gradient(x, y), b = full.gradient(x, y);
                own += glm::dot(a, a);
                there += glm::dot(b, b);
            });
            own /= kTile * kTile;
            there /= kTile * kTile;
            const bool has_texture = there > kTexture;
            sharpness.push_back(has_texture ? std::optional(0.5 * std::log2((own + kNoTexture) / (there + kNoTexture))) : std::nullopt);
        }
    }
    return sharpness;
}

double deviation(const std::vector<double>& values) {
    if (values.empty()) { return 0.0; }
    const auto count = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
    double squares = 0.0;
    for (const double value : values) { squares += (value - mean) * (value - mean); }
    return std::sqrt(squares / count);
}

}  // namespace

double VisibleErrors::badShare() const {
    if (tile_squares.empty()) { return 0.0; }
    const auto bad = std::ranges::count_if(tile_squares, [](float square) { return static_cast<double>(square) > kBadTileSquare; });
    return static_cast<double>(bad) / static_cast<double>(tile_squares.size());
}

VisibleErrors findVisibleErrors(const std::array<Image, 2>& pictures, const std::array<Image, 2>& full) {
    VisibleErrors found;
    std::array<std::vector<std::optional<double>>, 2> sharpness;
    for (std::size_t eye = 0; eye < 2; ++eye) {
        requireComparable(pictures[eye], full[eye]);
        addTiles(pictures[eye], full[eye], found.tile_squares);
        const Shown picture(pictures[eye]), whole(full[eye]);
        found.edge += 0.5 * lostEdges(picture, whole);
        found.seam += 0.5 * steps(picture, whole);
        sharpness[eye] = sharpnessOf(picture, whole);
    }
    std::vector<double> differences;
    for (std::size_t tile = 0; tile < std::min(sharpness[0].size(), sharpness[1].size()); ++tile) {
        const auto left = sharpness[0][tile], right = sharpness[1][tile];
        if (left && right) { differences.push_back(*left - *right); }
    }
    found.rival = deviation(differences);
    return found;
}

double worstTiles(std::vector<float> tile_squares, double share) {
    if (tile_squares.empty()) { return 0.0; }
    const std::size_t count = std::max<std::size_t>(1, static_cast<std::size_t>(share * static_cast<double>(tile_squares.size())));
    const auto end = tile_squares.begin() + static_cast<std::ptrdiff_t>(count);
    std::nth_element(tile_squares.begin(), end - 1, tile_squares.end(), std::greater());
    return std::accumulate(tile_squares.begin(), end, 0.0) / static_cast<double>(count);
}

}  // namespace binosplat
