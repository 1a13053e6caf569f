// Tiles that a method with an error bound did not render, and how many of them are far under that bound.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>

namespace binosplat {

// A tile this far under its bound is a fault. Nearer to it is not: expected errors are not exact, and a bound
// is on the quarters of a tile.
inline constexpr double kMuchUnder_db = 2.0;

struct BoundedTiles {
    std::uint64_t kept = 0;   // whole tiles that were not rendered
    std::uint64_t under = 0;  // of these, with a PSNR more than kMuchUnder_db under the bound

    // 0 if all were rendered.
    [[nodiscard]] double underShare() const {
        return kept > 0 ? static_cast<double>(under) / static_cast<double>(kept) : 0.0;
    }
    BoundedTiles& operator+=(const BoundedTiles& other) {
        kept += other.kept;
        under += other.under;
        return *this;
    }
};

// For one eye's picture of this size, by rows. `tile_squares`: the mean squared error of each whole tile;
// `kinds`: what made each tile, including those that stick out of the picture, from
// StereoFrame::readTileKinds(); empty if the eye was rendered in full.
BoundedTiles findBoundedTiles(std::span<const float> tile_squares, std::span<const std::uint32_t> kinds,
                              glm::uvec2 size_px, double bound_db);

}  // namespace binosplat
