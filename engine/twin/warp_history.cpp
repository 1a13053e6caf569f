// warp_history: an eye's picture from the one that it showed before, block by block.
#include "engine/twin/history_view.h"

namespace binosplat::reference {
namespace {

constexpr int kBorder = 2;
constexpr double kSmoothPx = 1.0 / 16.0;
constexpr double kSearchStepPx = 8.0;
constexpr int kMostSearched = 48;

struct BlockFromHistory {
    bool whole;                                      // it comes from a block of the history
    glm::dvec2 source_px;                            // where its middle comes from
    std::vector<std::optional<MovingPixel>> pixels;  // row by row
    glm::dvec2 mean_move_px;
    double nearest, farthest;  // inverse depths in it and around
    std::uint32_t spread = 0;  // the greatest code
};

// The inverse depth of the nearest content that comes to lie at a place from beyond its neighbours; 0: none
// in front of `known`. `moves_px`: how far it moves per unit of inverse depth.
double nearestOnTheWay(const HistoryView& view, const glm::dvec2& wanted_px, double moves_px, double known,
                       double near) {
    const int steps = static_cast<int>(std::min(moves_px / near / kSearchStepPx, double{kMostSearched}));
    double nearest = 0.0;
    for (int i = 1; i <= steps; ++i) {
        const EyeChange::Moved place = view.place(wanted_px, i * kSearchStepPx / moves_px);
        if (!place.in_front || !view.isInside(place.place_px)) { continue; }
        const HistoryView::Seen seen = view.look(place.place_px);
        const glm::dvec2 off_px = glm::abs(seen.lands_px - wanted_px);
        const bool comes = seen.pixel && std::max(off_px.x, off_px.y) <= kSearchStepPx;
        if (comes && moves_px * (seen.inverse_depth - known) > 1.0) {
            nearest = std::max(nearest, seen.inverse_depth);
        }
    }
    return nearest;
}

BlockFromHistory findBlock(const HistoryView& view, const glm::ivec2& first, double near) {
    const glm::dvec2 middle_px = glm::dvec2(first + kHistoryBlock / 2);
    const double guess = view.look(view.place(middle_px, 0.0).place_px).inverse_depth;
    const EyeChange::Moved source = view.place(middle_px, guess);
    BlockFromHistory block{source.in_front, source.place_px, {}, glm::dvec2(0.0), 0.0, HUGE_VAL};
    const glm::dvec2 in_reach = glm::clamp(source.place_px, glm::dvec2(-1e6), glm::dvec2(1e6));
    const glm::ivec2 corner = glm::ivec2(glm::floor(in_reach + 0.5)) - kHistoryBlock / 2,
                     end = corner + kHistoryBlock - 1;
    block.whole = block.whole && glm::all(glm::greaterThanEqual(corner, glm::ivec2(0))) &&
                  glm::all(glm::lessThanEqual(end, view.last)) && !view.reachesHidden(corner, end);

    const auto seenAt = [&](const glm::ivec2& at) {
        const std::optional<MovingPixel> pixel = view.pixel(glm::clamp(at, glm::ivec2(0), view.last));
        const EyeChange::Moved moved = view.now_from_history.move(
            glm::dvec2(glm::clamp(at, glm::ivec2(0), view.last)) + 0.5, pixel ? pixel->inverse_depth : 0.0);
        return pixel ? std::optional(MovingPixel{moved.inverse_depth, pixel->spread}) : std::nullopt;
    };
    const auto widen = [&](double inverse_depth) {
        block.nearest = std::max(block.nearest, inverse_depth);
        block.farthest = std::min(block.farthest, inverse_depth);
    };
    for (int y = 0; y < kHistoryBlock.y; ++y) {
        for (int x = 0; x < kHistoryBlock.x; ++x) {
            const std::optional<MovingPixel> pixel = seenAt(corner + glm::ivec2(x, y));
            block.whole = block.whole && pixel;
            block.pixels.push_back(pixel);
            widen(pixel ? pixel->inverse_depth : 0.0);
            block.spread = std::max(block.spread, pixel ? pixel->spread : 0);
            const glm::dvec2 here_px = glm::dvec2(first + glm::ivec2(x, y)) + 0.5;
            block.mean_move_px +=
                (view.place(here_px, pixel ? pixel->inverse_depth : 0.0).place_px - here_px) /
                double(kHistoryBlock.x * kHistoryBlock.y);
        }
    }
    const double differ = 0.5 * (block.nearest - block.farthest);
    // Content in front of its neighbours may have moved in front of this block.
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            if (x == 0 && y == 0) { continue; }
            const std::optional<MovingPixel> pixel =
                seenAt(corner + kHistoryBlock / 2 + glm::ivec2(x, y) * (kHistoryBlock / 2 + kBorder));
            widen(pixel ? pixel->inverse_depth : 0.0);
        }
    }
    const glm::dvec2 disparity = glm::abs(view.history_from_now.disparity(middle_px));
    const double moves_px = std::max(disparity.x, disparity.y);
    block.nearest = std::max(block.nearest, nearestOnTheWay(view, middle_px, moves_px, block.nearest, near));
    // What is found there must belong there: it must land where it was searched for.
    double mean = 0.0;
    for (const auto& pixel : block.pixels) {
        mean += (pixel ? pixel->inverse_depth : 0.0) / double(kHistoryBlock.x * kHistoryBlock.y);
    }
    block.whole = block.whole && moves_px * std::abs(mean - guess) <= kAgreesPx;
    // Not stretched along either axis, and of about one depth.
    const auto stretch = [&](int axis) {
        glm::dvec2 half(0.0);
        half[axis] = 0.5 * kHistoryBlock[axis];
        const double length = view.place(middle_px + half, guess).place_px[axis] -
                              view.place(middle_px - half, guess).place_px[axis];
        return 0.5 * (kHistoryBlock[axis] - 1) * std::abs(length / kHistoryBlock[axis] - 1.0);
    };
    block.whole = block.whole && std::max({stretch(0), stretch(1), moves_px * differ}) <= kSmoothPx &&
                  moves_px * (block.nearest - block.farthest) <= kSameDepthPx;
    return block;
}

