// Facts about the twins of reuse over time, with pictures whose result is computed by hand.
#include "engine/twin/history.h"
#include "tests/engine/twin/reference_scenes.h"

#include <complex>

SUITE(history_reference) {

using namespace binosplat::reference;

constexpr double kLeastGrowth = 1.9e-7;  // squared, for a pixel that moved

// An opaque picture with `colour(x, y)` at the inverse depth `depth(x, y)`; each pixel has a single depth,
// and tiles cost 100 pairs.
template <typename Colour, typename Depth>
History makeHistory(const Eye& eye, const Colour& colour, const Depth& depth) {
    Picture picture{eye.size_px, {}, {}, {}, {}};
    for (std::uint32_t i = 0; i < eye.size_px.x * eye.size_px.y; ++i) {
        const double x = i % eye.size_px.x, y = i / eye.size_px.x, w = depth(x, y);
        picture.rgba.emplace_back(colour(x, y), 1.0);
        picture.inverse_depth.push_back(w);
        picture.inverse_depth_squared.push_back(w * w);
    }
    const glm::uvec2 tiles = (eye.size_px + 15u) / 16u;
    return historyOf(eye, picture, std::vector<std::uint64_t>(std::size_t{tiles.x} * tiles.y, 100));
}

glm::dvec3 waves(double x, double y) {
    return {0.5 + 0.4 * std::sin(0.3 * x), 0.5 + 0.4 * std::sin(0.2 * y),
            0.5 + 0.4 * std::sin(0.2 * (x + y))};
}

double wall(double, double) { return 0.5; }
// Pairs of rows at two depths, so that no block is uniform.
double bands(double, double y) { return std::fmod(y, 4.0) < 2.0 ? 0.5 : 0.05; }
glm::dvec3 grey(double, double) { return glm::dvec3(0.5); }

Eye moved(Eye eye, const glm::dvec3& by) {
    eye.world_from_camera.position += by;
    return eye;
}

double depthAt(const WarpedHistory& warped, std::size_t pixel) {
    return warped.picture.pixels[pixel].value_or(MovingPixel{}).inverse_depth;
}

std::complex<double> responseOf(const std::array<double, 6>& weights, double frequency) {
    std::complex<double> sum(0.0);
    for (int tap = 0; tap < 6; ++tap) { sum += weights[tap] * std::polar(1.0, frequency * (tap - 2)); }
    return sum;
}

TEST_CASE("the kernel of repeated sampling keeps sums, and makes no frequency stronger at any shift") {
    for (int step = 0; step <= 200; ++step) {
        const auto weights = sixTapWeights(step / 200.0);
        CHECK(std::accumulate(weights.begin(), weights.end(), 0.0) == doctest::Approx(1.0).epsilon(1e-12));
        for (int wave = 0; wave <= 200; ++wave) {
            CHECK(std::abs(responseOf(weights, std::numbers::pi * wave / 200.0)) <= 1.0 + 1e-12);
        }
    }
    CHECK(sixTapWeights(0.0)[2] == 1.0);
    CHECK(sixTapWeights(1.0)[3] == 1.0);
}

TEST_CASE("what stands still before a head that stands still stays as it is, without an error") {
    const Eye eye = makeEye({70, 45});
    History history =
        makeHistory(eye, waves, [](double x, double y) { return x > 30 && y > 20 ? 0.5 : 0.2; });
    const History first = history;
    for (int frame = 0; frame < 5; ++frame) {
        WarpedHistory warped = warpHistory(history, eye);
        CHECK(std::ranges::count(warped.unseen, 1) == 0);
        growErrors(warped.picture.tiles);
        history = std::move(warped.picture);
    }
    CHECK(history.rgba == first.rgba);
    CHECK(std::ranges::equal(history.pixels, first.pixels, [](const auto& a, const auto& b) {
        return a->inverse_depth == b->inverse_depth && a->spread == b->spread;
    }));
    CHECK(std::ranges::all_of(history.tiles, [](const HistoryTile& tile) {
        return tile.age == 5 && tile.cost == 100 && tile.errors == std::array<double, 4>{} &&
               worthOf(tile) == 0.0;
    }));
}

TEST_CASE("a wave on a wall comes out as it would have been seen, for the least error that counts") {
    const Eye eye = makeEye({96, 64});
    // 0.005 to the right moves a wall at inverse depth 0.5 by 0.25 px to the left.
    const History history = makeHistory(eye, waves, wall);
    const WarpedHistory warped = warpHistory(history, moved(eye, {0.005, 0.0, 0.0}));
    // The kernel keeps all but a thousandth of such a wave.
    const std::complex<double> kept = responseOf(sixTapWeights(0.25), 0.3);
    CHECK(std::abs(kept - std::polar(1.0, 0.3 * 0.25)) < 1e-3);
    for (std::size_t y = 8; y < 56; ++y) {
        for (std::size_t x = 8; x < 88; ++x) {
            const std::size_t i = y * 96 + x;
            CHECK(depthAt(warped, i) == doctest::Approx(0.5));
            const double wave = std::imag(kept * std::polar(0.4, 0.3 * static_cast<double>(x)));
            CHECK(warped.picture.rgba[i].x == doctest::Approx(0.5 + wave).epsilon(1e-5));
        }
    }
    CHECK(std::ranges::count(warped.unseen, 1) == 0);
    CHECK(std::ranges::count(warped.one_by_one, 1) == 0);
    // The fifth differences of these waves are at most 2e-5.
    for (const double grown : warped.picture.tiles[1].grown) {
        CHECK(grown == doctest::Approx(64.0 * kLeastGrowth));
    }
    // After a whole pixel, the last column has no history; its pixels count with an amplitude of 1.
    const WarpedHistory on = warpHistory(history, moved(eye, {0.02, 0.0, 0.0}));
    CHECK(std::ranges::count(on.unseen, 1) == 64);
    CHECK(on.picture.tiles[5].grown[1] == within(8.0, 8.1));
}

TEST_CASE("what is lost between pixels is what alternates there, in whole blocks and pixel by pixel") {
    const Eye eye = makeEye({96, 64}), half = moved(eye, {0.01, 0.0, 0.0}),
              quarter = moved(eye, {0.005, 0.0, 0.0});
    const auto stripes = [](double x, double) { return glm::dvec3(std::fmod(x, 2.0) == 0.0 ? 0.7 : 0.3); };
    const auto grownOf = [&](const Eye& to, const auto& depth) {
        return warpHistory(makeHistory(eye, stripes, depth), to).picture.tiles[7].grown[0];
    };
    // An amplitude of 0.2 in 64 pixels of three channels, all moved by half a pixel, of which four fifths
    // count; a move by t from pixel to pixel counts 4 t (1 - t).
    CHECK(grownOf(half, wall) == doctest::Approx(64 * 3 * 0.16 * 0.16));
    CHECK(grownOf(quarter, wall) == doctest::Approx(64 * 3 * 0.12 * 0.12));
    // Half of the pixels move by 1/2, half by 1/20. Each row has an equal one next to it.
    const WarpedHistory apart = warpHistory(makeHistory(eye, stripes, bands), half);
    CHECK(std::ranges::count(apart.one_by_one, 0) == 0);
    CHECK(apart.picture.tiles[7].grown[0] ==
          doctest::Approx(32 * 3 * 0.2 * 0.2 + 32 * 3 * std::pow(0.19 * 0.2, 2)).epsilon(1e-4));
    // Not even where everything has one colour: every tile must get its turn.
    CHECK(warpHistory(makeHistory(eye, grey, bands), half).picture.tiles[7].grown[0] ==
          doctest::Approx(64 * kLeastGrowth));
}

TEST_CASE("a tile's gradient is its picture's, and where it is low a bound allows less error") {
    const Eye eye = makeEye({96, 64});
    const auto ramp = [](double x, double y) { return glm::dvec3(0.004 * x, 0.003 * y, 0.5); };
    for (const History& history : {makeHistory(eye, ramp, wall), makeHistory(eye, ramp, bands)}) {
        CHECK(warpHistory(history, moved(eye, {0.01, 0.0, 0.0})).picture.tiles[7].squared_gradient ==
              doctest::Approx(256 * (0.004 * 0.004 + 0.003 * 0.003)));
    }
    HistoryTile tile;
    tile.errors[2] = 0.03;
    const auto isOver = [&](double gradient) {
        tile.squared_gradient = 3 * 256 * gradient * gradient;
        return priceUnderBound(100, tile, 0.04) >= kOverPrice;
    };
    CHECK((isOver(0.0) && isOver(0.037)));  // 3/4 of 0.05 would be equal
    CHECK_FALSE((isOver(0.038) || isOver(0.2)));
    tile.errors[2] = 0.0239;  // less than 0.6 of the bound
    CHECK_FALSE(isOver(0.0));
}

TEST_CASE("what was hidden behind a nearer wall is not taken for seen, and the nearer of two is it") {
    const Eye eye = makeEye({160, 48});
    // The left half is near, at inverse depth 1: a step of 0.02 to the right moves it 2 px to the left, and
    // what is behind, at 0.1, by 0.2 px.
    const History history = makeHistory(eye, waves, [](double x, double) { return x < 80 ? 1.0 : 0.1; });
    const WarpedHistory warped = warpHistory(history, moved(eye, {0.02, 0.0, 0.0}));
    for (std::size_t y = 0; y < 48; ++y) {
        const std::size_t row = 160 * y;
        for (std::size_t x = 0; x < 160; ++x) {
            const bool is_unseen = x == 78 || x == 79;
            CHECK(warped.unseen[row + x] == is_unseen);
            if (!is_unseen) { CHECK(depthAt(warped, row + x) == doctest::Approx(x < 78 ? 1.0 : 0.1)); }
        }
    }
    // What a silhouette uncovers is expected to resemble what is next to it; there are 16 such pixels in a
    // quarter of the tile.
    CHECK(warped.picture.tiles[14].unseen == std::array<unsigned, 4>{0, 16, 0, 16});
    CHECK(warped.picture.tiles[14].grown[1] < 1.0);
    // And to the left: the near wall covers two pixels that both walls would claim.
    const WarpedHistory covered = warpHistory(history, moved(eye, {-0.02, 0.0, 0.0}));
    for (std::size_t x = 78; x < 160; ++x) {
        CHECK(depthAt(covered, 160 * 24 + x) == doctest::Approx(x < 82 ? 1.0 : 0.1));
    }
}

TEST_CASE("nothing comes from where the history was hidden, and what is hidden now is background") {
    const Eye eye = makeEye({96, 64});
    History history = makeHistory(eye, waves, wall);
    std::vector<std::uint8_t> hidden(24, 0);
    hidden[8] = 1;
    history.hidden = hidden;
    hidden[15] = 1;
    const WarpedHistory warped = warpHistory(history, moved(eye, {0.02, 0.0, 0.0}), hidden, {0.1, 0.2, 0.3});
    for (const std::size_t pixel : {40 * 96 + 50, 20 * 96 + 40}) {
        CHECK(warped.picture.rgba[pixel] == glm::dvec4(0.1, 0.2, 0.3, 0.0));
    }
    CHECK_FALSE(warped.picture.pixels[20 * 96 + 40]);
    // The first tile was seen; the source of the second pixel is the neighbouring one.
    CHECK(these(warped.unseen[40 * 96 + 46], warped.unseen[20 * 96 + 31], warped.unseen[20 * 96 + 30]) ==
          these(0, 1, 0));
}

TEST_CASE("the colour of what was hidden does not leak into the pixels beside it") {
    const Eye eye = makeEye({96, 64});
    History history = makeHistory(eye, grey, wall);
    history.hidden.assign(24, 0);
    history.hidden[8] = 1;
    for (std::size_t y = 16; y < 32; ++y) {
        for (std::size_t x = 32; x < 48; ++x) { history.rgba[y * 96 + x] = glm::dvec4(0.0); }
    }
    // By half a pixel in each direction.
    const WarpedHistory warped = warpHistory(history, moved(eye, {0.01, 0.01, 0.0}));
    for (std::size_t i = 0; i < warped.unseen.size(); ++i) {
        if (warped.unseen[i] == 0) { CHECK(warped.picture.rgba[i].r == doctest::Approx(0.5)); }
    }
}

}  // SUITE(history_reference)
