// Facts about the twins of the stereo passes on their own: small pictures whose result is worked out by hand.
#include "engine/twin/stereo.h"
#include "tests/engine/twin/reference_scenes.h"

SUITE(stereo_reference) {

using namespace binosplat::reference;

constexpr glm::uvec2 kSizePx(48, 16);

// Opaque, in greens, all at one inverse depth whose spread has this code.
template <typename Green>
Picture makePicture(double inverse_depth, std::uint32_t code, const Green& green) {
    Picture picture{kSizePx, {}, {}, {}, {}};
    const double w = inverse_depth;
    for (std::uint32_t i = 0; i < kSizePx.x * kSizePx.y; ++i) {
        picture.rgba.emplace_back(0.0, green(i % kSizePx.x, i / kSizePx.x), 0.0, 1.0);
        picture.depth.push_back(1.0 / w);
        picture.inverse_depth.push_back(w);
        picture.inverse_depth_squared.push_back(w * w * (1.0 + spreadOf(code) * spreadOf(code)));
    }
    return picture;
}
double ramp(std::uint32_t x, std::uint32_t) { return 0.01 * x; }

// Such a picture, of three tiles, as the other eye gets it.
struct Moved {
    explicit Moved(Picture of, const StereoSettings& how = {}) : picture(std::move(of)), settings(how) {}
    [[nodiscard]] std::vector<double> errors() const {
        return expectErrors(resolved, arrivals, picture, kinds, eyes, settings);
    }

    Picture picture;
    StereoSettings settings;
    EyePair eyes{parallelEyes(kSizePx)[kLeft], parallelEyes(kSizePx)[kRight]};
    std::vector<Arrival> arrivals = reproject(picture, eyes, settings);
    std::vector<Resolved> resolved = resolve(arrivals, eyes, settings);
    std::vector<TileKind> kinds = std::vector(3, TileKind::kNone);
};

TEST_CASE("spread codes are half octaves from 2^-13 to 4; what is less is none, what is more the last") {
    for (std::uint32_t code = 1; code <= 31; ++code) {
        const double spread = spreadOf(code);
        CHECK(spread == doctest::Approx(std::pow(2.0, (code - 1) / 2.0 - 13.0)));
        CHECK(these(spreadCode(spread), spreadCode(1.18 * spread), spreadCode(0.85 * spread)) ==
              these(code, code, code));
    }
    CHECK(these(spreadOf(31), spreadOf(0), spreadCode(1e9),
                spreadCode(std::numeric_limits<double>::infinity())) == these(4.0, 0.0, 31, 31));
    for (const double none : {0.0, -1.0, 1e-5, std::nan("")}) { CHECK(spreadCode(none) == 0); }
}

TEST_CASE("expected errors of blended depths: half the spread times the gradient, squared") {
    // 2 px of disparity at inverse depth 0.2, with a spread of 1/4 of it; every other row counts for two.
    Moved moved(makePicture(0.2, spreadCode(0.25), ramp), {.hole_error = 0.0});
    const double pixel = 0.25 * 0.25 * 0.01 * 0.01 / 3.0;
    CHECK(moved.errors()[1] == doctest::Approx(256.0 * pixel));
    // Two columns of holes on the right; beside them are the source's last two pixels, where the gradient
    // ends.
    CHECK(moved.errors()[2] == doctest::Approx(16.0 * (13.0 + 0.25) * pixel + 32.0 * 1e-4));
    // The spread is the one that arrived, whatever the source's is; and a mark excludes the tile.
    for (Resolved& r : moved.resolved) { r.spread = 0; }
    moved.kinds[2] = TileKind::kCheap;
    const auto without = moved.errors();
    CHECK(without[0] + without[1] < 1e-24);
    CHECK(without[2] == 0.0);
    // Four pixels are the maximum.
    for (Resolved& r : moved.resolved) { r.spread = 31; }
    CHECK(moved.errors()[1] == doctest::Approx(256.0 * 16.0 * 1e-4 / 3.0));
}

TEST_CASE("expected errors of steps in depth: the greater of both times the gradient, on both sides") {
    // 10 px of disparity at inverse depth 1, so a step of 0.1 is one pixel.
    Moved moved(makePicture(0.2, 0, ramp));
    CHECK(moved.errors()[1] < 1e-24);
    // One column of another depth next to each pair of columns: the class of a pixel itself stays.
    for (std::size_t y = 0; y < 16; ++y) { moved.arrivals[y * 48 + 24].inverse_depth = 0.3; }
    CHECK(moved.errors()[1] == doctest::Approx(16.0 * 2.0 * 0.01 * 0.01 / 3.0));
    // The larger step decides, on whichever side it is.
    for (std::size_t y = 0; y < 16; ++y) { moved.arrivals[y * 48 + 22].inverse_depth = 0.0; }
    CHECK(moved.errors()[1] == doctest::Approx(16.0 * (1.0 + 4.0 + 4.0) * 0.01 * 0.01 / 3.0));
    // Where nothing arrived, there is no step.
    for (std::size_t y = 0; y < 16; ++y) { moved.arrivals[y * 48 + 22] = moved.arrivals[y * 48 + 24] = {}; }
    CHECK(moved.errors()[1] < 1e-24);
}

TEST_CASE("expected errors of sampling: what alternates is lost halfway between two pixels") {
    const auto errorAt = [](double inverse_depth, bool across) {
        const auto stripes = [&](auto x, auto y) { return (across ? x : y) % 2 == 0 ? 0.55 : 0.45; };
        return Moved(makePicture(inverse_depth, 0, stripes)).errors()[1];
    };
    // 10 px of disparity at inverse depth 1.
    CHECK(errorAt(0.25, true) == doctest::Approx(256.0 * 0.05 * 0.05 / 3.0));
    CHECK(errorAt(0.225, true) == doctest::Approx(256.0 * 0.05 * 0.05 / 3.0 * 0.75 * 0.75));
    CHECK(errorAt(0.2, true) < 1e-24);
    // Rows stay where they are.
    CHECK(errorAt(0.25, false) == 0.0);
}

TEST_CASE("an eye sees all of an error where it looks, and less and less farther away") {
    // Pixels of 1/1000: cycles of 2/1000 rad, or 0.1146 degrees, which the eye resolves up to (0.1146 - 1/48)
    // / 0.022 = 4.26 degrees.
    const Eye eye{Pose{}, {1000.0, 1000.0, 8.0, 8.0}, {1024, 16}};
    const auto shareAt = [&](double tangent, const reference::Gaze& gaze) {
        return reference::findSeenShares(eye, gaze).at(
            static_cast<std::size_t>(tangent * 1000.0 / 16.0 + 0.5));
    };
    const reference::Gaze ahead{{0.0, 0.0, 2.0}, 0.0};
    CHECK(shareAt(0.0, ahead) == 1.0);
    CHECK(shareAt(0.064, ahead) == 1.0);  // 3.7 degrees
    CHECK(shareAt(0.08, ahead) < 1.0);    // 4.6 degrees
    const auto law = [](double degrees) {
        return std::pow(glm::degrees(0.002) / (1.0 / 48.0 + 0.022 * degrees), 2.0);
    };
    CHECK(shareAt(0.352, ahead) == doctest::Approx(law(glm::degrees(std::atan(0.352)))));
    CHECK(law(19.4) == doctest::Approx(0.0654).epsilon(0.01));
    // It may also look up to ten degrees to the side.
    CHECK(shareAt(0.352, {{0.0, 0.0, 1.0}, glm::radians(10.0)}) ==
          doctest::Approx(law(glm::degrees(std::atan(0.352)) - 10.0)));
    // It looks there; straight ahead is then just as far away.
    CHECK(shareAt(0.352, {{0.352, 0.0, 1.0}, 0.0}) == 1.0);
    CHECK(shareAt(0.0, {{0.352, 0.0, 1.0}, 0.0}) == doctest::Approx(shareAt(0.352, ahead)));
    // Behind the eye.
    CHECK(shareAt(0.0, {{0.0, 0.0, -1.0}, 0.0}) == doctest::Approx(law(180.0)));
}

}  // SUITE(stereo_reference)
