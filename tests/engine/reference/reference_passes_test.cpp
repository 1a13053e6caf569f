// Facts about the twin's passes one by one, held against a plain renderer that tries every splat at every pixel.
#include "engine/reference/harmonics.h"
#include "tests/engine/reference/reference_scenes.h"

#include <doctest/doctest.h>

#include <numbers>
#include <set>

TEST_SUITE_BEGIN("reference_passes");

namespace reference_passes_test {

using namespace binosplat;
using namespace binosplat::test;
using namespace binosplat::reference;

namespace {

// The largest difference anywhere in two pictures, relative where values are above 1.
double largestDifference(const Picture& a, const Picture& b) {
    double largest = 0.0;
    const auto add = [&](double x, double y) { largest = std::max(largest, std::abs(x - y) / std::max(1.0, std::abs(y))); };
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        for (int channel = 0; channel < 4; ++channel) { add(a.rgba[i][channel], b.rgba[i][channel]); }
        add(a.depth[i], b.depth[i]);
        add(a.inverse_depth[i], b.inverse_depth[i]);
        add(a.inverse_depth_squared[i], b.inverse_depth_squared[i]);
    }
    return largest;
}

std::vector<ProjectedSplat> projectAll(const Scene& scene, const Eye& eye) {
    std::vector<std::uint32_t> all(scene.size());
    std::iota(all.begin(), all.end(), 0u);
    return project(scene, all, eye, {});
}

template <typename Work>
void forPixels(glm::uvec2 size_px, const Work& work) {
    for (std::uint32_t y = 0; y < size_px.y; ++y) {
        for (std::uint32_t x = 0; x < size_px.x; ++x) { work(static_cast<int>(x), static_cast<int>(y)); }
    }
}

}  // namespace

TEST_CASE("pictures of every size equal those of a renderer without bounds") {
    Settings settings;
    settings.background = {0.3, 0.2, 0.1};
    settings.inverse_depth_moments = true;
    const Scene scene = makeCloud(400, 1);
    for (const glm::uvec2 size_px : {glm::uvec2(1, 1), glm::uvec2(17, 33), glm::uvec2(16, 16), glm::uvec2(64, 48)}) {
        for (const Eye& eye : {makeEye(size_px), makeOddEye(size_px)}) {
            const Picture picture = reference::render(scene, eye, settings);
            REQUIRE(picture.rgba.size() == std::size_t{size_px.x} * size_px.y);
            CHECK(largestDifference(picture, renderPlainly(scene, eye, settings)) < 1e-9);
        }
    }
}

TEST_CASE("the eye inside a cloud of large discs equals the renderer without bounds") {
    Settings settings;
    settings.inverse_depth_moments = true;
    Scene scene = makeCloud(150, 7);
    for (std::size_t i = 0; i < scene.size(); ++i) {
        scene.positions[i] *= 0.3f;
        scene.scales[i] = glm::max(scene.scales[i], glm::vec2(0.05f)) * 3.0f;
        scene.opacities[i] *= 0.3f;
    }
    const Eye eye = makeOddEye({70, 50});
    CHECK(largestDifference(reference::render(scene, eye, settings), renderPlainly(scene, eye, settings)) < 1e-9);
}

TEST_CASE("one thread and two give the same bits") {
    const Scene scene = makeCloud(3000, 2);
    const Eye eye = makeOddEye({150, 130});
    Settings one, two;
    one.threads = 1;
    two.threads = 2;
    const Picture a = reference::render(scene, eye, one), b = reference::render(scene, eye, two);
    CHECK(a.rgba == b.rgba);
    CHECK(a.depth == b.depth);
}

TEST_CASE("culling never drops a splat that either eye sees, and drops most that none sees") {
    const Scene scene = makeCloud(600, 3);
    const std::array<Eye, 2> eyes = stereoPair(makeOddEye({40, 30}), 0.5);
    const auto visible = cull(scene, eyes, {});
    int seen_count = 0, kept_count = 0;
    for (std::size_t i = 0; i < scene.size(); ++i) {
        bool seen = false;
        for (const Eye& eye : eyes) {
            forPixels(eye.size_px, [&](int x, int y) { seen = seen || hitPlainly(scene, i, eye, {x + 0.5, y + 0.5}, 0.2); });
        }
        seen_count += seen ? 1 : 0;
        kept_count += visible[i] != 0 ? 1 : 0;
        if (seen) { CHECK(visible[i] == 1); }
    }
    CHECK(seen_count > 100);
    CHECK(kept_count < seen_count + seen_count / 4);
    CHECK(kept_count < 500);
}

