// The float64 twins of the GPU passes: same names, same order, no shared arithmetic. Tests compare the passes
// with them. Each function is one pass of shaders/sort and shaders/splat; `render` runs them all. The
// equations: docs/how-it-works.md (2DGS, Huang et al. 2024, section 4; 3DGS, Kerbl et al. 2023, section 4).
#pragma once

#include "engine/geometry.h"
#include "engine/scene/scene.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace binosplat::reference {

struct Settings {
    // Positive; hits closer than this are skipped. Scene units along the camera's z.
    double near = 0.2;
    glm::dvec3 background{0.0};  // display-encoded
    // Colours are light, to be encoded after blending; if a scene is given, it decides.
    bool is_light = false;
    // Front to back by the distance of centres from this point (the midpoint between the eyes); empty: by
    // their camera z.
    std::optional<glm::dvec3> order_from = {};
    // By pixel, row by row: the depth along z of a mesh that cuts through the splats, and hides what is not
    // nearer; empty: no mesh.
    std::span<const double> mesh_depths = {};
    bool inverse_depth_moments = false;  // also I = sum w/z and J = sum w/z^2
    bool surface_depths = false;  // instead of D: A times the depth at which the transmittance passes a half
    int threads = 2;
    double* seconds = nullptr;  // render(): if given, an array of kPassCount, filled with each pass's time
};

enum Pass : int { kCull, kCompact, kSortDepth, kProject, kBin, kSortTiles, kRasterize, kPassCount };

// A splat as one eye sees it. With dx, dy the offset of a pixel from `reference_px`, and (A, B, D) =
// plane_from_pixel, the ray of the pixel meets the disc's plane at
//   1/z = inverse_depth + perspective.x dx + perspective.y dy
//   u/z = plane_offset.x + A dx + B dy
//   v/z = plane_offset.y + D dy
// where the (u, v) frame has been turned within the disc so that v/z does not depend on dx and A >= 0 (rho3 =
// u^2 + v^2 is unchanged by that). If the centre lies beyond the near plane (`low_pass`), reference_px is the
// projected centre and plane_offset is zero; otherwise reference_px is the middle of the image (size_px / 2)
// and there is no low-pass. For a 3D Gaussian (`gaussian`) these are u and v themselves in place of u/z and
// v/z, 1/z is where it is greatest along the ray, to first order and within kDepthReach of the centre's, and
// there is no low-pass but that in plane_from_pixel. A splat that cannot show anywhere (opacity at or below
// 1/255, an attribute or the colour not finite) is all zeros.
struct ProjectedSplat {
    glm::dvec2 reference_px;
    glm::dvec2 plane_offset;
    glm::dvec3 plane_from_pixel;
    glm::dvec2 perspective;
    double inverse_depth;
    bool low_pass;
    double low_pass_factor = 2.0;  // rho2 per squared distance from the centre
    bool gaussian;
    bool disc;            // false: the plane holds the eye, so no ray meets it; only the low-pass is left
    double depth;         // c.z, camera z of the centre
    double cut;           // rho at which alpha falls to 1/255: 2 ln(255 o)
    double opacity;       // dimmed, if the scene says so
    glm::dvec2 reach_px;  // of a 3D Gaussian: half its box on the screen
    glm::dvec3 colour;    // max(0, 0.5 + SH(d))
    // Rows of the splat's pixel matrix, U = fx (a.x, b.x, c.x) + cx (a.z, b.z, c.z), V and W accordingly; the
    // twin's own rasterizer uses these and not the reduced form above.
    glm::dvec3 row_u, row_v, row_w;
    // Pixels whose centres the splat can reach, [x0, x1) x [y0, y1), clipped to the image; empty if it
    // reaches none.
    glm::ivec4 box_px;  // x0, y0, x1, y1
    // The same in tiles for the usual square box of 3 sigma (ceil of three standard deviations of the larger
    // screen extent about the projected box's centre, as the public 2DGS rasterizer bins), for the report
    // only. 0 if c.z <= near.
    std::uint64_t square_box_tiles;
};

// Pictures hold one value per pixel, rows top to bottom.
struct Picture {
    glm::uvec2 size_px{0, 0};
    std::vector<glm::dvec4> rgba;                              // rgb = sum w c + T background, a = A = sum w
    std::vector<double> depth;                                 // D = sum w z
    std::vector<double> inverse_depth, inverse_depth_squared;  // I, J; empty unless asked for
};

