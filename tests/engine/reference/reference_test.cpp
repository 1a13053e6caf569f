// Facts about the float64 twin's pictures, in scenes whose values can be derived by hand. The eye sits at the origin and looks
// along z with a focal length of 100 px; its axis passes through the centre of the middle pixel.
#include "tests/engine/reference/reference_scenes.h"

#include <doctest/doctest.h>

#include <limits>

TEST_SUITE_BEGIN("reference");

namespace reference_test {

using namespace binosplat;
using namespace binosplat::test;
using reference::Picture;
using reference::Settings;

namespace {

constexpr glm::uvec2 kSize{101, 101};
constexpr float kRootHalf = 0.70710678f;
// t_u = (1, 0, 1)/sqrt(2), t_v = y: a wall that recedes to the right; and t_u = z, t_v = y: a wall seen edge-on.
const glm::quat kReceding = glm::angleAxis(-0.785398163f, glm::vec3(0.0f, 1.0f, 0.0f));
const glm::quat kEdgeOn(kRootHalf, 0.0f, -kRootHalf, 0.0f);
// t_u = x, t_v = z: a floor.
const glm::quat kFloor(kRootHalf, kRootHalf, 0.0f, 0.0f);

Picture render(const std::vector<Splat>& splats, const Settings& settings = {}, glm::uvec2 size_px = kSize) {
    return reference::render(makeScene(splats), makeEye(size_px), settings);
}

// With hits in each pixel's own order, or that of a window.
Picture renderByPixel(const Scene& scene, std::size_t window) {
    const Eye eye = makeEye(kSize);
    const auto order = reference::sortDepth(reference::compact(scene, reference::cull(scene, {&eye, 1}, {}), eye));
    const auto splats = reference::project(scene, order, eye, {});
    auto pairs = reference::bin(splats, kSize, {});
    reference::sortTiles(pairs);
    return reference::rasterizeByPixel(scene, order, splats, pairs, reference::tileRanges(pairs, kSize), eye, {}, window);
}

glm::dvec4 rgbaAt(const Picture& picture, std::uint32_t x, std::uint32_t y) { return picture.rgba[std::size_t{y} * picture.size_px.x + x]; }
double depthAt(const Picture& picture, std::uint32_t x, std::uint32_t y) { return picture.depth[std::size_t{y} * picture.size_px.x + x]; }

bool isFinite(const Picture& picture) {
    const auto finite = [](double value) { return std::isfinite(value); };
    return std::all_of(picture.rgba.begin(), picture.rgba.end(), [&](const glm::dvec4& p) { return finite(p.x + p.y + p.z + p.w); }) &&
           std::all_of(picture.depth.begin(), picture.depth.end(), finite);
}

bool isSame(const Picture& a, const Picture& b) { return a.rgba == b.rgba && a.depth == b.depth; }

doctest::Approx near(double value) { return doctest::Approx(value).epsilon(1e-6); }

}  // namespace

TEST_CASE("a disc that faces the eye is a Gaussian of its scale") {
    // Scale 0.2 at z = 2 and 100 px: sigma is 10 px. Alpha is o at the centre and o exp(-1/2) one sigma away.
    const Picture picture = render({{.colour = {0.9f, 0.6f, 0.3f}}});
    const double o = 0.8f, off = o * std::exp(-0.5);
    CHECK(rgbaAt(picture, 50, 50).w == near(o));
    CHECK(rgbaAt(picture, 60, 50).w == near(off));
    CHECK(rgbaAt(picture, 50, 40).w == near(off));
    CHECK(rgbaAt(picture, 60, 50).x == near(off * 0.9));
    CHECK(rgbaAt(picture, 60, 50).z == near(off * 0.3));
    CHECK(depthAt(picture, 60, 50) == near(off * 2.0));
}

TEST_CASE("a splat reaches exactly to rho = 2 ln(255 o)") {
    // 2 ln(255 * 0.8) = 10.636, whose root is 3.2613: 32.6 px at sigma = 10 px.
    const Picture picture = render({{}});
    CHECK(rgbaAt(picture, 82, 50).w == near(0.8 * std::exp(-0.5 * 3.2 * 3.2)));
    CHECK(rgbaAt(picture, 83, 50).w == 0.0);
    CHECK(rgbaAt(picture, 50, 18).w > 1.0 / 255.0);
    CHECK(rgbaAt(picture, 50, 17).w == 0.0);
    // (23, 23) is 32.53 px away, (23, 24) 33.2 px.
    CHECK(rgbaAt(picture, 73, 73).w > 1.0 / 255.0);
    CHECK(rgbaAt(picture, 73, 74).w == 0.0);
}

TEST_CASE("depth follows a slanted wall") {
    // The plane z = 4 + x meets the ray x = X z at z = 4 / (1 - X). X = (column - 50) / 100.
    const Picture picture = render({{.position = {0.0f, 0.0f, 4.0f}, .rotation = kReceding, .scale = glm::vec2(4.0f)}});
    for (const std::uint32_t column : {10u, 30u, 50u, 70u, 90u}) {
        const double slope = (column - 50.0) / 100.0;
        CHECK(depthAt(picture, column, 35) / rgbaAt(picture, column, 35).w == near(4.0 / (1.0 - slope)));
    }
}

TEST_CASE("two layers blend by the formula, and their moments with them") {
    Settings settings;
    settings.background = {0.1, 0.2, 0.3};
    settings.inverse_depth_moments = true;
    const Picture picture =
        render({{.position = {0.0f, 0.0f, 4.0f}, .scale = glm::vec2(1.0f), .opacity = 0.9f, .colour = {0.2f, 0.4f, 0.6f}},
                {.position = {0.0f, 0.0f, 2.0f}, .scale = glm::vec2(0.5f), .opacity = 0.5f, .colour = {1.0f, 0.8f, 0.0f}}},
               settings);
    // w1 = 0.5, w2 = 0.9 * 0.5 = 0.45, T = 0.05.
    const glm::dvec4 pixel = rgbaAt(picture, 50, 50);
    CHECK(pixel.x == near(0.5 * 1.0 + 0.45 * 0.2 + 0.05 * 0.1));
    CHECK(pixel.y == near(0.5 * 0.8 + 0.45 * 0.4 + 0.05 * 0.2));
    CHECK(pixel.z == near(0.45 * 0.6 + 0.05 * 0.3));
    CHECK(pixel.w == near(0.95));
    CHECK(depthAt(picture, 50, 50) == near(0.5 * 2.0 + 0.45 * 4.0));
    CHECK(picture.inverse_depth[50 * 101 + 50] == near(0.5 / 2.0 + 0.45 / 4.0));
    CHECK(picture.inverse_depth_squared[50 * 101 + 50] == near(0.5 / 4.0 + 0.45 / 16.0));
}

TEST_CASE("inverse depth moments are left out unless asked for") {
    const Picture picture = render({{}});
    CHECK(picture.inverse_depth.empty());
    CHECK(picture.inverse_depth_squared.empty());
}

TEST_CASE("beyond a step edge only the far wall is left") {
    // The near disc, sigma 10 px at z = 1 about column 20, ends 32.8 px (o = 0.85) to its right: after column 52.
    const Picture picture = render({{.position = {0.0f, 0.0f, 4.0f}, .scale = glm::vec2(40000.0f), .opacity = 0.9f},
                                    {.position = {-0.3f, 0.0f, 1.0f}, .scale = glm::vec2(0.1f), .opacity = 0.85f}});
    CHECK(depthAt(picture, 20, 50) == near(0.85 * 1.0 + 0.15 * 0.9 * 4.0));
    const double last = 0.85 * std::exp(-0.5 * 3.2 * 3.2);
    CHECK(depthAt(picture, 52, 50) == near(last * 1.0 + (1.0 - last) * 0.9 * 4.0));
    CHECK(depthAt(picture, 53, 50) == near(0.9 * 4.0));
    CHECK(depthAt(picture, 90, 50) == near(0.9 * 4.0));
}

TEST_CASE("a disc through the near plane keeps its front part and shows no mirror image") {
    // A floor at y = 1 under the eye: the ray with slope Y = (row - 50) / 100 meets it at z = 1 / Y, and the middle column at
    // v = z / 3. Its centre lies beside the near plane, so there is no low-pass.
    const std::vector<Splat> floor{{.position = {0.0f, 1.0f, 0.0f}, .rotation = kFloor, .scale = glm::vec2(3.0f)}};
    const Picture picture = render(floor);
    for (const std::uint32_t row : {65u, 80u, 100u}) {
        const double z = 100.0 / (row - 50.0);
        const double alpha = 0.8f * std::exp(-0.5 * z * z / 9.0);
        CHECK(rgbaAt(picture, 50, row).w == near(alpha));
        CHECK(depthAt(picture, 50, row) == near(alpha * z));
    }
    // Behind the eye the same plane would show above the horizon.
    for (std::uint32_t row = 0; row <= 50; ++row) { CHECK(rgbaAt(picture, 50, row).w == 0.0); }

    // With the near plane at z = 2 only slopes up to 1/2 are left: rows up to 100. At 2.1, rows up to 97.
    Settings settings;
    settings.near = 2.1;
    const Picture cut = render(floor, settings);
    CHECK(rgbaAt(cut, 50, 97).w == rgbaAt(picture, 50, 97).w);
    CHECK(rgbaAt(cut, 50, 98).w == 0.0);
}

TEST_CASE("a disc behind the eye is not seen") {
    CHECK(isSame(render({{.position = {0.0f, 0.0f, -2.0f}}}), render({})));
    CHECK(isSame(render({{.position = {0.0f, 0.0f, 0.1f}}}), render({})));
}

TEST_CASE("of a disc seen edge-on only the low-pass is left") {
    // rho2 = 2 r^2, so alpha = o exp(-r^2), to r = sqrt(10.636 / 2) = 2.3 px; depth is the centre's.
    for (const float turn : {0.0f, 1e-7f}) {
        const Picture picture = render({{.rotation = glm::angleAxis(turn, glm::vec3(1.0f, 0.0f, 0.0f)) * kEdgeOn}});
        CHECK(isFinite(picture));
        CHECK(rgbaAt(picture, 50, 50).w == near(0.8));
        CHECK(rgbaAt(picture, 51, 50).w == near(0.8 * std::exp(-1.0)));
        CHECK(rgbaAt(picture, 52, 51).w == near(0.8 * std::exp(-5.0)));
        CHECK(rgbaAt(picture, 53, 50).w == 0.0);
        CHECK(depthAt(picture, 51, 50) == near(0.8 * std::exp(-1.0) * 2.0));
    }
}

TEST_CASE("a disc smaller than a pixel is the low-pass about its projected centre") {
    // (0.005, 0) at z = 2 lands a quarter pixel to the right.
    const Picture picture = render({{.position = {0.005f, 0.0f, 2.0f}, .scale = glm::vec2(1e-6f)}});
    CHECK(rgbaAt(picture, 50, 50).w == near(0.8 * std::exp(-0.0625)));
    CHECK(rgbaAt(picture, 51, 50).w == near(0.8 * std::exp(-0.5625)));
    CHECK(rgbaAt(picture, 50, 51).w == near(0.8 * std::exp(-1.0625)));
}

TEST_CASE("a splat without a scale is a low-pass dot") {
    const Picture picture = render({{.scale = glm::vec2(0.0f)}});
    CHECK(isFinite(picture));
    CHECK(rgbaAt(picture, 51, 50).w == near(0.8 * std::exp(-1.0)));
}

TEST_CASE("opacity below 1/255 shows nothing, and opacity 1 blends as 0.99") {
    CHECK(isSame(render({{.opacity = 0.0f}}), render({})));
    CHECK(isSame(render({{.opacity = 0.00392f}}), render({})));
    CHECK(rgbaAt(render({{.opacity = 0.00393f}}), 50, 50).w == near(0.00393));
    CHECK(rgbaAt(render({{.opacity = 1.0f}}), 50, 50).w == 0.99);
}

TEST_CASE("equal depths blend in the order of the indices") {
    const Splat red{.opacity = 0.5f, .colour = {1.0f, 0.0f, 0.0f}}, green{.opacity = 0.5f, .colour = {0.0f, 1.0f, 0.0f}};
    CHECK(rgbaAt(render({red, green}), 50, 50).x == near(0.5));
    CHECK(rgbaAt(render({red, green}), 50, 50).y == near(0.25));
    CHECK(rgbaAt(render({green, red}), 50, 50).x == near(0.25));
}

TEST_CASE("two discs that cross are blended in the order of each pixel's own hits") {
    // Planes z = 2 + x and z = 2.1 - x meet at x = 0.05, z = 2.05: by whole discs the red one goes first everywhere, but to the right of
    // the crossing the green one is nearer. On the ray x = X z they are at 2 / (1 - X) and 2.1 / (1 + X), each at x from its centre: a
    // distance of sqrt(2) x along the disc.
    const Splat red{.position = {0.0f, 0.0f, 2.0f}, .rotation = kReceding, .scale = glm::vec2(1.0f), .colour = {1.0f, 0.0f, 0.0f}};
    const Splat green{
        .position = {0.0f, 0.0f, 2.1f}, .rotation = glm::conjugate(kReceding), .scale = glm::vec2(1.0f), .colour = {0.0f, 1.0f, 0.0f}};
    const auto alphaAt = [](double x) { return static_cast<double>(0.8f) * std::exp(-x * x); };
    for (const std::size_t window : {std::size_t{1}, std::size_t{2}, SIZE_MAX}) {
        const Picture picture = renderByPixel(makeScene({red, green}), window);
        for (const std::uint32_t column : {10u, 51u, 54u, 90u}) {
            const double slope = (column - 50.0) / 100.0, red_z = 2.0 / (1.0 - slope), green_z = static_cast<double>(2.1f) / (1.0 + slope);
            const double red_alpha = alphaAt(slope * red_z), green_alpha = alphaAt(slope * green_z);
            const bool red_first = window == 1 || red_z < green_z;
            CHECK(red_first == (window == 1 || column < 53));
            CHECK(rgbaAt(picture, column, 50).x == near(red_alpha * (red_first ? 1.0 : 1.0 - green_alpha)));
            CHECK(rgbaAt(picture, column, 50).y == near(green_alpha * (red_first ? 1.0 - red_alpha : 1.0)));
        }
    }
}

TEST_CASE("two 3D Gaussians go by where each is densest along a pixel's ray") {
    // Long along (1, 0, 1) and (1, 0, -1), through (0, 0, 2) and (0, 0, 2.1): needles in the planes of the discs above, that cross as these
    // do.
    const auto alongX = [](float z, const glm::quat& rotation, const glm::vec3& colour) {
        return Splat{.position = {0.0f, 0.0f, z}, .rotation = rotation, .scale = {1.0f, 0.02f}, .colour = colour};
    };
    Scene scene = makeScene({alongX(2.0f, kReceding, {1.0f, 0.0f, 0.0f}), alongX(2.1f, glm::conjugate(kReceding), {0.0f, 1.0f, 0.0f})});
    scene.thicknesses.assign(2, 0.02f);
    const Picture by_splat = renderByPixel(scene, 1), by_pixel = renderByPixel(scene, SIZE_MAX);
    for (const std::uint32_t column : {40u, 50u, 65u}) {
        CAPTURE(column);
        CHECK(rgbaAt(by_splat, column, 50).x > rgbaAt(by_splat, column, 50).y);
        CHECK((rgbaAt(by_pixel, column, 50).x > rgbaAt(by_pixel, column, 50).y) == (column < 53));
        CHECK(rgbaAt(by_splat, column, 50).w == near(rgbaAt(by_pixel, column, 50).w));
    }
}

TEST_CASE("a thousand layers blend until the transmittance is used up") {
    // T after n layers of 0.01 is 0.99^n; 0.99^916 = 1.005e-4 is the last not under 1e-4.
    std::vector<Splat> splats;
    for (int i = 0; i < 1000; ++i) {
        splats.push_back({.position = {0.0f, 0.0f, 2.0f + 0.001f * static_cast<float>(i)}, .scale = glm::vec2(1.0f), .opacity = 0.01f});
    }
    CHECK(rgbaAt(render(splats), 50, 50).w == near(1.0 - std::pow(1.0 - static_cast<double>(0.01f), 916)));
}

TEST_CASE("blending stops before transmittance falls under 1e-4") {
    // T: 1, 0.01, then 2e-4; the third layer would leave 2e-6 and closes the pixel, so the fourth, which would fit, is not blended.
    const auto layer = [](float z, float opacity) { return Splat{.position = {0.0f, 0.0f, z}, .opacity = opacity}; };
    const Picture picture = render({layer(2.0f, 1.0f), layer(3.0f, 0.98f), layer(4.0f, 1.0f), layer(5.0f, 0.1f)});
    CHECK(rgbaAt(picture, 50, 50).w == near(1.0 - 0.01 * (1.0 - static_cast<double>(0.98f))));
}

TEST_CASE("the background shows through by the transmittance that is left") {
    Settings settings;
    settings.background = {0.25, 0.5, 1.0};
    CHECK(rgbaAt(render({}, settings), 3, 4) == glm::dvec4(0.25, 0.5, 1.0, 0.0));
    const glm::dvec4 pixel = rgbaAt(render({{.colour = {0.0f, 0.0f, 0.0f}}}, settings), 50, 50);
    CHECK(pixel.z == near(0.2));
    CHECK(pixel.w == near(0.8));
}

TEST_CASE("negative colours are black") { CHECK(rgbaAt(render({{.colour = {-3.0f, 0.5f, 0.5f}}}), 50, 50).x == 0.0); }

TEST_CASE("a splat with an attribute that is not finite is not seen and harms nothing") {
    const Splat good{.position = {0.1f, 0.0f, 3.0f}};
    const Picture expected = render({good});
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()}) {
        std::vector<Splat> splats(12);
        for (int axis = 0; axis < 3; ++axis) { splats[static_cast<std::size_t>(axis)].position[axis] = bad; }
        for (int axis = 0; axis < 3; ++axis) { splats[3 + static_cast<std::size_t>(axis)].colour[axis] = bad; }
        splats[6].rotation.w = bad;
        splats[7].rotation.z = bad;
        splats[8].scale.x = bad;
        splats[9].scale.y = bad;
        splats[10].opacity = bad;
        splats[11].rotation = glm::quat(0.0f, 0.0f, 0.0f, 0.0f);
        splats.push_back(good);
        CHECK(isSame(render(splats), expected));
    }
}

