// price and rasterize, with a history: the expected errors of its tiles, and what these turn out to have
// been.
#include "engine/twin/history_view.h"

namespace binosplat::reference {
namespace {

constexpr double kChannels = 3.0, kCellPixels = kCell * kCell, kTilePixels = kTileSize * kTileSize;
constexpr double kMeasuredShare = 0.5, kUnseenGrowth = 0.05;
constexpr unsigned kNewPixels = 32;
constexpr double kNewError = 0.5;
constexpr double kMostChangedError = 0.5, kMostWorth = 2000.0, kMostSquares = 48.0, kStep = 0x1p-20;
constexpr std::uint64_t kPairsOfTile = 16, kMostCost = 0x1fffff;

std::optional<MovingPixel> pixelOf(const Picture& full, std::size_t i) {
    return movingPixel(full, i, {.choice = TileChoice::kPredicted, .depth_choice = DepthChoice::kInverse});
}

}  // namespace

void growErrors(std::span<HistoryTile> tiles) {
    for (HistoryTile& tile : tiles) {
        for (std::size_t q = 0; q < 4; ++q) {
            const double expected = tile.unseen[q] >= kNewPixels
                                        ? kNewError
                                        : std::sqrt(tile.grown[q] / (kChannels * kCellPixels));
            const double measured = tile.growth[q] > 0.0 && expected < kUnseenGrowth ? kMeasuredShare : 0.0;
            tile.errors[q] += (1.0 - measured) * expected + measured * tile.growth[q];
        }
    }
}

HistoryTile withLoss(const HistoryTile& tile, double share) {
    HistoryTile seen = tile;
    if (share * kChannels * kTilePixels * tile.lost * tile.lost >= 0.01 * 0.01 * kTilePixels) {
        for (double& error : seen.errors) { error += tile.lost; }
    }
    return seen;
}

void markChanged(std::span<HistoryTile> tiles, glm::uvec2 size_px, std::span<const ChangedRect> rects) {
    const std::size_t columns = tileGrid(size_px).x;
    std::vector<std::array<double, 4>> more(tiles.size());
    for (const ChangedRect& rect : rects) {
        std::vector<std::array<bool, 4>> meets(tiles.size());
        for (std::size_t y = rect.begin_px.y; y < std::min(rect.end_px.y, size_px.y); ++y) {
            for (std::size_t x = rect.begin_px.x; x < std::min(rect.end_px.x, size_px.x); ++x) {
                meets[y / kTileSize * columns + x / kTileSize][y / kCell % 2 * 2 + x / kCell % 2] = true;
            }
        }
        for (std::size_t t = 0; t < tiles.size(); ++t) {
            for (std::size_t q = 0; q < 4; ++q) { more[t][q] += meets[t][q] ? rect.error : 0.0; }
        }
    }
    for (std::size_t t = 0; t < tiles.size(); ++t) {
        for (std::size_t q = 0; q < 4; ++q) {
            if (more[t][q] > 0.0) {
                tiles[t].errors[q] = std::min(tiles[t].errors[q] + more[t][q], kMostChangedError);
            }
        }
    }
}

std::uint32_t priceUnderBound(std::uint32_t price, const HistoryTile& tile, double error_bound) {
    unsigned unseen = 0;
    for (const unsigned pixels : tile.unseen) { unseen += pixels; }
    if (unseen >= 0.25 * kTilePixels) { return kNewPrice; }
    const double gradient = std::sqrt(tile.squared_gradient / (kChannels * kTilePixels));
    const double bound = error_bound * std::clamp(gradient / 0.05, 0.6, 1.0);
    const bool is_over = std::ranges::any_of(tile.errors, [&](double error) { return error > bound; });
    return std::min((is_over ? kOverPrice : 0) + price / 2, kNewPrice - 1);
}

double worthOf(const HistoryTile& tile) {
    double squares = 0.0;
    for (const double error : tile.errors) { squares += kChannels * kCellPixels * error * error; }
    return squares > 0.0 ? std::max(std::min(squares * std::max(tile.age, 1u), kMostWorth), kStep) : 0.0;
}

std::uint64_t costOf(const HistoryTile& tile) { return std::min(tile.cost + kPairsOfTile, kMostCost); }

double leftSquares(std::span<const HistoryTile> tiles, std::span<const TileKind> kinds) {
    double squares = 0.0;
    for (std::size_t t = 0; t < tiles.size(); ++t) {
        double its = 0.0;
        for (const double error : tiles[t].errors) { its += kChannels * kCellPixels * error * error; }
        squares += kinds[t] == TileKind::kNone ? std::min(its, kMostSquares) : 0.0;
    }
    return squares;
}

ProjectedSplat asSeenWider(const ProjectedSplat& splat, glm::uvec2 size_px, bool dimmed) {
    ProjectedSplat wider = splat;
    wider.low_pass_factor /= 4.0;
    if (splat.gaussian) {
        const glm::dmat2 from_pixel(splat.plane_from_pixel.x, 0.0, splat.plane_from_pixel.y,
                                    splat.plane_from_pixel.z);
        const glm::dmat2 spread =
            glm::inverse(glm::transpose(from_pixel) * from_pixel) + glm::dmat2(3.0 * kScreenVariance);
        const double a = std::sqrt(spread[1].y / glm::determinant(spread));
        wider.plane_from_pixel = {a, -spread[1].x / spread[1].y * a, 1.0 / std::sqrt(spread[1].y)};
        if (dimmed) {
            wider.opacity /= glm::determinant(from_pixel) * std::sqrt(glm::determinant(spread));
            wider.cut = 2.0 * std::log(255.0 * wider.opacity);
        }
        wider.reach_px = glm::sqrt(std::max(wider.cut, 0.0) * glm::dvec2(spread[0].x, spread[1].y));
    }
    wider.box_px = glm::ivec4(0, 0, glm::ivec2(size_px));
    return wider;
}

double widerSquares(const HistoryTile& tile, const Picture& full, const Picture& wider, std::size_t index,
                    glm::uvec2 size_px) {
    const std::size_t columns = tileGrid(size_px).x;
    double squares = 0.0;
    for (std::size_t y = index / columns * kTileSize;
         y < std::min<std::size_t>((index / columns + 1) * kTileSize, size_px.y); ++y) {
        for (std::size_t x = index % columns * kTileSize;
             x < std::min<std::size_t>((index % columns + 1) * kTileSize, size_px.x); ++x) {
            squares += squareOf(
                glm::length(glm::dvec3(full.rgba[y * size_px.x + x] - wider.rgba[y * size_px.x + x])));
        }
    }
    return squares * std::clamp(tile.age, 1u, 32u);
}

SquaresOfTiles renderTiles(History& warped, const Picture& full, std::span<const std::uint64_t> costs,
                           std::span<const TileKind> kinds) {
    const std::size_t width = warped.eye.size_px.x, columns = tileGrid(warped.eye.size_px).x;
    std::vector<std::array<double, 4>> squares(kinds.size(), std::array<double, 4>{});
    for (std::size_t i = 0; i < warped.rgba.size(); ++i) {
        const std::size_t tile = i / width / kTileSize * columns + i % width / kTileSize;
        if (kinds[tile] == TileKind::kNone || kinds[tile] == TileKind::kHidden) { continue; }
        const std::size_t quarter = i / width % kTileSize / kCell * 2 + i % width % kTileSize / kCell;
        squares[tile][quarter] += squareOf(glm::length(glm::dvec3(full.rgba[i] - warped.rgba[i])));
        warped.rgba[i] = full.rgba[i];
        warped.pixels[i] = pixelOf(full, i);
    }
    SquaresOfTiles sums;
    for (std::size_t t = 0; t < kinds.size(); ++t) {
        if (kinds[t] == TileKind::kNone || kinds[t] == TileKind::kHidden) { continue; }
        const std::uint32_t age = warped.tiles[t].age;
        const std::array<double, 4> grown = warped.tiles[t].grown, errors = warped.tiles[t].errors;
        const std::array<unsigned, 4> unseen = warped.tiles[t].unseen;
        warped.tiles[t] = {costs[t], 0, {}, {}, {}};
        if (costs[t] == 0 || age == 0) { continue; }
        SquaresOfTiles its;
        for (std::size_t q = 0; q < 4; ++q) {
            if (unseen[q] >= kNewPixels || std::sqrt(grown[q] / (kChannels * kCellPixels)) >= kUnseenGrowth) {
                continue;
            }
            warped.tiles[t].growth[q] = std::sqrt(squares[t][q] / (kChannels * kCellPixels)) / age;
            its.expected += kChannels * kCellPixels * errors[q] * errors[q];
            its.found += squares[t][q];
        }
        sums.expected += std::min(its.expected, kMostSquares);
        sums.found += std::min(its.found, kMostSquares);
    }
    return sums;
}

History historyOf(const Eye& eye, const Picture& full, std::span<const std::uint64_t> costs) {
    History history{eye, full.rgba, {}, {}};
    for (std::size_t i = 0; i < full.rgba.size(); ++i) { history.pixels.push_back(pixelOf(full, i)); }
    for (const std::uint64_t cost : costs) { history.tiles.push_back({cost, 0, {}, {}, {}}); }
    return history;
}

}  // namespace binosplat::reference
