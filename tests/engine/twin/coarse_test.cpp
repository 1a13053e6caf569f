// Facts about how the twin fills a coarse tile, and what loss it expects; coarse_frames_test.cpp compares the
// device with it.
#include "engine/twin/coarse.h"
#include "tests/suite.h"

SUITE(coarse) {

constexpr double kApart = 15.0 / 7.0;  // distance of samples, in pixels

// The samples of a tile of a picture.
template <typename At>
std::vector<glm::dvec4> samplesOf(const At& at) {
    std::vector<glm::dvec4> samples;
    for (int i = 0; i < 64; ++i) { samples.push_back(at(glm::dvec2(i % 8, i / 8) * kApart)); }
    return samples;
}

TEST_CASE("a parabola is filled as one, up to the samples at the border") {
    const auto parabola = [](const glm::dvec2& place) {
        return glm::dvec4(0.3 + 0.02 * place.x - 0.001 * place.x * place.x + 0.003 * place.y,
                          0.1 + 0.002 * place.y * place.y, place);
    };
    const auto samples = samplesOf(parabola);
    for (int i = 0; i < 256; ++i) {
        const glm::ivec2 pixel(i % 16, i / 16);
        CHECK(glm::distance(reference::fillAt(samples, pixel), parabola(glm::dvec2(pixel))) < 1e-12);
    }
}

TEST_CASE("a ramp loses nothing, and what changes from sample to sample loses the more the more it changes") {
    CHECK(reference::expectLoss(samplesOf([](const glm::dvec2& place) {
              return glm::dvec4(0.5 + 0.01 * place.x - 0.02 * place.y);
          })) < 1e-20);
    const auto lossOf = [](double height) {
        return reference::expectLoss(samplesOf([&](const glm::dvec2& place) {
            return glm::dvec4(glm::dvec3(height * std::cos(glm::radians(180.0) * place.x / kApart)), 1.0);
        }));
    };
    // Second differences are four times the height, at 48 of 64 samples, which count 8/6; in three channels.
    CHECK(lossOf(0.1) == doctest::Approx(0.3 * 64 * 3 * 0.16));
    CHECK(lossOf(0.2) == doctest::Approx(4 * lossOf(0.1)));
    CHECK(lossOf(10.0) == doctest::Approx(0.3 * 4 * 48));  // no sample counts for more than 4
}

}  // SUITE(coarse)
