// Facts about the twins of the stereo passes by themselves: small pictures for which the answer is worked out by hand.
#include "engine/reference/stereo.h"
#include "tests/engine/reference/reference_scenes.h"

SUITE(stereo_reference) {

using namespace binosplat::reference;

// Parallel eyes 0.1 apart, of 100 px focal length: pixels go 10 px to the left for a unit of inverse depth.
EyePair parallelEyes(glm::uvec2 size_px) {
    const auto eyes = stereoPair(test::makeEye(size_px), 0.1);
    return {eyes[kLeft], eyes[kRight]};
}

// Opaque and black, all at one inverse depth.
Picture makePicture(glm::uvec2 size_px, double inverse_depth) {
    const std::size_t pixels = std::size_t{size_px.x} * size_px.y;
    return {size_px, std::vector(pixels, glm::dvec4(0.0, 0.0, 0.0, 1.0)), std::vector(pixels, 1.0 / inverse_depth),
            std::vector(pixels, inverse_depth), std::vector(pixels, inverse_depth * inverse_depth)};
}
// A ramp of 1/100 a pixel in green.
Picture makeRamp(glm::uvec2 size_px) {
    Picture picture = makePicture(size_px, 0.2);
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) { picture.rgba[i].y = 0.01 * static_cast<double>(i % size_px.x); }
    return picture;
}
// Lets a pixel's depths differ by as much as `code` says.
void spread(Picture& picture, std::size_t pixel, std::uint32_t code) {
    const double w = picture.inverse_depth[pixel] / picture.rgba[pixel].w;
    picture.inverse_depth_squared[pixel] = picture.rgba[pixel].w * w * w * (1.0 + spreadOf(code) * spreadOf(code));
}

std::string letters(std::span<const TileKind> kinds) {
    std::string row;
    for (const TileKind kind : kinds) { row += ".ecphC"[static_cast<std::size_t>(kind)]; }
    return row;
}

std::vector<TileRange> rangesOf(const std::vector<std::uint32_t>& pairs) {
    std::vector<TileRange> ranges;
    std::uint32_t end = 0;
    for (const std::uint32_t count : pairs) {
        ranges.push_back({end, end + count});
        end += count;
    }
    return ranges;
}

// A tile of the strip that `weigh` sees the pairs of: nothing moves if all is infinitely far.
Weighed weighStrip(const std::vector<std::uint32_t>& pairs, std::uint32_t move_cost, std::vector<std::uint8_t> hidden = {},
                   double budget = 0.0) {
    const glm::uvec2 size_px(16 * pairs.size(), 16);
    Picture far = makePicture(size_px, 1.0);
    for (glm::dvec4& value : far.rgba) { value.w = 0.0; }
    return weigh(far, rangesOf(pairs), parallelEyes(size_px),
                 {.budget = budget, .move_cost = move_cost, .target_hidden = std::move(hidden)});
}

TEST_CASE("spread codes are half octaves from 2^-13 to 4; what is less is none, what is more the last") {
    for (std::uint32_t code = 1; code <= 31; ++code) {
        CHECK(spreadOf(code) == doctest::Approx(std::pow(2.0, (code - 1) / 2.0 - 13.0)));
        CHECK(spreadCode(spreadOf(code)) == code);
        CHECK(spreadCode(1.18 * spreadOf(code)) == code);
        CHECK(spreadCode(0.85 * spreadOf(code)) == code);
    }
    CHECK(spreadOf(31) == 4.0);
    CHECK(spreadOf(0) == 0.0);
    CHECK(spreadCode(1e9) == 31);
    CHECK(spreadCode(std::numeric_limits<double>::infinity()) == 31);
    for (const double none : {0.0, -1.0, 1e-5, std::nan("")}) { CHECK(spreadCode(none) == 0); }
}