// If anything moves, a block loses at least this much, so that every tile gets its turn.
double leastLossOf(const BlockFromHistory& block) {
    return kHistoryBlock.x * kHistoryBlock.y * (block.mean_move_px != glm::dvec2(0.0) ? kLeastGrowth : 0.0);
}

// For a whole block: over all its pixels, estimated from two of them. Those in between may be worse.
Loss lossOf(const HistoryView& view, const BlockFromHistory& block, const glm::ivec2& first) {
    const double spread =
        kOwnSpread * spreadOf(block.spread) * block.nearest + 0.5 * (block.nearest - block.farthest);
    const glm::dvec2 off_px = view.uncertainMove(glm::dvec2(first), spread),
                     t = block.mean_move_px - glm::floor(block.mean_move_px);
    const glm::ivec2 corner = glm::ivec2(glm::floor(block.source_px)) - kHistoryBlock / 2;
    const Loss one = lossAt(view, corner + glm::ivec2(1, 2), t, off_px),
               other = lossAt(view, corner + glm::ivec2(2, 5), t, off_px);
    const double pixels_each = 0.5 * kHistoryBlock.x * kHistoryBlock.y;
    return {std::max(pixels_each * (one.error + other.error), leastLossOf(block)),
            pixels_each * (one.squared_gradient + other.squared_gradient)};
}

class Warper {
public:
    Warper(const History& history, const Eye& eye, std::span<const std::uint8_t> hidden,
           const glm::dvec3& background, double near)
        : history_(history),
          hidden_(hidden),
          background_(background, 0.0),
          near_(near),
          view_(history, eye),
          tiles_(tileGrid(eye.size_px)) {
        const std::size_t pixels = std::size_t{eye.size_px.x} * eye.size_px.y;
        warped_.picture = {eye,
                           std::vector<glm::dvec4>(pixels, background_),
                           std::vector<std::optional<MovingPixel>>(pixels),
                           {},
                           {hidden.begin(), hidden.end()}};
        warped_.unseen.resize(pixels);
        for (std::size_t t = 0; t < std::size_t{tiles_.x} * tiles_.y; ++t) {
            warped_.picture.tiles.push_back(tileBefore(t));
        }
    }

