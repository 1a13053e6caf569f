// Angles, turns, and the view's outline among the tiles of its picture.
#include "app/axes/staying_axes.h"

#include "engine/passes/frame_buffers.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace binosplat {
namespace {

// Wider pictures would be mostly border.
constexpr double kMostRad = 1.4;
// A turning head goes on turning for about this many frames; the axes move ahead by at most this share of the
// margin.
constexpr double kFramesAhead = 20.0, kMostAhead = 0.9;
// However wide whole tiles are, earlier axes that are farther off than this are not used.
constexpr double kMostMargins = 1.5;
// So that some tiles are hidden in every frame, since a frame in which hiding begins or ends is waited for.
constexpr std::uint32_t kLeastBorderTiles = 2;
// The compositor's filter reads pixels beyond the view's edge, and the warp reads some more.
constexpr double kBesidePx = 4.0;
// If tiles coincide with the view's. What the lens hides has its own margin for the filter.
constexpr double kRoundingPx = 0.02;
// Angles may jitter by the rounding of their float32.
constexpr double kSameShare = 1e-4;

// Maps pixels of one eye to those of another at the same place; only what is in front of the latter.
struct Homography {
    glm::dmat3 matrix;

    Homography(const Eye& to, const Eye& from) {
        const Intrinsics &k = to.intrinsics, &l = from.intrinsics;
        const glm::dmat3 to_from_from = glm::mat3_cast(glm::conjugate(to.world_from_camera.orientation) *
                                                       from.world_from_camera.orientation);
        matrix = glm::dmat3(k.fx, 0, 0, 0, k.fy, 0, k.cx, k.cy, 1) * to_from_from *
                 glm::dmat3(1 / l.fx, 0, 0, 0, 1 / l.fy, 0, -l.cx / l.fx, -l.cy / l.fy, 1);
    }
    [[nodiscard]] std::optional<glm::dvec2> operator()(const glm::dvec2& place_px) const {
        const glm::dvec3 at = matrix * glm::dvec3(place_px, 1.0);
        if (!(at.z > 1e-6)) { return std::nullopt; }
        return glm::dvec2(at) / at.z;
    }
};

std::optional<std::array<glm::dvec2, 4>> outlineOf(const Eye& view, const Eye& picture) {
    const Homography toPicture(picture, view);
    const glm::dvec2 size(view.size_px);
    std::array<glm::dvec2, 4> corners;
    for (std::size_t c = 0; c < 4; ++c) {
        const auto corner = toPicture(size * glm::dvec2(c == 1 || c == 2 ? 1 : 0, c >= 2 ? 1 : 0));
        if (!corner) { return std::nullopt; }
        corners[c] = *corner;
    }
    return corners;
}

// Whole tiles beyond an edge that is `px` from the axis.
std::uint32_t borderTiles(double px, double focal_px, double margin_rad) {
    const double wanted_px = focal_px * std::tan(std::min(std::atan(px / focal_px) + margin_rad, kMostRad));
    return std::max(static_cast<std::uint32_t>(std::ceil(std::max(wanted_px - px, 0.0) / gpu::kTileSize)),
                    kLeastBorderTiles);
}

bool sameLens(const Eye& a, const Eye& b) {
    const auto near = [&](double x, double y) { return std::abs(x - y) <= kSameShare * a.intrinsics.fx; };
    return a.size_px == b.size_px && a.own_pixel_px == b.own_pixel_px &&
           near(a.intrinsics.fx, b.intrinsics.fx) && near(a.intrinsics.fy, b.intrinsics.fy) &&
           near(a.intrinsics.cx, b.intrinsics.cx) && near(a.intrinsics.cy, b.intrinsics.cy);
}

// The rotation by this many times its angle.
glm::dquat timesAngle(const glm::dquat& turn, double factor) {
    const glm::dquat shorter = turn.w < 0.0 ? -turn : turn;
    const double angle = glm::angle(shorter);
    return angle < 1e-9 ? glm::dquat(1, 0, 0, 0) : glm::angleAxis(factor * angle, glm::axis(shorter));
}

// Sums over rectangles of tiles that begin at the first.
class TileSums {
public:
    TileSums(std::span<const std::uint8_t> hidden, glm::uvec2 tiles)
        : columns_(tiles.x + 1), sums_(std::size_t{columns_} * (tiles.y + 1)) {
        for (std::uint32_t y = 0; y < tiles.y; ++y) {
            for (std::uint32_t x = 0; x < tiles.x; ++x) {
                const std::uint32_t shown = hidden[std::size_t{y} * tiles.x + x] == 0 ? 1 : 0;
                at(x + 1, y + 1) = shown + at(x, y + 1) + at(x + 1, y) - at(x, y);
            }
        }
    }
    [[nodiscard]] bool anyShown(glm::uvec2 begin, glm::uvec2 end) {
        return at(end.x, end.y) + at(begin.x, begin.y) != at(begin.x, end.y) + at(end.x, begin.y);
    }

private:
    std::uint32_t& at(std::uint32_t x, std::uint32_t y) { return sums_[std::size_t{y} * columns_ + x]; }
    std::uint32_t columns_;
    std::vector<std::uint32_t> sums_;
};

// Also hides the tiles that are entirely where the view's are hidden.
void hideWhatTheLensHides(std::vector<std::uint8_t>& hidden, const Eye& view, const Eye& picture,
                          std::span<const std::uint8_t> hidden_in_view) {
    const glm::uvec2 tiles = tilesOf(picture.size_px), view_tiles = tilesOf(view.size_px);
    TileSums shown(hidden_in_view, view_tiles);
    const Homography toView(view, picture);
    std::vector<std::optional<glm::dvec2>> above, below;  // the corners of a row
    for (std::uint32_t y = 0; y <= tiles.y; ++y) {
        above = std::exchange(below, {});
        for (std::uint32_t x = 0; x <= tiles.x; ++x) {
            below.push_back(toView(glm::dvec2(x, y) * double{gpu::kTileSize}));
        }
        for (std::uint32_t x = 0; y > 0 && x < tiles.x; ++x) {
            std::uint8_t& its = hidden[std::size_t{y - 1} * tiles.x + x];
            if (its != 0) { continue; }
            glm::dvec2 low(1e9), high(-1e9);
            for (const auto& at : {above[x], above[x + 1], below[x], below[x + 1]}) {
                if (!at) { continue; }
                low = glm::min(low, *at);
                high = glm::max(high, *at);
            }
            const glm::dvec2 last = glm::dvec2(view_tiles) - 1.0;
            const glm::uvec2 first(
                glm::clamp(glm::floor((low + kRoundingPx) / double{gpu::kTileSize}), glm::dvec2(0.0), last));
            const glm::uvec2 end(
                glm::clamp(glm::floor((high - kRoundingPx) / double{gpu::kTileSize}), glm::dvec2(0.0), last) +
                1.0);
            its = shown.anyShown(first, end) ? 0 : 1;
        }
    }
}

}  // namespace

