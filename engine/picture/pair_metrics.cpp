// Steps at the borders of tiles, and sharpness that differs between the eyes.
#include "engine/picture/pair_metrics.h"

#include "shaders/shared/types.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace binosplat {
namespace {

constexpr std::size_t kTile = gpu::kTileSize;
// A tile has texture, and is found again, where its gradients are more and the rest is less than this, mean of its pixels.
constexpr double kTexture = 0.02, kFound = 0.02;
// Of the picture's width: farther apart no surface lies in the two eyes.
constexpr std::uint32_t kWidthsPerSearch = 8;

std::vector<float> greyOf(const Image& image) {
    std::vector<float> grey;
    grey.reserve(image.pixelCount());
    const auto channels = static_cast<std::size_t>(image.channels);
    for (std::size_t i = 0; i < image.pixelCount(); ++i) {
        const float* pixel = &image.values[i * channels];
        grey.push_back((pixel[0] + pixel[1] + pixel[2]) / 3.0f);
    }
    return grey;
}

struct Tile {
    std::size_t x, y;  // its first pixel
};

class Eye {
public:
    Eye(const Image& picture, const Image& full) : grey_(greyOf(picture)), full_(greyOf(full)), width_(full.size_px.x) {}

    [[nodiscard]] double textureOf(Tile tile) const { return gradients(full_, tile) / (kTile * kTile); }
    [[nodiscard]] double sharpnessOf(Tile tile) const { return gradients(grey_, tile) / gradients(full_, tile); }
    // Mean difference between a tile of this eye and one of another.
    [[nodiscard]] double differs(Tile tile, const Eye& other, Tile there) const {
        float sum = 0.0f;
        for (std::size_t y = 0; y < kTile; ++y) {
            const float *a = &full_[(tile.y + y) * width_ + tile.x], *b = &other.full_[(there.y + y) * width_ + there.x];
            for (std::size_t x = 0; x < kTile; ++x) { sum += std::abs(a[x] - b[x]); }
        }
        return sum / static_cast<float>(kTile * kTile);
    }

private:
    [[nodiscard]] double gradients(const std::vector<float>& grey, Tile tile) const {
        double sum = 0.0;
        for (std::size_t y = tile.y; y + 1 < tile.y + kTile; ++y) {
            for (std::size_t x = tile.x; x + 1 < tile.x + kTile; ++x) {
                const float here = grey[y * width_ + x];
                sum += std::abs(grey[y * width_ + x + 1] - here) + std::abs(grey[(y + 1) * width_ + x] - here);
            }
        }
        return sum;
    }

    std::vector<float> grey_, full_;
    std::size_t width_;
};

// Where the right eye sees what a tile of the left one shows: not farther right, but for what lies beyond infinity.
std::optional<Tile> findInRight(const Eye& left, Tile tile, const Eye& right, std::size_t reach) {
    double least = std::numeric_limits<double>::infinity();
    Tile best{0, tile.y};
    for (std::size_t shift = 0; shift <= reach && shift <= tile.x; ++shift) {
        const Tile there{tile.x - shift, tile.y};
        const double differs = left.differs(tile, right, there);
        if (differs < least) {
            least = differs;
            best = there;
        }
    }
    return least <= kFound ? std::optional(best) : std::nullopt;
}

}  // namespace

double tileSteps(const Image& error) {
    double sums[2] = {0.0, 0.0};  // within tiles, across borders
    std::uint64_t counts[2] = {0, 0};
    const auto width = std::size_t{error.size_px.x}, channels = static_cast<std::size_t>(error.channels);
    const auto add = [&](std::size_t from, std::size_t to, bool across) {
        for (std::size_t c = 0; c < channels; ++c) {
            sums[across] += std::abs(error.values[to * channels + c] - error.values[from * channels + c]);
        }
        counts[across] += channels;
    };
    for (std::size_t y = 0; y < error.size_px.y; ++y) {
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t at = y * width + x;
            if (x > 0) { add(at - 1, at, x % kTile == 0); }
            if (y > 0) { add(at - width, at, y % kTile == 0); }
        }
    }
    if (counts[0] == 0 || counts[1] == 0) { return 0.0; }
    return sums[1] / static_cast<double>(counts[1]) - sums[0] / static_cast<double>(counts[0]);
}

double sharpnessGap(const std::array<Image, 2>& pictures, const std::array<Image, 2>& full) {
    if (full[0].size_px != full[1].size_px) { return 0.0; }
    const Eye left(pictures[0], full[0]), right(pictures[1], full[1]);
    const glm::uvec2 size_px = full[0].size_px;
    double sum = 0.0;
    std::uint64_t found = 0;
    for (std::size_t y = 0; y + kTile <= size_px.y; y += kTile) {
        for (std::size_t x = 0; x + kTile <= size_px.x; x += kTile) {
            const Tile tile{x, y};
            if (left.textureOf(tile) < kTexture) { continue; }
            const std::optional<Tile> there = findInRight(left, tile, right, size_px.x / kWidthsPerSearch);
            if (!there || right.textureOf(*there) < kTexture) { continue; }
            sum += std::abs(left.sharpnessOf(tile) - right.sharpnessOf(*there));
            ++found;
        }
    }
    return found > 0 ? sum / static_cast<double>(found) : 0.0;
}

}  // namespace binosplat
