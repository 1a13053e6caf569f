// Facts about the picture comparer, among them that it fails what must fail.
#include "engine/picture/metrics.h"
#include "engine/error.h"
#include "engine/picture/pair_metrics.h"
#include "tests/engine/picture/pictures.h"
#include "tests/suite.h"

SUITE(metrics) {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// What a test of a GPU picture asks: close nearly everywhere, with a budget of flips at thresholds.
bool passesBudget(const Image& a, const Image& b) {
    const Difference difference = compare(a, b);
    return difference.psnrDb() > 50.0 && difference.shareOff() < 0.001 && difference.not_finite == 0;
}

TEST_CASE("equal pictures have an infinite PSNR and no difference, and so have empty ones") {
    for (const Image& image : {makeWaves({17, 33}, 0.0), Image{}}) {
        const Difference difference = compare(image, image);
        CHECK(difference.values == image.pixelCount() * 3);
        CHECK(difference.psnrDb() == kInfinity);
        CHECK(difference.shareOff() == 0.0);
        CHECK(difference.largest == 0.0);
        CHECK(difference.not_finite == 0);
    }
}

TEST_CASE("a constant difference of 0.1 is 20 dB, and values beyond 0 to 1 are compared as they are") {
    // PSNR = -10 log10(0.1^2).
    const Difference difference = compare(makeGrey({4, 4}, 4, 0.5f), makeGrey({4, 4}, 4, 0.6f));
    CHECK(difference.psnrDb() == doctest::Approx(20.0).epsilon(1e-6));
    CHECK(difference.largest == doctest::Approx(0.1).epsilon(1e-6));
    CHECK(difference.shareOff() == 1.0);
    const Difference beyond = compare(makeGrey({2, 2}, 3, 2.0f), makeGrey({2, 2}, 3, 3.0f));
    CHECK(beyond.psnrDb() == doctest::Approx(0.0));
    CHECK(beyond.largest == 1.0);
}

TEST_CASE("a value is off only beyond the threshold, and in the channels asked for") {
    Image a = makeGrey({10, 1}, 1, 0.0f), b = a;
    b.values[3] = 1.9f / 255.0f;
    b.values[4] = 2.1f / 255.0f;
    CHECK(compare(a, b, 1).off == 1);
    CHECK(compare(a, b, 1).shareOff() == doctest::Approx(0.1));
    CHECK(compare(a, b, 1, 0.0).off == 2);
    a = makeGrey({3, 3}, 4, 0.5f);
    b = makeFlat({3, 3}, glm::vec3(0.5f), 4);
    CHECK(compare(a, makeGrey({3, 3}, 3, 0.5f), 3).largest == 0.0);
    CHECK(compare(a, b, 3).largest == 0.0);
    CHECK(compare(a, b, 4).largest == 0.5);
}

TEST_CASE("one value that is not finite fails, even if both pictures have it") {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Image a = makeGrey({100, 100}, 3, 0.5f);
        const Image good = a;
        a.values[1234] = bad;
        for (const Image& b : {good, a}) {
            const Difference difference = compare(a, b);
            CHECK(difference.not_finite == 1);
            CHECK(difference.off == 1);
            CHECK(difference.largest == kInfinity);
            CHECK(difference.psnrDb() == -kInfinity);
            CHECK_FALSE(passesBudget(a, b));
        }
    }
}

TEST_CASE("float noise and a rare flip pass the budget of a GPU picture, a shift and swapped eyes do not") {
    const Image a = makeWaves({64, 64}, 1.5), other_eye = makeWaves({64, 64}, -1.5);
    Image noisy = a;
    for (std::size_t i = 0; i < noisy.values.size(); ++i) { noisy.values[i] += i % 2 == 0 ? 1e-5f : -1e-5f; }
    noisy.values[400] += 0.01f;
    CHECK(passesBudget(a, noisy));
    CHECK_FALSE(passesBudget(a, makeWaves({64, 64}, 2.5)));
    CHECK_FALSE(passesBudget(a, makeWaves({64, 64}, 1.6)));
    CHECK_FALSE(passesBudget(a, other_eye));
    CHECK_FALSE(passesBudget(other_eye, a));
}

TEST_CASE("pictures of other sizes or too few channels are refused") {
    CHECK_THROWS_AS(compare(makeGrey({4, 4}, 3, 0.0f), makeGrey({4, 5}, 3, 0.0f)), Error);
    CHECK_THROWS_AS(compare(makeGrey({4, 4}, 3, 0.0f), makeGrey({4, 4}, 1, 0.0f)), Error);
}

TEST_CASE("errors that end where tiles do are steps, and others are not") {
    Image error = makeGrey({64, 48}, 3, 0.0f);
    CHECK(tileSteps(error) == 0.0);
    for (std::uint32_t y = 16; y < 32; ++y) {
        for (std::uint32_t x = 32; x < 48; ++x) { setPixel(error, x, y, {0.3f, 0.0f, 0.0f}); }
    }
    // Four borders of 16 pixels, in one channel of three, of 3 x 48 + 2 x 64 pairs across borders.
    CHECK(tileSteps(error) == doctest::Approx(0.3 * 64 / (3 * (3 * 48 + 2 * 64))));
    const auto wave = [](std::uint32_t x, std::uint32_t) { return glm::vec3(0.1f * static_cast<float>(x % 2)); };
    CHECK(std::abs(tileSteps(makePicture({64, 48}, wave))) < 0.005);
}

TEST_CASE("a blur in one eye alone is a gap in sharpness, and one in both eyes is none") {
    const auto makeTexture = [](std::uint32_t shift_px, float contrast) {
        return makePicture({128, 32}, [&](std::uint32_t x, std::uint32_t y) {
            const std::uint32_t at = (x + shift_px) * 7919 + y * 104729;
            return glm::vec3(0.5f + contrast * (static_cast<float>(at % 97) / 97.0f - 0.5f));
        });
    };
    // The right eye sees it 5 pixels farther left.
    const std::array full{makeTexture(0, 0.8f), makeTexture(5, 0.8f)};
    CHECK(sharpnessGap(full, full) == 0.0);
    CHECK(sharpnessGap({makeTexture(0, 0.4f), makeTexture(5, 0.4f)}, full) == doctest::Approx(0.0).epsilon(1e-4));
    CHECK(sharpnessGap({makeTexture(0, 0.8f), makeTexture(5, 0.6f)}, full) == doctest::Approx(0.25).epsilon(1e-3));
}

}  // SUITE(metrics)