TEST_CASE("a pixel is moved if its depth is one; its spread is told where errors are predicted") {
    Picture picture = makePicture({4, 1}, 0.5);
    // Two equal parts at depths 1 and 2: mean inverse depth 3/4, deviation 1/4; alpha 1/2.
    picture.rgba[1].w = 0.5;
    picture.depth[1] = 0.75;
    picture.inverse_depth[1] = 0.375;
    picture.inverse_depth_squared[1] = 0.5 * (1.0 + 0.25) / 2.0;
    picture.rgba[2].w = 0.0;
    picture.depth[3] = -1.0;
    picture.inverse_depth[3] = 1e30;
    const auto at = [&](std::size_t i, DepthChoice choice) { return movingPixel(picture, i, {.depth_choice = choice}); };
    CHECK(at(0, DepthChoice::kInverse)->inverse_depth == 0.5);
    CHECK(at(0, DepthChoice::kInverse)->spread == 0);
    CHECK(at(1, DepthChoice::kInverse)->inverse_depth == 0.75);
    CHECK(at(1, DepthChoice::kInverse)->spread == spreadCode(1.0 / 3.0));
    CHECK(at(1, DepthChoice::kMean)->inverse_depth == doctest::Approx(1.0 / 1.5));
    CHECK(at(1, DepthChoice::kMean)->spread == spreadCode(0.25 * 1.5));
    CHECK(at(1, DepthChoice::kSum)->inverse_depth == doctest::Approx(1.0 / 0.75));
    // Nothing there is infinitely far; what is behind the eye or on it is nowhere.
    CHECK(at(2, DepthChoice::kMean)->inverse_depth == 0.0);
    CHECK(at(2, DepthChoice::kMean)->spread == 0);
    for (const DepthChoice choice : {DepthChoice::kSum, DepthChoice::kMean, DepthChoice::kInverse}) { CHECK_FALSE(at(3, choice)); }
}

TEST_CASE("the nearest arrives, with its own spread; depths that round to the same are equal") {
    // Pixels 5, 6, 10 and 11 all go to pixel 0, the others nowhere near.
    const glm::uvec2 size_px(12, 1);
    Picture picture = makePicture(size_px, 1e-9);
    const auto put = [&](std::size_t x, double inverse_depth, std::uint32_t code) {
        picture.inverse_depth[x] = inverse_depth;
        spread(picture, x, code);
    };
    put(5, 0.5, 19);
    put(6, 0.6, 20);
    put(10, 1.0, 3);
    std::vector<Arrival> arrivals = reproject(picture, parallelEyes(size_px), {.gap_px = 0});
    CHECK(arrivals[0].inverse_depth == 1.0);
    CHECK(arrivals[0].spread == 3);
    CHECK(arrivals[5].way == Arrival::kNone);
    put(11, 1.1, 20);
    arrivals = reproject(picture, parallelEyes(size_px), {.gap_px = 0});
    CHECK(arrivals[0].inverse_depth == 1.1);
    CHECK(arrivals[0].spread == 20);
    CHECK(roundedDepth(1.0) == roundedDepth(1.0 + 0x1p-20));
    CHECK(roundedDepth(1.0) != roundedDepth(1.0 + 0x1p-18));
    CHECK(roundedDepth(0.0) == 0.0);
}

TEST_CASE("what lies between two pixels has the greater spread of them; a gap that nothing reached has none") {
    // The centre of pixel 20 goes to 17.3, that of pixel 21 to 20.3: 18 and 19 lie between.
    const glm::uvec2 size_px(40, 1);
    Picture picture = makePicture(size_px, 0.12);
    for (std::size_t x = 0; x <= 20; ++x) { picture.inverse_depth[x] = 0.32; }
    for (std::size_t x = 0; x < 40; ++x) { spread(picture, x, x == 20 ? 20 : 18); }
    const EyePair eyes = parallelEyes(size_px);
    const StereoSettings settings{.gap_px = 2};
    const auto arrivals = reproject(picture, eyes, settings);
    CHECK(arrivals[17].way == Arrival::kLanded);
    CHECK(arrivals[17].spread == 20);
    CHECK(arrivals[18].way == Arrival::kBetween);
    CHECK(arrivals[18].spread == 20);
    CHECK(arrivals[20].way == Arrival::kLanded);
    CHECK(arrivals[20].spread == 18);
    CHECK(resolve(arrivals, eyes, settings)[18].spread == 20);
    const auto apart = reproject(picture, eyes, {.gap_px = 0});
    const auto resolved = resolve(apart, eyes, settings);
    CHECK(apart[18].way == Arrival::kNone);
    CHECK(resolved[18].pixel_class == PixelClass::kGap);
    CHECK(resolved[18].spread == 0);
}

