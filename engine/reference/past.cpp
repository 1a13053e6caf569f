// Warping an eye's last picture, and choosing what is rendered again.
#include "engine/reference/past.h"

#include "engine/parallel.h"
#include "engine/reference/eye_change.h"
#include "engine/reference/splat.h"

#include <algorithm>
#include <cmath>

namespace binosplat::reference {
namespace {

constexpr std::uint32_t kTile = kTileSize, kCell = kTile / 2;
constexpr int kSteps = 8;             // of the fixed point
constexpr double kAgreesPx = 0.5;     // forwards
constexpr double kUnseenError = 1.0;  // an amplitude: black where white should be
constexpr double kMostSpreadPx = 4.0;

glm::uvec2 cellGrid(glm::uvec2 size_px) { return (size_px + kCell - 1u) / kCell; }

std::size_t pixelAt(glm::uvec2 size_px, const glm::dvec2& place_px) {
    const glm::dvec2 held = glm::clamp(glm::floor(place_px), glm::dvec2(0.0), glm::dvec2(size_px) - 1.0);
    return static_cast<std::size_t>(held.y) * size_px.x + static_cast<std::size_t>(held.x);
}

bool isInside(glm::uvec2 size_px, const glm::dvec2& place_px) {
    return glm::all(glm::greaterThanEqual(place_px, glm::dvec2(0.0))) && glm::all(glm::lessThan(place_px, glm::dvec2(size_px)));
}

// The least and the greatest inverse depth of each tile and those around it.
std::vector<std::pair<double, double>> depthsAround(const Past& past) {
    const glm::ivec2 tiles(tileGrid(past.eye.size_px));
    std::vector<std::pair<double, double>> of_tile(static_cast<std::size_t>(tiles.x) * tiles.y, {1e300, 0.0}), around = of_tile;
    for (std::size_t i = 0; i < past.inverse_depths.size(); ++i) {
        const std::size_t x = i % past.eye.size_px.x, y = i / past.eye.size_px.x;
        auto& [least, most] = of_tile[y / kTile * static_cast<std::size_t>(tiles.x) + x / kTile];
        least = std::min(least, past.inverse_depths[i]);
        most = std::max(most, past.inverse_depths[i]);
    }
    for (int y = 0; y < tiles.y; ++y) {
        for (int x = 0; x < tiles.x; ++x) {
            auto& [least, most] = around[static_cast<std::size_t>(y * tiles.x + x)];
            for (int j = std::max(y - 1, 0); j <= std::min(y + 1, tiles.y - 1); ++j) {
                for (int i = std::max(x - 1, 0); i <= std::min(x + 1, tiles.x - 1); ++i) {
                    const auto& other = of_tile[static_cast<std::size_t>(j * tiles.x + i)];
                    least = std::min(least, other.first);
                    most = std::max(most, other.second);
                }
            }
        }
    }
    return around;
}

struct Sample {
    glm::dvec4 colour;
    double lost;              // amplitude of what sampling between pixels is expected to lose
    glm::dvec3 across, down;  // slopes, a pixel each way
};

Sample samplePast(const Past& past, const glm::dvec2& place_px) {
    const glm::ivec2 size(past.eye.size_px);
    glm::dvec2 at = glm::clamp(place_px, glm::dvec2(0.5), glm::dvec2(size) - 0.5) - 0.5;
    // What is off a pixel's centre by rounding alone is not blurred: a head that stands still sees what it saw.
    for (int axis = 0; axis < 2; ++axis) {
        if (std::abs(at[axis] - std::round(at[axis])) < 1e-9) { at[axis] = std::round(at[axis]); }
    }
    const glm::ivec2 base(glm::floor(at));
    const glm::dvec2 t = at - glm::dvec2(base);
    const auto weights_x = lagrangeWeights(t.x), weights_y = lagrangeWeights(t.y);
    const auto pixel = [&](int x, int y) {
        return past.rgba[static_cast<std::size_t>(std::clamp(y, 0, size.y - 1)) * static_cast<std::size_t>(size.x) +
                         static_cast<std::size_t>(std::clamp(x, 0, size.x - 1))];
    };
    // What changes its sign from pixel to pixel is lost halfway between them: the fifth difference of such a row is 32 times its amplitude.
    constexpr std::array<double, 6> kFifthDifference{-1, 5, -10, 10, -5, 1};
    glm::dvec4 sum(0.0);
    glm::dvec3 lost_across(0.0), lost_down(0.0);
    for (int y = 0; y < 6; ++y) {
        glm::dvec4 row(0.0);
        for (int x = 0; x < 6; ++x) {
            const glm::dvec4 one = pixel(base.x + x - 2, base.y + y - 2);
            row += weights_x[static_cast<std::size_t>(x)] * one;
            if (y == 2) { lost_across += kFifthDifference[static_cast<std::size_t>(x)] * glm::dvec3(one); }
            if (x == 2) { lost_down += kFifthDifference[static_cast<std::size_t>(y)] * glm::dvec3(one); }
        }
        sum += weights_y[static_cast<std::size_t>(y)] * row;
    }
    lost_across *= 4.0 * t.x * (1.0 - t.x) / 32.0;
    lost_down *= 4.0 * t.y * (1.0 - t.y) / 32.0;
    const glm::ivec2 nearest(glm::round(at));
    return {glm::max(sum, glm::dvec4(0.0)), std::sqrt((glm::dot(lost_across, lost_across) + glm::dot(lost_down, lost_down)) / 3.0),
            0.5 * glm::dvec3(pixel(nearest.x + 1, nearest.y) - pixel(nearest.x - 1, nearest.y)),
            0.5 * glm::dvec3(pixel(nearest.x, nearest.y + 1) - pixel(nearest.x, nearest.y - 1))};
}

// The amplitude of what an uncertain depth costs: depths differ between the pixels around, each of which may show through this one.
double uncertainty(const Past& past, const EyeChange& there, const glm::dvec2& place_px, double inverse_depth, const Sample& sample) {
    const glm::ivec2 size(past.eye.size_px);
    const glm::ivec2 at = glm::clamp(glm::ivec2(glm::floor(place_px)), glm::ivec2(0), size - 1);
    double spread = 0.0;
    for (const glm::ivec2 step : {glm::ivec2(-1, 0), glm::ivec2(1, 0), glm::ivec2(0, -1), glm::ivec2(0, 1)}) {
        const glm::ivec2 beside = glm::clamp(at + step, glm::ivec2(0), size - 1);
        const double other =
            past.inverse_depths[static_cast<std::size_t>(beside.y) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(beside.x)];
        spread = std::max(spread, std::abs(other - inverse_depth));
    }
    glm::dvec2 moves_px = 0.5 * spread * there.disparity(place_px);
    const double length = glm::length(moves_px);
    if (length > kMostSpreadPx) { moves_px *= kMostSpreadPx / length; }
    const glm::dvec3 change = moves_px.x * sample.across + moves_px.y * sample.down;
    return std::sqrt(glm::dot(change, change) / 3.0);
}

}  // namespace

std::array<double, 6> lagrangeWeights(double t) {
    std::array<double, 6> weights{};
    for (int i = 0; i < 6; ++i) {
        double weight = 1.0;
        for (int j = 0; j < 6; ++j) {
            if (j != i) { weight *= (t - (j - 2)) / (i - j); }
        }
        weights[static_cast<std::size_t>(i)] = weight;
    }
    return weights;
}

std::vector<std::optional<FoundInPast>> findInPast(const Past& past, const Eye& eye, int threads) {
    const EyeChange back(past.eye, eye), forth(eye, past.eye);
    const glm::uvec2 size_px = eye.size_px, tiles = tileGrid(past.eye.size_px);
    const auto around = depthsAround(past);
    std::vector<std::optional<FoundInPast>> found(std::size_t{size_px.x} * size_px.y);
    const auto search = [&](const glm::dvec2& wanted_px, double inverse_depth) -> std::optional<FoundInPast> {
        for (int step = 0; step < kSteps; ++step) {
            const EyeChange::Moved place = back.move(wanted_px, inverse_depth);
            if (!place.in_front || !isInside(past.eye.size_px, place.place_px)) { return std::nullopt; }
            const EyeChange::Moved again = forth.move(place.place_px, past.inverse_depths[pixelAt(past.eye.size_px, place.place_px)]);
            if (!again.in_front) { return std::nullopt; }
            const bool settled = std::abs(again.inverse_depth - inverse_depth) <= 1e-9 * std::abs(inverse_depth);
            inverse_depth = again.inverse_depth;
            const glm::dvec2 off = glm::abs(again.place_px - wanted_px);
            if (settled || step + 1 == kSteps) {
                if (std::max(off.x, off.y) > kAgreesPx) { return std::nullopt; }
                return FoundInPast{back.move(wanted_px, inverse_depth).place_px, inverse_depth};
            }
        }
        return std::nullopt;
    };
    forBlocks(found.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::dvec2 wanted_px(static_cast<double>(i % size_px.x) + 0.5, static_cast<double>(i / size_px.x) + 0.5);
            const glm::dvec2 near_place =
                glm::clamp(back.move(wanted_px, 0.0).place_px, glm::dvec2(0.0), glm::dvec2(past.eye.size_px) - 1.0);
            const glm::uvec2 tile = glm::uvec2(near_place) / kTile;
            const auto [least, most] = around[std::size_t{tile.y} * tiles.x + tile.x];
            const auto from_near = search(wanted_px, most), from_far = search(wanted_px, least);
            found[i] = from_near && (!from_far || from_near->inverse_depth >= from_far->inverse_depth) ? from_near : from_far;
        }
    });
    return found;
}

