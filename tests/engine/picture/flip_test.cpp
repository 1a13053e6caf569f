// Facts about FLIP.
#include "engine/picture/flip.h"
#include "engine/error.h"
#include "engine/picture/colour.h"
#include "tests/engine/picture/pictures.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

TEST_SUITE_BEGIN("flip");

namespace flip_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

double meanFlip(const Image& a, const Image& b) { return flip(a, b).mean().value(); }

// FLIP at one pixel straight from the paper, in double: whole two-dimensional filters, one pixel at a time.
class FlipByDefinition {
public:
    FlipByDefinition(const Image& image, double ppd) : image_(image), ppd_(ppd) {}

    // Hunt-adjusted Lab of pixel (px, py) behind the contrast sensitivity.
    [[nodiscard]] glm::dvec3 lab(int px, int py) const {
        const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(0.04 / 2.0) / std::numbers::pi * ppd_));
        glm::dvec3 sum(0.0), weights(0.0);
        for (int y = -radius; y <= radius; ++y) {
            for (int x = -radius; x <= radius; ++x) {
                const double d2 = (x * x + y * y) / (ppd_ * ppd_);
                const glm::dvec3 weight{term(1.0, 0.0047, d2), term(1.0, 0.0053, d2), term(34.1, 0.04, d2) + term(13.5, 0.025, d2)};
                sum += weight * glm::dvec3(ycxczFromXyz(xyzFromLinear(linearFromEncoded(at(px + x, py + y)))));
                weights += weight;
            }
        }
        const glm::vec3 linear = glm::clamp(linearFromXyz(xyzFromYcxcz(glm::vec3(sum / weights))), 0.0f, 1.0f);
        const glm::dvec3 lab(labFromXyz(xyzFromLinear(linear)));
        return {lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z};
    }

    // Strength of edges (order 1) or points (order 2) at pixel (px, py).
    [[nodiscard]] double feature(int px, int py, int order) const {
        const double sigma = 0.5 * 0.082 * ppd_;
        const int radius = static_cast<int>(std::ceil(3.0 * sigma));
        glm::dvec2 above(0.0), below(0.0), weights_above(0.0), weights_below(0.0);
        for (int y = -radius; y <= radius; ++y) {
            for (int x = -radius; x <= radius; ++x) {
                const double bell = std::exp(-(x * x + y * y) / (2.0 * sigma * sigma));
                const glm::dvec2 weight = bell * (order == 1 ? glm::dvec2(-x, -y) : glm::dvec2(x * x, y * y) / (sigma * sigma) - 1.0);
                const double grey =
                    (static_cast<double>(ycxczFromXyz(xyzFromLinear(linearFromEncoded(at(px + x, py + y)))).x) + 16.0) / 116.0;
                for (int i = 0; i < 2; ++i) {
                    (weight[i] > 0.0 ? above : below)[i] += weight[i] * grey;
                    (weight[i] > 0.0 ? weights_above : weights_below)[i] += std::abs(weight[i]);
                }
            }
        }
        return glm::length(above / weights_above + below / weights_below);
    }

private:
    static double term(double a, double b, double d2) {
        return a * std::sqrt(std::numbers::pi / b) * std::exp(-std::numbers::pi * std::numbers::pi * d2 / b);
    }
    [[nodiscard]] glm::vec3 at(int x, int y) const {
        const int cx = std::clamp(x, 0, static_cast<int>(image_.size_px.x) - 1),
                  cy = std::clamp(y, 0, static_cast<int>(image_.size_px.y) - 1);
        const float* values = image_.values.data() + static_cast<std::size_t>(cy * static_cast<int>(image_.size_px.x) + cx) * 3;
        return {values[0], values[1], values[2]};
    }

    const Image& image_;
    double ppd_;
};

double hyab(const glm::dvec3& a, const glm::dvec3& b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

// HyAB of hunt-adjusted green and blue, from the textbook Lab of sRGB's primaries: green (87.735, -86.183, 83.180) and blue
// (32.299, 79.191, -107.865).
const double kLargest = std::pow(hyab({87.735, 0.87735 * -86.183, 0.87735 * 83.180}, {32.299, 0.32299 * 79.191, 0.32299 * -107.865}), 0.7);

double colourScore(double distance) {
    const double difference = std::pow(distance, 0.7), knee = 0.4 * kLargest;
    return difference < knee ? 0.95 * difference / knee : 0.95 + 0.05 * (difference - knee) / (kLargest - knee);
}

}  // namespace