TEST_CASE("a pixel that blends two depths moves with the nearest of itself and its neighbours in the row") {
    // Content of 0.32 in front of 0.12, at pixels 20 to 22, is moved by 3.2 pixels and what is behind by 1.2; pixels 19 and 23 blend both.
    const glm::uvec2 size_px(40, 3);
    Picture picture = makePicture(size_px, 0.12);
    const auto moved = [&](std::uint32_t code, const StereoSettings& settings) {
        for (std::size_t x = 59; x <= 63; ++x) {
            picture.inverse_depth[x] = x == 59 || x == 63 ? 0.2 : 0.32;
            spread(picture, x, x == 59 || x == 63 ? code : 3);
        }
        const auto arrivals = reproject(picture, parallelEyes(size_px), settings);
        return std::array{arrivals[40 + 16].inverse_depth, arrivals[40 + 20].inverse_depth, arrivals[40 + 16 - 40].inverse_depth};
    };
    CHECK(moved(21, {.gap_px = 0}) == std::array{0.32, 0.32, 0.12});
    CHECK(moved(20, {.gap_px = 0}) == std::array{0.12, 0.0, 0.12});  // nothing arrives at 20
    CHECK(moved(21, {.forward = true, .gap_px = 0})[0] == 0.12);     // the paper's pixels keep their own depth
}

TEST_CASE("a tile costs its pairs and 16; where that is no more than moving it, it is cheap") {
    const Weighed weighed = weighStrip({0, 100, 40, 41, 5000000, 39}, 40);
    CHECK(letters(weighed.kinds) == "C.C..C");
    CHECK(weighed.costs == std::vector<std::uint64_t>{16, 116, 56, 57, 2097151, 55});
    CHECK(weighed.picture_cost == 16 + 116 + 56 + 57 + 2097151 + 55);
    CHECK(weighed.saved_cost == 60 + 1 + 4999960);
    CHECK(weighed.moves);
    // For nothing only what has no pair is cheap.
    CHECK(letters(weighStrip({0, 1, 7}, 0).kinds) == "C..");
}

TEST_CASE("nothing is moved where that saves no more than half of moving all tiles that are shown, and the budget") {
    // Eight tiles that cost 40 each to move: 160 must be saved.
    CHECK(letters(weighStrip({200, 1, 1, 1, 1, 1, 1, 1}, 40).kinds) == "CCCCCCCC");
    CHECK_FALSE(weighStrip({200, 1, 1, 1, 1, 1, 1, 1}, 40).moves);
    CHECK(letters(weighStrip({201, 1, 1, 1, 1, 1, 1, 1}, 40).kinds) == ".CCCCCCC");
    // Of seven 140.
    CHECK(letters(weighStrip({181, 1, 1, 1, 1, 1, 1, 1}, 40, {0, 0, 0, 1, 0, 0, 0, 0}).kinds) == ".CChCCCC");
    // 477 in all, of which 309 are saved: more than 160 and 143 for mending, not more than 160 and 190.
    std::vector<std::uint32_t> pairs(8, 0);
    pairs[0] = 349;
    CHECK(weighStrip(pairs, 40, {}, 0.25).picture_cost == 349 + 8 * 16);
    CHECK_FALSE(weighStrip(pairs, 40, {}, 0.4).moves);
    CHECK(weighStrip(pairs, 40, {}, 0.3).moves);
    // What is hidden counts for nothing.
    const Weighed hidden = weighStrip({181, 1, 1, 9999, 1, 1, 1, 1}, 40, {0, 0, 0, 1, 0, 0, 0, 0});
    CHECK(hidden.picture_cost == 197 + 6 * 17);
    CHECK(hidden.saved_cost == 141);
    CHECK_FALSE(weighStrip({500, 500}, 0, {1, 1}).moves);
}

