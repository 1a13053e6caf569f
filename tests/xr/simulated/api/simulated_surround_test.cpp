// XR_KHR_composition_layer_cylinder, _equirect2 and _cube on the simulated runtime: what is refused, and that they reach picture and log.
#include "tests/xr/simulated/api/simulated_fixture.h"
#include "tests/xr/simulated/api/simulated_painter.h"
#include "xr/simulated/compose/picture_file.h"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

TEST_SUITE_BEGIN("simulated_surround");

namespace simulated_surround_test {

using namespace binosplat::test;

namespace {

const std::vector<const char*> kExtensions{XR_KHR_COMPOSITION_LAYER_CYLINDER_EXTENSION_NAME,
                                           XR_KHR_COMPOSITION_LAYER_EQUIRECT2_EXTENSION_NAME, XR_KHR_COMPOSITION_LAYER_CUBE_EXTENSION_NAME};
constexpr float kPi = 3.14159265f;
using Texel = std::array<std::uint8_t, 4>;

struct SurroundFixture : SessionFixture {
    Painter painter{*this};
    XrSwapchain picture = XR_NULL_HANDLE, cube_map = XR_NULL_HANDLE;
    XrCompositionLayerCylinderKHR cylinder{XR_TYPE_COMPOSITION_LAYER_CYLINDER_KHR};
    XrCompositionLayerEquirect2KHR sphere{XR_TYPE_COMPOSITION_LAYER_EQUIRECT2_KHR};
    XrCompositionLayerCubeKHR cube{XR_TYPE_COMPOSITION_LAYER_CUBE_KHR};

