// Facts about which errors a wearer notices through a headset's lenses, by the program's model.
#include "app/bench/seen_through_lens.h"
#include "tests/engine/picture/pictures.h"

SUITE(seen_through_lens) {

// 96 degrees wide and high, and 8 pixels per degree in the middle.
Cameras wideCameras() {
    const Eye eye{{}, intrinsicsFromFovX(glm::radians(96.0), {1024, 1024}), {1024, 1024}};
    return {eye, stereoPair(eye, 0.06), 0.06, std::nullopt};
}

// Grey, with a square of 128 pixels that is 0.06 brighter: 3.6 times the squared error of a bad tile.
Image brightSquare(std::uint32_t left_px) {
    return makePicture({1024, 1024}, [&](std::uint32_t x, std::uint32_t y) {
        const bool inside = x >= left_px && x < left_px + 128 && y >= 448 && y < 576;
        return glm::vec3(inside ? 0.56f : 0.5f);
    });
}

TEST_CASE("within 15 degrees of a lens's centre an error counts as it is, at 43 degrees for a seventh") {
    const SeenThroughLens lens(wideCameras());
    const Image full = makeGrey({1024, 1024}, 4, 0.5f);
    const auto find = [&](const Image& left, const Image& right) {
        return lens.find(lens.show({left, right}), lens.show({full, full}));
    };
    const auto worst = [](const VisibleErrors& errors) { return worstTiles(errors.tile_squares, 1e-9); };
    const auto badTiles = [](const VisibleErrors& errors) {
        return errors.badShare() * static_cast<double>(errors.tile_squares.size());
    };
    const double whole = worst(findVisibleErrors({brightSquare(448), full}, {full, full}));
    const VisibleErrors middle = find(brightSquare(448), full), border = find(brightSquare(16), full);
    CHECK(badTiles(middle) == doctest::Approx(64.0));
    CHECK(worst(middle) == doctest::Approx(whole).epsilon(1e-4));
    CHECK(badTiles(border) == 0.0);
    // Two pixels span 0.248 degrees at the tile's 35 to 46, the finest cycle seen 1/48 + 0.022 (angle - 15).
    CHECK(worst(border) == between(whole * std::pow(0.248 / (1.0 / 48.0 + 0.022 * (46.0 - 15.0)), 2.0) * 0.85,
                                   whole * std::pow(0.248 / (1.0 / 48.0 + 0.022 * (35.0 - 15.0)), 2.0)));
    CHECK(worst(find(full, full)) == 0.0);
    // With the lens centres moved to the left, an error there is seen.
    Cameras aside = wideCameras();
    aside.lens_centres = {glm::dvec3(-0.93, 0.0, 1.0), glm::dvec3(-0.93, 0.0, 1.0)};
    const SeenThroughLens there(aside);
    const auto findThere = [&](const Image& left) {
        return there.find(there.show({left, full}), there.show({full, full}));
    };
    CHECK(badTiles(findThere(brightSquare(16))) > 0.0);
    CHECK(worst(findThere(brightSquare(880))) < 0.1 * whole);
}

}  // SUITE(seen_through_lens)
