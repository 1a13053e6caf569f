// Facts about pictures as they reach an eye through a lens, and about which of their errors it sees.
#include "app/scores/lens_view.h"
#include "app/scores/visible_errors.h"
#include "tests/engine/picture/pictures.h"

SUITE(lens_view) {

const glm::dvec3 kAhead(0.0, 0.0, 1.0);

// 96 degrees wide and high, and 4 pixels per degree in the middle.
std::array<Eye, 2> wideEyes(double canting_rad = 0.0) {
    const glm::uvec2 size_px(512, 512);
    std::array<Eye, 2> eyes;
    for (const int side : {kLeft, kRight}) {
        const double turn = side == kLeft ? -canting_rad : canting_rad;
        eyes[side] = {
            {glm::angleAxis(turn, glm::dvec3(0.0, 1.0, 0.0)), {side == kLeft ? -0.03 : 0.03, 0.0, 0.0}},
            intrinsicsFromFovX(glm::radians(96.0), size_px),
            size_px};
    }
    return eyes;
}

struct Lens {
    explicit Lens(double canting_rad = 0.0) : view(wideEyes(canting_rad), {kAhead, kAhead}) {
        const glm::uvec2 tiles = view.sizePx() / 16u;
        for (const int side : {kLeft, kRight}) {
            Sight& sight = sights[side];
            sight.rendered_tiles = view.tilesOf(side);
            // Everything within 20 degrees is seen fully, a hundredth of the rest.
            for (unsigned tile = 0; tile < tiles.x * tiles.y; ++tile) {
                const glm::dvec3 direction =
                    view.directionAt(16.0 * (glm::dvec2(tile % tiles.x, tile / tiles.x) + 0.5), side);
                sight.shares.push_back(direction.z > std::cos(glm::radians(20.0)) ? 1.0 : 0.01);
            }
        }
    }
    [[nodiscard]] std::array<Image, 2> show(const Image& left, const Image& right) const {
        return {view.show(asShown(left), kLeft), view.show(asShown(right), kRight)};
    }
    [[nodiscard]] VisibleErrors find(const Image& left, const Image& right, const Image& full) const {
        return findSeenErrors(show(left, right), show(full, full), sights);
    }

    LensView view;
    std::array<Sight, 2> sights;
};

float stripesAt(std::uint32_t x, std::uint32_t y) {
    return (x / 12 % 2 == 0 ? 0.35f : 0.6f) +
           0.05f * std::sin(1.1f * static_cast<float>(x) + 0.9f * static_cast<float>(y));
}

// The stripes, changed where `isThere`.
template <typename Place, typename Change>
Image draw(Place&& isThere, Change&& change) {
    return makePicture({512, 512}, [&](std::uint32_t x, std::uint32_t y) {
        return glm::vec3(isThere(x, y) ? change(x, y) : stripesAt(x, y));
    });
}
bool nowhere(std::uint32_t, std::uint32_t) { return false; }
bool inTheMiddle(std::uint32_t x, std::uint32_t y) { return x >= 224 && x < 288 && y >= 224 && y < 288; }
bool atTheBorder(std::uint32_t x, std::uint32_t y) { return x >= 16 && x < 80 && y >= 224 && y < 288; }
float shifted(std::uint32_t x, std::uint32_t y) { return stripesAt(x + 6, y); }
float brighter(std::uint32_t x, std::uint32_t y) {
    return stripesAt(x, y) + (x / 16 % 2 == 0 ? 0.02f : 0.0f);
}

TEST_CASE_FIXTURE(Lens, "every pixel of the lens's picture is as wide in angle as a flat one in the middle") {
    const double focal_px = wideEyes()[0].intrinsics.fx;
    const glm::dvec2 middle_px = glm::dvec2(view.sizePx()) / 2.0;
    for (const double angle_deg : {0.0, 10.0, 30.0, 47.0}) {
        const double angle_rad = glm::radians(angle_deg);
        const glm::dvec3 there = view.directionAt(middle_px + glm::dvec2(angle_rad * focal_px, 0.0), kLeft);
        CHECK(glm::distance(there, {std::sin(angle_rad), 0.0, std::cos(angle_rad)}) < 1e-9);
        // The solid angle, from the directions of neighbouring pixels in radians.
        const double across = angle_deg > 0.0 ? std::sin(angle_rad) / angle_rad : 1.0;
        CHECK(view.solidAngleAt(middle_px + glm::dvec2(0.0, angle_rad * focal_px)) ==
              doctest::Approx(across / (focal_px * focal_px)));
    }
    // The corners of flat pictures lie beyond the lens's view; the grid's corners show nothing.
    CHECK(view.tilesOf(kLeft).front() == LensView::kNowhere);
}

TEST_CASE_FIXTURE(Lens, "a picture keeps its colours: a pixel is the mean of what it covers") {
    const glm::uvec2 middle = view.sizePx() / 2u;
    const glm::vec3 colour(0.25f, 0.5f, 0.75f);
    const Image flat = view.show(makeFlat({512, 512}, colour, 4), kLeft);
    CHECK(these(flat.channels, colourOf(flat, 0, 0)) == these(3, glm::vec3(0.0f)));
    for (const std::uint32_t y : {middle.y, 20u}) {
        CHECK(glm::length(colourOf(flat, middle.x, y) - colour) < 1e-6f);
    }
    // At 45 degrees, 256 * tan(45) / tan(48) = 230 pixels of the flat picture from its middle.
    const auto columns = [&](const auto& grey) {
        return view.show(
            makePicture({512, 512}, [&](std::uint32_t x, std::uint32_t) { return glm::vec3(grey(x)); }),
            kLeft);
    };
    const Image ramp = columns([](std::uint32_t x) { return static_cast<float>(x) / 512.0f; });
    const double focal_px = wideEyes()[0].intrinsics.fx;
    for (const double angle_deg : {-45.0, -20.0, 20.0, 45.0}) {
        const auto at = static_cast<std::uint32_t>(middle.x + focal_px * glm::radians(angle_deg));
        const double place_px = focal_px * std::tan((at + 0.5 - middle.x) / focal_px);
        CHECK(colourOf(ramp, at, middle.y).x ==
              doctest::Approx(0.5 + (place_px - 0.5) / 512.0).epsilon(0.001));
    }
    // Stripes one pixel wide: little of them is left where a pixel of the lens covers two of them.
    const Image fine = columns([](std::uint32_t x) { return x % 2 == 0 ? 0.0f : 1.0f; });
    const auto contrastFrom = [&](std::uint32_t first) {
        double sum = 0.0;
        for (std::uint32_t x = first; x < first + 16; ++x) {
            sum += std::abs(colourOf(fine, x, middle.y).x - 0.5) / 16;
        }
        return sum;
    };
    CHECK(contrastFrom(middle.x) > 0.4);
    CHECK(contrastFrom(middle.x + static_cast<std::uint32_t>(focal_px * glm::radians(45.0)) - 8) < 0.2);
    CHECK_THROWS_AS(view.show(makeGrey({512, 511}, 3, 0.5f), kLeft), Error);
}

TEST_CASE_FIXTURE(Lens, "of equal pictures nothing is seen, whatever lies beyond the lens's border") {
    const Image full = draw(nowhere, shifted);
    const VisibleErrors none = find(full, full, full);
    REQUIRE(!none.tile_squares.empty());
    CHECK(std::ranges::max(none.tile_squares) == 0.0f);
    CHECK(these(none.badShare(), none.edge, none.seam, none.rival) == these(0.0, 0.0, 0.0, 0.0));
    CHECK(worstTiles(none.tile_squares, 0.001) == 0.0);
}

TEST_CASE_FIXTURE(Lens, "an edge that is off is seen in the middle, at the border not, nor what is faint") {
    const Image full = draw(nowhere, shifted), middle = draw(inTheMiddle, shifted);
    const auto seen = [&](const Image& picture) { return find(picture, picture, full); };
    CHECK(seen(middle).edge > 0.5 * findVisibleErrors({middle, middle}, {full, full}).edge);
    CHECK(seen(draw(atTheBorder, shifted)).edge == 0.0);
    // Less than a hundredth of this contrast is left there, so nobody notices it.
    const auto faint = [](std::uint32_t x, std::uint32_t y) { return stripesAt(x, y) + 0.02f; };
    CHECK(worstTiles(seen(draw(atTheBorder, faint)).tile_squares, 0.001) == 0.0);
    CHECK(worstTiles(seen(draw(inTheMiddle, faint)).tile_squares, 0.001) > 1e-4);
}

TEST_CASE_FIXTURE(Lens, "steps between rendered tiles are seen where these meet, and less at the border") {
    const Image full = draw(nowhere, brighter), middle = draw(inTheMiddle, brighter),
                border = draw(atTheBorder, brighter);
    const double seam_middle = find(middle, middle, full).seam, seam_border = find(border, border, full).seam;
    CHECK(seam_middle > 5e-5);
    CHECK(std::abs(seam_border) < 0.2 * seam_middle);
    // The same steps inside tiles are not seams.
    const auto moved = [](std::uint32_t x, std::uint32_t y) {
        return brighter(x + 8, y) - stripesAt(x + 8, y) + stripesAt(x, y);
    };
    const Image within = draw(
        [](std::uint32_t x, std::uint32_t y) { return x >= 232 && x < 280 && y >= 232 && y < 280; }, moved);
    CHECK(find(within, within, full).seam < 0.0);
    // Nor is an error that is the same everywhere, even though its steps are seen a hundred times less
    // towards the border, where tiles are small.
    const Image noisy = makePicture({512, 512}, [&](std::uint32_t x, std::uint32_t y) {
        return glm::vec3(brighter(x, y) + ((x * 7919 + y * 104729) % 101 < 50 ? 0.04f : -0.04f));
    });
    CHECK(std::abs(find(noisy, noisy, full).seam) < 0.01 * 0.04);
}

TEST_CASE("blur in one eye alone is rivalry, in both eyes none, and canted eyes look at the same") {
    for (const double canting_deg : {0.0, 5.0}) {
        const Lens lens(glm::radians(canting_deg));
        const auto blurred = [](std::uint32_t x, std::uint32_t y) {
            return 0.5f + 0.3f * (stripesAt(x, y) - 0.5f);
        };
        const Image full = draw(nowhere, blurred), middle = draw(inTheMiddle, blurred),
                    border = draw(atTheBorder, blurred);
        const double one = lens.find(middle, full, full).rival;
        CHECK(one > 0.1);
        CHECK(lens.find(border, full, full).rival < 0.2 * one);
        if (canting_deg == 0.0) { CHECK(lens.find(middle, middle, full).rival == 0.0); }
        // What lies far ahead is in the middle of both eyes.
        const glm::dvec2 middle_px = glm::dvec2(lens.view.sizePx()) / 2.0;
        for (const int side : {kLeft, kRight}) {
            const glm::dvec3 ahead =
                glm::mat3_cast(wideEyes(glm::radians(canting_deg))[side].world_from_camera.orientation) *
                lens.view.directionAt(middle_px, side);
            CHECK(glm::length(ahead - kAhead) < 1e-9);
        }
        const Image other = draw(inTheMiddle, shifted);
        CHECK(lens.find(other, full, full).badShare() > 0.0);
    }
}

TEST_CASE_FIXTURE(Lens, "lenses that have no middle, and sights of another size, are refused") {
    std::array<Eye, 2> eyes = wideEyes();
    CHECK_THROWS_AS(LensView(eyes, {kAhead, -kAhead}), Error);
    eyes[1].world_from_camera.orientation = glm::angleAxis(3.14159265, kAhead);
    CHECK_THROWS_AS(LensView(eyes, {kAhead, kAhead}), Error);
    const Image full = draw(nowhere, shifted);
    CHECK_THROWS_AS(findSeenErrors({full, full}, {full, full}, sights), Error);
}

}  // SUITE(lens_view)