TEST_CASE("compaction keeps the visible splats in order with the depths of their centres") {
    const Scene scene = makeScene({{.position = {0, 0, 5}}, {.position = {1, 0, -3}}, {.position = {0, 1, 4}}});
    const std::vector<std::uint8_t> flags{1, 0, 1};
    const Visible visible = compact(scene, flags, makeEye({8, 8}));
    CHECK(visible.splats == std::vector<std::uint32_t>{0, 2});
    CHECK(visible.depths == std::vector<double>{5.0, 4.0});
}

TEST_CASE("depth order is ascending with ties by index, through zero") {
    const Visible visible{{3, 5, 7, 8, 9, 11, 12}, {2.0, -1.0, 0.0, -0.0, 2.0, 1e-300, -1e300}};
    CHECK(sortDepth(visible) == std::vector<std::uint32_t>{12, 5, 7, 8, 11, 3, 9});
}

TEST_CASE("depth order of many equals a stable sort") {
    for (const std::uint32_t count : {0u, 1u, 2u, 255u, 256u, 5000u}) {
        std::mt19937 random(count);
        Visible visible;
        std::vector<std::uint32_t> expected(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            visible.splats.push_back(i);
            visible.depths.push_back(std::floor(static_cast<double>(random() % 2000)) / 7.0 - 20.0);
            expected[i] = i;
        }
        std::stable_sort(expected.begin(), expected.end(), [&](auto i, auto j) { return visible.depths[i] < visible.depths[j]; });
        CHECK(sortDepth(visible) == expected);
    }
}

TEST_CASE("the box holds every pixel that is hit, and is no larger than its four sides need") {
    const Scene scene = makeCloud(500, 4);
    const Eye eye = makeOddEye({60, 50});
    const auto splats = projectAll(scene, eye);
    int compared = 0;
    for (std::size_t i = 0; i < scene.size(); ++i) {
        glm::ivec2 low(1000), high(-1000);
        forPixels(eye.size_px, [&](int x, int y) {
            if (hitPlainly(scene, i, eye, {x + 0.5, y + 0.5}, 0.2)) {
                low = glm::min(low, glm::ivec2(x, y));
                high = glm::max(high, glm::ivec2(x + 1, y + 1));
            }
        });
        const glm::ivec4 box = splats[i].box_px;
        if (high.x < 0) { continue; }
        CHECK(box.x <= low.x);
        CHECK(box.y <= low.y);
        CHECK(box.z >= high.x);
        CHECK(box.w >= high.y);
        // Of a splat wholly inside the image, pixel centres may miss the extremes of a thin outline, but not of a stout one.
        const bool inside = box.x > 0 && box.y > 0 && box.z < 60 && box.w < 50;
        const double aspect = static_cast<double>(scene.scales[i].x / scene.scales[i].y);
        if (inside && aspect > 0.5 && aspect < 2.0 && splats[i].depth > 1.0) {
            CHECK(box.x >= low.x - 1);
            CHECK(box.z <= high.x + 1);
            ++compared;
        }
    }
    CHECK(compared > 5);
}

TEST_CASE("the reduced form agrees with the rows") {
    const Scene scene = makeCloud(500, 5);
    const Eye eye = makeOddEye({640, 480});
    std::mt19937 random(5);
    int with_reference = 0, without = 0;
    for (const ProjectedSplat& splat : projectAll(scene, eye)) {
        if (!splat.disc) { continue; }
        (splat.low_pass ? with_reference : without) += 1;
        CHECK(splat.plane_from_pixel.x >= 0.0);
        if (splat.low_pass) {
            CHECK(splat.plane_offset == glm::dvec2(0.0));
            CHECK(splat.inverse_depth == doctest::Approx(1.0 / splat.depth));
        } else {
            CHECK(splat.reference_px == glm::dvec2(320.0, 240.0));
        }
        for (int sample = 0; sample < 5; ++sample) {
            const glm::dvec2 pixel = glm::dvec2(random() % 640, random() % 480) + 0.5;
            // In long double, since raw rows lose digits that the test wants to see.
            using Vec = glm::tvec3<long double>;
            const Vec u(splat.row_u), v(splat.row_v), w(splat.row_w);
            const Vec q = static_cast<long double>(pixel.x) * glm::cross(v, w) + static_cast<long double>(pixel.y) * glm::cross(w, u) +
                          glm::cross(u, v);
            const glm::dvec3 expected(q / glm::dot(w, glm::cross(u, v)));
            const glm::dvec2 d = pixel - splat.reference_px;
            const double inverse_depth = splat.inverse_depth + glm::dot(splat.perspective, d);
            const double u_z = splat.plane_offset.x + splat.plane_from_pixel.x * d.x + splat.plane_from_pixel.y * d.y;
            const double v_z = splat.plane_offset.y + splat.plane_from_pixel.z * d.y;
            const double scale = std::abs(splat.inverse_depth) + std::abs(splat.perspective.x * d.x) + std::abs(splat.perspective.y * d.y);
            CHECK(std::abs(inverse_depth - expected.z) <= 1e-9 * scale);
            CHECK(std::hypot(u_z, v_z) == doctest::Approx(std::hypot(expected.x, expected.y)).epsilon(1e-9));
        }
    }
    CHECK(with_reference > 100);
    CHECK(without > 20);
}

