// Facts about the twins of reuse over time: pictures for which the answer is worked out by hand.
#include "engine/reference/past.h"
#include "tests/reference_scenes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

TEST_SUITE_BEGIN("past_reference");

using namespace binosplat;
using namespace binosplat::reference;

namespace {

// Waves of colour, opaque, at the inverse depth that `depth(x, y)` gives.
template <typename Depth>
Past makePast(const Eye& eye, const Depth& depth) {
    const std::size_t pixels = std::size_t{eye.size_px.x} * eye.size_px.y;
    Picture picture{eye.size_px, std::vector<glm::dvec4>(pixels), {}, std::vector<double>(pixels), {}};
    for (std::size_t i = 0; i < pixels; ++i) {
        const double x = static_cast<double>(i % eye.size_px.x), y = static_cast<double>(i / eye.size_px.x);
        picture.rgba[i] = {0.5 + 0.4 * std::sin(0.3 * x), 0.5 + 0.4 * std::sin(0.2 * y), 0.5 + 0.4 * std::sin(0.2 * (x + y)), 1.0};
        picture.inverse_depth[i] = depth(x, y);
    }
    return pastOf(eye, picture);
}

Eye moved(Eye eye, const glm::dvec3& by) {
    eye.world_from_camera.position += by;
    return eye;
}

}  // namespace

TEST_CASE("the kernel of repeated sampling keeps sums, and makes no frequency stronger at any shift") {
    for (int step = 0; step <= 200; ++step) {
        const auto weights = lagrangeWeights(step / 200.0);
        double sum = 0.0;
        for (const double weight : weights) { sum += weight; }
        CHECK(sum == doctest::Approx(1.0).epsilon(1e-12));
        for (int wave = 0; wave <= 200; ++wave) {
            std::complex<double> gain(0.0);
            for (int tap = 0; tap < 6; ++tap) {
                gain += weights[static_cast<std::size_t>(tap)] * std::polar(1.0, std::numbers::pi * wave / 200.0 * (tap - 2));
            }
            CHECK(std::abs(gain) <= 1.0 + 1e-12);
        }
    }
    CHECK(lagrangeWeights(0.0)[2] == 1.0);
    CHECK(lagrangeWeights(1.0)[3] == 1.0);
}

TEST_CASE("what stands still in front of a head that stands still stays as it is, however often") {
    const Eye eye = test::makeEye({70, 45});
    Past past = makePast(eye, [](double x, double y) { return x > 30 && y > 20 ? 0.5 : 0.2; });
    const Past first = past;
    for (int frame = 0; frame < 5; ++frame) {
        const WarpedPast warped = warpPast(past, eye);
        CHECK(warped.unseen_pixels == 0);
        past = warped.picture;
    }
    CHECK(past.rgba == first.rgba);
    CHECK(past.inverse_depths == first.inverse_depths);
    CHECK(past.cell_errors == first.cell_errors);
    CHECK(std::ranges::all_of(past.ages, [](std::uint32_t age) { return age == 5; }));
}

TEST_CASE("a wall is found where it was, and a wave on it comes out as it would have been seen") {
    const Eye eye = test::makeEye({96, 64});
    // 0.005 to the right moves a wall at inverse depth 0.5 by 0.25 px to the left.
    const Eye later = moved(eye, {0.005, 0.0, 0.0});
    const Past past = makePast(eye, [](double, double) { return 0.5; });
    const auto found = findInPast(past, later);
    const WarpedPast warped = warpPast(past, later);
    for (std::size_t y = 8; y < 56; ++y) {
        for (std::size_t x = 8; x < 88; ++x) {
            const std::size_t i = y * 96 + x;
            REQUIRE(found[i]);
            CHECK(found[i]->place_px.x == doctest::Approx(static_cast<double>(x) + 0.75));
            CHECK(found[i]->inverse_depth == doctest::Approx(0.5));
            CHECK(warped.picture.rgba[i].x == doctest::Approx(0.5 + 0.4 * std::sin(0.3 * (static_cast<double>(x) + 0.25))).epsilon(1e-5));
        }
    }
    CHECK(warped.unseen_pixels == 0);
    // A whole pixel on, the last column has no past.
    const Eye on = moved(eye, {0.02, 0.0, 0.0});
    CHECK_FALSE(findInPast(past, on)[95]);
    CHECK(warpPast(past, on).unseen_pixels == 64);
}

TEST_CASE("what was hidden behind a nearer wall is not taken for seen, and the nearer of two is it") {
    const Eye eye = test::makeEye({160, 48});
    // The left half near, at inverse depth 1; a step of 0.1 to the right moves it 10 px to the left, and what is behind, at 0.1, one.
    const Past past = makePast(eye, [](double x, double) { return x < 80 ? 1.0 : 0.1; });
    const auto found = findInPast(past, moved(eye, {0.1, 0.0, 0.0}));
    for (std::size_t y = 0; y < 48; ++y) {
        const std::size_t row = 160 * y;
        for (std::size_t x = 0; x < 70; ++x) { CHECK(found[row + x].value_or(FoundInPast{}).inverse_depth == 1.0); }
        for (std::size_t x = 71; x < 78; ++x) { CHECK_FALSE(found[row + x]); }
        for (std::size_t x = 80; x < 158; ++x) { CHECK(found[row + x].value_or(FoundInPast{}).inverse_depth == 0.1); }
    }
    // And to the left: the near wall covers ten pixels that both would claim.
    const auto covered = findInPast(past, moved(eye, {-0.1, 0.0, 0.0}));
    for (std::size_t x = 81; x < 89; ++x) { CHECK(covered[x].value_or(FoundInPast{}).inverse_depth == 1.0); }
}

TEST_CASE("tiles are rendered by error, age and cost; a dear one has its turn, too") {
    const Eye eye = test::makeEye({64, 16});
    Past past = makePast(eye, [](double, double) { return 0.5; });
    past.cell_errors.assign(past.cell_errors.size(), 0.1);
    past.ages = {1, 2, 1, 1};
    CHECK(chooseTiles(past, std::vector<std::uint64_t>{10, 10, 10, 10}, 10) == std::vector<std::uint8_t>{0, 1, 0, 0});
    CHECK(chooseTiles(past, std::vector<std::uint64_t>{10, 40, 5, 10}, 15) == std::vector<std::uint8_t>{1, 0, 1, 0});
    past.ages = {1, 200, 1, 1};
    CHECK(chooseTiles(past, std::vector<std::uint64_t>{10, 1000, 10, 10}, 15) == std::vector<std::uint8_t>{0, 1, 0, 0});
    past.cell_errors.assign(past.cell_errors.size(), 0.0);
    CHECK(chooseTiles(past, std::vector<std::uint64_t>{10, 10, 10, 10}, 100) == std::vector<std::uint8_t>{0, 0, 0, 0});
}