TEST_CASE("a tile's pairs are those where its middle comes from") {
    // 18 px to the left: what the right eye sees in the middle of tile 1, pixel 24, is pixel 42 of the left one, in tile 2.
    const glm::uvec2 size_px(96, 20);
    const std::vector<std::uint32_t> pairs{10, 20, 30, 40, 50, 60, 11, 21, 31, 41, 51, 61};
    Picture picture = makePicture(size_px, 1.8);
    const auto costs = weigh(picture, rangesOf(pairs), parallelEyes(size_px), {}).costs;
    CHECK(costs == std::vector<std::uint64_t>{36, 46, 56, 66, 76, 76, 37, 47, 57, 67, 77, 77});
    // The depth is that of the same pixel of the source: (24, 8), and (24, 18) in the cut row, whose last even one that is.
    picture.inverse_depth[8 * 96 + 24] = 0.0;
    picture.inverse_depth[18 * 96 + 24] = 1e31;
    const auto other = weigh(picture, rangesOf(pairs), parallelEyes(size_px), {}).costs;
    CHECK(other == std::vector<std::uint64_t>{36, 36, 56, 66, 76, 76, 37, 37, 57, 67, 77, 77});
}

TEST_CASE("expected errors of blended depths: half the spread in pixels times the gradient, squared, on every other row for two") {
    // 2 px of disparity at inverse depth 0.2, a spread of 1/4 of it.
    const glm::uvec2 size_px(48, 16);
    Picture picture = makeRamp(size_px);
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) { spread(picture, i, spreadCode(0.25)); }
    const EyePair eyes = parallelEyes(size_px);
    const StereoSettings settings{.hole_error = 0.0};
    const auto arrivals = reproject(picture, eyes, settings);
    const auto resolved = resolve(arrivals, eyes, settings);
    std::vector<TileKind> kinds(3, TileKind::kNone);
    const auto errors = expectErrors(resolved, arrivals, picture, kinds, eyes, settings);
    const double pixel = 0.25 * 0.25 * 0.01 * 0.01 / 3.0;
    CHECK(errors[1] == doctest::Approx(256.0 * pixel));
    // Two columns of holes at the right; beside them the source's last two pixels, where the gradient ends in itself.
    CHECK(errors[2] == doctest::Approx(16.0 * (13.0 + 0.25) * pixel + 32.0 * 1e-4));
    // The spread is the one that arrived, whatever the source says; and a mark takes the tile out.
    auto spreadless = resolved;
    for (Resolved& r : spreadless) { r.spread = 0; }
    kinds[2] = TileKind::kCheap;
    const auto without = expectErrors(spreadless, arrivals, picture, kinds, eyes, settings);
    CHECK(without[0] + without[1] < 1e-24);
    CHECK(without[2] == 0.0);
    // Four pixels are the most.
    for (Resolved& r : spreadless) { r.spread = 31; }
    CHECK(expectErrors(spreadless, arrivals, picture, kinds, eyes, settings)[1] == doctest::Approx(256.0 * 16.0 * 1e-4 / 3.0));
}

TEST_CASE("expected errors of steps in depth: the greater of both, in pixels, times the gradient, on both sides of it") {
    // 10 px of disparity at inverse depth 1, so that a step of 0.1 is one pixel.
    const glm::uvec2 size_px(48, 16);
    const Picture picture = makeRamp(size_px);
    const EyePair eyes = parallelEyes(size_px);
    const auto arrivals = reproject(picture, eyes, {});
    const auto resolved = resolve(arrivals, eyes, {});
    const std::vector<TileKind> kinds(3, TileKind::kNone);
    const auto errorsOf = [&](const std::vector<Arrival>& beside) { return expectErrors(resolved, beside, picture, kinds, eyes, {}); };
    CHECK(errorsOf(arrivals)[1] < 1e-24);
    // One column of another depth beside each pixel of two: what a pixel itself is taken for stays.
    auto stepped = arrivals;
    for (std::size_t y = 0; y < 16; ++y) { stepped[y * 48 + 24].inverse_depth = 0.3; }
    CHECK(errorsOf(stepped)[1] == doctest::Approx(16.0 * 2.0 * 0.01 * 0.01 / 3.0));
    // The greater step decides, whichever side it is on.
    for (std::size_t y = 0; y < 16; ++y) { stepped[y * 48 + 22].inverse_depth = 0.0; }
    CHECK(errorsOf(stepped)[1] == doctest::Approx(16.0 * (1.0 + 4.0 + 4.0) * 0.01 * 0.01 / 3.0));
    // Where nothing arrived there is no step.
    for (std::size_t y = 0; y < 16; ++y) { stepped[y * 48 + 22] = stepped[y * 48 + 24] = {}; }
    CHECK(errorsOf(stepped)[1] < 1e-24);
}

