// 7: blending, front to back, one tile at a time.
#include "engine/reference/parallel.h"
#include "engine/reference/reach.h"

namespace binosplat::reference {
namespace {

struct PixelState {
    glm::dvec3 colour{0.0};
    double transmittance = 1.0;
    double weight = 0.0;                                                   // A
    double depth = 0.0, inverse_depth = 0.0, inverse_depth_squared = 0.0;  // D, I, J
    bool open = true;
};

// Blends one hit; closes the pixel instead if the transmittance would fall under its limit.
bool blend(PixelState& pixel, const ProjectedSplat& splat, const Hit& hit, bool inverse_moments) {
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
    if (inverse_moments) {
        const double inverse_depth = 1.0 / hit.depth;
        pixel.inverse_depth += weight * inverse_depth;
        pixel.inverse_depth_squared += weight * inverse_depth * inverse_depth;
    }
    pixel.transmittance = transmittance;
    return true;
}

struct Tile {
    glm::ivec2 begin_px, end_px;
    std::array<PixelState, kTileSize * kTileSize> pixels;

    PixelState& at(int x, int y) { return pixels[static_cast<std::size_t>((y - begin_px.y) * kTileSize + x - begin_px.x)]; }
};

void blendTile(Tile& tile, std::span<const ProjectedSplat> splats, std::span<const TilePair> pairs, glm::uvec2 size_px,
               const Settings& settings) {
    int open_count = (tile.end_px.x - tile.begin_px.x) * (tile.end_px.y - tile.begin_px.y);
    for (const TilePair& pair : pairs) {
        if (open_count == 0) { return; }
        const ProjectedSplat& splat = splats[pair.splat];
        const RayPlane plane = rayPlane(splat, size_px, settings.near);
        const int x0 = std::max(splat.box_px.x, tile.begin_px.x), x1 = std::min(splat.box_px.z, tile.end_px.x);
        const int y0 = std::max(splat.box_px.y, tile.begin_px.y), y1 = std::min(splat.box_px.w, tile.end_px.y);
        for (int y = y0; y < y1; ++y) {
            for (const Span& run : runsOfReach(plane, y, x0, x1)) {
                for (int x = run.begin; x < run.end; ++x) {
                    PixelState& pixel = tile.at(x, y);
                    Hit hit;
                    if (pixel.open && meet(plane, {x + 0.5, y + 0.5}, hit) && !blend(pixel, splat, hit, settings.inverse_depth_moments)) {
                        --open_count;
                    }
                }
            }
        }
    }
}

void writeTile(Tile& tile, Picture& picture, const Settings& settings) {
    for (int y = tile.begin_px.y; y < tile.end_px.y; ++y) {
        for (int x = tile.begin_px.x; x < tile.end_px.x; ++x) {
            const PixelState& pixel = tile.at(x, y);
            const std::size_t place = static_cast<std::size_t>(y) * picture.size_px.x + static_cast<std::size_t>(x);
            picture.rgba[place] = glm::dvec4(pixel.colour + pixel.transmittance * settings.background, pixel.weight);
            picture.depth[place] = pixel.depth;
            if (settings.inverse_depth_moments) {
                picture.inverse_depth[place] = pixel.inverse_depth;
                picture.inverse_depth_squared[place] = pixel.inverse_depth_squared;
            }
        }
    }
}

}  // namespace

Picture rasterize(std::span<const ProjectedSplat> splats, std::span<const TilePair> pairs, std::span<const TileRange> ranges,
                  const Eye& eye, const Settings& settings) {
    Picture picture;
    picture.size_px = eye.size_px;
    const std::size_t pixel_count = std::size_t{eye.size_px.x} * eye.size_px.y;
    picture.rgba.resize(pixel_count);
    picture.depth.resize(pixel_count);
    if (settings.inverse_depth_moments) {
        picture.inverse_depth.resize(pixel_count);
        picture.inverse_depth_squared.resize(pixel_count);
    }
    const int columns = static_cast<int>(tileGrid(eye.size_px).x);
    forBlocks(ranges.size(), 1, settings.threads, [&](std::size_t index, std::size_t) {
        Tile tile;
        tile.begin_px = kTileSize * glm::ivec2(static_cast<int>(index) % columns, static_cast<int>(index) / columns);
        tile.end_px = glm::min(tile.begin_px + kTileSize, glm::ivec2(eye.size_px));
        const TileRange range = ranges[index];
        blendTile(tile, splats, pairs.subspan(range.begin, range.end - range.begin), eye.size_px, settings);
        writeTile(tile, picture, settings);
    });
    return picture;
}

}  // namespace binosplat::reference