// A splat in a 16x16 tile: `splat` is its rank in depth order, that is an index into the projected splats.
struct TilePair {
    std::uint32_t tile;  // row-major
    std::uint32_t splat;
    bool operator==(const TilePair&) const = default;
};

struct TileRange {
    std::uint32_t begin, end;
};

// A page: splats that are loaded and dropped together. The two corners, along the world's axes, enclose all
// of its visible splats, each as far as it reaches until its alpha falls to 1/255.
struct Page {
    glm::dvec3 low, high;
    double reach = 0.0;       // how far any of its splats extends from its centre, at most
    std::uint32_t count = 0;  // of its visible splats; 0: the other fields mean nothing
};
Page boundPage(const Scene& scene, std::size_t first, std::size_t count);

// cull_pages: which pages may hold splats that cull keeps for any of the eyes (1 or 0 per page): those whose
// box reaches the inner side of each plane of the view. The planes are moved outwards by `slack` times the
// box's distance.
std::vector<std::uint8_t> cullPages(std::span<const Page> pages, bool gaussians, std::span<const Eye> eyes,
                                    const Settings& settings, double slack = 0.0);

// cull: which splats may touch a pixel of any of the eyes (1 or 0 per splat). Never 0 for one that does.
std::vector<std::uint8_t> cull(const Scene& scene, std::span<const Eye> eyes, const Settings& settings);

// compact: indices of the visible splats, ascending, and their sort keys: the camera z of the centre in
// `order_eye`, or the square of its distance from Settings::order_from.
struct Visible {
    std::vector<std::uint32_t> splats;
    std::vector<double> depths;
};
Visible compact(const Scene& scene, std::span<const std::uint8_t> visible, const Eye& order_eye,
                const Settings& settings = {});

// sort_depth: the same splats, front to back, ties by index.
std::vector<std::uint32_t> sortDepth(const Visible& visible, const Settings& settings = {});

// project: one eye's view of each splat, in the given order.
std::vector<ProjectedSplat> project(const Scene& scene, std::span<const std::uint32_t> order, const Eye& eye,
                                    const Settings& settings);

// bin: exactly the (tile, splat) pairs in which at least one pixel centre has rho < cut with a hit not nearer
// than near, in depth order, with tiles ascending within a splat. If the disc's own hit is nearer than near,
// or behind the eye, only the low-pass remains (rho = rho2), if there is one.
std::vector<TilePair> bin(std::span<const ProjectedSplat> splats, glm::uvec2 size_px,
                          const Settings& settings);

// Also bin: removes the pairs in hidden tiles. `hidden` has a byte per tile, 1 for these; empty: none.
void hidePairs(std::vector<TilePair>& pairs, std::span<const std::uint8_t> hidden);

// sort_tiles: pairs by tile, in depth order within each; and where each tile's pairs are.
void sortTiles(std::vector<TilePair>& pairs, const Settings& settings = {});
std::vector<TileRange> tileRanges(std::span<const TilePair> pairs, glm::uvec2 size_px);

// rasterize: blending, front to back.
Picture rasterize(std::span<const ProjectedSplat> splats, std::span<const TilePair> pairs,
                  std::span<const TileRange> ranges, const Eye& eye, const Settings& settings);

// All passes for one eye.
Picture render(const Scene& scene, const Eye& eye, const Settings& settings);

// rasterize without an order of splats: each pixel blends its own hits front to back, by where its ray meets
// each splat: a disc at the hit or, if the low-pass wins, at the centre's depth; a 3D Gaussian where it is
// densest along the ray. D is summed as in rasterize(). `pairs` and `splats` follow `order`. With a `window`,
// hits come in that order, this many of them wait, and the nearest of these is blended next (Radl et al.
// 2024, StopThePop, in its simplest form). A window of 1 is rasterize().
Picture rasterizeByPixel(const Scene& scene, std::span<const std::uint32_t> order,
                         std::span<const ProjectedSplat> splats, std::span<const TilePair> pairs,
                         std::span<const TileRange> ranges, const Eye& eye, const Settings& settings,
                         std::size_t window = SIZE_MAX);

}  // namespace binosplat::reference
