// Facts about the picture comparer, including that it fails pictures that must fail.
#include "app/scores/metrics.h"
#include "app/scores/resize.h"
#include "app/scores/visible_errors.h"
#include "tests/engine/picture/pictures.h"

SUITE(metrics) {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST_CASE("a constant difference of 0.1 is 20 dB, and values beyond 0 to 1 are compared as they are") {
    const Difference difference = compare(makeGrey({4, 4}, 4, 0.5f), makeGrey({4, 4}, 4, 0.6f));
    CHECK(these(difference.psnrDb(), difference.largest, difference.shareOff()) ==
          these(doctest::Approx(20.0).epsilon(1e-6), doctest::Approx(0.1).epsilon(1e-6), 1.0));
    const Difference beyond = compare(makeGrey({2, 2}, 3, 2.0f), makeGrey({2, 2}, 3, 3.0f));
    CHECK(these(beyond.psnrDb(), beyond.largest) == these(doctest::Approx(0.0), 1.0));
}

TEST_CASE("a value is off only beyond the threshold, and in the channels asked for") {
    Image a = makeGrey({10, 1}, 1, 0.0f), b = a;
    b.values[3] = 1.9f / 255.0f;
    b.values[4] = 2.1f / 255.0f;
    CHECK(these(compare(a, b, 1).off, compare(a, b, 1).shareOff(), compare(a, b, 1, 0.0).off) ==
          these(1, doctest::Approx(0.1), 2));
    a = makeGrey({3, 3}, 4, 0.5f);
    b = makeFlat({3, 3}, glm::vec3(0.5f), 4);
    CHECK(these(compare(a, makeGrey({3, 3}, 3, 0.5f), 3).largest, compare(a, b, 3).largest,
                compare(a, b, 4).largest) == these(0.0, 0.0, 0.5));
}

TEST_CASE("one value that is not finite fails, even if both pictures have it") {
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Image a = makeGrey({100, 100}, 3, 0.5f);
        const Image good = a;
        a.values[1234] = bad;
        for (const Image& b : {good, a}) {
            const Difference difference = compare(a, b);
            CHECK(these(difference.not_finite, difference.off, difference.largest, difference.psnrDb()) ==
                  these(1, 1, kInfinity, -kInfinity));
        }
    }
}

TEST_CASE("pictures of other sizes or too few channels are refused") {
    CHECK_THROWS_AS(compare(makeGrey({4, 4}, 3, 0.0f), makeGrey({4, 5}, 3, 0.0f)), Error);
    CHECK_THROWS_AS(compare(makeGrey({4, 4}, 3, 0.0f), makeGrey({4, 4}, 1, 0.0f)), Error);
}

TEST_CASE("each way to be wrong that a wearer notices has a figure of its own") {
    // A wall with a pattern and an edge every 40 pixels.
    const auto patternAt = [](std::uint32_t x) {
        return x / 40 % 2 == 1 ? 0.5f + 0.02f * std::sin(1.5707963f * static_cast<float>(x)) : 0.375f;
    };
    const auto draw = [&](auto&& change) {
        return makePicture({128, 64}, [&](std::uint32_t x, std::uint32_t y) {
            return glm::vec3(change(x, y, patternAt(x)));
        });
    };
    const Image full = draw([](std::uint32_t, std::uint32_t, float grey) { return grey; });
    constexpr double kAny = 1e9;
    const Range none = within(0.0, 0.0);
    const auto check = [&](const Image& left, const Image& right, const Range& bad, const Range& edge,
                           const Range& seam, const Range& rival) {
        const VisibleErrors found = findVisibleErrors({left, right}, {full, full});
        CHECK(these(found.badShare(), found.edge, found.seam, found.rival) == these(bad, edge, seam, rival));
        return found.tile_squares;
    };
    CHECK(check(full, full, none, none, none, none) == std::vector<float>(64, 0.0f));

    const Image shifted = draw([&](std::uint32_t x, std::uint32_t, float) {
        return x / 40 % 2 == 1 ? patternAt(x) : patternAt(x + 1);
    });
    check(shifted, shifted, none, between(0.3, kAny), between(-kAny, 1e-4), none);

    const auto isTile = [](std::uint32_t x, std::uint32_t y) { return x / 16 == 3 && y / 16 == 1; };
    const Image blurred =
        draw([&](std::uint32_t x, std::uint32_t y, float grey) { return isTile(x, y) ? 0.5f : grey; });
    // A tenth of a step of 255.
    check(blurred, full, none, none, between(-kAny, 4e-4), between(0.3, kAny));
    check(blurred, blurred, none, between(-kAny, kAny), between(-kAny, kAny), none);

    const Image stepped = draw([](std::uint32_t x, std::uint32_t y, float grey) {
        return grey + ((x / 16 + y / 16) % 2 == 0 ? 0.02f : 0.0f);  // 5 steps of 255
    });
    check(stepped, stepped, none, none, between(0.0196, 0.0204), between(-kAny, 0.01));

    const Image streaked = draw([](std::uint32_t x, std::uint32_t y, float grey) {
        return x < 16 ? (y % 8 < 4 ? 0.3f : 0.5f) : grey;
    });
    const auto streaks =
        check(streaked, streaked, between(0.1249, 0.1251), between(-kAny, 0.01), between(-kAny, kAny), none);
    CHECK(worstTiles(streaks, 1.0 / 8.0) > kBadTileSquare);
    CHECK(worstTiles(streaks, 1.0) == doctest::Approx(worstTiles(streaks, 1.0 / 8.0) / 8.0));
}

TEST_CASE("a picture is scaled up by a cubic that keeps constants, and ramps within its borders") {
    CHECK(scaleUp(makeWaves({17, 9}, 0.0), {17, 9}).values == makeWaves({17, 9}, 0.0).values);
    const Image ramp = makePicture({20, 10}, [](std::uint32_t x, std::uint32_t y) {
        return glm::vec3(glm::dvec3(0.02 * x, 0.03 * y, 0.5));
    });
    const Image scaled = scaleUp(ramp, {50, 25});
    CHECK(scaled.size_px == glm::uvec2(50, 25));
    for (const glm::uvec2 at : {glm::uvec2(10, 10), glm::uvec2(23, 12), glm::uvec2(40, 17)}) {
        const glm::vec3 expected(
            glm::dvec3(0.02 * ((at.x + 0.5) * 0.4 - 0.5), 0.03 * ((at.y + 0.5) * 0.4 - 0.5), 0.5));
        CHECK(glm::length(colourOf(scaled, at.x, at.y) - expected) < 1e-6f);
    }
    CHECK(colourOf(scaled, 0, 0).z == doctest::Approx(0.5f));
    CHECK_THROWS_AS(scaleUp(ramp, {19, 25}), Error);
}

}  // SUITE(metrics)