Eye coverOf(const Eye& view, double margin_rad) {
    Eye picture = view;
    Intrinsics& k = picture.intrinsics;
    const glm::dvec2 size(view.size_px);
    const glm::uvec2 before(borderTiles(k.cx, k.fx, margin_rad), borderTiles(k.cy, k.fy, margin_rad));
    const glm::uvec2 after(borderTiles(size.x - k.cx, k.fx, margin_rad),
                           borderTiles(size.y - k.cy, k.fy, margin_rad));
    picture.size_px = view.size_px + gpu::kTileSize * (before + after);
    k.cx += double{gpu::kTileSize} * before.x;
    k.cy += double{gpu::kTileSize} * before.y;
    return picture;
}

bool covers(const Eye& picture, const Eye& view) {
    const auto corners = outlineOf(view, picture);
    const glm::dvec2 size(picture.size_px);
    return corners && std::ranges::all_of(*corners, [&](const glm::dvec2& corner) {
               return glm::all(glm::greaterThanEqual(corner, glm::dvec2(-0.01))) &&
                      glm::all(glm::lessThanEqual(corner, size + 0.01));
           });
}

std::vector<std::uint8_t> hiddenFrom(const Eye& view, const Eye& picture,
                                     std::span<const std::uint8_t> hidden_in_view) {
    const glm::uvec2 tiles = tilesOf(picture.size_px);
    std::vector<std::uint8_t> hidden(std::size_t{tiles.x} * tiles.y, 1);
    const double columns = tiles.x;
    const auto corners = outlineOf(view, picture);
    if (!corners) { return std::vector<std::uint8_t>(hidden.size(), 0); }
    for (std::uint32_t row = 0; row < tiles.y; ++row) {
        // The part of the view, which is convex, within the row: its corners there, and where its edges cross
        // the row's borders.
        const double top = gpu::kTileSize * row - kBesidePx, bottom = gpu::kTileSize * (row + 1) + kBesidePx;
        double left = 1e9, right = -1e9;
        const auto hold = [&](double x) {
            left = std::min(left, x);
            right = std::max(right, x);
        };
        for (std::size_t c = 0; c < 4; ++c) {
            const glm::dvec2 &from = (*corners)[c], &to = (*corners)[(c + 1) % 4];
            if (from.y >= top && from.y <= bottom) { hold(from.x); }
            for (const double y : {top, bottom}) {
                if ((from.y < y) != (to.y < y)) {
                    hold(from.x + (y - from.y) / (to.y - from.y) * (to.x - from.x));
                }
            }
        }
        if (left > right) { continue; }
        const auto tileAt = [&](double x) {
            return std::clamp(std::floor(x / gpu::kTileSize), 0.0, columns);
        };
        const auto begin = static_cast<std::uint32_t>(tileAt(left - kBesidePx));
        const auto end = static_cast<std::uint32_t>(std::min(tileAt(right + kBesidePx) + 1.0, columns));
        const auto first = hidden.begin() + static_cast<std::ptrdiff_t>(std::size_t{row} * tiles.x);
        if (begin < end) { std::fill(first + begin, first + end, std::uint8_t{0}); }
    }
    if (!hidden_in_view.empty()) { hideWhatTheLensHides(hidden, view, picture, hidden_in_view); }
    return hidden;
}

