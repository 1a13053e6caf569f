// Both eyes' pictures as they reach a wearer's eyes through a headset's lenses: no longer flat, with pixels
// of equal angle.
#pragma once

#include "engine/geometry.h"
#include "engine/picture/image.h"

#include <array>
#include <cstdint>
#include <vector>

namespace binosplat {

// What both eyes see on a shared grid of directions about the lenses' common middle, so that distant things
// are in the same place in both. On the grid, the distance from the middle is the angle from it (the
// azimuthal equidistant projection: Snyder 1987, Map Projections, section 25). Its pixels are as wide as
// those of the eyes' pictures at the lenses' centres, where a lens is sharpest: flat pictures have ever more
// pixels per degree towards their borders (2.6 times as many at 52 degrees), which the lens and the display
// do not show. A pixel of the grid is the mean of what is shown at 4x4 places in it. The middle is a corner
// of tiles of kTileSize.
class LensView {
public:
    // By Side. `lens_centres`: directions in the eyes' axes. Throws Error if the eyes look away from each
    // other's view.
    LensView(const std::array<Eye, 2>& eyes, const std::array<glm::dvec3, 2>& lens_centres);

    // The size of the grid, in whole tiles.
    [[nodiscard]] glm::uvec2 sizePx() const { return size_px_; }
    // The direction to a place on the grid, in the axes of an eye.
    [[nodiscard]] glm::dvec3 directionAt(const glm::dvec2& place_px, int side) const;
    // The solid angle of a pixel of the grid, which is smaller farther out, where a circle around the middle
    // has more pixels.
    [[nodiscard]] double solidAngleAt(const glm::dvec2& place_px) const;
    // For each of the grid's pixels, row by row: the tile of the eye's own picture at its centre; kNowhere if
    // the pixel is not wholly in the picture.
    [[nodiscard]] const std::vector<std::uint32_t>& tilesOf(int side) const {
        return views_[static_cast<std::size_t>(side)].tiles;
    }
    static constexpr std::uint32_t kNowhere = 0xffffffffu;

    // A picture of an eye of the size that it was made for, on the grid: R, G and B, 0 where there is no
    // picture.
    [[nodiscard]] Image show(const Image& picture, int side) const;

private:
    struct View {
        glm::dmat3 eye_from_grid{1.0};
        glm::uvec2 size_px{0, 0};
        std::vector<glm::vec2> corners_px;  // of the grid's pixels, in the eye's picture
        std::vector<std::uint32_t> tiles;
    };
    void coverPictures(const std::array<Eye, 2>& eyes);
    void lookUp(const Eye& eye, int side);

    double pixel_rad_ = 0.0;
    glm::uvec2 size_px_{0, 0};
    glm::dvec2 middle_px_{0.0};
    std::array<View, 2> views_;
};

}  // namespace binosplat
