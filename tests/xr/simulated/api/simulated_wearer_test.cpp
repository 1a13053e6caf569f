// Facts about how an application's swapchain images get through the runtime to the wearer's eyes, pixel by
// pixel.
#include "tests/xr/simulated/api/simulated_painter.h"

#include <glm/gtc/packing.hpp>

SUITE(simulated_wearer) {

using simulated::kLeft;
using simulated::kRight;

using Halves4 = std::array<std::uint16_t, 4>;

constexpr float kEighthTurn = 0.78539816f;
constexpr XrFovf kSquare{-kEighthTurn, kEighthTurn, kEighthTurn, -kEighthTurn};  // tangents -1 to 1
constexpr Rgba kRed{255, 0, 0, 255}, kGreen{0, 255, 0, 255}, kBlue{0, 0, 255, 255},
    kWhite{255, 255, 255, 255};
constexpr Rgb kBlackSeen{0, 0, 0}, kRedSeen{255, 0, 0}, kGreenSeen{0, 255, 0}, kBlueSeen{0, 0, 255};

int encoded(double linear) { return static_cast<int>(std::lround(255.0 * simulated::encodeSrgb(linear))); }

// Both eyes in the same place, looking where the script says.
struct EyesFixture : Wearer {
    explicit EyesFixture(const std::string& script = "") : Wearer("rate 100\nsize 4 4\nipd 0\n" + script) {
        focus();
    }

    // All four texels of a quad that covers the view.
    [[nodiscard]] XrCompositionLayerQuad quadOf(XrSwapchain swapchain) const {
        return SessionFixture::quadOf(local, {swapchain, {{0, 0}, {2, 2}}, 0}, {2, 2});
    }
    template <class Texel>
    [[nodiscard]] XrSwapchain painted(const std::vector<Texel>& texels, VkFormat format) const {
        const XrSwapchain swapchain = painter.makeSwapchain(format, 2, 2);
        painter.paint(swapchain, 2, 2, texels);
        return swapchain;
    }
    template <class... Layer>
    simulated::RgbPicture see(const Layer&... layers) const {
        frame({headerOf(layers)...});
        return seen();
    }
};

TEST_CASE_FIXTURE(EyesFixture, "every format comes through as it is encoded, and halves as light") {
    const std::vector<Rgba> texels{{200, 100, 50, 255}, {1, 2, 3, 255}, {0, 128, 255, 0}, {77, 88, 99, 128}};
    for (const auto& [format, is_bgr, is_linear] :
         {std::tuple(VK_FORMAT_R8G8B8A8_SRGB, false, false), std::tuple(VK_FORMAT_B8G8R8A8_SRGB, true, false),
          std::tuple(VK_FORMAT_R8G8B8A8_UNORM, false, true),
          std::tuple(VK_FORMAT_B8G8R8A8_UNORM, true, true)}) {
        CAPTURE(format);
        const simulated::RgbPicture seen = see(quadOf(painted(texels, format)));
        // The outermost of 4 x 4 pixels look past the texels' centres, so their corners show a single texel.
        for (std::uint32_t corner = 0; corner < 4; ++corner) {
            Rgb expected{};
            for (std::size_t channel = 0; channel < 3; ++channel) {
                const int value = texels[corner][is_bgr ? 2 - channel : channel];
                expected[channel] = is_linear ? encoded(value / 255.0) : value;
            }
            for (const simulated::Side side : simulated::kSides) {
                CHECK(at(seen, side, corner % 2 * 3, corner / 2 * 3) == expected);
            }
        }
    }
    const auto halves = [](float r, float g, float b) {
        return Halves4{glm::packHalf1x16(r), glm::packHalf1x16(g), glm::packHalf1x16(b),
                       glm::packHalf1x16(1.0f)};
    };
    const Halves4 light = halves(0.25f, 0.5f, 3.0f), odd = halves(-1.0f, NAN, INFINITY);
    const simulated::RgbPicture seen =
        see(quadOf(painted(std::vector<Halves4>{light, odd, light, odd}, VK_FORMAT_R16G16B16A16_SFLOAT)));
    // More than white is white, and NaN is black.
    CHECK(at(seen, kLeft, 0, 0) == Rgb{encoded(0.25), encoded(0.5), 255});
    CHECK(at(seen, kLeft, 3, 3) == Rgb{0, 0, 255});
    // NaN does not spread to what lies beside it, three quarters of the way.
    CHECK(at(seen, kLeft, 1, 1)[1] == encoded(0.75 * 0.5));
}

TEST_CASE_FIXTURE(EyesFixture, "each eye gets its array layer and its rectangle") {
    // Two layers of 4 x 2: the left half of the first is red, the right half of the second is green, the rest
    // is white.
    const XrSwapchain swapchain = painter.makeSwapchain(VK_FORMAT_R8G8B8A8_SRGB, 4, 2, 2);
    std::vector<Rgba> texels(16, kWhite);
    for (const std::size_t row : {0u, 1u}) {
        texels[4 * row] = texels[4 * row + 1] = kRed;
        texels[8 + 4 * row + 2] = texels[8 + 4 * row + 3] = kGreen;
    }
    painter.paint(swapchain, 4, 2, texels);
    const std::array views{projectionView({swapchain, {{0, 0}, {2, 2}}, 0}, kSquare),
                           projectionView({swapchain, {{2, 0}, {2, 2}}, 1}, kSquare)};
    const simulated::RgbPicture seen = see(projectionOf(local, views));
    for (std::uint32_t i = 0; i < 16; ++i) {
        CHECK(at(seen, kLeft, i % 4, i / 4) == kRedSeen);
        CHECK(at(seen, kRight, i % 4, i / 4) == kGreenSeen);
    }
}

TEST_CASE_FIXTURE(EyesFixture, "what is seen is the image released last, not the one being drawn") {
    const XrSwapchain swapchain = plain(2, kRed);
    const XrCompositionLayerQuad quad = quadOf(swapchain);
    CHECK(at(see(quad), kLeft, 1, 1) == kRedSeen);
    painter.begin(swapchain, 2, 2, std::vector<Rgba>(4, kBlue));
    CHECK(at(see(quad), kLeft, 1, 1) == kRedSeen);
    REQUIRE(xrReleaseSwapchainImage(swapchain, nullptr) == XR_SUCCESS);
    CHECK(at(see(quad), kLeft, 1, 1) == kBlueSeen);
    for (int i = 0; i < 8; ++i) {
        const auto grey = static_cast<std::uint8_t>(30 * i);
        painter.paint(swapchain, 2, 2, std::vector<Rgba>(4, {grey, grey, grey, 255}));
        CHECK(at(see(quad), kRight, 2, 2) == Rgb{30 * i, 30 * i, 30 * i});
    }
}

TEST_CASE_FIXTURE(EyesFixture,
                  "layers lie over one another in their order, with their alpha, for their eye") {
    XrCompositionLayerQuad below = quadOf(plain(2, kBlue)), above = quadOf(plain(2, {255, 255, 255, 128}));
    // The order does not depend on depth.
    above.pose.position.z = -2;
    above.size = {4, 4};
    CHECK(at(see(below, above), kLeft, 0, 0) == Rgb{255, 255, 255});
    above.layerFlags =
        XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT | XR_COMPOSITION_LAYER_UNPREMULTIPLIED_ALPHA_BIT;
    const int half = encoded(128.0 / 255.0);
    CHECK(at(see(below, above), kLeft, 0, 0) == Rgb{half, half, 255});
    CHECK(at(see(above, below), kLeft, 0, 0) == kBlueSeen);
    for (const auto side : {kLeft, kRight}) {
        above.eyeVisibility = side == kLeft ? XR_EYE_VISIBILITY_LEFT : XR_EYE_VISIBILITY_RIGHT;
        const auto seen = see(below, above);
        CHECK(at(seen, side, 0, 0) == Rgb{half, half, 255});
        CHECK(at(seen, side == kLeft ? kRight : kLeft, 0, 0) == kBlueSeen);
    }
}

TEST_CASE("VIEW goes with the head, LOCAL and STAGE stay") {
    // Three frames pass until the session has the focus, and by then the head has turned.
    const EyesFixture made("head 0 turn 0 0\nhead 0.01 turn 90 0\n");
    XrCompositionLayerQuad quad = made.quadOf(made.plain(2, kGreen));
    CHECK(at(made.see(quad), kLeft, 1, 1) == kBlackSeen);
    quad.space = made.makeSpace(XR_REFERENCE_SPACE_TYPE_VIEW);
    CHECK(at(made.see(quad), kLeft, 1, 1) == kGreenSeen);
    // A metre to the left of the head, which is at (0, 1.6, 0) in STAGE, turned to face it: +z becomes +x.
    quad.pose = {{0, 0.70710678f, 0, 0.70710678f}, {-1, 0, 0}};
    quad.space = made.local;
    CHECK(at(made.see(quad), kLeft, 1, 1) == kGreenSeen);
    quad.space = made.makeSpace(XR_REFERENCE_SPACE_TYPE_STAGE);
    CHECK(at(made.see(quad), kLeft, 1, 1) == kBlackSeen);
    quad.pose.position.y = 1.6f;
    CHECK(at(made.see(quad), kLeft, 1, 1) == kGreenSeen);
}

TEST_CASE("a picture drawn for another pose is turned to where it belongs") {
    // Drawn for a head that looked straight ahead; since then the head has turned left by atan(1/2). A
    // tangent t of the eye is (t - 1/2) / (1 + t / 2) in the picture. The pixels' middles -3/4, -1/4, 1/4 and
    // 3/4 are at -2, -6/7, -2/9 and 2/11 there: outside, then in columns 0.29, 1.56 and 2.36.
    const EyesFixture made("head 0 turn 0 0\nhead 0.01 turn 26.565051177 0\n");
    const XrSwapchain swapchain = made.painter.makeSwapchain(VK_FORMAT_R8G8B8A8_SRGB, 4, 4);
    std::vector<Rgba> texels;
    for (std::size_t i = 0; i < 16; ++i) {
        texels.push_back(i % 4 == 0 ? kRed : i % 4 == 1 ? kGreen : kBlue);
    }
    made.painter.paint(swapchain, 4, 4, texels);
    std::array<XrCompositionLayerProjectionView, 2> views{};
    views.fill(projectionView({swapchain, {{0, 0}, {4, 4}}, 0}, kSquare));
    const simulated::RgbPicture seen = made.see(projectionOf(made.local, views));
    CHECK(at(seen, kLeft, 0, 1) == kBlackSeen);
    CHECK(at(seen, kLeft, 1, 1) == kRedSeen);
    // Texel middles are at 0.5, 1.5 ...: column 1.556 is 1.056 texels from the first, so 94.4 % green and 5.6
    // % blue.
    CHECK(at(seen, kLeft, 2, 1) == Rgb{0, encoded(17.0 / 18.0), encoded(1.0 / 18.0)});
    CHECK(at(seen, kLeft, 3, 1)[0] == 0);
}

}  // SUITE(simulated_wearer)