glm::dmat3 pictureFromView(const Eye& picture, const Eye& view) { return Homography(picture, view).matrix; }

std::array<std::optional<Gaze>, 2> turnGazes(std::array<std::optional<Gaze>, 2> gazes,
                                             std::span<const Eye> views, std::span<const Eye> pictures) {
    for (std::size_t e = 0; e < views.size(); ++e) {
        if (!gazes[e]) { continue; }
        gazes[e]->direction = glm::conjugate(pictures[e].world_from_camera.orientation) *
                              (views[e].world_from_camera.orientation * gazes[e]->direction);
    }
    return gazes;
}

bool StayingAxes::coverAll(std::span<const Eye> views) const {
    for (std::size_t e = 0; e < views.size(); ++e) {
        if (!covers(pictures_[e], views[e])) { return false; }
    }
    return true;
}

bool StayingAxes::isFarFrom(const Eye& view) const {
    const double alike =
        glm::dot(pictures_.front().world_from_camera.orientation, view.world_from_camera.orientation);
    return std::abs(alike) < std::cos(0.5 * kMostMargins * margin_rad_);
}

// The views are assumed to go on turning as they have since the last frame.
void StayingAxes::moveTo(std::span<const Eye> views) {
    const auto axesOf = [](const Eye& eye) { return eye.world_from_camera.orientation; };
    const glm::dquat turn = views_.size() == views.size()
                                ? axesOf(views[0]) * glm::conjugate(axesOf(views_[0]))
                                : glm::dquat(1, 0, 0, 0);
    const double angle = glm::angle(turn.w < 0.0 ? -turn : turn);
    double ahead =
        angle < 1e-9 || angle > margin_rad_ ? 0.0 : std::min(kFramesAhead, kMostAhead * margin_rad_ / angle);
    pictures_.clear();
    for (const Eye& view : views) { pictures_.push_back(coverOf(view, margin_rad_)); }
    if (views.front().size_px == views.back().size_px) {
        const glm::uvec2 size_px = glm::max(pictures_.front().size_px, pictures_.back().size_px);
        for (Eye& picture : pictures_) { picture.size_px = size_px; }
    }
    for (;; ahead = ahead > 0.1 ? 0.7 * ahead : 0.0) {
        const glm::dquat on = timesAngle(turn, ahead);
        for (std::size_t e = 0; e < views.size(); ++e) {
            pictures_[e].world_from_camera.orientation = on * axesOf(views[e]);
        }
        if (ahead == 0.0 || coverAll(views)) { return; }
    }
}

std::span<const Eye> StayingAxes::follow(
    std::span<const Eye> views, const std::array<std::span<const std::uint8_t>, 2>& hidden_in_views) {
    bool stays = views_.size() == views.size();
    for (std::size_t e = 0; stays && e < views.size(); ++e) { stays = sameLens(views_[e], views[e]); }
    if (!stays) { views_.clear(); }
    for (std::size_t e = 0; stays && e < views.size(); ++e) {
        pictures_[e].world_from_camera.position = views[e].world_from_camera.position;
    }
    if (!stays || !coverAll(views) || isFarFrom(views.front())) { moveTo(views); }
    views_.assign(views.begin(), views.end());
    for (std::size_t e = 0; e < views.size(); ++e) {
        hidden_[e] = hiddenFrom(views[e], pictures_[e], hidden_in_views[e]);
    }
    return pictures_;
}

}  // namespace binosplat
