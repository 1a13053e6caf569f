// Facts about the scores of each pixel, SSIM and FLIP, and about their filters and colour spaces.
#include "app/scores/colour.h"
#include "app/scores/flip.h"
#include "app/scores/ssim.h"
#include "tests/engine/picture/pictures.h"

SUITE(scores) {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                kInfinity = std::numeric_limits<float>::infinity();

struct Score {
    const char* name;
    PixelScores (*of)(const Image& a, const Image& b, int threads);
    float alike, worst;
    float rounding;  // of a pixel that is equal in both
};

template <Border border>
PixelScores ssimWith(const Image& a, const Image& b, int threads) {
    return ssim(a, b, border, threads);
}

const Score kScores[]{
    {"SSIM", ssimWith<Border::kCutWindow>, 1.0f, -1.0f, 2e-6f},
    {"SSIM with zeros around", ssimWith<Border::kZero>, 1.0f, -1.0f, 2e-6f},
    {"FLIP",
     [](const Image& a, const Image& b, int threads) { return flip(a, b, kFlipPixelsPerDegree, threads); },
     0.0f, 1.0f, 0.0f}};

constexpr double kC1 = 1e-4, kC2 = 9e-4;

// The luminance term: the only part of SSIM that differs between two flat windows.
double luminanceTerm(double a, double b) { return (2.0 * a * b + kC1) / (a * a + b * b + kC1); }

// The score that the definition gives at a pixel, in float64 and with full two-dimensional filters.
using Places = std::vector<glm::uvec2>;
void checkKnown(const PixelScores& scores, const Places& places, const std::vector<double>& known) {
    for (std::size_t i = 0; i < known.size(); ++i) {
        CHECK(scores.values[places[i].y * scores.size_px.x + places[i].x] ==
              doctest::Approx(known[i]).epsilon(1e-4));
    }
}

double hyab(const glm::dvec3& a, const glm::dvec3& b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// HyAB of hunt-adjusted green and blue, from the textbook Lab of sRGB's primaries: green (87.735, -86.183,
// 83.180) and blue (32.299, 79.191, -107.865).
const double kLargest = std::pow(
    hyab({87.735, 0.87735 * -86.183, 0.87735 * 83.180}, {32.299, 0.32299 * 79.191, 0.32299 * -107.865}), 0.7);

double colourScore(double distance) {
    const double difference = std::pow(distance, 0.7), knee = 0.4 * kLargest;
    return difference < knee ? 0.95 * difference / knee
                             : 0.95 + 0.05 * (difference - knee) / (kLargest - knee);
}

TEST_CASE("a score is the same from either side and on any number of threads, and best if all is alike") {
    const Image a = makeWaves({50, 200}, 0.0), b = makeWaves({50, 200}, 0.3);
    const Image black = makeFlat({12, 12}, glm::vec3(0.0f)), white = makeFlat({12, 12}, glm::vec3(1.0f));
    for (const Score& score : kScores) {
        CAPTURE(std::string(score.name));
        const std::vector<float> forward = score.of(a, b, 1).values;
        CHECK(these(forward, forward) == these(score.of(a, b, 3).values, score.of(b, a, 2).values));
        for (const auto& [one, other] :
             {std::pair(a, a), std::pair(white, makeFlat({12, 12}, glm::vec3(3.0f), 4)),
              std::pair(black, makeFlat({12, 12}, glm::vec3(-3.0f)))}) {
            for (const float value : score.of(one, other, 2).values) {
                CHECK(std::abs(value - score.alike) <= score.rounding);
            }
        }
    }
}

TEST_CASE("a pixel that is not finite scores worst, alone, even if both pictures have it") {
    const Image a = makeFlat({20, 20}, glm::vec3(0.5f));
    for (const float bad : {kNan, kInfinity}) {
        Image b = a;
        setPixel(b, 3, 2, {0.5f, bad, 0.5f});
        for (const Score& score : kScores) {
            const auto [least, most] = std::minmax(score.alike, score.worst);
            for (const PixelScores& scores : {score.of(a, b, 2), score.of(b, b, 2)}) {
                CHECK(scores.values[2 * 20 + 3] == score.worst);
                for (const float value : scores.values) {
                    CHECK(value == within(least, most + score.rounding));
                }
            }
        }
    }
}

TEST_CASE("pictures that cannot be compared are refused, and empty ones have no score") {
    const Image four = makeFlat({4, 4}, glm::vec3(0.0f));
    for (const Score& score : kScores) {
        CHECK_THROWS_AS(score.of(four, makeFlat({4, 5}, glm::vec3(0.0f)), 2), Error);
        CHECK_THROWS_AS(score.of(makeGrey({4, 4}, 1, 0.0f), four, 2), Error);
        CHECK_FALSE(score.of(Image{}, Image{}, 2).mean().has_value());
    }
    CHECK_THROWS_AS(flip(four, four, 0.0), Error);
    CHECK_THROWS_AS(flip(four, four, std::nan("")), Error);
    CHECK(kFlipPixelsPerDegree == doctest::Approx(67.0206).epsilon(1e-6));  // the paper's
    CHECK(pixelsPerDegree(3840.0) == doctest::Approx(kFlipPixelsPerDegree));
}

TEST_CASE("between flat pictures SSIM is the luminance term; an opposite pattern is below zero") {
    const auto flat = [](glm::uvec2 size_px, float grey, int channels = 3) {
        return makeFlat(size_px, glm::vec3(grey), channels);
    };
    const double expected = luminanceTerm(0.4, 0.5);
    const Image a = flat({20, 15}, 0.4f), b = flat({20, 15}, 0.5f, 4);
    for (const float score : ssim(a, b).values) { CHECK(score == doctest::Approx(expected).epsilon(5e-4)); }
    // With zeros beyond the border, the windows there are not flat; those in the middle of the picture are.
    const PixelScores zero = ssim(a, b, Border::kZero);
    CHECK(zero.values[7 * 20 + 10] == doctest::Approx(expected).epsilon(5e-4));
    CHECK(std::abs(zero.values[0] - expected) > 1e-3);
    const PixelScores pixel =
        ssim(makeFlat({1, 1}, {0.2f, 0.6f, 1.0f}), makeFlat({1, 1}, {0.1f, 0.6f, 0.0f}));
    CHECK(pixel.mean().value() ==
          doctest::Approx((luminanceTerm(0.2, 0.1) + 1.0 + luminanceTerm(1.0, 0.0)) / 3.0).epsilon(1e-4));
    CHECK(ssim(flat({16, 16}, 0.0f), flat({16, 16}, 1.0f)).mean().value() ==
          doctest::Approx(kC1 / (1.0 + kC1)).epsilon(1e-3));
    Image waves = makeWaves({32, 32}, 0.0), opposite = waves;
    for (float& value : opposite.values) { value = 1.0f - value; }
    CHECK(ssim(waves, opposite).mean().value() < -0.5);
}

TEST_CASE("every pixel's SSIM is the definition's, which sees 11 by 11 pixels") {
    const Image waves = makeWaves({37, 70}, 0.0), moved = makeWaves({37, 70}, 0.8);
    // Corners, borders, both sides of the boundary between two bands of rows, and the middle.
    const Places places{{0, 0}, {36, 69}, {5, 0}, {0, 30}, {20, 63}, {20, 64}, {20, 59}, {18, 35}};
    checkKnown(ssim(waves, moved), places,
               {0.936256328, 0.953579881, 0.943520026, 0.956750976, 0.912343744, 0.896779036, 0.939115304,
                0.942502200});
    checkKnown(ssim(waves, moved, Border::kZero), places,
               {0.964917965, 0.971055345, 0.965745809, 0.961475773});
    const Image a = makeFlat({31, 31}, glm::vec3(0.5f));
    Image b = a;
    setPixel(b, 15, 15, glm::vec3(0.9f));
    const PixelScores around = ssim(a, b);
    for (int pixel = 0; pixel < 31 * 31; ++pixel) {
        const bool in_window = std::abs(pixel % 31 - 15) <= 5 && std::abs(pixel / 31 - 15) <= 5;
        if (in_window) { CHECK(around.values[pixel] < 1.0f); }
        if (!in_window) { CHECK(around.values[pixel] == doctest::Approx(1.0).epsilon(1e-6)); }
    }
}

TEST_CASE("between flat pictures FLIP is their colours' difference, of any size") {
    const auto meanFlip = [](glm::uvec2 size_px, const glm::vec3& a, const glm::vec3& b) {
        return flip(makeFlat(size_px, a), makeFlat(size_px, b, 4)).mean().value();
    };
    // Black and white differ by 100 in lightness.
    CHECK(meanFlip({9, 9}, glm::vec3(0.0f), glm::vec3(1.0f)) ==
          doctest::Approx(colourScore(100.0)).epsilon(1e-4));
    // Encoded greys 0.5 and 0.55 have L* 53.389 and 58.165: below the knee.
    const double dark = 116.0 * std::cbrt(std::pow((0.5 + 0.055) / 1.055, 2.4)) - 16.0,
                 light = 116.0 * std::cbrt(std::pow((0.55 + 0.055) / 1.055, 2.4)) - 16.0;
    for (const float score :
         flip(makeFlat({9, 9}, glm::vec3(0.5f)), makeFlat({9, 9}, glm::vec3(0.55f))).values) {
        CHECK(score == doctest::Approx(colourScore(light - dark)).epsilon(1e-3));
    }
    // So dark that encoded values are 12.92 times as large as light, and Lab's cube root is a straight line.
    CHECK(meanFlip({9, 9}, glm::vec3(0.0f), glm::vec3(0.04f)) ==
          doctest::Approx(colourScore(24389.0 / 27.0 * 0.04 / 12.92)).epsilon(1e-4));
    // The largest difference that the score tells apart is green against blue.
    CHECK(meanFlip({9, 9}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}) == doctest::Approx(1.0).epsilon(1e-5));
    const glm::vec3 one{0.2f, 0.7f, 0.4f}, other{0.9f, 0.1f, 0.3f};
    CHECK(meanFlip({1, 1}, one, other) ==
          doctest::Approx(flipColourDifference(linearFromEncoded(one), linearFromEncoded(other)))
              .epsilon(1e-4));
}

TEST_CASE("every pixel's FLIP is the paper's, and lies from 0 to 1 at every size and distance") {
    const Image a = makeWaves({33, 70}, 0.0), b = makeWaves({33, 70}, 0.9);
    const Places places{{0, 0}, {32, 69}, {16, 35}, {3, 64}, {20, 63}};
    checkKnown(flip(a, b, 20.0), places, {0.5390366, 0.5111377, 0.5051623, 0.5123770, 0.3907326});
    checkKnown(flip(a, b), places, {0.4991233, 0.5331954, 0.4503161, 0.4495015, 0.3438545});
    for (const glm::uvec2 size_px : {glm::uvec2{1, 1}, {1, 40}, {17, 1}, {2, 3}, {16, 65}}) {
        for (const double ppd : {1.0, 5.0, 67.0, 300.0}) {
            const PixelScores scores = flip(makeWaves(size_px, 0.0), makeWaves(size_px, 3.0), ppd);
            for (const float score : scores.values) { CHECK(score == within(0.0, 1.0)); }
        }
    }
}

TEST_CASE("means by class are over that class alone") {
    const PixelScores scores{{2, 2}, {0.25f, 0.5f, 1.0f, 0.0f}};
    const std::vector<std::uint8_t> classes{1, 1, 0, 4};
    CHECK(these(scores.mean(), scores.meanWhere(classes, 1), scores.meanWhere(classes, 0),
                scores.meanWhere(classes, 2).has_value()) == these(0.4375, 0.375, 1.0, false));
    CHECK_THROWS_AS((void)scores.meanWhere(std::vector<std::uint8_t>{1}, 1), Error);
}

}  // SUITE(scores)