TEST_CASE("expected errors of sampling: what alternates from pixel to pixel is lost halfway between two, and not on one") {
    const glm::uvec2 size_px(48, 16);
    const auto errorAt = [&](double inverse_depth, bool across) {
        Picture picture = makePicture(size_px, inverse_depth);
        for (std::size_t i = 0; i < picture.rgba.size(); ++i) { picture.rgba[i].y = (across ? i : i / 48) % 2 == 0 ? 0.55 : 0.45; }
        const EyePair eyes = parallelEyes(size_px);
        const auto arrivals = reproject(picture, eyes, {});
        return expectErrors(resolve(arrivals, eyes, {}), arrivals, picture, std::vector<TileKind>(3, TileKind::kNone), eyes, {})[1];
    };
    // 10 px of disparity at inverse depth 1.
    CHECK(errorAt(0.25, true) == doctest::Approx(256.0 * 0.05 * 0.05 / 3.0));
    CHECK(errorAt(0.225, true) == doctest::Approx(256.0 * 0.05 * 0.05 / 3.0 * 0.75 * 0.75));
    CHECK(errorAt(0.2, true) < 1e-24);
    // Rows stay where they are.
    CHECK(errorAt(0.25, false) == 0.0);
}

TEST_CASE("prices are sixteenths of an octave of error steps a pair, of unmarked tiles with an error") {
    const auto priceOf = [](double steps, std::uint64_t cost) {
        return price(std::vector{TileKind::kNone}, std::vector{steps * 0x1p-20}, std::vector{cost})[0];
    };
    CHECK(priceOf(1.0, 1) == 23 * 16);
    CHECK(priceOf(17.0, 16) == 23 * 16 + 1);
    CHECK(priceOf(33.9, 16) == 24 * 16);
    CHECK(priceOf(34.0, 16) == 24 * 16 + 1);
    CHECK(priceOf(31.0, 16) == 23 * 16 + 15);
    CHECK(priceOf(1.0, 4194303) == 16);
    CHECK(priceOf(1e300, 16) == (23 + 27) * 16 - 1);
    CHECK_FALSE(priceOf(0.999, 16));
    CHECK_FALSE(price(std::vector{TileKind::kEdge}, std::vector{1.0}, std::vector<std::uint64_t>{16})[0]);
}

TEST_CASE("an eye that resolves as much as the picture shows sees all of an error, farther from where it looks less and less") {
    // Pixels of 1/1000: cycles of 2/1000 rad, 0.1146 degrees, which the eye resolves up to (0.1146 - 1/48) / 0.022 = 4.26 degrees.
    const Eye eye{Pose{}, {1000.0, 1000.0, 8.0, 8.0}, {1024, 16}};
    const auto shareAt = [&](double tangent, const reference::Gaze& gaze) {
        return reference::findSeenShares(eye, gaze).at(static_cast<std::size_t>(tangent * 1000.0 / 16.0 + 0.5));
    };
    const reference::Gaze ahead{{0.0, 0.0, 2.0}, 0.0};
    CHECK(shareAt(0.0, ahead) == 1.0);
    CHECK(shareAt(0.064, ahead) == 1.0);  // 3.7 degrees
    CHECK(shareAt(0.08, ahead) < 1.0);    // 4.6 degrees
    const auto law = [](double degrees) { return std::pow(glm::degrees(0.002) / (1.0 / 48.0 + 0.022 * degrees), 2.0); };
    CHECK(shareAt(0.352, ahead) == doctest::Approx(law(glm::degrees(std::atan(0.352)))));
    CHECK(law(19.4) == doctest::Approx(0.0654).epsilon(0.01));
    // It may look up to ten degrees beside it as well.
    CHECK(shareAt(0.352, {{0.0, 0.0, 1.0}, glm::radians(10.0)}) == doctest::Approx(law(glm::degrees(std::atan(0.352)) - 10.0)));
    // It looks there; straight ahead is then as far away.
    CHECK(shareAt(0.352, {{0.352, 0.0, 1.0}, 0.0}) == 1.0);
    CHECK(shareAt(0.0, {{0.352, 0.0, 1.0}, 0.0}) == doctest::Approx(shareAt(0.352, ahead)));
    // Behind the eye.
    CHECK(shareAt(0.0, {{0.0, 0.0, -1.0}, 0.0}) == doctest::Approx(law(180.0)));
}

