// Bad tiles, lost edges, steps at the borders of tiles, and sharpness that differs between the eyes.
#include "app/scores/visible_errors.h"

#include "app/scores/planes.h"
#include "engine/error.h"
#include "engine/geometry.h"
#include "shaders/shared/constants.h"
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
// A change in luma from pixel to pixel above which there is an edge.
constexpr float kStrongEdge = 0.06f;
// A tile has texture if its squared gradient, averaged over its pixels, is more than this.
constexpr double kTexture = 2e-4;
// Keeps flat tiles' sharpness finite.
constexpr double kNoTexture = 1e-6;

// Calls with each pixel of a tile.
template <typename Visit>
void overTile(std::size_t tile_x, std::size_t tile_y, Visit&& visit) {
    for (std::size_t y = tile_y * kTile; y < (tile_y + 1) * kTile; ++y) {
        for (std::size_t x = tile_x * kTile; x < (tile_x + 1) * kTile; ++x) { visit(x, y); }
    }
}

float shown(float value) { return std::round(255.0f * std::clamp(value, 0.0f, 1.0f)) / 255.0f; }

// One eye's picture or full render as shown: its luma.
struct Luma {
    explicit Luma(const Image& image)
        : width(image.size_px.x), height(image.size_px.y), values(image.pixelCount()) {
        for (std::size_t i = 0; i < values.size(); ++i) {
            const float* rgb = &image.values[3 * i];
            values[i] = 0.299f * rgb[0] + 0.587f * rgb[1] + 0.114f * rgb[2];
        }
    }
    // Central differences; 0 along the picture's border.
    [[nodiscard]] glm::vec2 gradient(std::size_t x, std::size_t y) const {
        const std::size_t at = y * width + x;
        return {x > 0 && x + 1 < width ? 0.5f * (values[at + 1] - values[at - 1]) : 0.0f,
                y > 0 && y + 1 < height ? 0.5f * (values[at + width] - values[at - width]) : 0.0f};
    }

    std::size_t width, height;
    std::vector<float> values;
};

// One eye's sight or, without one, the whole rendered picture as it is.
class SeenPixels {
public:
    SeenPixels(glm::uvec2 size_px, const Sight* sight)
        : width_(size_px.x), row_tiles_((size_px.x + kTile - 1) / kTile), sight_(sight) {}

    [[nodiscard]] bool isShown(std::size_t x, std::size_t y) const {
        return sight_ == nullptr || sight_->rendered_tiles[y * width_ + x] != Sight::kNoTile;
    }
    // Along with the pixels that a gradient needs.
    [[nodiscard]] bool isShownAround(std::size_t x, std::size_t y) const {
        if (sight_ == nullptr) { return true; }
        const std::size_t height = sight_->rendered_tiles.size() / width_;
        return isShown(x, y) && (x == 0 || isShown(x - 1, y)) && (x + 1 == width_ || isShown(x + 1, y)) &&
               (y == 0 || isShown(x, y - 1)) && (y + 1 == height || isShown(x, y + 1));
    }
    [[nodiscard]] bool isTileShown(std::size_t tile_x, std::size_t tile_y) const {
        bool all = true;
        if (sight_ != nullptr) {
            overTile(tile_x, tile_y, [&](std::size_t x, std::size_t y) { all = all && isShown(x, y); });
        }
        return all;
    }
    // Of the square of an error in this tile.
    [[nodiscard]] double shareOfTile(std::size_t tile_x, std::size_t tile_y) const {
        return sight_ == nullptr ? 1.0 : sight_->shares[tile_y * row_tiles_ + tile_x];
    }
    // Of an error at this pixel.
    [[nodiscard]] double amplitude(std::size_t x, std::size_t y) const {
        return std::sqrt(shareOfTile(x / kTile, y / kTile));
    }
    // True if different rendered tiles meet between a pixel and the one to its right, or the one below it.
    [[nodiscard]] bool isBorder(std::size_t x, std::size_t y, bool down) const {
        if (sight_ == nullptr) { return (down ? y : x) % kTile == kTile - 1; }
        const std::size_t at = y * width_ + x;
        return sight_->rendered_tiles[at] != sight_->rendered_tiles[at + (down ? width_ : 1)];
    }

    // Where steps are compared with each other: in the whole picture, or in each tile of a sight.
    [[nodiscard]] std::size_t placeCount(std::size_t height) const {
        return sight_ == nullptr ? 1 : row_tiles_ * ((height + kTile - 1) / kTile);
    }
    [[nodiscard]] std::size_t placeOf(std::size_t x, std::size_t y) const {
        return sight_ == nullptr ? 0 : y / kTile * row_tiles_ + x / kTile;
    }

private:
    std::size_t width_, row_tiles_;
    const Sight* sight_;
};

