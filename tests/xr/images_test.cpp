// Facts about copies of images that a headset's runtime or a window shows.
#include "xr/images.h"
#include "tests/engine/gpu/device_image.h"

SUITE(images) {

TEST_CASE_FIXTURE(Gpu, "smaller copies of a picture are the mean of its light, down to a single pixel") {
    constexpr glm::uvec2 kSize(8, 4);
    constexpr std::uint32_t kLevels = 4;
    REQUIRE(canMakeMips(context(), DeviceImage::kFormat));
    const DeviceImage image(context(), kSize, DeviceImage::kFormat, kLevels);
    // Black and white alternate on the left; on the right everything is white.
    std::vector<std::uint32_t> texels;
    for (std::uint32_t i = 0; i < kSize.x * kSize.y; ++i) {
        const std::uint32_t x = i % kSize.x, y = i / kSize.x;
        texels.push_back(x < 4 && (x + y) % 2 == 0 ? 0xff000000u : 0xffffffffu);
    }
    const Buffer in = upload("picture", texels), out = allocate<std::uint32_t>("smallest", 1 + 2);
    run([&](Commands& commands) {
        commands.copyToImage(in, *image.image, kSize, vk::ImageAspectFlagBits::eColor);
        makeMips(commands.buffer(), *image.image, kSize, kLevels);
        image.copyLevel(commands, 2, {2, 1}, out, 0);
        image.copyLevel(commands, 3, {1, 1}, out, 2 * sizeof(std::uint32_t));
    });
    const std::vector<std::uint32_t> small = readBack<std::uint32_t>(out, 3);
    const auto isNear = [](std::uint32_t texel, int grey) {
        return std::abs(static_cast<int>(texel & 255) - grey) <= 2;
    };
    // Half and three quarters of white's light, in sRGB.
    CHECK(isNear(small[0], 188));
    CHECK(small[1] == 0xffffffffu);
    CHECK(isNear(small[2], 225));
}

}  // SUITE(images)
