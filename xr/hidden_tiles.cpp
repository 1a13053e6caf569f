// The hidden mesh, row by row of pixels.
#include "xr/hidden_tiles.h"

#include "shaders/shared/constants.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace binosplat::xr {
namespace {

// Neighbours share an edge, and no pixel's centre may lie in its rounding.
constexpr double kSeamPx = 1e-6;

struct Triangle {
    std::array<glm::dvec2, 3> corners;
    double top, bottom;
};

// Of a row: from `begin` to before `end`.
struct Span {
    std::uint32_t begin, end;
};

// The pixels of row `y` whose centres lie in the triangle, edges included.
std::optional<Span> spanOf(const std::array<glm::dvec2, 3>& corners, double y, std::uint32_t width_px) {
    double low = INFINITY, high = -INFINITY;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec2 &a = corners[i], &b = corners[(i + 1) % 3];
        if (a.y == b.y || !(y >= std::min(a.y, b.y) && y <= std::max(a.y, b.y))) { continue; }
        const double x = a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y);
        low = std::min(low, x);
        high = std::max(high, x);
    }
    const double begin = std::max(std::ceil(low - kSeamPx - 0.5), 0.0);
    const double end = std::min(std::floor(high + kSeamPx - 0.5) + 1.0, static_cast<double>(width_px));
    if (!(begin < end)) { return std::nullopt; }
    return Span{static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
}

// The mesh's triangles that have an area, in the picture's pixels, from the top.
std::vector<Triangle> trianglesOf(const HiddenMesh& mesh, const Intrinsics& intrinsics) {
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        std::array<glm::dvec2, 3> corners{};
        bool known = true;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t index = mesh.indices[i + corner];
            known = known && index < mesh.vertices.size();
            if (!known) { break; }
            // OpenXR's plane z = -1 is ours at z = 1, with y flipped.
            const XrVector2f& v = mesh.vertices[index];
            corners[corner] = {intrinsics.fx * static_cast<double>(v.x) + intrinsics.cx,
                               -intrinsics.fy * static_cast<double>(v.y) + intrinsics.cy};
        }
        const auto& [a, b, c] = corners;
        const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        if (!known || !std::isfinite(area) || area == 0.0) { continue; }
        const auto [top, bottom] = std::minmax({a.y, b.y, c.y});
        triangles.push_back({corners, top, bottom});
    }
    std::ranges::sort(triangles, {}, &Triangle::top);
    return triangles;
}

}  // namespace

std::uint32_t hiddenMarginPx(const Intrinsics& intrinsics) {
    // A degree: a quick turn of 100 degrees/s, ten milliseconds after its prediction.
    constexpr double kMarginRadians = 0.0175;
    return static_cast<std::uint32_t>(std::ceil(kMarginRadians * std::max(intrinsics.fx, intrinsics.fy)));
}

std::vector<std::uint8_t> findHiddenTiles(const HiddenMesh& mesh, const Intrinsics& intrinsics,
                                          glm::uvec2 size_px, std::uint32_t margin_px) {
    const std::vector<Triangle> triangles = trianglesOf(mesh, intrinsics);
    const glm::uvec2 tiles = (size_px + gpu::kTileSize - 1u) / gpu::kTileSize;
    std::vector<std::uint8_t> hidden_tiles(std::size_t{tiles.x} * tiles.y, 1);
    // A visible pixel keeps every tile within the margin.
    const auto firstTile = [&](std::uint32_t at) { return (at - std::min(at, margin_px)) / gpu::kTileSize; };
    const auto endTile = [&](std::uint32_t last, std::uint32_t end) {
        return std::min((last + margin_px) / gpu::kTileSize + 1, end);
    };
    std::vector<Span> hidden;
    for (std::uint32_t y = 0; y < size_px.y; ++y) {
        hidden.clear();
        for (const Triangle& triangle : triangles) {
            if (triangle.top > y + 0.5) { break; }
            if (triangle.bottom < y + 0.5) { continue; }
            if (const auto span = spanOf(triangle.corners, y + 0.5, size_px.x)) { hidden.push_back(*span); }
        }
        std::ranges::sort(hidden, {}, &Span::begin);
        hidden.push_back({size_px.x, size_px.x});
        std::uint32_t from = 0;
        for (const Span& span : hidden) {
            for (std::uint32_t row = firstTile(y); from < span.begin && row < endTile(y, tiles.y); ++row) {
                const auto columns =
                    hidden_tiles.begin() + static_cast<std::ptrdiff_t>(std::size_t{row} * tiles.x);
                std::fill(columns + firstTile(from), columns + endTile(span.begin - 1, tiles.x),
                          std::uint8_t{0});
            }
            from = std::max(from, span.end);
        }
    }
    return hidden_tiles;
}

}  // namespace binosplat::xr
