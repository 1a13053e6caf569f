// Section 10.6 of OpenXR on the simulated runtime: the layers of xrEndFrame, and what of them reaches the wearer's eyes and the log.
#include "tests/xr/simulated/api/simulated_fixture.h"

#include <cmath>
#include <fstream>

TEST_SUITE_BEGIN("simulated_layer");

namespace simulated_layer_test {

using namespace binosplat::test;

namespace {

struct LayersFixture : SessionFixture {
    XrSwapchain colour, depth;
    XrCompositionLayerProjectionView views[2];
    XrCompositionLayerDepthInfoKHR depths[2];
    XrCompositionLayerProjection projection{XR_TYPE_COMPOSITION_LAYER_PROJECTION};
    XrCompositionLayerQuad quad{XR_TYPE_COMPOSITION_LAYER_QUAD};

    explicit LayersFixture(const std::string& script = kQuietScript) : SessionFixture(script) {
        focus();
        colour = makeSwapchain();
        depth = makeSwapchain(VK_FORMAT_D32_SFLOAT);
        turn(colour);
        turn(depth);
        for (int eye = 0; eye < 2; ++eye) {
            depths[eye] = {XR_TYPE_COMPOSITION_LAYER_DEPTH_INFO_KHR, nullptr, {depth, {{0, 0}, {64, 32}}, 0}, 0, 1, 0.1f, 100};
            views[eye] = {XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW,
                          &depths[eye],
                          kIdentity,
                          {-0.8f, 0.8f, 0.8f, -0.8f},
                          {colour, {{0, 0}, {64, 32}}, 0}};
        }
        projection.space = local;
        projection.viewCount = 2;
        projection.views = views;
        quad.space = local;
        quad.subImage = {colour, {{0, 0}, {64, 32}}, 0};
        quad.pose = {{0, 0, 0, 1}, {0, 0, -1}};
        quad.size = {1, 0.5f};
    }

