// Facts about SSIM and the filters below it.
#include "engine/picture/ssim.h"
#include "engine/error.h"
#include "tests/engine/picture/pictures.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

TEST_SUITE_BEGIN("ssim");

namespace ssim_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

constexpr double kC1 = 1e-4, kC2 = 9e-4;

// The luminance term: all that is left of SSIM between two flat windows.
double luminanceTerm(double a, double b) { return (2.0 * a * b + kC1) / (a * a + b * b + kC1); }

// SSIM of one channel at one pixel straight from the definition, in double: every pixel of the window that lies inside.
double ssimByDefinition(const Image& a, const Image& b, int px, int py, int channel) {
    double weights = 0.0, sum_a = 0.0, sum_b = 0.0, sum_aa = 0.0, sum_bb = 0.0, sum_ab = 0.0;
    for (int y = std::max(0, py - 5); y <= std::min(static_cast<int>(a.size_px.y) - 1, py + 5); ++y) {
        for (int x = std::max(0, px - 5); x <= std::min(static_cast<int>(a.size_px.x) - 1, px + 5); ++x) {
            const double weight = std::exp(-((x - px) * (x - px) + (y - py) * (y - py)) / 4.5);
            const std::size_t at =
                (static_cast<std::size_t>(y) * a.size_px.x + static_cast<std::size_t>(x)) * 3 + static_cast<std::size_t>(channel);
            const double va = static_cast<double>(a.values[at]), vb = static_cast<double>(b.values[at]);
            weights += weight;
            sum_a += weight * va;
            sum_b += weight * vb;
            sum_aa += weight * va * va;
            sum_bb += weight * vb * vb;
            sum_ab += weight * va * vb;
        }
    }
    const double ma = sum_a / weights, mb = sum_b / weights;
    const double variances = sum_aa / weights - ma * ma + sum_bb / weights - mb * mb, covariance = sum_ab / weights - ma * mb;
    return luminanceTerm(ma, mb) * (2.0 * covariance + kC2) / (variances + kC2);
}

double meanSsim(const Image& a, const Image& b) { return ssim(a, b).mean().value(); }

}  // namespace

TEST_CASE("equalPicturesScoreOne") {
    const Image image = makeWaves({70, 33}, 0.0);
    for (const Border border : {Border::kCutWindow, Border::kZero}) {
        for (const float score : ssim(image, image, border).values) { CHECK(score == doctest::Approx(1.0).epsilon(1e-6)); }
    }
}

TEST_CASE("flatPicturesScoreTheLuminanceTerm") {
    const double expected = luminanceTerm(0.4, 0.5);
    const Image a = makeFlat({20, 15}, glm::vec3(0.4f)), b = makeFlat({20, 15}, glm::vec3(0.5f), 4);
    for (const float score : ssim(a, b).values) { CHECK(score == doctest::Approx(expected).epsilon(5e-4)); }
    // With zeros beyond the border the windows there are not flat; in the middle of the picture they are.
    const PixelScores zero = ssim(a, b, Border::kZero);
    CHECK(zero.values[7 * 20 + 10] == doctest::Approx(expected).epsilon(5e-4));
    CHECK(std::abs(static_cast<double>(zero.values[0]) - expected) > 1e-3);
}

TEST_CASE("aPictureOfOnePixelScoresTheLuminanceTerm") {
    const PixelScores score = ssim(makeFlat({1, 1}, {0.2f, 0.6f, 1.0f}), makeFlat({1, 1}, {0.1f, 0.6f, 0.0f}));
    CHECK(score.mean().value() == doctest::Approx((luminanceTerm(0.2, 0.1) + 1.0 + luminanceTerm(1.0, 0.0)) / 3.0).epsilon(1e-4));
}

TEST_CASE("blackAgainstWhiteIsNearlyNothing") {
    CHECK(meanSsim(makeFlat({16, 16}, glm::vec3(0.0f)), makeFlat({16, 16}, glm::vec3(1.0f))) ==
          doctest::Approx(kC1 / (1.0 + kC1)).epsilon(1e-3));
}

TEST_CASE("everyPixelScoresAsTheDefinitionSays") {
    const Image a = makeWaves({37, 70}, 0.0), b = makeWaves({37, 70}, 0.8);
    const PixelScores scores = ssim(a, b);
    // Corners, borders, both sides of where one band of rows ends, and the middle.
    for (const auto& [x, y] : std::vector<std::pair<int, int>>{{0, 0}, {36, 69}, {5, 0}, {0, 30}, {20, 63}, {20, 64}, {20, 59}, {18, 35}}) {
        double expected = 0.0;
        for (int channel = 0; channel < 3; ++channel) { expected += ssimByDefinition(a, b, x, y, channel) / 3.0; }
        CHECK(static_cast<double>(scores.values[static_cast<std::size_t>(y) * 37 + static_cast<std::size_t>(x)]) ==
              doctest::Approx(expected).epsilon(1e-4));
    }
}

TEST_CASE("ssimIsSymmetricAndKnowsNoDirection") {
    const Image a = makeWaves({48, 40}, 0.0), b = makeWaves({48, 40}, 2.0);
    CHECK(meanSsim(a, b) == doctest::Approx(meanSsim(b, a)).epsilon(1e-9));
    CHECK(meanSsim(mirror(a), mirror(b)) == doctest::Approx(meanSsim(a, b)).epsilon(1e-5));
}

TEST_CASE("anOppositePatternScoresBelowZero") {
    Image a = makeWaves({32, 32}, 0.0), b = a;
    for (float& value : b.values) { value = 1.0f - value; }
    CHECK(meanSsim(a, b) < -0.5);
}

