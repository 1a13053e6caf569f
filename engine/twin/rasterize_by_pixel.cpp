// rasterize with each pixel's hits in their own order, which any order of whole splats only approximates.
#include "engine/parallel.h"
#include "engine/twin/blend.h"
#include "engine/twin/reach.h"

namespace binosplat::reference {
namespace {

// The depth of a 3D Gaussian along a pixel's ray: with M mapping camera space to standard deviations about c,
// the response along the ray z r is greatest where |M (z r - c)| is least.
struct GreatestResponse {
    glm::dmat3 deviations_from_camera;
    glm::dvec3 centre;

    // NaN for a Gaussian without a volume.
    [[nodiscard]] double depthAlong(const glm::dvec3& ray) const {
        const glm::dvec3 r = deviations_from_camera * ray;
        return glm::dot(r, centre) / glm::dot(r, r);
    }
};

struct OwnHit {
    double order_depth;
    std::uint32_t splat;
    Hit hit;
};

// Hits of one pixel that wait to be blended, the next one last; among equals the first to come is blended
// first.
struct Waiting {
    std::vector<OwnHit> hits;

    void insert(const OwnHit& hit) {
        const auto place =
            std::lower_bound(hits.begin(), hits.end(), hit,
                             [](const OwnHit& a, const OwnHit& b) { return a.order_depth > b.order_depth; });
        hits.insert(place, hit);
    }
};

class PixelOrder {
public:
    PixelOrder(std::span<const ProjectedSplat> splats, const Eye& eye, const Settings& settings,
               std::size_t window)
        : splats_(splats), eye_(eye), settings_(settings), window_(window) {}

    void blendTile(Tile& tile, const Scene& scene, std::span<const std::uint32_t> order,
                   std::span<const TilePair> pairs) const {
        std::array<Waiting, kTileSize * kTileSize> waiting;
        const EyeFrame frame(eye_);
        for (const TilePair& pair : pairs) {
            const ProjectedSplat& splat = splats_[pair.splat];
            const GreatestResponse response =
                splat.gaussian ? responseOf(*toCamera(scene, order[pair.splat], frame)) : GreatestResponse{};
            gather(tile, waiting, pair.splat, response);
        }
        for (std::size_t i = 0; i < waiting.size(); ++i) {
            while (!waiting[i].hits.empty()) { blendNearest(tile.pixels[i], waiting[i]); }
        }
    }

private:
    static GreatestResponse responseOf(const CameraSplat& splat) {
        const glm::dmat3 deviations_from_camera = glm::inverse(glm::dmat3(splat.a, splat.b, splat.w));
        return {deviations_from_camera, deviations_from_camera * splat.c};
    }

    void gather(Tile& tile, std::span<Waiting> waiting, std::uint32_t rank,
                const GreatestResponse& response) const {
        const ProjectedSplat& splat = splats_[rank];
        const RayPlane plane = rayPlane(splat, eye_.size_px, settings_.near);
        const Intrinsics& k = eye_.intrinsics;
        const glm::ivec4& box = splat.box_px;
        for (int y = std::max(box.y, tile.begin_px.y); y < std::min(box.w, tile.end_px.y); ++y) {
            for (const Span& run :
                 runsOfReach(plane, y, std::max(box.x, tile.begin_px.x), std::min(box.z, tile.end_px.x))) {
                for (int x = run.begin; x < run.end; ++x) {
                    PixelState& pixel = tile.at(x, y);
                    Hit hit;
                    if (!pixel.open || !meet(plane, {x + 0.5, y + 0.5}, hit)) { continue; }
                    if (splat.gaussian) {
                        const double depth =
                            response.depthAlong({(x + 0.5 - k.cx) / k.fx, (y + 0.5 - k.cy) / k.fy, 1.0});
                        if (std::isfinite(depth)) { hit.depth = depth; }
                    }
                    Waiting& own = waiting[tile.indexOf(x, y)];
                    own.insert({hit.depth, rank, hit});
                    if (own.hits.size() >= window_) { blendNearest(pixel, own); }
                }
            }
        }
    }

    void blendNearest(PixelState& pixel, Waiting& waiting) const {
        const OwnHit next = waiting.hits.back();
        waiting.hits.pop_back();
        if (pixel.open) { blend(pixel, splats_[next.splat], next.hit, settings_.inverse_depth_moments); }
    }

    std::span<const ProjectedSplat> splats_;
    const Eye& eye_;
    const Settings& settings_;
    std::size_t window_;
};

}  // namespace

Picture rasterizeByPixel(const Scene& scene, std::span<const std::uint32_t> order,
                         std::span<const ProjectedSplat> splats, std::span<const TilePair> pairs,
                         std::span<const TileRange> ranges, const Eye& eye, const Settings& settings,
                         std::size_t window) {
    Picture picture = makePicture(eye.size_px, settings);
    const PixelOrder pixels(splats, eye, settings, window);
    forBlocks(ranges.size(), 1, settings.threads, [&](std::size_t index, std::size_t) {
        Tile tile(index, eye.size_px);
        const TileRange range = ranges[index];
        pixels.blendTile(tile, scene, order, pairs.subspan(range.begin, range.end - range.begin));
        tile.write(picture, settings);
    });
    return picture;
}

}  // namespace binosplat::reference
