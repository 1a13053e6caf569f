// Facts about the picture that shows how each tile was made.
#include "engine/picture/roi_picture.h"
#include "shaders/shared/constants.h"
#include "tests/engine/picture/pictures.h"

SUITE(roi_picture) {

glm::vec3 tinted(PixelOrigin origin, float grey) {
    return (1.0f - kTintShare) * glm::vec3(grey) + kTintShare * tintOf(origin);
}

bool isAt(const Image& image, std::uint32_t x, std::uint32_t y, const glm::vec3& colour) {
    return glm::length(colourOf(image, x, y) - colour) < 1e-6f;
}

TEST_CASE("tiles are tinted up to their last pixel, and what is reprojected stays as it is") {
    // 3 x 2 tiles over 33 x 17 pixels: the last column and the last row of tiles are one pixel wide.
    const std::vector<std::uint32_t> kinds{gpu::kTileEdge, 0, gpu::kTileCenter, gpu::kTilePredicted, 0, 0};
    const Image picture = makeRoiPicture(makeGrey({33, 17}, 4, 0.5f), kinds, {});
    CHECK(these(picture.channels, picture.size_px) == these(3, glm::uvec2(33, 17)));
    const PixelOrigin plain = PixelOrigin::kReprojected;
    const PixelOrigin origins[] = {PixelOrigin::kEdgeRoi,      plain, PixelOrigin::kCenterRoi,
                                   PixelOrigin::kPredictedRoi, plain, plain};
    for (std::uint32_t i = 0; i < 33 * 17; ++i) {
        const std::uint32_t x = i % 33, y = i / 33;
        const PixelOrigin origin = origins[y / 16 * 3 + x / 16];
        CHECK(isAt(picture, x, y, origin == plain ? glm::vec3(0.5f) : tinted(origin, 0.5f)));
    }
    const Image waves = makeWaves({5, 4}, 0.0);
    CHECK(isAt(makeRoiPicture(waves, {}, {}), 4, 3, colourOf(waves, 4, 3)));
}

TEST_CASE("interpolated pixels are tinted where no tile was rendered again") {
    const std::vector<std::uint32_t> kinds{0, gpu::kTilePredicted};
    std::vector<std::uint8_t> classes(32 * 16, gpu::kCovered);
    classes[0] = gpu::kGap;
    classes[1] = gpu::kHole;
    classes[20] = gpu::kHole;  // in the tile that was rendered again
    const std::vector<std::uint8_t> origins = pixelOrigins({32, 16}, kinds, classes);
    CHECK(origins[0] == static_cast<std::uint8_t>(PixelOrigin::kGap));
    CHECK(origins[1] == static_cast<std::uint8_t>(PixelOrigin::kHole));
    CHECK(origins[2] == static_cast<std::uint8_t>(PixelOrigin::kReprojected));
    CHECK(origins[20] == static_cast<std::uint8_t>(PixelOrigin::kPredictedRoi));
    CHECK(std::ranges::count(origins, static_cast<std::uint8_t>(PixelOrigin::kPredictedRoi)) == 256);
    const Image picture = makeRoiPicture(makeGrey({32, 16}, 3, 0.25f), kinds, classes);
    CHECK(isAt(picture, 0, 0, tinted(PixelOrigin::kGap, 0.25f)));
    CHECK(isAt(picture, 1, 0, tinted(PixelOrigin::kHole, 0.25f)));
}

TEST_CASE("lists that do not fit are refused") {
    const std::vector<std::uint32_t> one_kind{0}, unknown_kind{6};
    const std::vector<std::uint8_t> one_class{gpu::kHole}, unknown_class{3};
    CHECK_THROWS_AS(pixelOrigins({17, 1}, one_kind, {}), Error);
    CHECK_THROWS_AS(pixelOrigins({2, 1}, {}, one_class), Error);
    CHECK_THROWS_AS(pixelOrigins({1, 1}, unknown_kind, {}), Error);
    CHECK_THROWS_AS(pixelOrigins({1, 1}, {}, unknown_class), Error);
    CHECK_THROWS_AS(makeRoiPicture(makeGrey({1, 1}, 1, 0.0f), {}, {}), Error);
    CHECK(pixelOrigins({0, 0}, {}, {}).empty());
}

}  // SUITE(roi_picture)
