// Facts about the float64 twin's pictures that are derived by hand, and about what its passes leave out. What
// frame_test.cpp derives for the device's pictures, which are compared with the twin's, is not repeated. The
// eye is at the origin and looks along z with a focal length of 100 px; its axis passes through the centre of
// the middle pixel.
#include "engine/twin/reach.h"
#include "tests/engine/twin/reference_scenes.h"

SUITE(reference) {

using reference::Picture;
using reference::Settings;

constexpr glm::uvec2 kSize{101, 101};
constexpr float kRootHalf = 0.70710678f;
// t_u = (1, 0, 1)/sqrt(2), t_v = y: a wall that recedes to the right; and t_u = z, t_v = y: a wall seen
// edge-on.
const glm::quat kReceding = glm::angleAxis(-0.785398163f, glm::vec3(0.0f, 1.0f, 0.0f));
const glm::quat kEdgeOn(kRootHalf, 0.0f, -kRootHalf, 0.0f);
// t_u = x, t_v = z: a floor.
const glm::quat kFloor(kRootHalf, kRootHalf, 0.0f, 0.0f);

Picture render(const std::vector<Splat>& splats, const Settings& settings = {}, glm::uvec2 size_px = kSize) {
    return reference::render(makeScene(splats), makeEye(size_px), settings);
}

// With hits in each pixel's own order, or in that of a window.
Picture renderByPixel(const Scene& scene, std::size_t window) {
    const Eye eye = makeEye(kSize);
    const auto order =
        reference::sortDepth(reference::compact(scene, reference::cull(scene, {&eye, 1}, {}), eye));
    const auto splats = reference::project(scene, order, eye, {});
    auto pairs = reference::bin(splats, kSize, {});
    reference::sortTiles(pairs);
    return reference::rasterizeByPixel(scene, order, splats, pairs, reference::tileRanges(pairs, kSize), eye,
                                       {}, window);
}

glm::dvec4 rgbaAt(const Picture& picture, std::uint32_t x, std::uint32_t y) {
    return picture.rgba[std::size_t{y} * picture.size_px.x + x];
}
double depthAt(const Picture& picture, std::uint32_t x, std::uint32_t y) {
    return picture.depth[std::size_t{y} * picture.size_px.x + x];
}

doctest::Approx near(double value) { return doctest::Approx(value).epsilon(1e-6); }

TEST_CASE("no pixel at which a splat is met is left out by cull, box, runs or bin") {
    Scene scene = makeCloud(500, 6);
    for (std::size_t i = 0; i < 100; ++i) {  // large ones around the eye
        scene.positions[i] *= 0.3f;
        scene.scales[i] = glm::max(scene.scales[i], glm::vec2(0.05f)) * 3.0f;
    }
    std::vector<std::uint32_t> all(scene.size());
    std::iota(all.begin(), all.end(), 0u);
    for (const glm::uvec2 size_px :
         {glm::uvec2(1, 1), glm::uvec2(17, 33), glm::uvec2(16, 16), glm::uvec2(90, 70)}) {
        for (const Eye& eye : {makeEye(size_px), makeOddEye(size_px)}) {
            const auto splats = reference::project(scene, all, eye, {});
            const auto visible = reference::cull(scene, {&eye, 1}, {});
            std::vector<reference::TilePair> expected;
            std::size_t met = 0, left_out = 0, kept = 0;
            for (const std::uint32_t i : all) {
                const reference::RayPlane plane = reference::rayPlane(splats[i], size_px, Settings{}.near);
                const glm::ivec4 box = splats[i].box_px;
                std::set<std::uint32_t> tiles;
                for (int y = 0; y < static_cast<int>(size_px.y); ++y) {
                    const auto runs = reference::runsOfReach(plane, y, 0, static_cast<int>(size_px.x));
                    for (int x = 0; x < static_cast<int>(size_px.x); ++x) {
                        reference::Hit hit;
                        if (!reference::meet(plane, {x + 0.5, y + 0.5}, hit)) { continue; }
                        ++met;
                        tiles.insert(y / 16 * ((size_px.x + 15) / 16) + x / 16);
                        const bool in_box = x >= box.x && x < box.z && y >= box.y && y < box.w;
                        const bool in_run = std::ranges::any_of(
                            runs, [&](auto run) { return x >= run.begin && x < run.end; });
                        left_out += !(visible[i] != 0 && in_box && in_run);
                    }
                }
                for (const std::uint32_t tile : tiles) { expected.push_back({tile, i}); }
                kept += visible[i];
            }
            CHECK(met > 0);
            CHECK(left_out == 0);
            CHECK(reference::bin(splats, size_px, {}) == expected);
            CHECK(kept < scene.size());
        }
    }
}

TEST_CASE("the customary box of a disc that faces the eye is a square of 3 sigma") {
    // Sigma is 10.2 px, so the radius is ceil(30.6) = 31 about (50.5, 50.5): pixels 19.5 to 81.5, tiles 1 to
    // 5 in both directions.
    const std::uint32_t both[] = {0, 1};
    const Scene scene = makeScene({{.scale = {0.204f, 0.1f}}, {.position = {0, 0, -2}}});
    const auto splats = reference::project(scene, both, makeEye(kSize), {});
    CHECK(these(splats[0].square_box_tiles, splats[1].square_box_tiles) == these(25, 0));
}

TEST_CASE("a disc through the near plane keeps its front part and shows no mirror image") {
    // A floor at y = 1 below the eye: the ray with slope Y = (row - 50) / 100 meets it at z = 1 / Y, and the
    // middle column at v = z / 3. Its centre is nearer than the near plane, so there is no low-pass.
    const std::vector<Splat> floor{
        {.position = {0.0f, 1.0f, 0.0f}, .rotation = kFloor, .scale = glm::vec2(3.0f)}};
    const Picture picture = render(floor);
    for (const std::uint32_t row : {65u, 80u, 100u}) {
        const double z = 100.0 / (row - 50.0);
        const double alpha = 0.8f * std::exp(-0.5 * z * z / 9.0);
        CHECK(rgbaAt(picture, 50, row).w == near(alpha));
        CHECK(depthAt(picture, 50, row) == near(alpha * z));
    }
    // Behind the eye, the same plane would appear above the horizon.
    for (std::uint32_t row = 0; row <= 50; ++row) { CHECK(rgbaAt(picture, 50, row).w == 0.0); }

    // With the near plane at z = 2, only slopes up to 1/2 remain: rows up to 100. At 2.1, rows up to 97.
    Settings settings;
    settings.near = 2.1;
    const Picture cut = render(floor, settings);
    CHECK(rgbaAt(cut, 50, 97).w == rgbaAt(picture, 50, 97).w);
    CHECK(rgbaAt(cut, 50, 98).w == 0.0);
    CHECK(rgbaAt(render({{.position = {0.0f, 0.0f, 0.1f}}}), 50, 50).w == 0.0);
}

TEST_CASE("of a disc seen edge-on, smaller than a pixel or without a scale only the low-pass is left") {
    // rho2 = 2 r^2, so alpha = o exp(-r^2), up to r = sqrt(10.636 / 2) = 2.3 px; the depth is the centre's.
    for (const Splat& splat :
         {Splat{.rotation = kEdgeOn},
          Splat{.rotation = glm::angleAxis(1e-7f, glm::vec3(1.0f, 0.0f, 0.0f)) * kEdgeOn},
          Splat{.scale = glm::vec2(1e-6f)}, Splat{.scale = glm::vec2(0.0f)}}) {
        const Picture picture = render({splat});
        CHECK(std::ranges::all_of(picture.rgba,
                                  [](const glm::dvec4& p) { return std::isfinite(p.x + p.y + p.z + p.w); }));
        CHECK(std::ranges::all_of(picture.depth, [](double depth) { return std::isfinite(depth); }));
        CHECK(rgbaAt(picture, 50, 50).w == near(0.8));
        CHECK(rgbaAt(picture, 51, 50).w == near(0.8 * std::exp(-1.0)));
        CHECK(rgbaAt(picture, 52, 51).w == near(0.8 * std::exp(-5.0)));
        CHECK(rgbaAt(picture, 53, 50).w == 0.0);
        CHECK(depthAt(picture, 51, 50) == near(0.8 * std::exp(-1.0) * 2.0));
    }
    // (0.005, 0) at z = 2 lands a quarter pixel to the right.
    const Picture beside = render({{.position = {0.005f, 0.0f, 2.0f}, .scale = glm::vec2(1e-6f)}});
    CHECK(rgbaAt(beside, 50, 50).w == near(0.8 * std::exp(-0.0625)));
    CHECK(rgbaAt(beside, 51, 50).w == near(0.8 * std::exp(-0.5625)));
    CHECK(rgbaAt(beside, 50, 51).w == near(0.8 * std::exp(-1.0625)));
}

TEST_CASE("opacity below 1/255 shows nothing, and opacity 1 blends as 0.99; negative colours are black") {
    CHECK(rgbaAt(render({{.opacity = 0.00392f}}), 50, 50).w == 0.0);
    CHECK(rgbaAt(render({{.opacity = 0.00393f}}), 50, 50).w == near(0.00393));
    CHECK(rgbaAt(render({{.opacity = 1.0f}}), 50, 50).w == 0.99);
    CHECK(rgbaAt(render({{.colour = {-3.0f, 0.5f, 0.5f}}}), 50, 50).x == 0.0);
}

// Seen by an eye in front, two splats in the planes z = 2 + x and z = 2.1 - x, which meet at x = 0.05, z =
// 2.05: red ones recede to the right, green ones to the left. `height` is across that.
Scene makeCrossing(float height) {
    return makeScene({{.rotation = kReceding, .scale = {1.0f, height}, .colour = {1.0f, 0.0f, 0.0f}},
                      {.position = {0.0f, 0.0f, 2.1f},
                       .rotation = glm::conjugate(kReceding),
                       .scale = {1.0f, height},
                       .colour = {0.0f, 1.0f, 0.0f}}});
}

TEST_CASE("two discs that cross are blended in the order of each pixel's own hits") {
    // Sorted as whole discs, the red one comes first everywhere, but to the right of the crossing the green
    // one is nearer. On the ray x = X z they are at 2 / (1 - X) and 2.1 / (1 + X), each at x from its centre:
    // a distance of sqrt(2) x along the disc.
    const auto alphaAt = [](double x) { return 0.8f * std::exp(-x * x); };
    for (const std::size_t window : {std::size_t{1}, std::size_t{2}, SIZE_MAX}) {
        const Picture picture = renderByPixel(makeCrossing(1.0f), window);
        for (const std::uint32_t column : {10u, 51u, 54u, 90u}) {
            const double slope = (column - 50.0) / 100.0, red_z = 2.0 / (1.0 - slope),
                         green_z = 2.1f / (1.0 + slope);
            const double red_alpha = alphaAt(slope * red_z), green_alpha = alphaAt(slope * green_z);
            const bool red_first = window == 1 || red_z < green_z;
            CHECK(red_first == (window == 1 || column < 53));
            CHECK(rgbaAt(picture, column, 50).x == near(red_alpha * (red_first ? 1.0 : 1.0 - green_alpha)));
            CHECK(rgbaAt(picture, column, 50).y == near(green_alpha * (red_first ? 1.0 - red_alpha : 1.0)));
        }
    }
}

TEST_CASE("two 3D Gaussians go by where each is densest along a pixel's ray") {
    Scene needles = makeCrossing(0.02f);
    needles.thicknesses.assign(2, 0.02f);
    const Picture by_splat = renderByPixel(needles, 1), by_pixel = renderByPixel(needles, SIZE_MAX);
    for (const std::uint32_t column : {40u, 50u, 65u}) {
        CAPTURE(column);
        CHECK(rgbaAt(by_splat, column, 50).x > rgbaAt(by_splat, column, 50).y);
        CHECK((rgbaAt(by_pixel, column, 50).x > rgbaAt(by_pixel, column, 50).y) == (column < 53));
        CHECK(rgbaAt(by_splat, column, 50).w == near(rgbaAt(by_pixel, column, 50).w));
    }
}

TEST_CASE("blending stops before transmittance falls under 1e-4") {
    // T: 1, 0.01, then 2e-4. The third layer would leave 2e-6 and closes the pixel, so the fourth is not
    // blended, although it would fit.
    const Picture picture = render({{.position = {0, 0, 2}, .opacity = 1.0f},
                                    {.position = {0, 0, 3}, .opacity = 0.98f},
                                    {.position = {0, 0, 4}, .opacity = 1.0f},
                                    {.position = {0, 0, 5}, .opacity = 0.1f}});
    CHECK(rgbaAt(picture, 50, 50).w == near(1.0 - 0.01 * (1.0 - 0.98f)));
}

TEST_CASE("spherical harmonics have the signs scenes are trained with") {
    // In direction d = (0, 0, 1), degree 1 gives +0.48860 sh[2], degree 2 gives 2 * 0.31539 sh[6], and degree
    // 3 gives 2 * 0.37318 sh[12].
    const glm::vec3 ahead(0, 0, 2), right(2, 0, 2), down(0, 2, 2);
    const double root = std::sqrt(0.5);
    using Known = std::tuple<std::size_t, glm::vec3, double>;
    const Known known[] = {Known(0, ahead, 0.2820947918),
                           Known(2, ahead, 0.4886025119),
                           Known(6, ahead, 0.6307831305),
                           Known(12, ahead, 0.7463526652),
                           Known(3, right, -0.4886025119 * root),
                           Known(1, down, -0.4886025119 * root),
                           Known(7, right, -1.0925484306 * 0.5),
                           Known(5, down, -1.0925484306 * 0.5),
                           Known(8, right, 0.5462742153 * 0.5),
                           Known(13, right, -0.4570457995 * 1.5 * root),
                           Known(15, right, -0.5900435899 * 0.5 * root)};
    Scene scene = makeScene({{}});
    scene.sh_degree = 3;
    for (const auto& [coefficient, position, value] : known) {
        CAPTURE(coefficient);
        scene.positions[0] = position;
        scene.sh.assign(48, 0.0f);
        scene.sh[3 * coefficient] = 0.25f;
        const std::uint32_t order = 0;
        CHECK((reference::project(scene, {&order, 1}, makeEye({301, 301}), {})[0].colour.x - 0.5) / 0.25 ==
              near(value));
    }
}

}  // SUITE(reference)
