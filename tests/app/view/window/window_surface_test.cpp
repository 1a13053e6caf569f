// Facts about which of a display's offers a window accepts.
#include "app/view/window/window_surface.h"
#include "tests/suite.h"

SUITE(window_surface) {

constexpr vk::Extent2D kWindow{1337, 720};

constexpr vk::Extent2D kUnsaid{UINT32_MAX, UINT32_MAX}, kOne{1, 1}, kMost{4096, 4096};

std::optional<vk::Extent2D> extentOf(vk::Extent2D current, vk::Extent2D least, vk::Extent2D most,
                                     vk::Extent2D window = kWindow) {
    vk::SurfaceCapabilitiesKHR able;
    able.currentExtent = current;
    able.minImageExtent = least;
    able.maxImageExtent = most;
    return windowExtent(able, window);
}

TEST_CASE("pictures are as large as the compositor says, or as the window where it does not") {
    CHECK(extentOf({1300, 700}, kOne, kMost) == vk::Extent2D(1300, 700));
    CHECK(extentOf(kUnsaid, kOne, kMost) == kWindow);
    CHECK(extentOf(kUnsaid, kOne, {1024, 4096}) == vk::Extent2D(1024, 720));
    CHECK(extentOf(kUnsaid, {2000, 1}, kMost) == vk::Extent2D(2000, 720));
    // On Wayland, before the window is first shown.
    CHECK(extentOf(kUnsaid, kOne, {0, 0}) == kOne);
}

TEST_CASE("there is nothing to draw on while the window is put away") {
    CHECK_FALSE(extentOf({0, 0}, {0, 0}, {0, 0}).has_value());
    CHECK_FALSE(extentOf(kUnsaid, kOne, kMost, {0, 0}).has_value());
}

TEST_CASE("formats that show bytes as they are are taken, eight bits first") {
    using Format = vk::Format;
    const auto space = vk::ColorSpaceKHR::eSrgbNonlinear;
    using Offered = std::vector<vk::SurfaceFormatKHR>;
    CHECK(windowFormat(Offered{{Format::eB8G8R8A8Srgb, space}, {Format::eB8G8R8A8Unorm, space}})->format ==
          Format::eB8G8R8A8Unorm);
    CHECK(windowFormat(Offered{{Format::eA2B10G10R10UnormPack32, space}, {Format::eR8G8B8A8Unorm, space}})
              ->format == Format::eR8G8B8A8Unorm);
    CHECK(windowFormat(Offered{{Format::eA2B10G10R10UnormPack32, space}})->format ==
          Format::eA2B10G10R10UnormPack32);
    CHECK_FALSE(windowFormat(Offered{{Format::eB8G8R8A8Srgb, space}}).has_value());
    // Linear light instead of encoded values.
    CHECK_FALSE(windowFormat(Offered{{Format::eR8G8B8A8Unorm, vk::ColorSpaceKHR::eExtendedSrgbLinearEXT}})
                    .has_value());
    CHECK(windowFormat(Offered{{Format::eUndefined, space}})->format == Format::eB8G8R8A8Unorm);
}

TEST_CASE("a window is opaque where it can be") {
    using Alpha = vk::CompositeAlphaFlagBitsKHR;
    CHECK(windowAlpha(Alpha::eOpaque | Alpha::ePreMultiplied) == Alpha::eOpaque);
    CHECK(windowAlpha(Alpha::ePreMultiplied | Alpha::eInherit) == Alpha::eInherit);
    CHECK(windowAlpha(Alpha::ePostMultiplied) == Alpha::ePostMultiplied);
}

}  // SUITE(window_surface)
