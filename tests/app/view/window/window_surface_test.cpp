// Facts about which of a display's offers a window accepts.
#include "app/view/window/window_surface.h"
#include "tests/suite.h"

SUITE(window_surface) {

constexpr vk::Extent2D kWindow{1337, 720}, kUnsaid{UINT32_MAX, UINT32_MAX}, kOne{1, 1}, kMost{4096, 4096};

std::optional<vk::Extent2D> extentOf(vk::Extent2D current, vk::Extent2D least, vk::Extent2D most,
                                     vk::Extent2D window = kWindow) {
    vk::SurfaceCapabilitiesKHR able;
    able.currentExtent = current;
    able.minImageExtent = least;
    able.maxImageExtent = most;
    return windowExtent(able, window);
}

TEST_CASE("pictures are as large as the compositor says, else as the window, if it is not put away") {
    CHECK(extentOf({1300, 700}, kOne, kMost) == vk::Extent2D(1300, 700));
    CHECK(extentOf(kUnsaid, kOne, kMost) == kWindow);
    CHECK(extentOf(kUnsaid, kOne, {1024, 4096}) == vk::Extent2D(1024, 720));
    CHECK(extentOf(kUnsaid, {2000, 1}, kMost) == vk::Extent2D(2000, 720));
    // On Wayland, before the window is first shown.
    CHECK(extentOf(kUnsaid, kOne, {0, 0}) == kOne);
    CHECK_FALSE(extentOf({0, 0}, {0, 0}, {0, 0}).has_value());
    CHECK_FALSE(extentOf(kUnsaid, kOne, kMost, {0, 0}).has_value());
}

TEST_CASE("formats that show bytes as they are are taken, eight bits first") {
    using enum vk::Format;
    const auto taken = [](const std::vector<vk::Format>& offered,
                          vk::ColorSpaceKHR space = vk::ColorSpaceKHR::eSrgbNonlinear) {
        std::vector<vk::SurfaceFormatKHR> all;
        for (const vk::Format format : offered) { all.emplace_back(format, space); }
        const auto found = windowFormat(all);
        return found ? std::optional(found->format) : std::nullopt;
    };
    CHECK(taken({eB8G8R8A8Srgb, eB8G8R8A8Unorm}) == eB8G8R8A8Unorm);
    CHECK(taken({eA2B10G10R10UnormPack32, eR8G8B8A8Unorm}) == eR8G8B8A8Unorm);
    CHECK(taken({eA2B10G10R10UnormPack32}) == eA2B10G10R10UnormPack32);
    CHECK(taken({eUndefined}) == eB8G8R8A8Unorm);
    CHECK_FALSE(taken({eB8G8R8A8Srgb}).has_value());
    CHECK_FALSE(taken({eR8G8B8A8Unorm}, vk::ColorSpaceKHR::eExtendedSrgbLinearEXT).has_value());
}

TEST_CASE("a window is opaque where it can be") {
    using Alpha = vk::CompositeAlphaFlagBitsKHR;
    CHECK(windowAlpha(Alpha::eOpaque | Alpha::ePreMultiplied) == Alpha::eOpaque);
    CHECK(windowAlpha(Alpha::ePreMultiplied | Alpha::eInherit) == Alpha::eInherit);
    CHECK(windowAlpha(Alpha::ePostMultiplied) == Alpha::ePostMultiplied);
}

}  // SUITE(window_surface)
