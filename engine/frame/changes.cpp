// From boxes in the world to rectangles in a picture.
#include "engine/frame/changes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace binosplat {
namespace {

// How far the low-pass extends splats, in pixels of the eye's own picture, plus a small margin.
constexpr double kBorderPx = 3.0;

std::optional<gpu::ChangedRect> rectOf(const SceneChange& change, const Eye& eye, double near) {
    const glm::dmat3 camera_from_world = glm::mat3_cast(glm::conjugate(eye.world_from_camera.orientation));
    std::array<glm::dvec3, 8> corners;
    for (std::size_t c = 0; c < corners.size(); ++c) {
        const glm::dvec3 at((c & 1) != 0 ? change.high.x : change.low.x,
                            (c & 2) != 0 ? change.high.y : change.low.y,
                            (c & 4) != 0 ? change.high.z : change.low.z);
        corners[c] = camera_from_world * (at - eye.world_from_camera.position);
    }
    const Intrinsics& k = eye.intrinsics;
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
    const auto hold = [&](const glm::dvec3& p) {
        const glm::dvec2 place(k.fx * p.x / p.z + k.cx, k.fy * p.y / p.z + k.cy);
        low = glm::min(low, place);
        high = glm::max(high, place);
    };
    // The part beyond the near plane: corners, and where edges cross the plane. Corners of an edge differ in
    // one bit.
    for (std::size_t c = 0; c < corners.size(); ++c) {
        if (corners[c].z >= near) { hold(corners[c]); }
        for (const std::size_t bit : {1u, 2u, 4u}) {
            const glm::dvec3 &from = corners[c], &to = corners[c | bit];
            if ((from.z < near) == (to.z < near)) { continue; }
            hold(from + (near - from.z) / (to.z - from.z) * (to - from));
        }
    }
    const double border = kBorderPx * eye.own_pixel_px;
    const glm::dvec2 size(eye.size_px);
    const glm::dvec2 begin = glm::max(glm::floor(low - border), 0.0),
                     end = glm::min(glm::ceil(high + border), size);
    if (!(begin.x < end.x && begin.y < end.y)) { return std::nullopt; }
    return gpu::ChangedRect{glm::uvec2(begin), glm::uvec2(end), gpu::kChangedError * change.amount};
}

}  // namespace

std::vector<gpu::ChangedRect> rectsOf(std::span<const SceneChange> changes, const Eye& eye, double near) {
    const std::size_t together = (changes.size() + kMostChanges - 1) / kMostChanges;
    std::vector<gpu::ChangedRect> rects;
    for (std::size_t first = 0; first < changes.size(); first += together) {
        SceneChange all = changes[first];
        for (const SceneChange& change : changes.subspan(first, std::min(together, changes.size() - first))) {
            all.low = glm::min(all.low, change.low);
            all.high = glm::max(all.high, change.high);
            all.amount = std::max(all.amount, change.amount);
        }
        if (const auto rect = rectOf(all, eye, near)) { rects.push_back(*rect); }
    }
    return rects;
}

double changedShare(std::span<const SceneChange> changes, const Eye& eye, double near) {
    if (changes.empty()) { return 0.0; }
    const glm::uvec2 tiles = tilesOf(eye.size_px);
    std::vector<bool> changed(std::size_t{tiles.x} * tiles.y, false);
    for (const gpu::ChangedRect& rect : rectsOf(changes, eye, near)) {
        if (rect.error < 0.5f * gpu::kChangedError) { continue; }
        const glm::uvec2 begin = rect.begin_px / gpu::kTileSize, end = tilesOf(rect.end_px);
        for (std::uint32_t y = begin.y; y < end.y; ++y) {
            const auto row = changed.begin() + static_cast<std::ptrdiff_t>(std::size_t{y} * tiles.x);
            std::fill(row + begin.x, row + end.x, true);
        }
    }
    return static_cast<double>(std::ranges::count(changed, true)) / static_cast<double>(changed.size());
}

}  // namespace binosplat