WarpedPast warpPast(const Past& past, const Eye& eye, int threads) {
    const auto found = findInPast(past, eye, threads);
    const EyeChange back(past.eye, eye), forth(eye, past.eye);
    const glm::uvec2 size_px = eye.size_px, cells = cellGrid(size_px), past_cells = cellGrid(past.eye.size_px);
    WarpedPast warped{{eye, std::vector<glm::dvec4>(found.size()), std::vector<double>(found.size()), {}, past.ages}, 0};
    for (std::uint32_t& age : warped.picture.ages) { ++age; }
    std::vector<double> grown(found.size()), carried(found.size());
    forBlocks(found.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::dvec2 wanted_px(static_cast<double>(i % size_px.x) + 0.5, static_cast<double>(i / size_px.x) + 0.5);
            const glm::dvec2 place_px = found[i] ? found[i]->place_px : back.move(wanted_px, 0.0).place_px;
            const Sample sample = samplePast(past, place_px);
            const std::size_t source = pixelAt(past.eye.size_px, place_px);
            warped.picture.rgba[i] = sample.colour;
            warped.picture.inverse_depths[i] = found[i] ? found[i]->inverse_depth : 0.0;
            grown[i] = found[i] ? sample.lost + uncertainty(past, forth, place_px, past.inverse_depths[source], sample) : kUnseenError;
            const std::size_t x = source % past.eye.size_px.x, y = source / past.eye.size_px.x;
            carried[i] = past.cell_errors[y / kCell * past_cells.x + x / kCell];
        }
    });
    // What was wrong comes along as the worst of where a cell comes from; what this step loses adds to it as an amplitude, since a blur of
    // a blur is blurred more.
    std::vector<double> worst(std::size_t{cells.x} * cells.y, 0.0), squares(worst.size(), 0.0), pixels(worst.size(), 0.0);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const std::size_t cell = i / size_px.x / kCell * cells.x + i % size_px.x / kCell;
        worst[cell] = std::max(worst[cell], carried[i]);
        squares[cell] += grown[i] * grown[i];
        pixels[cell] += 1.0;
        warped.unseen_pixels += found[i] ? 0 : 1;
    }
    warped.picture.cell_errors.resize(worst.size());
    for (std::size_t cell = 0; cell < worst.size(); ++cell) {
        warped.picture.cell_errors[cell] = worst[cell] + std::sqrt(squares[cell] / pixels[cell]);
    }
    return warped;
}

