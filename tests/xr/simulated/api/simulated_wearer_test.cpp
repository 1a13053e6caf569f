// Facts about the way from an application's swapchain images through the runtime to the wearer's eyes, pixel by pixel.
#include "tests/xr/simulated/api/simulated_painter.h"
#include "xr/simulated/compose/compose.h"
#include "xr/simulated/compose/picture_file.h"

#include <glm/gtc/packing.hpp>

#include <cmath>
#include <set>

TEST_SUITE_BEGIN("simulated_wearer");

namespace simulated_wearer_test {

using namespace binosplat::test;
using simulated::kLeft;
using simulated::kRight;

namespace {

using Bytes4 = std::array<std::uint8_t, 4>;
using Halves4 = std::array<std::uint16_t, 4>;
using Rgb = std::array<int, 3>;

constexpr float kEighthTurn = 0.78539816f;
constexpr XrFovf kSquare{-kEighthTurn, kEighthTurn, kEighthTurn, -kEighthTurn};  // tangents -1 to 1
constexpr Bytes4 kRed{255, 0, 0, 255}, kGreen{0, 255, 0, 255}, kBlue{0, 0, 255, 255}, kWhite{255, 255, 255, 255};
constexpr Rgb kBlackSeen{0, 0, 0}, kRedSeen{255, 0, 0}, kGreenSeen{0, 255, 0}, kBlueSeen{0, 0, 255};

int encoded(double linear) { return static_cast<int>(std::lround(255.0 * simulated::encodeSrgb(linear))); }

// Eyes at one place, looking from where the script says; the last picture that was written is read back.
struct Wearer : SessionFixture {
    Painter painter{*this};

    explicit Wearer(const std::string& script = "") : SessionFixture("rate 100\nsize 4 4\nipd 0\n" + script) { focus(); }

    // All four texels of a quad that covers the view from 1 m.
    [[nodiscard]] XrCompositionLayerQuad quadOf(XrSwapchain swapchain, std::int32_t side = 2) const {
        XrCompositionLayerQuad quad{XR_TYPE_COMPOSITION_LAYER_QUAD};
        quad.space = local;
        quad.eyeVisibility = XR_EYE_VISIBILITY_BOTH;
        quad.subImage = {swapchain, {{0, 0}, {side, side}}, 0};
        quad.pose = {{0, 0, 0, 1}, {0, 0, -1}};
        quad.size = {2, 2};
        return quad;
    }
    [[nodiscard]] XrSwapchain plain(const Bytes4& colour) const {
        const XrSwapchain swapchain = painter.makeSwapchain(VK_FORMAT_R8G8B8A8_SRGB, 2, 2);
        painter.paint(swapchain, 2, 2, std::vector<Bytes4>(4, colour));
        return swapchain;
    }