    // Ends a frame with the layer, and then one without any, so that the next call starts anew.
    XrResult shown(const void* layer) const {
        const XrTime time = waitFrame().predictedDisplayTime;
        REQUIRE(xrBeginFrame(session, nullptr) == XR_SUCCESS);
        const XrResult result = endFrame(time, {static_cast<const XrCompositionLayerBaseHeader*>(layer)});
        if (XR_FAILED(result)) REQUIRE(endFrame(time) == XR_SUCCESS);
        return result;
    }
};

struct WritingFixture : LayersFixture {
    WritingFixture() : LayersFixture("size 64 32\nframes from 3 to 9\n") {}
};

}  // namespace

TEST_CASE_FIXTURE(LayersFixture, "good layers are taken") {
    CHECK(shown(&projection) == XR_SUCCESS);
    CHECK(shown(&quad) == XR_SUCCESS);
    CHECK(frame({reinterpret_cast<const XrCompositionLayerBaseHeader*>(&projection),
                 reinterpret_cast<const XrCompositionLayerBaseHeader*>(&quad)})
              .shouldRender == XR_TRUE);
}

TEST_CASE_FIXTURE(LayersFixture, "a layer is of a known type, and there") {
    CHECK(shown(nullptr) == XR_ERROR_LAYER_INVALID);
    quad.type = XR_TYPE_COMPOSITION_LAYER_CUBE_KHR;
    CHECK(shown(&quad) == XR_ERROR_LAYER_INVALID);
    quad.type = XR_TYPE_COMPOSITION_LAYER_QUAD;
    quad.layerFlags = 1 << 20;
    CHECK(shown(&quad) == XR_ERROR_VALIDATION_FAILURE);
    quad.layerFlags = 0;
    quad.space = XR_NULL_HANDLE;
    CHECK(shown(&quad) == XR_ERROR_HANDLE_INVALID);
}

TEST_CASE_FIXTURE(LayersFixture, "there are at most as many layers as the system says") {
    XrSystemProperties properties{XR_TYPE_SYSTEM_PROPERTIES};
    REQUIRE(xrGetSystemProperties(instance, system, &properties) == XR_SUCCESS);
    const std::uint32_t most = properties.graphicsProperties.maxLayerCount;
    std::vector<const XrCompositionLayerBaseHeader*> layers(most, reinterpret_cast<const XrCompositionLayerBaseHeader*>(&quad));
    const XrTime time = waitFrame().predictedDisplayTime;
    REQUIRE(xrBeginFrame(session, nullptr) == XR_SUCCESS);
    layers.push_back(layers.front());
    CHECK(endFrame(time, layers) == XR_ERROR_LAYER_LIMIT_EXCEEDED);
    layers.pop_back();
    const XrFrameEndInfo nothing{XR_TYPE_FRAME_END_INFO, nullptr, time, XR_ENVIRONMENT_BLEND_MODE_OPAQUE, 1, nullptr};
    CHECK(xrEndFrame(session, &nothing) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(endFrame(time, layers) == XR_SUCCESS);
}

TEST_CASE_FIXTURE(LayersFixture, "rectangles stay inside their image") {
    const auto withRect = [&](XrRect2Di rect) {
        quad.subImage.imageRect = rect;
        return shown(&quad);
    };
    CHECK(withRect({{0, 0}, {65, 32}}) == XR_ERROR_SWAPCHAIN_RECT_INVALID);
    CHECK(withRect({{1, 0}, {64, 32}}) == XR_ERROR_SWAPCHAIN_RECT_INVALID);
    CHECK(withRect({{0, 1}, {64, 32}}) == XR_ERROR_SWAPCHAIN_RECT_INVALID);
    CHECK(withRect({{-1, 0}, {32, 32}}) == XR_ERROR_SWAPCHAIN_RECT_INVALID);
    CHECK(withRect({{32, 0}, {-32, 32}}) == XR_ERROR_SWAPCHAIN_RECT_INVALID);
    CHECK(withRect({{1, 0}, {INT32_MAX, 32}}) == XR_ERROR_SWAPCHAIN_RECT_INVALID);
    CHECK(withRect({{63, 31}, {1, 1}}) == XR_SUCCESS);
    // Empty ones reach out nowhere.
    CHECK(withRect({{0, 0}, {0, 32}}) == XR_SUCCESS);
    CHECK(withRect({{64, 32}, {0, 0}}) == XR_SUCCESS);
    CHECK(withRect({{65, 0}, {0, 0}}) == XR_ERROR_SWAPCHAIN_RECT_INVALID);
    CHECK(withRect({{0, 0}, {32, -1}}) == XR_ERROR_SWAPCHAIN_RECT_INVALID);
    quad.subImage.imageRect = {{63, 31}, {1, 1}};
    quad.subImage.imageArrayIndex = 1;
    CHECK(shown(&quad) == XR_ERROR_VALIDATION_FAILURE);
}

TEST_CASE_FIXTURE(LayersFixture, "a swapchain has to have shown an image before") {
    quad.subImage.swapchain = makeSwapchain();
    quad.subImage.imageRect = {{0, 0}, {64, 32}};
    CHECK(shown(&quad) == XR_ERROR_LAYER_INVALID);
    turn(quad.subImage.swapchain);
    CHECK(shown(&quad) == XR_SUCCESS);
    CHECK_MESSAGE(shown(&quad) == XR_SUCCESS, "the last released image stays");
    quad.subImage.swapchain = XR_NULL_HANDLE;
    CHECK(shown(&quad) == XR_ERROR_HANDLE_INVALID);
    quad.subImage.swapchain = depth;
    CHECK(shown(&quad) == XR_ERROR_LAYER_INVALID);
}

TEST_CASE_FIXTURE(LayersFixture, "poses are of length 1 and finite") {
    quad.pose.orientation.w = 0;
    CHECK(shown(&quad) == XR_ERROR_POSE_INVALID);
    views[1].pose.orientation = {1, 1, 0, 0};
    CHECK(shown(&projection) == XR_ERROR_POSE_INVALID);
}

TEST_CASE_FIXTURE(LayersFixture, "a projection layer has a view for each eye") {
    projection.viewCount = 1;
    CHECK(shown(&projection) == XR_ERROR_VALIDATION_FAILURE);
    projection.viewCount = 3;
    CHECK(shown(&projection) == XR_ERROR_VALIDATION_FAILURE);
    projection.viewCount = 2;
    projection.views = nullptr;
    CHECK(shown(&projection) == XR_ERROR_VALIDATION_FAILURE);
    projection.views = views;
    views[0].type = XR_TYPE_VIEW;
    CHECK(shown(&projection) == XR_ERROR_VALIDATION_FAILURE);
    views[0].type = XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW;
    views[0].fov.angleRight = 1.6f;
    CHECK(shown(&projection) == XR_ERROR_VALIDATION_FAILURE);
}

TEST_CASE_FIXTURE(LayersFixture, "a quad is seen by some eye") {
    quad.eyeVisibility = static_cast<XrEyeVisibility>(3);
    CHECK(shown(&quad) == XR_ERROR_VALIDATION_FAILURE);
    quad.eyeVisibility = XR_EYE_VISIBILITY_RIGHT;
    CHECK(shown(&quad) == XR_SUCCESS);
}

TEST_CASE_FIXTURE(LayersFixture, "a quad may be a line or a point, but not inside out") {
    quad.size = {0, 0};
    CHECK(shown(&quad) == XR_SUCCESS);
    quad.size = {1, 0};
    CHECK(shown(&quad) == XR_SUCCESS);
    quad.size = {1, -1};
    CHECK(shown(&quad) == XR_ERROR_VALIDATION_FAILURE);
    quad.size = {NAN, 1};
    CHECK(shown(&quad) == XR_ERROR_VALIDATION_FAILURE);
}

TEST_CASE_FIXTURE(LayersFixture, "depth is checked as colour is") {
    depths[0].subImage.imageRect.extent.width = 65;
    CHECK(shown(&projection) == XR_ERROR_SWAPCHAIN_RECT_INVALID);
    depths[0].subImage.imageRect.extent.width = 64;
    depths[0].minDepth = -0.5f;
    CHECK(shown(&projection) == XR_ERROR_VALIDATION_FAILURE);
    depths[0].minDepth = 0;
    depths[0].maxDepth = 2;
    CHECK(shown(&projection) == XR_ERROR_VALIDATION_FAILURE);
    depths[0].maxDepth = 1;
    depths[0].nearZ = depths[0].farZ;
    CHECK(shown(&projection) == XR_ERROR_VALIDATION_FAILURE);
    depths[0].nearZ = 0.1f;
    depths[1].subImage.swapchain = colour;
    CHECK(shown(&projection) == XR_ERROR_LAYER_INVALID);
    depths[1].subImage.swapchain = depth;
    CHECK(shown(&projection) == XR_SUCCESS);
}

TEST_CASE_FIXTURE(WritingFixture, "frames are logged, and pictures written for those with layers") {
    CHECK(shown(&projection) == XR_SUCCESS);
    CHECK(std::filesystem::exists(written / "frame_000003.png"));
    CHECK(!std::filesystem::exists(written / "frame_000002.png"));
    std::ifstream log(written / "frames.jsonl");
    std::string line;
    for (int i = 0; i < 4; ++i) REQUIRE(std::getline(log, line));
    CHECK(line.find("\"projection\"") != std::string::npos);
    CHECK(line.find("VK_FORMAT_R8G8B8A8_SRGB") != std::string::npos);
    CHECK(line.find("VK_FORMAT_D32_SFLOAT") != std::string::npos);
    CHECK(line.find("\"LOCAL\"") != std::string::npos);
    CHECK(!std::getline(log, line));
}

TEST_CASE_FIXTURE(WritingFixture, "a layer of which no pixel is chosen is logged, and the picture is written without it") {
    for (XrCompositionLayerProjectionView& view : views) view.subImage.imageRect = {{0, 0}, {0, 0}};
    CHECK(shown(&projection) == XR_SUCCESS);
    CHECK(std::filesystem::exists(written / "frame_000003.png"));
}

TEST_CASE_FIXTURE(WritingFixture, "what is on show stays on show while the application holds every image") {
    REQUIRE(shown(&projection) == XR_SUCCESS);
    turn(colour);
    for (int i = 0; i < 3; ++i) {
        std::uint32_t index = 0;
        REQUIRE(xrAcquireSwapchainImage(colour, nullptr, &index) == XR_SUCCESS);
    }
    CHECK(shown(&projection) == XR_SUCCESS);
    CHECK(std::filesystem::exists(written / "frame_000004.png"));
}

}  // namespace simulated_layer_test