TEST_CASE("flipOfEqualPicturesIsZero") {
    const Image image = makeWaves({40, 70}, 0.0);
    for (const float score : flip(image, image).values) { CHECK(score == 0.0f); }
}

TEST_CASE("flatPicturesScoreTheirColourDifferenceAlone") {
    // Black and white differ by 100 in lightness.
    CHECK(meanFlip(makeFlat({9, 9}, glm::vec3(0.0f)), makeFlat({9, 9}, glm::vec3(1.0f))) ==
          doctest::Approx(colourScore(100.0)).epsilon(1e-4));
    // Encoded greys 0.5 and 0.55 have L* 53.389 and 58.165: below the knee.
    const double dark = 116.0 * std::cbrt(std::pow((0.5 + 0.055) / 1.055, 2.4)) - 16.0,
                 light = 116.0 * std::cbrt(std::pow((0.55 + 0.055) / 1.055, 2.4)) - 16.0;
    const PixelScores greys = flip(makeFlat({9, 9}, glm::vec3(0.5f)), makeFlat({9, 9}, glm::vec3(0.55f), 4));
    for (const float score : greys.values) { CHECK(score == doctest::Approx(colourScore(light - dark)).epsilon(1e-3)); }
    // The largest difference that is told apart is green against blue.
    CHECK(meanFlip(makeFlat({9, 9}, {0.0f, 1.0f, 0.0f}), makeFlat({9, 9}, {0.0f, 0.0f, 1.0f})) == doctest::Approx(1.0).epsilon(1e-5));
    CHECK(static_cast<double>(flipColourDifference(glm::vec3(0.0f), glm::vec3(1.0f))) == doctest::Approx(colourScore(100.0)).epsilon(1e-4));
}

TEST_CASE("aPictureOfOnePixelScoresItsColourDifference") {
    const double score = meanFlip(makeFlat({1, 1}, {0.2f, 0.7f, 0.4f}), makeFlat({1, 1}, {0.9f, 0.1f, 0.3f}));
    CHECK(score == doctest::Approx(static_cast<double>(
                                       flipColourDifference(linearFromEncoded({0.2f, 0.7f, 0.4f}), linearFromEncoded({0.9f, 0.1f, 0.3f}))))
                       .epsilon(1e-4));
}

TEST_CASE("everyPixelScoresAsThePaperSays") {
    const Image a = makeWaves({33, 70}, 0.0), b = makeWaves({33, 70}, 0.9);
    for (const double ppd : {20.0, kFlipPixelsPerDegree}) {
        const PixelScores scores = flip(a, b, ppd);
        const FlipByDefinition in_a(a, ppd), in_b(b, ppd);
        for (const auto& [x, y] : std::vector<std::pair<int, int>>{{0, 0}, {32, 69}, {16, 35}, {3, 64}, {20, 63}}) {
            const double edge = std::abs(in_a.feature(x, y, 1) - in_b.feature(x, y, 1)),
                         point = std::abs(in_a.feature(x, y, 2) - in_b.feature(x, y, 2));
            const double feature = std::sqrt(std::max(edge, point) / std::numbers::sqrt2);
            const double expected = std::pow(colourScore(hyab(in_a.lab(x, y), in_b.lab(x, y))), 1.0 - feature);
            CHECK(static_cast<double>(scores.values[static_cast<std::size_t>(y) * 33 + static_cast<std::size_t>(x)]) ==
                  doctest::Approx(expected).epsilon(2e-3));
        }
    }
}

TEST_CASE("flipIsSymmetricAndKnowsNoDirection") {
    const Image a = makeWaves({48, 40}, 0.0), b = makeWaves({48, 40}, 2.0);
    CHECK(flip(a, b).values == flip(b, a).values);
    CHECK(meanFlip(mirror(a), mirror(b)) == doctest::Approx(meanFlip(a, b)).epsilon(1e-4));
}

TEST_CASE("onePixelIsSeenAsFarAsTheFiltersReach") {
    const Image a = makeFlat({41, 41}, glm::vec3(0.5f));
    Image b = a;
    setPixel(b, 20, 20, glm::vec3(1.0f));
    const PixelScores scores = flip(a, b);
    const auto at = [&](std::size_t x, std::size_t y) { return scores.values[y * 41 + x]; };
    CHECK(at(20, 20) > 0.1f);
    CHECK(at(20, 20) == *std::ranges::max_element(scores.values));
    CHECK(at(20, 25) == doctest::Approx(at(15, 20)).epsilon(1e-3));
    // Three sigma of the widest filter are 9.05 pixels: it reaches 10.
    CHECK(at(20, 31) < 1e-3f);
    CHECK(at(0, 0) < 1e-3f);
}

