// The hidden mesh, drawn pixel by pixel.
#include "xr/hidden_tiles.h"

#include "shaders/shared/constants.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace binosplat::xr {
namespace {

// Twice the signed area of the triangle a, b, p: its sign tells on which side of the edge p lies.
double side(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) { return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x); }

// Marks the pixels whose centres lie in the triangle, edges included, so that neighbours leave no seam.
void markTriangle(const std::array<glm::dvec2, 3>& corners, glm::uvec2 size_px, std::vector<std::uint8_t>& hidden) {
    const auto& [a, b, c] = corners;
    const glm::dvec2 low = glm::max(glm::min(glm::min(a, b), c), glm::dvec2(0.0)),
                     high = glm::min(glm::max(glm::max(a, b), c), glm::dvec2(size_px));
    if (!(low.x <= high.x && low.y <= high.y)) { return; }  // beside the picture, or not finite
    const double area = side(a, b, c);
    for (auto y = static_cast<std::uint32_t>(low.y); y < static_cast<std::uint32_t>(std::ceil(high.y)); ++y) {
        for (auto x = static_cast<std::uint32_t>(low.x); x < static_cast<std::uint32_t>(std::ceil(high.x)); ++x) {
            const glm::dvec2 centre(x + 0.5, y + 0.5);
            const bool inside = side(a, b, centre) * area >= 0.0 && side(b, c, centre) * area >= 0.0 && side(c, a, centre) * area >= 0.0;
            if (inside && area != 0.0) { hidden[std::size_t{y} * size_px.x + x] = 1; }
        }
    }
}

}  // namespace

std::uint32_t hiddenMarginPx(const Intrinsics& intrinsics) {
    constexpr double kMarginRadians = 0.0175;  // a degree: a quick turn of 100 degrees/s, ten milliseconds after its prediction
    return static_cast<std::uint32_t>(std::ceil(kMarginRadians * std::max(intrinsics.fx, intrinsics.fy)));
}

std::vector<std::uint8_t> findHiddenTiles(const HiddenMesh& mesh, const Intrinsics& intrinsics, glm::uvec2 size_px,
                                          std::uint32_t margin_px) {
    std::vector<std::uint8_t> hidden(std::size_t{size_px.x} * size_px.y, 0);
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        std::array<glm::dvec2, 3> corners;
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
        if (known) { markTriangle(corners, size_px, hidden); }
    }
    const glm::uvec2 tiles = (size_px + gpu::kTileSize - 1u) / gpu::kTileSize;
    std::vector<std::uint8_t> hidden_tiles(std::size_t{tiles.x} * tiles.y, 1);
    // A visible pixel keeps every tile within the margin.
    const auto firstTile = [&](std::uint32_t at) { return (at - std::min(at, margin_px)) / gpu::kTileSize; };
    const auto lastTile = [&](std::uint32_t at, std::uint32_t end) { return std::min((at + margin_px) / gpu::kTileSize, end - 1); };
    for (std::uint32_t y = 0; y < size_px.y; ++y) {
        for (std::uint32_t x = 0; x < size_px.x; ++x) {
            if (hidden[std::size_t{y} * size_px.x + x] != 0) { continue; }
            for (std::uint32_t row = firstTile(y); row <= lastTile(y, tiles.y); ++row) {
                for (std::uint32_t column = firstTile(x); column <= lastTile(x, tiles.x); ++column) {
                    hidden_tiles[std::size_t{row} * tiles.x + column] = 0;
                }
            }
        }
    }
    return hidden_tiles;
}

}  // namespace binosplat::xr
