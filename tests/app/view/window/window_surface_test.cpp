// Facts about which of a display's offers a window accepts.
#include "app/view/window/window_surface.h"
#include "tests/suite.h"

SUITE(window_surface) {

constexpr vk::Extent2D kWindow{1337, 720};

vk::SurfaceCapabilitiesKHR able(vk::Extent2D current, vk::Extent2D least, vk::Extent2D most) {
    vk::SurfaceCapabilitiesKHR capabilities;
    capabilities.currentExtent = current;
    capabilities.minImageExtent = least;
    capabilities.maxImageExtent = most;
    return capabilities;
}

TEST_CASE("pictures are as large as the compositor says, or as the window where it does not") {
    CHECK(windowExtent(able({1300, 700}, {1, 1}, {4096, 4096}), kWindow) == vk::Extent2D(1300, 700));
    CHECK(windowExtent(able({UINT32_MAX, UINT32_MAX}, {1, 1}, {4096, 4096}), kWindow) == kWindow);
    CHECK(windowExtent(able({UINT32_MAX, UINT32_MAX}, {1, 1}, {1024, 4096}), kWindow) ==
          vk::Extent2D(1024, 720));
    CHECK(windowExtent(able({UINT32_MAX, UINT32_MAX}, {2000, 1}, {4096, 4096}), kWindow) ==
          vk::Extent2D(2000, 720));
    // On Wayland, before the window is first shown.
    CHECK(windowExtent(able({UINT32_MAX, UINT32_MAX}, {1, 1}, {0, 0}), kWindow) == vk::Extent2D(1, 1));
}

TEST_CASE("there is nothing to draw on while the window is put away") {
    CHECK_FALSE(windowExtent(able({0, 0}, {0, 0}, {0, 0}), kWindow).has_value());
    CHECK_FALSE(windowExtent(able({UINT32_MAX, UINT32_MAX}, {1, 1}, {4096, 4096}), {0, 0}).has_value());
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