TEST_CASE("binning gives exactly the tiles in which a pixel is hit") {
    const Scene scene = makeCloud(500, 6);
    for (const glm::uvec2 size_px : {glm::uvec2(1, 1), glm::uvec2(17, 33), glm::uvec2(90, 70)}) {
        const Eye eye = makeOddEye(size_px);
        const std::uint32_t columns = (size_px.x + 15) / 16;
        std::vector<TilePair> expected;
        for (std::uint32_t i = 0; i < scene.size(); ++i) {
            std::set<std::uint32_t> tiles;
            forPixels(size_px, [&](int x, int y) {
                if (hitPlainly(scene, i, eye, {x + 0.5, y + 0.5}, 0.2)) {
                    tiles.insert(static_cast<std::uint32_t>(y / 16) * columns + static_cast<std::uint32_t>(x / 16));
                }
            });
            for (const std::uint32_t tile : tiles) { expected.push_back({tile, i}); }
        }
        CHECK(bin(projectAll(scene, eye), size_px, {}) == expected);
    }
}

TEST_CASE("tile sort keeps the depth order within a tile, and ranges cover each tile's pairs") {
    std::vector<TilePair> pairs{{2, 0}, {5, 0}, {0, 1}, {2, 1}, {2, 2}, {5, 3}};
    sortTiles(pairs);
    CHECK(pairs == std::vector<TilePair>{{0, 1}, {2, 0}, {2, 1}, {2, 2}, {5, 0}, {5, 3}});
    const auto ranges = tileRanges(pairs, {40, 20});  // 3 x 2 tiles
    REQUIRE(ranges.size() == 6);
    const std::vector<std::uint32_t> counts{1, 0, 3, 0, 0, 2};
    std::uint32_t begin = 0;
    for (std::size_t tile = 0; tile < 6; ++tile) {
        CHECK(ranges[tile].begin == begin);
        CHECK(ranges[tile].end - ranges[tile].begin == counts[tile]);
        begin = ranges[tile].end;
    }
}

TEST_CASE("the customary box of a disc that faces the eye is a square of 3 sigma") {
    // Sigma 10.2 px: radius ceil(30.6) = 31 about (50.5, 50.5), i.e. pixels 19.5 to 81.5: tiles 1 to 5 both ways.
    const auto splats = projectAll(makeScene({{.scale = {0.204f, 0.1f}}, {.position = {0, 0, -2}}}), makeEye({101, 101}));
    CHECK(splats[0].square_box_tiles == 25);
    CHECK(splats[1].square_box_tiles == 0);
}

TEST_CASE("spherical harmonics are orthonormal over the sphere") {
    // Gauss-Legendre is not needed: the mean over n heights and m angles of a polynomial of degree 6 converges as 1/n^2.
    constexpr int kHeights = 400, kAngles = 16;
    double products[16][16] = {};
    for (int i = 0; i < kHeights; ++i) {
        const double z = (2.0 * i + 1.0) / kHeights - 1.0, r = std::sqrt(1.0 - z * z);
        for (int j = 0; j < kAngles; ++j) {
            const double angle = 2.0 * std::numbers::pi * (j + 0.25) / kAngles;
            double values[16];
            for (int k = 0; k < 16; ++k) {
                float sh[48] = {};
                sh[3 * k] = 1.0f;
                values[k] = evaluateHarmonics(sh, 3, {r * std::cos(angle), r * std::sin(angle), z}).x;
            }
            for (int k = 0; k < 16; ++k) {
                for (int l = 0; l < 16; ++l) { products[k][l] += values[k] * values[l] * 4.0 * std::numbers::pi / (kHeights * kAngles); }
            }
        }
    }
    for (int k = 0; k < 16; ++k) {
        for (int l = 0; l < 16; ++l) { CHECK(std::abs(products[k][l] - (k == l ? 1.0 : 0.0)) < 1e-3); }
    }
}

}  // namespace reference_passes_test
