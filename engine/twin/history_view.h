// A history as warp_history and warp_pixels see it.
#pragma once

#include "engine/twin/eye_change.h"
#include "engine/twin/history.h"
#include "engine/twin/splat.h"

#include <algorithm>
#include <cmath>

namespace binosplat::reference {

inline constexpr int kCell = kTileSize / 2;
inline constexpr glm::ivec2 kHistoryBlock{4, 8};
inline constexpr double kMostSpreadPx = 4.0, kOwnSpread = 0.5;
inline constexpr double kMostPixelError = 4.0;  // squared, of three channels
// The square, in three channels, for a pixel that is made from another.
inline constexpr double kLeastGrowth = 1.9e-7;
// Content whose depths separate it by no more than this moves as one.
inline constexpr double kSameDepthPx = 0.25;
// A pixel of the history this close to the wanted place is what is seen there.
inline constexpr double kAgreesPx = 0.51;

inline constexpr int kReach = 3;  // the taps of a place reach this far from its pixel

inline double squareOf(double amplitude) { return std::min(amplitude * amplitude, kMostPixelError); }

class HistoryView {
public:
    HistoryView(const History& history, const Eye& now)
        : history_from_now(history.eye, now),
          now_from_history(now, history.eye),
          last(glm::ivec2(history.eye.size_px) - 1),
          columns_(tileGrid(history.eye.size_px).x),
          history_(history) {}

    [[nodiscard]] bool isInside(const glm::dvec2& place_px) const {
        return glm::all(glm::greaterThanEqual(place_px, glm::dvec2(0.0))) &&
               glm::all(glm::lessThan(place_px, glm::dvec2(last) + 1.0));
    }
    // Where a pixel is in the history. A place that is off a pixel by rounding alone counts as that pixel: a
    // head that stands still sees what it saw.
    [[nodiscard]] EyeChange::Moved place(const glm::dvec2& pixel_px, double inverse_depth) const {
        EyeChange::Moved moved = history_from_now.move(pixel_px, inverse_depth);
        for (int axis = 0; axis < 2; ++axis) {
            if (std::abs(moved.place_px[axis] - pixel_px[axis]) < 1e-9) {
                moved.place_px[axis] = pixel_px[axis];
            }
        }
        return moved;
    }
    [[nodiscard]] std::size_t indexOf(const glm::ivec2& pixel) const {
        const glm::ivec2 held = glm::clamp(pixel, glm::ivec2(0), last);
        return static_cast<std::size_t>(held.y) * static_cast<std::size_t>(last.x + 1) +
               static_cast<std::size_t>(held.x);
    }
    [[nodiscard]] const glm::dvec4& colour(int x, int y) const { return history_.rgba[indexOf({x, y})]; }
    [[nodiscard]] bool isHidden(const glm::ivec2& at) const {
        const glm::uvec2 tile = glm::uvec2(glm::clamp(at, glm::ivec2(0), last)) / unsigned{kTileSize};
        return !history_.hidden.empty() && history_.hidden[std::size_t{tile.y} * columns_ + tile.x] != 0;
    }
    [[nodiscard]] std::optional<MovingPixel> pixel(const glm::ivec2& at) const {
        return isHidden(at) ? std::nullopt : history_.pixels[indexOf(at)];
    }

    // True if taps around the pixels of a box, at most a tile wide, include hidden ones, whose background
    // would leak in.
    [[nodiscard]] bool reachesHidden(const glm::ivec2& first, const glm::ivec2& end) const {
        for (int y = first.y - kReach; y <= end.y + kReach; ++y) {
            for (int x = first.x - kReach; x <= end.x + kReach; ++x) {
                if (isHidden({x, y})) { return true; }
            }
        }
        return false;
    }
    // Whether it was hidden.
    [[nodiscard]] std::optional<MovingPixel> own(const glm::ivec2& at) const {
        return history_.pixels[indexOf(at)];
    }

    // What the history shows at a place.
    struct Seen {
        std::optional<MovingPixel> pixel;
        double inverse_depth = 0.0;  // as seen in the picture that is being made
        glm::dvec2 lands_px{0.0};    // where the pixel's middle lands
    };
    [[nodiscard]] Seen look(const glm::dvec2& place_px) const {
        const glm::ivec2 at(glm::floor(glm::clamp(place_px, glm::dvec2(0.0), glm::dvec2(last))));
        const std::optional<MovingPixel> found = pixel(at);
        const EyeChange::Moved moved =
            now_from_history.move(glm::dvec2(at) + 0.5, found ? found->inverse_depth : 0.0);
        if (!moved.in_front) { return {}; }
        return {found, moved.inverse_depth, moved.place_px};
    }

    // How far a pixel's place may be off if its inverse depth is off by `spread`.
    [[nodiscard]] glm::dvec2 uncertainMove(const glm::dvec2& pixel_px, double spread) const {
        const glm::dvec2 move_px = spread * history_from_now.disparity(pixel_px);
        const double length = glm::length(move_px);
        return length > kMostSpreadPx ? move_px * (kMostSpreadPx / length) : move_px;
    }

    EyeChange history_from_now, now_from_history;
    glm::ivec2 last;  // pixel of the history

private:
    std::size_t columns_;
    const History& history_;
};

// With six taps each way.
glm::dvec4 sampleSmoothly(const HistoryView& view, const glm::dvec2& place_px);
// The expected squared error of that, `t` after the pixel `wanted`, if the place may be off by `off_px`; and
// the picture's gradient there.
struct Loss {
    double error, squared_gradient;
};
Loss lossAt(const HistoryView& view, const glm::ivec2& wanted, const glm::dvec2& t, const glm::dvec2& off_px);

// warp_pixels: a pixel by itself. `near` and `far`: inverse depths around it.
struct PixelFromHistory {
    glm::dvec4 colour;
    MovingPixel pixel;
    bool seen;
    Loss loss;  // as expected
};
PixelFromHistory makePixel(const HistoryView& view, const glm::dvec2& wanted_px, double near, double far);

}  // namespace binosplat::reference