    WarpedHistory run() {
        const glm::ivec2 size(warped_.picture.eye.size_px);
        for (int y = 0; y < size.y; y += kHistoryBlock.y) {
            for (int x = 0; x < size.x; x += kHistoryBlock.x) { makeBlock({x, y}); }
        }
        return std::move(warped_);
    }

private:
    // The tile's cost and age are those of where its middle comes from.
    [[nodiscard]] HistoryTile tileBefore(std::size_t tile) const {
        const glm::dvec2 middle_px =
            glm::min(glm::dvec2(tile % tiles_.x, tile / tiles_.x) * double{kTileSize} + 0.5 * kTileSize,
                     glm::dvec2(warped_.picture.eye.size_px));
        const double guess = view_.look(view_.place(middle_px, 0.0).place_px).inverse_depth;
        const glm::dvec2 from_px =
            glm::clamp(view_.place(middle_px, guess).place_px, glm::dvec2(0.0), glm::dvec2(view_.last));
        const HistoryTile& before = tileOf(history_, from_px);
        return {before.cost, before.age + 1, {}, {}, {}, before.lost};
    }
    static const HistoryTile& tileOf(const History& history, const glm::dvec2& place_px) {
        const glm::uvec2 at = glm::uvec2(place_px) / unsigned{kTileSize};
        return history.tiles[std::size_t{at.y} * tileGrid(history.eye.size_px).x + at.x];
    }
    static std::size_t quarterOf(const glm::ivec2& pixel) {
        return static_cast<std::size_t>(pixel.y % kTileSize / kCell * 2 + pixel.x % kTileSize / kCell);
    }

    void makeBlock(const glm::ivec2& first) {
        const std::size_t tile_index =
            std::size_t(first.y / kTileSize) * tiles_.x + std::size_t(first.x / kTileSize);
        if (!hidden_.empty() && hidden_[tile_index] != 0) { return warped_.one_by_one.push_back(0); }
        const BlockFromHistory block = findBlock(view_, first, near_);
        HistoryTile& tile = warped_.picture.tiles[tile_index];
        const std::size_t quarter = quarterOf(first);
        // The history's errors carry over as squares, and their growth unchanged: as means over where the
        // quarter's blocks come from.
        if (view_.isInside(block.source_px)) {
            const std::size_t from = quarterOf(glm::ivec2(block.source_px));
            const HistoryTile& before = tileOf(history_, block.source_px);
            const bool is_cut =
                first.x / kCell * kCell + kHistoryBlock.x >= static_cast<int>(warped_.picture.eye.size_px.x);
            const double share = is_cut ? 1.0 : static_cast<double>(kHistoryBlock.x) / kCell;
            tile.errors[quarter] =
                std::hypot(tile.errors[quarter], std::sqrt(share) * std::min(before.errors[from], 1.0));
            tile.growth[quarter] += share * std::min(before.growth[from], 1.0);
        }
        warped_.one_by_one.push_back(block.whole ? 0 : 1);
        // And the loss of its pixels.
        const Loss loss = block.whole ? lossOf(view_, block, first) : Loss{leastLossOf(block), 0.0};
        tile.grown[quarter] += loss.error;
        tile.squared_gradient += loss.squared_gradient;
        const glm::ivec2 size(warped_.picture.eye.size_px);
        for (int i = 0; i < kHistoryBlock.x * kHistoryBlock.y; ++i) {
            const glm::ivec2 pixel = first + glm::ivec2(i % kHistoryBlock.x, i / kHistoryBlock.x);
            if (glm::any(glm::greaterThanEqual(pixel, size))) { continue; }
            const glm::dvec2 middle_px = glm::dvec2(pixel) + 0.5;
            if (block.whole) {
                const MovingPixel& its = *block.pixels[static_cast<std::size_t>(i)];
                put(pixel, its, sampleSmoothly(view_, view_.place(middle_px, its.inverse_depth).place_px));
                continue;
            }
            const PixelFromHistory made = makePixel(view_, middle_px, block.nearest, block.farthest);
            tile.grown[quarter] += made.loss.error;
            tile.squared_gradient += made.loss.squared_gradient;
            tile.unseen[quarter] += made.seen ? 0 : 1;
            warped_.unseen[indexOf(pixel)] = made.seen ? 0 : 1;
            put(pixel, made.pixel, made.colour);
        }
    }
    [[nodiscard]] std::size_t indexOf(const glm::ivec2& pixel) const {
        return static_cast<std::size_t>(pixel.y) * warped_.picture.eye.size_px.x +
               static_cast<std::size_t>(pixel.x);
    }
    void put(const glm::ivec2& pixel, const MovingPixel& moving, const glm::dvec4& colour) {
        warped_.picture.rgba[indexOf(pixel)] = colour;
        warped_.picture.pixels[indexOf(pixel)] = moving;
    }