void addTiles(const Image& picture, const Image& full, const SeenPixels& seen, std::vector<float>& squares) {
    const std::size_t width = full.size_px.x;
    for (std::size_t tile_y = 0; (tile_y + 1) * kTile <= full.size_px.y; ++tile_y) {
        for (std::size_t tile_x = 0; (tile_x + 1) * kTile <= width; ++tile_x) {
            if (!seen.isTileShown(tile_x, tile_y)) { continue; }
            float sum = 0.0f;
            overTile(tile_x, tile_y, [&](std::size_t x, std::size_t y) {
                for (std::size_t c = 0; c < 3; ++c) {
                    const std::size_t at = y * width + x;
                    const float off = picture.values[at * 3 + c] - full.values[at * 3 + c];
                    sum += off * off;
                }
            });
            const auto share = static_cast<float>(seen.shareOfTile(tile_x, tile_y));
            const bool is_noticed = share >= 1.0f || share * sum >= gpu::kLeastSeenError;
            squares.push_back(is_noticed ? share * sum / (3 * kTile * kTile) : 0.0f);
        }
    }
}

double lostEdges(const Luma& picture, const Luma& full, const SeenPixels& seen) {
    std::size_t edges = 0, lost = 0;
    for (std::size_t y = 0; y < full.height; ++y) {
        for (std::size_t x = 0; x < full.width; ++x) {
            const glm::vec2 there = full.gradient(x, y);
            const float strength = glm::length(there);
            if (strength <= kStrongEdge || !seen.isShownAround(x, y)) { continue; }
            ++edges;
            lost += seen.amplitude(x, y) * static_cast<double>(glm::length(picture.gradient(x, y) - there)) >
                            0.5 * static_cast<double>(strength)
                        ? 1
                        : 0;
        }
    }
    return edges > 0 ? static_cast<double>(lost) / static_cast<double>(edges) : 0.0;
}

// How much more an error changes across borders than within tiles, averaged over both directions. With a
// sight, averaged over those of its own tiles that show a border: towards a lens's edge, more borders of
// rendered tiles are seen, and errors count for less.
double steps(const Luma& picture, const Luma& full, const SeenPixels& seen) {
    struct Sums {
        double within = 0.0, across = 0.0;
        std::size_t within_count = 0, across_count = 0;
    };
    double mean = 0.0;
    for (const bool down : {false, true}) {
        const std::size_t stride = down ? full.width : 1;
        std::vector<Sums> places(seen.placeCount(full.height));
        for (std::size_t y = 0; y + (down ? 1 : 0) < full.height; ++y) {
            for (std::size_t x = 0; x + (down ? 0 : 1) < full.width; ++x) {
                if (!seen.isShown(x, y) || !seen.isShown(x + (down ? 0 : 1), y + (down ? 1 : 0))) {
                    continue;
                }
                const std::size_t from = y * full.width + x, at = from + stride;
                const bool across = seen.isBorder(x, y, down);
                const float step = std::abs((picture.values[at] - picture.values[from]) -
                                            (full.values[at] - full.values[from]));
                Sums& here = places[seen.placeOf(x, y)];
                (across ? here.across : here.within) += seen.amplitude(x, y) * static_cast<double>(step);
                ++(across ? here.across_count : here.within_count);
            }
        }
        std::erase_if(places, [](const Sums& one) { return one.within_count == 0 || one.across_count == 0; });
        for (const Sums& one : places) {
            const double more = one.across / static_cast<double>(one.across_count) -
                                one.within / static_cast<double>(one.within_count);
            mean += 0.5 * more / static_cast<double>(places.size());
        }
    }
    return mean;
}

