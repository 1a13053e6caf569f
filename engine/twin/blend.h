// A pixel's sums while splats are blended, and the pixels of a tile.
#pragma once

#include "engine/srgb.h"
#include "engine/twin/splat.h"

#include <algorithm>
#include <array>

namespace binosplat::reference {

struct PixelState {
    glm::dvec3 colour{0.0};
    double transmittance = 1.0;
    double weight = 0.0;                                                   // A
    double depth = 0.0, inverse_depth = 0.0, inverse_depth_squared = 0.0;  // D, I, J
    double surface_depth = 0.0;
    bool open = true;
};

// Blends one hit; closes the pixel instead if the transmittance would fall below its limit.
inline bool blend(PixelState& pixel, const ProjectedSplat& splat, const Hit& hit, bool inverse_moments) {
    const double alpha = std::min(kMaxAlpha, splat.opacity * std::exp(-0.5 * hit.rho));
    const double transmittance = pixel.transmittance * (1.0 - alpha);
    if (transmittance < kMinTransmittance) {
        pixel.open = false;
        return false;
    }
    const double weight = alpha * pixel.transmittance;
    pixel.colour += weight * splat.colour;
    pixel.weight += weight;
    pixel.depth += weight * hit.depth;
    if (pixel.transmittance > 0.5 && transmittance <= 0.5) { pixel.surface_depth = hit.depth; }
    if (inverse_moments) {
        const double inverse_depth = 1.0 / hit.depth;
        pixel.inverse_depth += weight * inverse_depth;
        pixel.inverse_depth_squared += weight * inverse_depth * inverse_depth;
    }
    pixel.transmittance = transmittance;
    return true;
}

// The pixel's colour before the background, and its alpha.
inline glm::dvec4 shownOf(const PixelState& pixel, const Settings& settings) {
    const glm::dvec3 background = settings.is_light ? lightOf(settings.background) : settings.background,
                     blended = pixel.colour + pixel.transmittance * background;
    return {settings.is_light ? encodedOf(blended) : blended, pixel.weight};
}

inline Picture makePicture(glm::uvec2 size_px, const Settings& settings) {
    Picture picture;
    picture.size_px = size_px;
    const std::size_t pixel_count = std::size_t{size_px.x} * size_px.y;
    picture.rgba.resize(pixel_count);
    picture.depth.resize(pixel_count);
    if (settings.inverse_depth_moments) {
        picture.inverse_depth.resize(pixel_count);
        picture.inverse_depth_squared.resize(pixel_count);
    }
    return picture;
}

// The tile with this index, row-major.
struct Tile {
    Tile(std::size_t index, glm::uvec2 size_px) {
        const int columns = static_cast<int>(tileGrid(size_px).x);
        begin_px =
            kTileSize * glm::ivec2(static_cast<int>(index) % columns, static_cast<int>(index) / columns);
        end_px = glm::min(begin_px + kTileSize, glm::ivec2(size_px));
    }

    [[nodiscard]] std::size_t indexOf(int x, int y) const {
        return static_cast<std::size_t>((y - begin_px.y) * kTileSize + x - begin_px.x);
    }
    PixelState& at(int x, int y) { return pixels[indexOf(x, y)]; }

    void write(Picture& picture, const Settings& settings) {
        for (int y = begin_px.y; y < end_px.y; ++y) {
            for (int x = begin_px.x; x < end_px.x; ++x) {
                const PixelState& pixel = at(x, y);
                const std::size_t place =
                    static_cast<std::size_t>(y) * picture.size_px.x + static_cast<std::size_t>(x);
                picture.rgba[place] = shownOf(pixel, settings);
                picture.depth[place] =
                    settings.surface_depths ? pixel.weight * pixel.surface_depth : pixel.depth;
                if (settings.inverse_depth_moments) {
                    picture.inverse_depth[place] = pixel.inverse_depth;
                    picture.inverse_depth_squared[place] = pixel.inverse_depth_squared;
                }
            }
        }
    }

    glm::ivec2 begin_px, end_px;
    std::array<PixelState, kTileSize * kTileSize> pixels;
};

}  // namespace binosplat::reference