std::vector<std::uint8_t> chooseTiles(const Past& warped, std::span<const std::uint64_t> costs, std::uint64_t budget_pairs) {
    const glm::uvec2 tiles = tileGrid(warped.eye.size_px), cells = cellGrid(warped.eye.size_px);
    struct Worth {
        double worth;
        std::size_t tile;
    };
    std::vector<Worth> by_worth;
    for (std::size_t tile = 0; tile < costs.size(); ++tile) {
        double squares = 0.0;
        for (std::uint32_t j = 0; j < 2; ++j) {
            for (std::uint32_t i = 0; i < 2; ++i) {
                const glm::uvec2 cell(2 * (tile % tiles.x) + i, 2 * (tile / tiles.x) + j);
                if (cell.x >= cells.x || cell.y >= cells.y) { continue; }
                const double error = warped.cell_errors[std::size_t{cell.y} * cells.x + cell.x];
                squares += error * error;
            }
        }
        const double worth = squares * warped.ages[tile] / static_cast<double>(std::max<std::uint64_t>(costs[tile], 1));
        if (worth > 0.0) { by_worth.push_back({worth, tile}); }
    }
    std::ranges::stable_sort(by_worth, std::ranges::greater{}, &Worth::worth);
    std::vector<std::uint8_t> chosen(costs.size(), 0);
    std::uint64_t spent = 0;
    for (const Worth& one : by_worth) {
        if (spent > 0 && spent + costs[one.tile] > budget_pairs) { continue; }
        spent += costs[one.tile];
        chosen[one.tile] = 1;
        if (spent >= budget_pairs) { break; }
    }
    return chosen;
}

void renderChosen(Past& warped, const Picture& full, std::span<const std::uint8_t> chosen) {
    const glm::uvec2 size_px = warped.eye.size_px, tiles = tileGrid(size_px), cells = cellGrid(size_px);
    for (std::size_t i = 0; i < warped.rgba.size(); ++i) {
        const std::size_t x = i % size_px.x, y = i / size_px.x, tile = y / kTile * tiles.x + x / kTile;
        if (chosen[tile] == 0) { continue; }
        warped.rgba[i] = full.rgba[i];
        warped.inverse_depths[i] = full.rgba[i].a > 0.0 ? full.inverse_depth[i] / full.rgba[i].a : 0.0;
        warped.cell_errors[y / kCell * cells.x + x / kCell] = 0.0;
        warped.ages[tile] = 0;
    }
}

Past pastOf(const Eye& eye, const Picture& full) {
    const glm::uvec2 tiles = tileGrid(eye.size_px), cells = cellGrid(eye.size_px);
    Past past{eye, full.rgba, std::vector<double>(full.rgba.size()), std::vector<double>(std::size_t{cells.x} * cells.y, 0.0),
              std::vector<std::uint32_t>(std::size_t{tiles.x} * tiles.y, 0)};
    renderChosen(past, full, std::vector<std::uint8_t>(past.ages.size(), 1));
    return past;
}

}  // namespace binosplat::reference