TEST_CASE("aSharpEdgeCountsMoreThanTheSameDifferenceSpreadOut") {
    // Both differ from grey by the same colour over half of the picture; one of them has an edge there.
    const Image grey = makeFlat({64, 32}, glm::vec3(0.5f));
    Image sharp = grey;
    for (std::uint32_t y = 0; y < 32; ++y) {
        for (std::uint32_t x = 32; x < 64; ++x) { setPixel(sharp, x, y, glm::vec3(0.6f)); }
    }
    const PixelScores scores = flip(grey, sharp);
    const float beside_edge = scores.values[16 * 64 + 33], far_from_edge = scores.values[16 * 64 + 60];
    CHECK(beside_edge > 1.2f * far_from_edge);
}

TEST_CASE("finePatternsVanishFromAfar") {
    // A checkerboard of single pixels against its mean in linear light: seen at 10 pixels per degree, gone at 200.
    const float mean = 0.7354f;  // encodes 0.5
    Image board = makeFlat({40, 40}, glm::vec3(0.0f));
    for (std::uint32_t y = 0; y < 40; ++y) {
        for (std::uint32_t x = y % 2; x < 40; x += 2) { setPixel(board, x, y, glm::vec3(1.0f)); }
    }
    const Image flat = makeFlat({40, 40}, glm::vec3(mean));
    const auto middle = [&](double ppd) { return flip(flat, board, ppd).values[20 * 40 + 20]; };
    CHECK(middle(10.0) > 0.5f);
    CHECK(middle(200.0) < 0.05f);
}

TEST_CASE("aShiftByOnePixelAndSwappedEyesAreDetected") {
    const Image left = makeWaves({64, 64}, 1.5), right = makeWaves({64, 64}, -1.5);
    CHECK(meanFlip(left, makeWaves({64, 64}, 0.5)) > 0.1);
    CHECK(meanFlip(left, right) > 0.2);
    CHECK(meanFlip(left, makeWaves({64, 64}, 1.5 + 1e-4)) < 0.01);
}

TEST_CASE("flipDoesNotDependOnTheNumberOfThreads") {
    const Image a = makeWaves({50, 200}, 0.0), b = makeWaves({50, 200}, 0.3);
    CHECK(flip(a, b, kFlipPixelsPerDegree, 1).values == flip(a, b, kFlipPixelsPerDegree, 3).values);
}

TEST_CASE("aPixelThatIsNotFiniteScoresOne") {
    const Image a = makeFlat({20, 20}, glm::vec3(0.5f));
    Image b = a;
    setPixel(b, 3, 2, {0.5f, 0.5f, std::numeric_limits<float>::infinity()});
    for (const PixelScores& scores : {flip(a, b), flip(b, b)}) {
        CHECK(scores.values[2 * 20 + 3] == 1.0f);
        for (const float score : scores.values) { CHECK((score >= 0.0f && score <= 1.0f)); }
    }
}

TEST_CASE("everySizeAndDistanceGivesScoresFromZeroToOne") {
    for (const glm::uvec2 size_px : {glm::uvec2{1, 1}, {1, 40}, {17, 1}, {2, 3}, {16, 65}}) {
        for (const double ppd : {1.0, 5.0, 67.0, 300.0}) {
            const PixelScores scores = flip(makeWaves(size_px, 0.0), makeWaves(size_px, 3.0), ppd);
            for (const float score : scores.values) { CHECK((score >= 0.0f && score <= 1.0f)); }
        }
    }
    CHECK(flip(Image{}, Image{}).values.empty() == true);
}

TEST_CASE("flipRefusesWhatItCannotCompare") {
    CHECK_THROWS_AS(flip(makeFlat({4, 4}, glm::vec3(0.0f)), makeFlat({4, 5}, glm::vec3(0.0f))), Error);
    CHECK_THROWS_AS(flip(makeFlat({4, 4}, glm::vec3(0.0f)), makeFlat({4, 4}, glm::vec3(0.0f)), 0.0), Error);
    CHECK_THROWS_AS(flip(makeFlat({4, 4}, glm::vec3(0.0f)), makeFlat({4, 4}, glm::vec3(0.0f)), std::nan("")), Error);
}

TEST_CASE("theDefaultDistanceIsThePapers") {
    CHECK(kFlipPixelsPerDegree == doctest::Approx(67.0206).epsilon(1e-6));
    CHECK(pixelsPerDegree(3840.0) == doctest::Approx(kFlipPixelsPerDegree));
}

}  // namespace flip_test
