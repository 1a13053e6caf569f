// Facts about the picture comparer, among them that it fails what must fail.
#include "engine/picture/metrics.h"
#include "engine/error.h"
#include "engine/picture/pair_metrics.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

TEST_SUITE_BEGIN("metrics");

namespace metrics_test {

using namespace binosplat;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Image makeGrey(glm::uvec2 size_px, int channels, float value) {
    Image image{size_px, channels, {}};
    image.values.assign(image.pixelCount() * static_cast<std::size_t>(channels), value);
    return image;
}

// Stripes and a slope with the structure of a picture; `shift_px` moves it to the right.
Image makeScene(glm::uvec2 size_px, double shift_px) {
    Image image{size_px, 4, {}};
    for (std::uint32_t y = 0; y < size_px.y; ++y) {
        for (std::uint32_t x = 0; x < size_px.x; ++x) {
            const double at = x - shift_px;
            image.values.push_back(static_cast<float>(0.5 + 0.4 * std::sin(0.7 * at + 0.2 * y)));
            image.values.push_back(static_cast<float>(0.5 + 0.4 * std::sin(0.3 * at)));
            image.values.push_back(static_cast<float>(0.01 * at));
            image.values.push_back(1.0f);
        }
    }
    return image;
}

// What a test of a GPU picture asks: close nearly everywhere, with a budget of flips at thresholds.
bool passesBudget(const Difference& difference) {
    return difference.psnrDb() > 50.0 && difference.shareOff() < 0.001 && difference.not_finite == 0;
}

}  // namespace

TEST_CASE("equal pictures have an infinite PSNR and no difference") {
    const Image image = makeScene({17, 33}, 0.0);
    const Difference difference = compare(image, image);
    CHECK(difference.values == 17 * 33 * 3);
    CHECK(difference.psnrDb() == kInfinity);
    CHECK(difference.off == 0);
    CHECK(difference.largest == 0.0);
    CHECK(difference.not_finite == 0);
}

TEST_CASE("a constant difference of 0.1 is 20 dB") {
    // PSNR = -10 log10(0.1^2).
    const Difference difference = compare(makeGrey({4, 4}, 4, 0.5f), makeGrey({4, 4}, 4, 0.6f));
    CHECK(difference.psnrDb() == doctest::Approx(20.0).epsilon(1e-6));
    CHECK(difference.largest == doctest::Approx(0.1).epsilon(1e-6));
    CHECK(difference.shareOff() == 1.0);
}

TEST_CASE("values beyond 0 to 1 are compared as they are") {
    const Difference difference = compare(makeGrey({2, 2}, 3, 2.0f), makeGrey({2, 2}, 3, 3.0f));
    CHECK(difference.psnrDb() == doctest::Approx(0.0));
    CHECK(difference.largest == 1.0);
}

TEST_CASE("a value is off only beyond the threshold") {
    Image a = makeGrey({10, 1}, 1, 0.0f), b = a;
    b.values[3] = 1.9f / 255.0f;
    b.values[4] = 2.1f / 255.0f;
    const Difference difference = compare(a, b, 1);
    CHECK(difference.off == 1);
    CHECK(difference.shareOff() == doctest::Approx(0.1));
    CHECK(compare(a, b, 1, 0.0).off == 2);
}

TEST_CASE("only the channels asked for are compared") {
    Image a = makeGrey({3, 3}, 4, 0.5f), b = a;
    for (std::size_t i = 3; i < b.values.size(); i += 4) { b.values[i] = 0.0f; }
    CHECK(compare(a, b, 3).largest == 0.0);
    CHECK(compare(a, b, 4).largest == 0.5);
    CHECK(compare(a, makeGrey({3, 3}, 3, 0.5f), 3).largest == 0.0);
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
            CHECK_FALSE(passesBudget(difference));
        }
    }
}