    simulated::RgbPicture show(const std::vector<const void*>& layers) const {
        std::vector<const XrCompositionLayerBaseHeader*> headers;
        for (const void* layer : layers) { headers.push_back(static_cast<const XrCompositionLayerBaseHeader*>(layer)); }
        frame(headers);
        std::set<std::filesystem::path> files;
        for (const auto& entry : std::filesystem::directory_iterator(written)) {
            if (entry.path().extension() == ".png") { files.insert(entry.path()); }
        }
        REQUIRE(!files.empty());
        return simulated::readPng(*files.rbegin());
    }
};

Rgb at(const simulated::RgbPicture& both, simulated::Side side, std::uint32_t x, std::uint32_t y) {
    const std::size_t i = 3 * (std::size_t{y} * both.size_px.x + x + side * both.size_px.x / 2);
    return {both.bytes[i], both.bytes[i + 1], both.bytes[i + 2]};
}

struct Resting : Wearer {
    Resting() : Wearer() {}
};
// Three frames pass until the session has the focus: by then the head has turned.
struct LooksLeft : Wearer {
    LooksLeft() : Wearer("head 0 turn 0 0\nhead 0.01 turn 90 0\n") {}
};
struct LooksLittleLeft : Wearer {
    LooksLittleLeft() : Wearer("head 0 turn 0 0\nhead 0.01 turn 26.565051177 0\n") {}  // atan(1/2)
};

}  // namespace

TEST_CASE_FIXTURE(Resting, "every 8-bit format comes through, encoded as its format says") {
    const std::vector<Bytes4> texels{{200, 100, 50, 255}, {1, 2, 3, 255}, {0, 128, 255, 0}, {77, 88, 99, 128}};
    struct Case {
        VkFormat format;
        bool is_bgr, is_linear;
    };
    for (const Case& one : {Case{VK_FORMAT_R8G8B8A8_SRGB, false, false}, Case{VK_FORMAT_B8G8R8A8_SRGB, true, false},
                            Case{VK_FORMAT_R8G8B8A8_UNORM, false, true}, Case{VK_FORMAT_B8G8R8A8_UNORM, true, true}}) {
        CAPTURE(one.format);
        const XrSwapchain swapchain = painter.makeSwapchain(one.format, 2, 2);
        painter.paint(swapchain, 2, 2, texels);
        const XrCompositionLayerQuad quad = quadOf(swapchain);
        const simulated::RgbPicture seen = show({&quad});
        // Of 4 x 4 pixels the outermost look past the texels' centres: their corners show one texel alone.
        for (std::uint32_t corner = 0; corner < 4; ++corner) {
            const Bytes4& texel = texels[corner];
            const auto value = [&](std::size_t channel) { return one.is_linear ? encoded(texel[channel] / 255.0) : int{texel[channel]}; };
            const Rgb expected{value(one.is_bgr ? 2 : 0), value(1), value(one.is_bgr ? 0 : 2)};
            for (const simulated::Side side : simulated::kSides) { CHECK(at(seen, side, corner % 2 * 3, corner / 2 * 3) == expected); }
        }
    }
}

TEST_CASE_FIXTURE(Resting, "half floats come through as light") {
    const XrSwapchain swapchain = painter.makeSwapchain(VK_FORMAT_R16G16B16A16_SFLOAT, 2, 2);
    painter.paint(
        swapchain, 2, 2,
        std::vector<Halves4>(4, {glm::packHalf1x16(0.25f), glm::packHalf1x16(0.5f), glm::packHalf1x16(3.0f), glm::packHalf1x16(1.0f)}));
    const XrCompositionLayerQuad quad = quadOf(swapchain);
    CHECK(at(show({&quad}), kLeft, 1, 1) == Rgb{encoded(0.25), encoded(0.5), 255});
}

TEST_CASE_FIXTURE(Resting, "each eye gets its array layer and its rectangle") {
    // Two layers of 4 x 2: the left half of the first is red, the right half of the second is green, the rest is white.
    const XrSwapchain swapchain = painter.makeSwapchain(VK_FORMAT_R8G8B8A8_SRGB, 4, 2, 2);
    std::vector<Bytes4> texels(16, kWhite);
    for (const std::size_t row : {0u, 1u}) {
        texels[4 * row] = texels[4 * row + 1] = kRed;
        texels[8 + 4 * row + 2] = texels[8 + 4 * row + 3] = kGreen;
    }
    painter.paint(swapchain, 4, 2, texels);
    const std::array<XrCompositionLayerProjectionView, 2> views{
        {{XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW, nullptr, kIdentity, kSquare, {swapchain, {{0, 0}, {2, 2}}, 0}},
         {XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW, nullptr, kIdentity, kSquare, {swapchain, {{2, 0}, {2, 2}}, 1}}}};
    const XrCompositionLayerProjection projection{XR_TYPE_COMPOSITION_LAYER_PROJECTION, nullptr, 0, local, 2, views.data()};
    const simulated::RgbPicture seen = show({&projection});
    for (std::uint32_t i = 0; i < 16; ++i) {
        CHECK(at(seen, kLeft, i % 4, i / 4) == kRedSeen);
        CHECK(at(seen, kRight, i % 4, i / 4) == kGreenSeen);
    }
}

TEST_CASE_FIXTURE(Resting, "what is seen is the image released last, not the one being drawn") {
    const XrSwapchain swapchain = painter.makeSwapchain(VK_FORMAT_R8G8B8A8_SRGB, 2, 2);
    painter.paint(swapchain, 2, 2, std::vector<Bytes4>(4, kRed));
    const XrCompositionLayerQuad quad = quadOf(swapchain);
    CHECK(at(show({&quad}), kLeft, 1, 1) == kRedSeen);
    painter.begin(swapchain, 2, 2, std::vector<Bytes4>(4, kBlue));
    CHECK(at(show({&quad}), kLeft, 1, 1) == kRedSeen);
    REQUIRE(xrReleaseSwapchainImage(swapchain, nullptr) == XR_SUCCESS);
    CHECK(at(show({&quad}), kLeft, 1, 1) == kBlueSeen);
}

TEST_CASE_FIXTURE(Resting, "many frames in turn show each its own picture") {
    const XrSwapchain swapchain = painter.makeSwapchain(VK_FORMAT_R8G8B8A8_SRGB, 2, 2);
    const XrCompositionLayerQuad quad = quadOf(swapchain);
    for (int i = 0; i < 8; ++i) {
        const auto grey = static_cast<std::uint8_t>(30 * i);
        painter.paint(swapchain, 2, 2, std::vector<Bytes4>(4, {grey, grey, grey, 255}));
        CHECK(at(show({&quad}), kRight, 2, 2) == Rgb{30 * i, 30 * i, 30 * i});
    }
}

TEST_CASE_FIXTURE(Resting, "layers lie over one another in their order, with their alpha and for their eye") {
    XrCompositionLayerQuad below = quadOf(plain(kBlue)), above = quadOf(plain({255, 255, 255, 128}));
    CHECK(at(show({&below, &above}), kLeft, 0, 0) == Rgb{255, 255, 255});
    above.layerFlags = XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT | XR_COMPOSITION_LAYER_UNPREMULTIPLIED_ALPHA_BIT;
    const int half = encoded(128.0 / 255.0);
    CHECK(at(show({&below, &above}), kLeft, 0, 0) == Rgb{half, half, 255});
    CHECK(at(show({&above, &below}), kLeft, 0, 0) == kBlueSeen);
    above.eyeVisibility = XR_EYE_VISIBILITY_RIGHT;
    const simulated::RgbPicture seen = show({&below, &above});
    CHECK(at(seen, kLeft, 0, 0) == kBlueSeen);
    CHECK(at(seen, kRight, 0, 0) == Rgb{half, half, 255});
}

TEST_CASE_FIXTURE(LooksLeft, "VIEW goes with the head, LOCAL and STAGE stay") {
    XrCompositionLayerQuad quad = quadOf(plain(kGreen));
    CHECK(at(show({&quad}), kLeft, 1, 1) == kBlackSeen);
    quad.space = makeSpace(XR_REFERENCE_SPACE_TYPE_VIEW);
    CHECK(at(show({&quad}), kLeft, 1, 1) == kGreenSeen);
    // A metre to the left of the head, which is at (0, 1.6, 0) in STAGE, turned to face it: +z becomes +x.
    quad.pose = {{0, 0.70710678f, 0, 0.70710678f}, {-1, 0, 0}};
    quad.space = local;
    CHECK(at(show({&quad}), kLeft, 1, 1) == kGreenSeen);
    quad.space = makeSpace(XR_REFERENCE_SPACE_TYPE_STAGE);
    CHECK(at(show({&quad}), kLeft, 1, 1) == kBlackSeen);
    quad.pose.position.y = 1.6f;
    CHECK(at(show({&quad}), kLeft, 1, 1) == kGreenSeen);
}

TEST_CASE_FIXTURE(LooksLittleLeft, "a picture drawn for another pose is turned to where it belongs") {
    // Drawn for a head that looked straight ahead; the head has turned left by atan(1/2). A tangent t of the eye is (t - 1/2) / (1 + t / 2)
    // in the picture. The pixels' middles -3/4, -1/4, 1/4 and 3/4 are at -2, -6/7, -2/9 and 2/11 there: outside, then in columns 0.29, 1.56
    // and 2.36.
    const XrSwapchain swapchain = painter.makeSwapchain(VK_FORMAT_R8G8B8A8_SRGB, 4, 4);
    std::vector<Bytes4> texels;
    for (std::size_t i = 0; i < 16; ++i) { texels.push_back(i % 4 == 0 ? kRed : i % 4 == 1 ? kGreen : kBlue); }
    painter.paint(swapchain, 4, 4, texels);
    std::array<XrCompositionLayerProjectionView, 2> views{};
    views.fill({XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW, nullptr, kIdentity, kSquare, {swapchain, {{0, 0}, {4, 4}}, 0}});
    const XrCompositionLayerProjection projection{XR_TYPE_COMPOSITION_LAYER_PROJECTION, nullptr, 0, local, 2, views.data()};
    const simulated::RgbPicture seen = show({&projection});
    CHECK(at(seen, kLeft, 0, 1) == kBlackSeen);
    CHECK(at(seen, kLeft, 1, 1) == kRedSeen);
    // Texel middles are at 0.5, 1.5 ...: column 1.556 is 1.056 texels from the first, so 94.4 % of green and 5.6 % of blue.
    CHECK(at(seen, kLeft, 2, 1) == Rgb{0, encoded(17.0 / 18.0), encoded(1.0 / 18.0)});
    CHECK(at(seen, kLeft, 3, 1)[0] == 0);
}

}  // namespace simulated_wearer_test