TEST_CASE("an error is worth what is seen of it, and beside where the eye looks nothing if that is less than a hundredth a pixel") {
    const std::vector<TileKind> kinds(4, TileKind::kNone);
    const std::vector<std::uint64_t> costs(4, 16);
    // 256 pixels of 1/100 squared are 0.0256.
    const auto prices = price(kinds, std::vector{0.4, 0.4, 0.1, 0.1}, costs, std::vector{1.0, 0.25, 0.25, 1.0});
    REQUIRE(prices[0]);
    REQUIRE(prices[1]);
    CHECK(*prices[0] - *prices[1] == 2 * 16);
    CHECK_FALSE(prices[2]);
    CHECK(prices[3]);
    CHECK(price(kinds, std::vector{0.4, 0.4, 0.1, 1e-4}, costs, std::vector(4, 1.0)) ==
          price(kinds, std::vector{0.4, 0.4, 0.1, 1e-4}, costs));
}

using Prices = std::vector<std::optional<std::uint32_t>>;

TEST_CASE("the dearest errors are mended first, in the order of tiles where they are alike, up to what the budget pays for") {
    const Prices prices{5, 9, std::nullopt, 5, 9, 1};
    const std::vector<std::uint64_t> costs{20, 30, 10, 20, 40, 1};
    // What is too dear lets nothing behind it through.
    for (const auto& [budget, expected] :
         {std::pair(0u, "..e..."), std::pair(29u, "..e..."), std::pair(30u, ".pe..."), std::pair(69u, ".pe..."), std::pair(70u, ".pe.p."),
          std::pair(90u, "ppe.p."), std::pair(110u, "ppepp."), std::pair(111u, "ppeppp")}) {
        std::vector<TileKind> kinds(6, TileKind::kNone);
        kinds[2] = TileKind::kEdge;
        select(kinds, prices, costs, budget);
        CHECK(letters(kinds) == expected);
    }
}

TEST_CASE("the budget ends where it would if all errors were seen whole, and what is seen of an error must be worth that") {
    const Prices whole{9, 8, 8, 5, 5, 1};
    const std::vector<std::uint64_t> costs{20, 20, 20, 20, 20, 20};
    const auto chosen = [&](const Prices& seen, std::uint64_t budget) {
        std::vector<TileKind> kinds(6, TileKind::kNone);
        select(kinds, seen, costs, budget, whole);
        return letters(kinds);
    };
    CHECK(chosen(whole, 80) == "pppp..");
    CHECK(chosen({9, 8, 4, 5, 5, 1}, 80) == "pp.p..");  // the third is not replaced by the fifth
    CHECK(chosen({9, 8, 5, 5, 5, 1}, 80) == "pp.p..");  // nor does it take the place of the fourth, which is worth as much
    CHECK(chosen({4, std::nullopt, 4, 5, 4, 1}, 80) == "...p..");
    CHECK(chosen({1, std::nullopt, 1, 1, 1, 1}, 120) == "p.pppp");
    CHECK(chosen({9, 8, 8, 5, 5, 1}, 0) == "......");
}

}  // SUITE(stereo_reference)