TEST_CASE("float noise and a rare flip pass the budget") {
    Image a = makeScene({64, 64}, 0.0), b = a;
    for (std::size_t i = 0; i < b.values.size(); ++i) { b.values[i] += i % 2 == 0 ? 1e-5f : -1e-5f; }
    b.values[400] += 0.01f;
    CHECK(passesBudget(compare(a, b)));
}

TEST_CASE("a picture shifted by one pixel fails the budget") {
    CHECK_FALSE(passesBudget(compare(makeScene({64, 64}, 0.0), makeScene({64, 64}, 1.0))));
    CHECK_FALSE(passesBudget(compare(makeScene({64, 64}, 0.0), makeScene({64, 64}, 0.1))));
}

TEST_CASE("swapped eyes fail the budget") {
    const Image left = makeScene({64, 64}, 1.5), right = makeScene({64, 64}, -1.5);
    CHECK(passesBudget(compare(left, left)));
    CHECK(passesBudget(compare(right, right)));
    CHECK_FALSE(passesBudget(compare(left, right)));
    CHECK_FALSE(passesBudget(compare(right, left)));
}

TEST_CASE("pictures of other sizes or too few channels are refused") {
    CHECK_THROWS_AS(compare(makeGrey({4, 4}, 3, 0.0f), makeGrey({4, 5}, 3, 0.0f)), Error);
    CHECK_THROWS_AS(compare(makeGrey({4, 4}, 3, 0.0f), makeGrey({4, 4}, 1, 0.0f)), Error);
}

TEST_CASE("an empty picture has no difference") {
    const Difference difference = compare(Image{}, Image{});
    CHECK(difference.values == 0);
    CHECK(difference.shareOff() == 0.0);
    CHECK(difference.psnrDb() == kInfinity);
}

TEST_CASE("errors that end where tiles do are steps, and others are not") {
    Image error = makeGrey({64, 48}, 3, 0.0f);
    CHECK(tileSteps(error) == 0.0);
    for (std::size_t y = 16; y < 32; ++y) {
        for (std::size_t x = 32; x < 48; ++x) { error.values[3 * (y * 64 + x)] = 0.3f; }
    }
    // Four borders of 16 pixels, in one channel of three, of 3 x 48 + 2 x 64 pairs across borders.
    CHECK(tileSteps(error) == doctest::Approx(0.3 * 64 / (3 * (3 * 48 + 2 * 64))));
    Image wave = makeGrey({64, 48}, 3, 0.0f);
    for (std::size_t i = 0; i < wave.values.size(); ++i) { wave.values[i] = 0.1f * static_cast<float>(i / 3 % 2); }
    CHECK(std::abs(tileSteps(wave)) < 0.005);
}

TEST_CASE("a blur in one eye alone is a gap in sharpness, and one in both eyes is none") {
    const auto makeTexture = [](std::size_t shift_px, float contrast) {
        Image image{{128, 32}, 3, {}};
        for (std::size_t y = 0; y < 32; ++y) {
            for (std::size_t x = 0; x < 128; ++x) {
                const std::size_t at = (x + shift_px) * 7919 + y * 104729;
                const float value = 0.5f + contrast * (static_cast<float>(at % 97) / 97.0f - 0.5f);
                for (int channel = 0; channel < 3; ++channel) { image.values.push_back(value); }
            }
        }
        return image;
    };
    // The right eye sees it 5 pixels farther left.
    const std::array full{makeTexture(0, 0.8f), makeTexture(5, 0.8f)};
    CHECK(sharpnessGap(full, full) == 0.0);
    CHECK(sharpnessGap({makeTexture(0, 0.4f), makeTexture(5, 0.4f)}, full) == doctest::Approx(0.0).epsilon(1e-4));
    CHECK(sharpnessGap({makeTexture(0, 0.8f), makeTexture(5, 0.6f)}, full) == doctest::Approx(0.25).epsilon(1e-3));
}

}  // namespace metrics_test