    explicit SurroundFixture(const std::vector<const char*>& extensions = kExtensions)
        : SessionFixture("size 16 16\nframes from 3 to 99\n", extensions) {
        focus();
        picture = painter.makeSwapchain(VK_FORMAT_R8G8B8A8_SRGB, 4, 4);
        painter.paint(picture, 4, 4, std::vector<Texel>(16, {255, 0, 0, 255}));
        const XrSwapchainSubImage image{picture, {{0, 0}, {4, 4}}, 0};
        cylinder.space = sphere.space = cube.space = local;
        cylinder.subImage = sphere.subImage = image;
        cylinder.pose = sphere.pose = kIdentity;
        cylinder.centralAngle = kPi;
        cylinder.aspectRatio = 1;
        sphere.centralHorizontalAngle = 2 * kPi;
        sphere.upperVerticalAngle = kPi / 2;
        sphere.lowerVerticalAngle = -kPi / 2;
        cube.orientation = {0, 0, 0, 1};
    }
    void makeCube() {
        cube_map = painter.makeSwapchain(VK_FORMAT_R8G8B8A8_SRGB, 4, 4, 1, 6);
        std::vector<Texel> texels(6 * 16, {0, 0, 0, 255});
        std::fill(texels.begin() + 5 * 16, texels.end(), Texel{0, 255, 0, 255});  // -z
        painter.paint(cube_map, 4, 4, texels);
        cube.swapchain = cube_map;
    }
    XrResult shown(const void* layer) const {
        const XrTime time = waitFrame().predictedDisplayTime;
        REQUIRE(xrBeginFrame(session, nullptr) == XR_SUCCESS);
        const XrResult result = endFrame(time, {static_cast<const XrCompositionLayerBaseHeader*>(layer)});
        if (XR_FAILED(result)) REQUIRE(endFrame(time) == XR_SUCCESS);
        return result;
    }
    nlohmann::json lastLogged() const {
        std::ifstream log(written / "frames.jsonl");
        std::string line, last;
        while (std::getline(log, line)) last = line;
        return nlohmann::json::parse(last);
    }
    // In the middle of the left eye's last picture.
    Texel seen() const {
        char name[32];
        std::snprintf(name, sizeof name, "frame_%06d.png", lastLogged()["frame"].get<int>());
        const simulated::RgbPicture both = simulated::readPng(written / name);
        const std::size_t i = 3 * (8 * std::size_t{both.size_px.x} + 8);
        return {both.bytes[i], both.bytes[i + 1], both.bytes[i + 2], 255};
    }
};

struct PlainFixture : SurroundFixture {
    PlainFixture() : SurroundFixture(std::vector<const char*>{}) {}
};

}  // namespace

TEST_CASE_FIXTURE(SurroundFixture, "layers that surround reach the wearer and the log") {
    CHECK(shown(&cylinder) == XR_SUCCESS);
    CHECK(seen() == Texel{255, 0, 0, 255});
    nlohmann::json layer = lastLogged()["layers"][0];
    CHECK(layer["type"] == "cylinder");
    CHECK(layer["central_angle"].get<double>() == doctest::Approx(kPi));
    CHECK(layer["radius"] == 0.0);
    CHECK(layer["eye_visibility"] == "both");
    CHECK(shown(&sphere) == XR_SUCCESS);
    CHECK(seen() == Texel{255, 0, 0, 255});
    layer = lastLogged()["layers"][0];
    CHECK(layer["type"] == "equirect2");
    CHECK(layer["upper_angle"].get<double>() == doctest::Approx(kPi / 2));
    makeCube();
    CHECK(shown(&cube) == XR_SUCCESS);
    CHECK(seen() == Texel{0, 255, 0, 255});
    layer = lastLogged()["layers"][0];
    CHECK(layer["type"] == "cube");
    CHECK(layer["views"][0]["rect"] == nlohmann::json{0, 0, 4, 4});
    cube.orientation = {0, 0.70710678f, 0, 0.70710678f};
    CHECK(shown(&cube) == XR_SUCCESS);
    CHECK(seen() == Texel{0, 0, 0, 255});
}

TEST_CASE_FIXTURE(SurroundFixture,
                  "a frame that is refused stands in the log, with the layer and the value that were wrong, and has no picture") {
    cylinder.centralAngle = 7;
    const XrTime time = waitFrame().predictedDisplayTime;
    REQUIRE(xrBeginFrame(session, nullptr) == XR_SUCCESS);
    const std::vector layers{reinterpret_cast<const XrCompositionLayerBaseHeader*>(&sphere),
                             reinterpret_cast<const XrCompositionLayerBaseHeader*>(&cylinder)};
    CHECK(endFrame(time, layers) == XR_ERROR_VALIDATION_FAILURE);
    const nlohmann::json refused = lastLogged();
    CHECK(refused["refused"] == "XR_ERROR_VALIDATION_FAILURE");
    CHECK(refused["reason"] == "layer 1: the central angle is 7, must be 0 to 2 pi");
    CHECK(refused["session_state"] == "FOCUSED");
    CHECK_FALSE(refused.contains("picture"));
    cylinder.centralAngle = 1;
    CHECK(endFrame(time, layers) == XR_SUCCESS);
    CHECK(lastLogged()["picture"] == "frame_000003.png");
}

TEST_CASE_FIXTURE(SurroundFixture, "cylinders and spheres have angles, radii and pictures") {
    const auto refusedCylinder = [&](auto&& change) {
        XrCompositionLayerCylinderKHR bad = cylinder;
        change(bad);
        return shown(&bad);
    };
    CHECK(refusedCylinder([](auto& bad) { bad.radius = -1; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(refusedCylinder([](auto& bad) { bad.radius = NAN; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(refusedCylinder([](auto& bad) { bad.radius = INFINITY; }) == XR_SUCCESS);
    CHECK(refusedCylinder([](auto& bad) { bad.centralAngle = 7; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(refusedCylinder([](auto& bad) { bad.centralAngle = 0; }) == XR_SUCCESS);
    CHECK(refusedCylinder([](auto& bad) { bad.aspectRatio = 0; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(refusedCylinder([](auto& bad) { bad.pose.orientation.w = 0; }) == XR_ERROR_POSE_INVALID);
    CHECK(refusedCylinder([](auto& bad) { bad.subImage.imageRect.extent.width = 5; }) == XR_ERROR_SWAPCHAIN_RECT_INVALID);
    CHECK(refusedCylinder([](auto& bad) { bad.eyeVisibility = static_cast<XrEyeVisibility>(3); }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(refusedCylinder([](auto& bad) { bad.space = XR_NULL_HANDLE; }) == XR_ERROR_HANDLE_INVALID);
    CHECK(refusedCylinder([](auto& bad) { bad.layerFlags = 1 << 20; }) == XR_ERROR_VALIDATION_FAILURE);
    const auto refusedSphere = [&](auto&& change) {
        XrCompositionLayerEquirect2KHR bad = sphere;
        change(bad);
        return shown(&bad);
    };
    CHECK(refusedSphere([](auto& bad) { bad.radius = -1; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(refusedSphere([](auto& bad) { bad.centralHorizontalAngle = 7; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(refusedSphere([](auto& bad) { bad.upperVerticalAngle = 2; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(refusedSphere([](auto& bad) { bad.lowerVerticalAngle = -2; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(refusedSphere([](auto& bad) { bad.subImage.imageArrayIndex = 1; }) == XR_ERROR_VALIDATION_FAILURE);
}

TEST_CASE_FIXTURE(SurroundFixture, "a cube map is shown as a cube, and a picture as a picture") {
    cube.swapchain = picture;
    CHECK(shown(&cube) == XR_ERROR_LAYER_INVALID);
    makeCube();
    cube.imageArrayIndex = 1;
    CHECK(shown(&cube) == XR_ERROR_VALIDATION_FAILURE);
    cube.imageArrayIndex = 0;
    cube.orientation.w = 0;
    CHECK(shown(&cube) == XR_ERROR_POSE_INVALID);
    cylinder.subImage.swapchain = cube_map;
    CHECK(shown(&cylinder) == XR_ERROR_LAYER_INVALID);
    XrSwapchainCreateInfo info = swapchainInfo();
    info.faceCount = 6;
    XrSwapchain oblong = XR_NULL_HANDLE;
    CHECK(xrCreateSwapchain(session, &info, &oblong) == XR_ERROR_VALIDATION_FAILURE);
    info.height = info.width;
    info.arraySize = 2;
    CHECK(xrCreateSwapchain(session, &info, &oblong) == XR_SUCCESS);
}

TEST_CASE_FIXTURE(PlainFixture, "without their extensions these layers are none, and there are no cube maps") {
    CHECK(shown(&cylinder) == XR_ERROR_LAYER_INVALID);
    CHECK(shown(&sphere) == XR_ERROR_LAYER_INVALID);
    CHECK(shown(&cube) == XR_ERROR_LAYER_INVALID);
    XrSwapchainCreateInfo info = swapchainInfo();
    info.height = info.width;
    info.faceCount = 6;
    XrSwapchain swapchain = XR_NULL_HANDLE;
    CHECK(xrCreateSwapchain(session, &info, &swapchain) == XR_ERROR_FEATURE_UNSUPPORTED);
}

}  // namespace simulated_surround_test