// For each tile, by how many octaves the picture is sharper than its full render; empty if that has no
// texture.
std::vector<std::optional<double>> sharpnessOf(const Luma& picture, const Luma& full,
                                               const SeenPixels& seen) {
    std::vector<std::optional<double>> sharpness;
    for (std::size_t tile_y = 0; (tile_y + 1) * kTile <= full.height; ++tile_y) {
        for (std::size_t tile_x = 0; (tile_x + 1) * kTile <= full.width; ++tile_x) {
            double own = 0.0, there = 0.0;
            overTile(tile_x, tile_y, [&](std::size_t x, std::size_t y) {
                if (!seen.isShownAround(x, y)) { return; }
                const glm::vec2 a = picture.gradient(x, y), b = full.gradient(x, y);
                own += glm::dot(a, a);
                there += glm::dot(b, b);
            });
            own /= kTile * kTile;
            there /= kTile * kTile;
            const bool has_texture = there > kTexture && seen.isTileShown(tile_x, tile_y);
            sharpness.push_back(
                has_texture ? std::optional(0.5 * std::log2((own + kNoTexture) / (there + kNoTexture)))
                            : std::nullopt);
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

// Pictures as shown.
VisibleErrors findErrors(const std::array<Image, 2>& pictures, const std::array<Image, 2>& full,
                         const std::array<Sight, 2>* sights) {
    VisibleErrors found;
    std::array<std::vector<std::optional<double>>, 2> sharpness;
    std::array<std::optional<SeenPixels>, 2> seen;
    for (std::size_t eye = 0; eye < 2; ++eye) {
        seen[eye].emplace(full[eye].size_px, sights != nullptr ? &(*sights)[eye] : nullptr);
        addTiles(pictures[eye], full[eye], *seen[eye], found.tile_squares);
        const Luma picture(pictures[eye]), whole(full[eye]);
        found.edge += 0.5 * lostEdges(picture, whole, *seen[eye]);
        found.seam += 0.5 * steps(picture, whole, *seen[eye]);
        sharpness[eye] = sharpnessOf(picture, whole, *seen[eye]);
    }
    const std::size_t row_tiles = full[0].size_px.x / kTile;
    std::vector<double> differences;
    for (std::size_t tile = 0; tile < std::min(sharpness[0].size(), sharpness[1].size()); ++tile) {
        const auto left = sharpness[0][tile], right = sharpness[1][tile];
        if (!left || !right) { continue; }
        const auto shareOf = [&](const SeenPixels& by) {
            return by.shareOfTile(tile % row_tiles, tile / row_tiles);
        };
        differences.push_back(std::sqrt(std::min(shareOf(*seen[0]), shareOf(*seen[1]))) * (*left - *right));
    }
    found.rival = deviation(differences);
    return found;
}

}  // namespace

double VisibleErrors::badShare() const {
    if (tile_squares.empty()) { return 0.0; }
    const auto bad = std::ranges::count_if(
        tile_squares, [](float square) { return static_cast<double>(square) > kBadTileSquare; });
    return static_cast<double>(bad) / static_cast<double>(tile_squares.size());
}

Image asShown(const Image& picture) {
    Image rounded{picture.size_px, 3, {}};
    rounded.values.reserve(3 * picture.pixelCount());
    for (std::size_t pixel = 0; pixel < picture.pixelCount(); ++pixel) {
        const float* rgb = &picture.values[pixel * static_cast<std::size_t>(picture.channels)];
        for (std::size_t c = 0; c < 3; ++c) { rounded.values.push_back(shown(rgb[c])); }
    }
    return rounded;
}

VisibleErrors findVisibleErrors(const std::array<Image, 2>& pictures, const std::array<Image, 2>& full) {
    for (std::size_t eye = 0; eye < 2; ++eye) { requireComparable(pictures[eye], full[eye]); }
    return findErrors({asShown(pictures[kLeft]), asShown(pictures[kRight])},
                      {asShown(full[kLeft]), asShown(full[kRight])}, nullptr);
}

VisibleErrors findSeenErrors(const std::array<Image, 2>& pictures, const std::array<Image, 2>& full,
                             const std::array<Sight, 2>& sights) {
    for (std::size_t eye = 0; eye < 2; ++eye) {
        requireComparable(pictures[eye], full[eye]);
        const glm::uvec2 size_px = full[eye].size_px,
                         tiles = (size_px + static_cast<unsigned>(kTile) - 1u) / static_cast<unsigned>(kTile);
        check(pictures[eye].channels == 3 && full[eye].channels == 3 &&
                  sights[eye].rendered_tiles.size() == full[eye].pixelCount() &&
                  sights[eye].shares.size() == std::size_t{tiles.x} * tiles.y,
              "what an eye sees of a picture of {}x{} needs three channels, a tile for each pixel and a "
              "share for each tile",
              size_px.x, size_px.y);
    }
    return findErrors(pictures, full, &sights);
}

double worstTiles(std::vector<float> tile_squares, double share) {
    if (tile_squares.empty()) { return 0.0; }
    const std::size_t count =
        std::max<std::size_t>(1, static_cast<std::size_t>(share * static_cast<double>(tile_squares.size())));
    const auto end = tile_squares.begin() + static_cast<std::ptrdiff_t>(count);
    std::nth_element(tile_squares.begin(), end - 1, tile_squares.end(), std::greater());
    return std::accumulate(tile_squares.begin(), end, 0.0) / static_cast<double>(count);
}

}  // namespace binosplat