TEST_CASE("a quaternion that is not unit turns like its unit one") {
    const Splat unit{.rotation = kReceding}, longer{.rotation = 8.0f * kReceding};
    CHECK(isSame(render({unit}), render({longer})));
}

TEST_CASE("spherical harmonics have the signs scenes are trained with") {
    // In direction d = (0, 0, 1): degree 1 gives +0.48860 sh[2], degree 2 2 * 0.31539 sh[6], degree 3 2 * 0.37318 sh[12].
    Scene scene = makeScene({{}});
    scene.sh_degree = 3;
    const auto redWith = [&](std::size_t coefficient, glm::vec3 position) {
        scene.positions[0] = position;
        scene.sh.assign(48, 0.0f);
        scene.sh[3 * coefficient] = 0.25f;
        const Eye eye = makeEye({301, 301});
        const std::uint32_t order = 0;
        return (reference::project(scene, {&order, 1}, eye, {})[0].colour.x - 0.5) / 0.25;
    };
    CHECK(redWith(0, {0, 0, 2}) == near(0.2820947918));
    CHECK(redWith(2, {0, 0, 2}) == near(0.4886025119));
    CHECK(redWith(6, {0, 0, 2}) == near(0.6307831305));
    CHECK(redWith(12, {0, 0, 2}) == near(0.7463526652));
    // d = (1, 0, 1)/sqrt(2) and (0, 1, 1)/sqrt(2).
    CHECK(redWith(3, {2, 0, 2}) == near(-0.4886025119 * std::sqrt(0.5)));
    CHECK(redWith(1, {0, 2, 2}) == near(-0.4886025119 * std::sqrt(0.5)));
    CHECK(redWith(7, {2, 0, 2}) == near(-1.0925484306 * 0.5));
    CHECK(redWith(5, {0, 2, 2}) == near(-1.0925484306 * 0.5));
    CHECK(redWith(8, {2, 0, 2}) == near(0.5462742153 * 0.5));
    CHECK(redWith(13, {2, 0, 2}) == near(-0.4570457995 * 3.0 * std::pow(0.5, 1.5)));
    CHECK(redWith(15, {2, 0, 2}) == near(-0.5900435899 * std::pow(0.5, 1.5)));
}

TEST_CASE("an empty scene and an empty picture are no trouble") {
    CHECK(render({}).rgba.size() == 101 * 101);
    CHECK(render({{}}, {}, {0, 0}).rgba.empty());
    CHECK(render({{}}, {}, {0, 7}).rgba.empty());
}

}  // namespace reference_test