TEST_CASE("onePixelIsSeenByItsWindowAlone") {
    const Image a = makeFlat({31, 31}, glm::vec3(0.5f));
    Image b = a;
    setPixel(b, 15, 15, glm::vec3(0.9f));
    const PixelScores scores = ssim(a, b);
    for (int y = 0; y < 31; ++y) {
        for (int x = 0; x < 31; ++x) {
            const float score = scores.values[static_cast<std::size_t>(y) * 31 + static_cast<std::size_t>(x)];
            const bool in_window = std::abs(x - 15) <= 5 && std::abs(y - 15) <= 5;
            if (in_window) { CHECK(score < 1.0f); }
            if (!in_window) { CHECK(score == doctest::Approx(1.0).epsilon(1e-6)); }
        }
    }
}

TEST_CASE("aShiftByOnePixelAndSwappedEyesAreDetected") {
    const Image left = makeWaves({64, 64}, 1.5), right = makeWaves({64, 64}, -1.5);
    CHECK(meanSsim(left, makeWaves({64, 64}, 0.5)) < 0.9);
    CHECK(meanSsim(left, right) < 0.7);
    CHECK(meanSsim(left, makeWaves({64, 64}, 1.5 + 1e-4)) > 0.999);
}

TEST_CASE("ssimDoesNotDependOnTheNumberOfThreads") {
    const Image a = makeWaves({50, 200}, 0.0), b = makeWaves({50, 200}, 0.3);
    CHECK(ssim(a, b, Border::kCutWindow, 1).values == ssim(a, b, Border::kCutWindow, 3).values);
}

TEST_CASE("aValueThatIsNotFiniteScoresWorst") {
    const Image a = makeFlat({20, 20}, glm::vec3(0.5f));
    Image b = a;
    setPixel(b, 3, 2, {0.5f, std::numeric_limits<float>::quiet_NaN(), 0.5f});
    for (const PixelScores& scores : {ssim(a, b), ssim(b, b)}) {
        CHECK(scores.values[2 * 20 + 3] == -1.0f);
        for (const float score : scores.values) { CHECK(std::isfinite(score)); }
    }
}

TEST_CASE("valuesAreClampedToWhatADisplayShows") {
    CHECK(meanSsim(makeFlat({12, 12}, glm::vec3(1.0f)), makeFlat({12, 12}, glm::vec3(3.0f))) == doctest::Approx(1.0));
    CHECK(meanSsim(makeFlat({12, 12}, glm::vec3(0.0f)), makeFlat({12, 12}, glm::vec3(-3.0f))) == doctest::Approx(1.0));
}

TEST_CASE("picturesThatCannotBeComparedAreRefused") {
    CHECK_THROWS_AS(ssim(makeFlat({4, 4}, glm::vec3(0.0f)), makeFlat({4, 5}, glm::vec3(0.0f))), Error);
    CHECK_THROWS_AS(ssim(Image{{1, 1}, 1, {0.0f}}, makeFlat({1, 1}, glm::vec3(0.0f))), Error);
    CHECK_FALSE(ssim(Image{}, Image{}).mean().has_value());
}

TEST_CASE("meansByClassAreOverThatClassAlone") {
    const PixelScores scores{{2, 2}, {0.25f, 0.5f, 1.0f, 0.0f}};
    const std::vector<std::uint8_t> classes{1, 1, 0, 4};
    CHECK(scores.mean() == 0.4375);
    CHECK(scores.meanWhere(classes, 1) == 0.375);
    CHECK(scores.meanWhere(classes, 0) == 1.0);
    CHECK_FALSE(scores.meanWhere(classes, 2).has_value());
    CHECK_THROWS_AS(static_cast<void>(scores.meanWhere(std::vector<std::uint8_t>{1}, 1)), Error);
}

TEST_CASE("filtersHandleEverySizeAndBorder") {
    // A kernel that is not symmetric tells a correlation from a convolution, and left from right.
    const Weights kernel{0.5f, 0.0f, 0.25f, 0.0f, 0.25f}, one{1.0f};
    const Plane plane{{4, 1}, {1.0f, 2.0f, 4.0f, 8.0f}};
    CHECK(filterPlane(plane, kernel, one, Border::kZero, 1).values == std::vector<float>{1.25f, 2.5f, 1.5f, 3.0f});
    CHECK(filterPlane(plane, kernel, one, Border::kClamp, 1).values == std::vector<float>{1.75f, 3.0f, 3.5f, 5.0f});
    // Inside lie the weights .25 .25, .25 .25, .75 and .75.
    CHECK(filterPlane(plane, kernel, one, Border::kCutWindow, 1).values == std::vector<float>{2.5f, 5.0f, 2.0f, 4.0f});
    const Plane upright{{1, 4}, plane.values};
    for (const Border border : {Border::kZero, Border::kClamp, Border::kCutWindow}) {
        CHECK(filterPlane(upright, one, kernel, border, 1).values == filterPlane(plane, kernel, one, border, 1).values);
        for (const std::uint32_t side : {0u, 1u, 2u, 63u, 64u, 65u, 129u}) {
            const Plane flat{{3, side}, std::vector<float>(std::size_t{3} * side, 1.0f)};
            const Plane out = filterPlane(flat, gaussianKernel(1.5, 5), gaussianKernel(1.5, 5), border, 2);
            CHECK(out.values.size() == flat.values.size());
            for (const float value : out.values) { CHECK((border == Border::kZero ? value < 1.0f : std::abs(value - 1.0f) < 1e-5f)); }
        }
    }
    const Weights bell = gaussianKernel(1.5, 5);
    CHECK(bell.size() == 11);
    CHECK(std::accumulate(bell.begin(), bell.end(), 0.0f) == doctest::Approx(1.0));
    CHECK(bell[5] / bell[6] == doctest::Approx(std::exp(1.0 / 4.5)));
}

}  // namespace ssim_test