    const History& history_;
    std::span<const std::uint8_t> hidden_;
    glm::dvec4 background_;
    double near_;
    HistoryView view_;
    glm::uvec2 tiles_;
    WarpedHistory warped_;
};

}  // namespace

glm::dvec4 sampleSmoothly(const HistoryView& view, const glm::dvec2& place_px) {
    const glm::dvec2 at = place_px - 0.5, base = glm::floor(at);
    const auto weights_x = sixTapWeights(at.x - base.x), weights_y = sixTapWeights(at.y - base.y);
    glm::dvec4 sum(0.0);
    for (int y = 0; y < 6; ++y) {
        for (int x = 0; x < 6; ++x) {
            sum += weights_x[static_cast<std::size_t>(x)] * weights_y[static_cast<std::size_t>(y)] *
                   view.colour(static_cast<int>(base.x) + x - 2, static_cast<int>(base.y) + y - 2);
        }
    }
    return glm::max(sum, glm::dvec4(0.0));
}

// The expected squared error of a pixel of a block. A signal that alternates in sign from pixel to pixel with
// an amplitude d has fifth differences of 32 d, all of which is lost halfway between two pixels, but less of
// longer waves: four fifths in all. To this is added how the picture changes over the uncertainty of the
// place.
Loss lossAt(const HistoryView& view, const glm::ivec2& wanted, const glm::dvec2& t,
            const glm::dvec2& off_px) {
    constexpr std::array<double, 6> kFifthDifference{-1, 5, -10, 10, -5, 1};
    const glm::ivec2 at = glm::clamp(wanted, glm::ivec2(0), view.last);
    glm::dvec3 across(0.0), down(0.0);
    for (int k = 0; k < 6; ++k) {
        across += kFifthDifference[static_cast<std::size_t>(k)] * glm::dvec3(view.colour(at.x + k - 2, at.y));
        down += kFifthDifference[static_cast<std::size_t>(k)] * glm::dvec3(view.colour(at.x, at.y + k - 2));
    }
    across *= 0.8 * 4.0 * t.x * (1.0 - t.x) / 32.0;
    down *= 0.8 * 4.0 * t.y * (1.0 - t.y) / 32.0;
    const glm::dvec3 slope_across =
        0.5 * glm::dvec3(view.colour(at.x + 1, at.y) - view.colour(at.x - 1, at.y));
    const glm::dvec3 slope_down = 0.5 * glm::dvec3(view.colour(at.x, at.y + 1) - view.colour(at.x, at.y - 1));
    return {squareOf(std::sqrt(glm::dot(across, across) + glm::dot(down, down)) +
                     glm::length(off_px.x * slope_across + off_px.y * slope_down)),
            glm::dot(slope_across, slope_across) + glm::dot(slope_down, slope_down)};
}

std::array<double, 6> sixTapWeights(double t) {
    std::array<double, 6> weights{};
    for (int i = 0; i < 6; ++i) {
        double weight = 1.0;
        for (int j = 0; j < 6; ++j) {
            if (j != i) { weight *= (t - (j - 2)) / (i - j); }
        }
        weights[static_cast<std::size_t>(i)] = weight;
    }
    constexpr std::array<double, 5> kFourth{1, -4, 6, -4, 1}, kSecond{0, 1, -2, 1, 0};
    const double most = squareOf(4.0 * t * (1.0 - t));
    for (std::size_t i = 0; i < 5; ++i) {
        const double sharper = most * (0.024 * kFourth[i] + 0.02 * kSecond[i]);
        weights[i] += (1.0 - t) * sharper;
        weights[i + 1] += t * sharper;
    }
    return weights;
}

WarpedHistory warpHistory(const History& history, const Eye& eye, std::span<const std::uint8_t> hidden,
                          const glm::dvec3& background, double near) {
    return Warper(history, eye, hidden, background, near).run();
}

}  // namespace binosplat::reference
