// Section 10.6 of OpenXR on the simulated runtime: layers, flat and curved, and what reaches the eyes and the
// log.
#include "tests/xr/simulated/api/simulated_painter.h"

SUITE(simulated_layer) {

using Json = nlohmann::json;

constexpr float kPi = 3.14159265f;
constexpr auto kNotValid = XR_ERROR_VALIDATION_FAILURE;
constexpr Rgb kBlack{0, 0, 0}, kRed{255, 0, 0}, kGreen{0, 255, 0};
const Extensions kExtensions{XR_KHR_COMPOSITION_LAYER_CYLINDER_EXTENSION_NAME,
                             XR_KHR_COMPOSITION_LAYER_EQUIRECT2_EXTENSION_NAME,
                             XR_KHR_COMPOSITION_LAYER_CUBE_EXTENSION_NAME};

struct FlatFixture : SessionFixture {
    XrSwapchain colour, depth;
    std::array<XrCompositionLayerProjectionView, 2> views;
    XrCompositionLayerDepthInfoKHR depths[2];
    XrCompositionLayerProjection projection = projectionOf(local, views);
    XrCompositionLayerQuad quad;

    explicit FlatFixture(const std::string& script = kQuietScript) : SessionFixture(script) {
        focus();
        colour = makeSwapchain();
        depth = makeSwapchain(swapchainInfo(VK_FORMAT_D32_SFLOAT));
        turn(colour);
        turn(depth);
        const XrRect2Di whole{{0, 0}, {64, 32}};
        for (std::size_t eye = 0; eye < 2; ++eye) {
            depths[eye] = {
                XR_TYPE_COMPOSITION_LAYER_DEPTH_INFO_KHR, nullptr, {depth, whole, 0}, 0, 1, 0.1f, 100};
            views[eye] = projectionView({colour, whole, 0}, {-0.8f, 0.8f, 0.8f, -0.8f});
            views[eye].next = &depths[eye];
        }
        quad = quadOf(local, {colour, whole, 0}, {1, 0.5f});
    }
};

struct SurroundFixture : Wearer {
    XrSwapchain picture = XR_NULL_HANDLE;
    XrCompositionLayerCylinderKHR cylinder{XR_TYPE_COMPOSITION_LAYER_CYLINDER_KHR};
    XrCompositionLayerEquirect2KHR sphere{XR_TYPE_COMPOSITION_LAYER_EQUIRECT2_KHR};
    XrCompositionLayerCubeKHR cube{XR_TYPE_COMPOSITION_LAYER_CUBE_KHR};

    explicit SurroundFixture(const Extensions& extensions = kExtensions, const std::string& more = {})
        : Wearer("size 16 16\nframes from 3 to 99\n" + more, extensions) {
        focus();
        picture = plain(4, {255, 0, 0, 255});
        cylinder.space = sphere.space = cube.space = local;
        cylinder.subImage = sphere.subImage = {picture, {{0, 0}, {4, 4}}, 0};
        cylinder.pose = sphere.pose = kIdentity;
        cylinder.centralAngle = kPi;
        cylinder.aspectRatio = 1;
        sphere.centralHorizontalAngle = 2 * kPi;
        sphere.upperVerticalAngle = kPi / 2;
        sphere.lowerVerticalAngle = -kPi / 2;
        cube.orientation = {0, 0, 0, 1};
    }
    void makeCube() {
        cube.swapchain = painter.makeSwapchain(VK_FORMAT_R8G8B8A8_SRGB, 4, 4, 1, 6);
        std::vector<Rgba> texels(6 * 16, {0, 0, 0, 255});
        std::fill(texels.begin() + 5 * 16, texels.end(), Rgba{0, 255, 0, 255});  // -z
        painter.paint(cube.swapchain, 4, 4, texels);
    }
    // In the middle of the left eye's last picture.
    Rgb middle() const { return at(seen(), 8, 8); }
};

TEST_CASE("the room is a layer, seen while neither it nor its passthrough is paused") {
    const SurroundFixture room({XR_FB_PASSTHROUGH_EXTENSION_NAME}, "passthrough on\nroom-colour 0 1 0\n");
    const auto create = room.XR(xrCreatePassthroughFB);
    XrPassthroughCreateInfoFB info{XR_TYPE_PASSTHROUGH_CREATE_INFO_FB};
    XrPassthroughFB passthrough = XR_NULL_HANDLE, second = XR_NULL_HANDLE;
    CHECK(create(room.session, &info, &passthrough) == XR_SUCCESS);
    CHECK(create(room.session, &info, &second) == XR_ERROR_FEATURE_ALREADY_CREATED_PASSTHROUGH_FB);
    XrPassthroughLayerCreateInfoFB of_layer{XR_TYPE_PASSTHROUGH_LAYER_CREATE_INFO_FB, nullptr, passthrough,
                                            XR_PASSTHROUGH_IS_RUNNING_AT_CREATION_BIT_FB,
                                            XR_PASSTHROUGH_LAYER_PURPOSE_PROJECTED_FB};
    XrCompositionLayerPassthroughFB layer{XR_TYPE_COMPOSITION_LAYER_PASSTHROUGH_FB};
    const auto create_layer = room.XR(xrCreatePassthroughLayerFB);
    CHECK(create_layer(room.session, &of_layer, &layer.layerHandle) == XR_ERROR_FEATURE_UNSUPPORTED);
    of_layer.purpose = XR_PASSTHROUGH_LAYER_PURPOSE_RECONSTRUCTION_FB;
    CHECK(create_layer(room.session, &of_layer, &layer.layerHandle) == XR_SUCCESS);
    const auto seenAfter = [&](XrResult call) {
        checkEach(XR_SUCCESS, {call, room.show(&layer)});
        return room.middle();
    };
    CHECK(seenAfter(XR_SUCCESS) == kBlack);
    CHECK(seenAfter(room.XR(xrPassthroughStartFB)(passthrough)) == kGreen);
    CHECK(seenAfter(room.XR(xrPassthroughLayerPauseFB)(layer.layerHandle)) == kBlack);
    CHECK(seenAfter(room.XR(xrPassthroughLayerResumeFB)(layer.layerHandle)) == kGreen);
    CHECK(room.XR(xrDestroyPassthroughLayerFB)(layer.layerHandle) == XR_SUCCESS);
    CHECK(room.show(&layer) == XR_ERROR_HANDLE_INVALID);
}

TEST_CASE_FIXTURE(FlatFixture, "layers are of a known type, some eye's, and as many as the system says") {
    const auto showQuad = [&] { return show(&quad); };
    const auto showViews = [&] { return show(&projection); };
    checkEach(XR_SUCCESS, {showViews(), showQuad()});
    CHECK(frame({headerOf(projection), headerOf(quad)}).shouldRender == XR_TRUE);
    checkEach(XR_ERROR_LAYER_INVALID,
              {show(nullptr), with(quad.type, XR_TYPE_COMPOSITION_LAYER_CUBE_KHR, showQuad)});
    CHECK(with(quad.space, XR_NULL_HANDLE, showQuad) == XR_ERROR_HANDLE_INVALID);
    CHECK(with(quad.pose.orientation.w, 0, showQuad) == XR_ERROR_POSE_INVALID);
    // It may be a line or a point, but not negative.
    checkChanges(showQuad, XR_SUCCESS, to(quad.size, {0, 0}), to(quad.size, {1, 0}),
                 to(quad.eyeVisibility, XR_EYE_VISIBILITY_RIGHT));
    checkChanges(showQuad, kNotValid, to(quad.size, {1, -1}), to(quad.size, {NAN, 1}),
                 to(quad.layerFlags, 1 << 20), to(quad.eyeVisibility, static_cast<XrEyeVisibility>(3)));
    // A view for each eye.
    checkChanges(showViews, kNotValid, to(projection.viewCount, 1), to(projection.viewCount, 3),
                 to(projection.views, nullptr), to(views[0].type, XR_TYPE_VIEW),
                 to(views[0].fov.angleRight, 1.6f));
    CHECK(with(views[1].pose.orientation, {1, 1, 0, 0}, showViews) == XR_ERROR_POSE_INVALID);
    // Depth is checked like colour.
    CHECK(with(depths[0].subImage.imageRect.extent.width, 65, showViews) == XR_ERROR_SWAPCHAIN_RECT_INVALID);
    checkChanges(showViews, kNotValid, to(depths[0].minDepth, -0.5f), to(depths[0].maxDepth, 2),
                 to(depths[0].nearZ, depths[0].farZ));
    CHECK(with(depths[1].subImage.swapchain, colour, showViews) == XR_ERROR_LAYER_INVALID);
    CHECK(showViews() == XR_SUCCESS);

    Layers layers(systemProperties().graphicsProperties.maxLayerCount + 1, headerOf(quad));
    const XrTime time = waitFrame().predictedDisplayTime;
    REQUIRE(xrBeginFrame(session, nullptr) == XR_SUCCESS);
    CHECK(endFrame(time, layers) == XR_ERROR_LAYER_LIMIT_EXCEEDED);
    layers.pop_back();
    const XrFrameEndInfo nothing{XR_TYPE_FRAME_END_INFO, nullptr, time, XR_ENVIRONMENT_BLEND_MODE_OPAQUE, 1};
    CHECK(xrEndFrame(session, &nothing) == kNotValid);
    CHECK(endFrame(time, layers) == XR_SUCCESS);
}

TEST_CASE_FIXTURE(FlatFixture, "rectangles stay inside their image, of a swapchain that has shown one") {
    const auto showQuad = [&] { return show(&quad); };
    for (const XrRect2Di& outside :
         {XrRect2Di{{0, 0}, {65, 32}}, XrRect2Di{{1, 0}, {64, 32}}, XrRect2Di{{0, 1}, {64, 32}},
          XrRect2Di{{-1, 0}, {32, 32}}, XrRect2Di{{32, 0}, {-32, 32}}, XrRect2Di{{1, 0}, {INT32_MAX, 32}},
          XrRect2Di{{65, 0}, {0, 0}}, XrRect2Di{{0, 0}, {32, -1}}}) {
        INFO("outside.offset.x ", outside.offset.x, ", outside.extent.width ", outside.extent.width);
        CHECK(with(quad.subImage.imageRect, outside, showQuad) == XR_ERROR_SWAPCHAIN_RECT_INVALID);
    }
    // Empty rectangles exceed nothing.
    for (const XrRect2Di& inside :
         {XrRect2Di{{63, 31}, {1, 1}}, XrRect2Di{{0, 0}, {0, 32}}, XrRect2Di{{64, 32}, {0, 0}}}) {
        CHECK(with(quad.subImage.imageRect, inside, showQuad) == XR_SUCCESS);
    }
    CHECK(with(quad.subImage.imageArrayIndex, 1, showQuad) == kNotValid);
    CHECK(with(quad.subImage.swapchain, XR_NULL_HANDLE, showQuad) == XR_ERROR_HANDLE_INVALID);
    CHECK(with(quad.subImage.swapchain, depth, showQuad) == XR_ERROR_LAYER_INVALID);
    quad.subImage.swapchain = makeSwapchain();
    CHECK(showQuad() == XR_ERROR_LAYER_INVALID);
    turn(quad.subImage.swapchain);
    CHECK(showQuad() == XR_SUCCESS);
    CHECK_MESSAGE(showQuad() == XR_SUCCESS, "the last released image stays");
}

TEST_CASE("frames are logged, and pictures written for those with layers, of whatever images") {
    FlatFixture made(
        "size 64 32\nframes from 3 to 9\neye left angles -40.10705 34.37747 28.64789 -22.91831\nat 0 "
        "gpu-load 1000 ms-per-megapixel\n");
    made.projection.layerFlags = XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT;
    made.depths[0].nearZ = INFINITY;
    made.quad.eyeVisibility = XR_EYE_VISIBILITY_LEFT;
    made.frame({headerOf(made.projection), headerOf(made.quad)});
    CHECK(std::filesystem::exists(made.written / "frame_000003.png"));
    CHECK_FALSE(std::filesystem::exists(made.written / "frame_000002.png"));
    const std::vector<Json> lines = made.logged();
    REQUIRE(lines.size() == 4);
    CHECK(lines[3] == expecting(lines[3], {{"frame", 3},
                                           {"session_state", "FOCUSED"},
                                           {"should_render", true},
                                           {"blend_mode", "OPAQUE"}}));
    CHECK(lines[3]["gpu_ms"].get<double>() == doctest::Approx(2 * 2.048));  // for both views
    CHECK(these(lines[3]["eyes"][0]["fov"]["left"].get<double>(), lines[2].contains("picture")) ==
          these(doctest::Approx(-0.7), false));
    REQUIRE(lines[3]["layers"].size() == 2);
    const Json &projection = lines[3]["layers"][0], &quad = lines[3]["layers"][1],
               &views = projection["views"];
    CHECK(projection ==
          expecting(projection,
                    {{"type", "projection"}, {"space", "LOCAL"}, {"flags", {"blend_texture_source_alpha"}}}));
    CHECK(these(views.size(), views[1]["rect"]) == these(2, Json{0, 0, 64, 32}));
    CHECK(views[0] == expecting(views[0], {{"format", "VK_FORMAT_R8G8B8A8_SRGB"},
                                           {"depth", {{"format", "VK_FORMAT_D32_SFLOAT"}, {"far", 100.0}}}}));
    CHECK(views[0]["depth"]["near"].is_null());  // infinite
    CHECK_FALSE(projection.contains("size"));
    CHECK(quad == expecting(quad, {{"size", {1.0, 0.5}}, {"eye_visibility", "left"}}));
    CHECK_FALSE(quad["views"][0].contains("pose"));
    made.turn(made.colour);
    for (int i = 0; i < 3; ++i) { made.acquire(made.colour); }  // all of its images
    CHECK(made.show(&made.projection) == XR_SUCCESS);
    CHECK(std::filesystem::exists(made.written / "frame_000004.png"));
    for (XrCompositionLayerProjectionView& view : made.views) { view.subImage.imageRect = {{0, 0}, {0, 0}}; }
    CHECK(made.show(&made.projection) == XR_SUCCESS);
    CHECK(std::filesystem::exists(made.written / "frame_000005.png"));
    CHECK(made.logged().size() == 6);
}

TEST_CASE_FIXTURE(SurroundFixture, "layers that surround reach the wearer and the log") {
    const auto layerAfter = [&](const void* layer, const Rgb& expected) {
        CHECK(show(layer) == XR_SUCCESS);
        CHECK(middle() == expected);
        return logged().back()["layers"][0];
    };
    Json layer = layerAfter(&cylinder, kRed);
    CHECK(layer == expecting(layer, {{"type", "cylinder"}, {"radius", 0.0}, {"eye_visibility", "both"}}));
    CHECK(layer["central_angle"].get<double>() == doctest::Approx(kPi));
    layer = layerAfter(&sphere, kRed);
    CHECK(these(layer["type"], layer["upper_angle"].get<double>()) ==
          these("equirect2", doctest::Approx(kPi / 2)));
    makeCube();
    layer = layerAfter(&cube, kGreen);
    CHECK(these(layer["type"], layer["views"][0]["rect"]) == these("cube", Json{0, 0, 4, 4}));
    cube.orientation = {0, 0.70710678f, 0, 0.70710678f};
    layerAfter(&cube, kBlack);

    // A refused frame appears in the log with the layer and the value that were wrong, and without a picture.
    cylinder.centralAngle = 7;
    const XrTime time = waitFrame().predictedDisplayTime;
    REQUIRE(xrBeginFrame(session, nullptr) == XR_SUCCESS);
    CHECK(endFrame(time, {headerOf(sphere), headerOf(cylinder)}) == kNotValid);
    const Json refused = logged().back();
    CHECK(refused == expecting(refused, {{"refused", "XR_ERROR_VALIDATION_FAILURE"},
                                         {"reason", "layer 1: the central angle is 7, must be 0 to 2 pi"},
                                         {"session_state", "FOCUSED"},
                                         {"should_render", true}}));
    CHECK_FALSE(refused.contains("picture"));
    cylinder.centralAngle = 1;
    CHECK(endFrame(time, {headerOf(sphere), headerOf(cylinder)}) == XR_SUCCESS);
    CHECK(logged().back()["picture"] == "frame_000007.png");
}

TEST_CASE_FIXTURE(SurroundFixture,
                  "cylinders and spheres have angles, radii and pictures, cubes have cube maps") {
    const auto showCylinder = [&] { return show(&cylinder); };
    const auto showSphere = [&] { return show(&sphere); };
    const auto showCube = [&] { return show(&cube); };
    checkChanges(showCylinder, XR_SUCCESS, to(cylinder.radius, INFINITY), to(cylinder.centralAngle, 0));
    checkChanges(showCylinder, kNotValid, to(cylinder.radius, -1), to(cylinder.radius, NAN),
                 to(cylinder.centralAngle, 7), to(cylinder.aspectRatio, 0),
                 to(cylinder.eyeVisibility, static_cast<XrEyeVisibility>(3)),
                 to(cylinder.layerFlags, 1 << 20));
    CHECK(with(cylinder.pose.orientation.w, 0, showCylinder) == XR_ERROR_POSE_INVALID);
    CHECK(with(cylinder.subImage.imageRect.extent.width, 5, showCylinder) == XR_ERROR_SWAPCHAIN_RECT_INVALID);
    CHECK(with(cylinder.space, XR_NULL_HANDLE, showCylinder) == XR_ERROR_HANDLE_INVALID);
    checkChanges(showSphere, kNotValid, to(sphere.radius, -1), to(sphere.centralHorizontalAngle, 7),
                 to(sphere.upperVerticalAngle, 2), to(sphere.lowerVerticalAngle, -2),
                 to(sphere.subImage.imageArrayIndex, 1));
    makeCube();
    CHECK(these(with(cube.swapchain, picture, showCube), with(cube.imageArrayIndex, 1, showCube),
                with(cube.orientation.w, 0, showCube)) ==
          these(XR_ERROR_LAYER_INVALID, kNotValid, XR_ERROR_POSE_INVALID));
    CHECK(with(cylinder.subImage.swapchain, cube.swapchain, showCylinder) == XR_ERROR_LAYER_INVALID);
    // Faces are square.
    XrSwapchainCreateInfo info = swapchainInfo();
    info.faceCount = 6;
    info.arraySize = 2;
    XrSwapchain swapchain = XR_NULL_HANDLE;
    const auto make = [&] { return xrCreateSwapchain(session, &info, &swapchain); };
    CHECK(make() == kNotValid);
    CHECK(with(info.height, info.width, make) == XR_SUCCESS);
}

TEST_CASE("without their extensions these layers are none") {
    const SurroundFixture plain(Extensions{});
    for (const XrCompositionLayerBaseHeader* layer :
         {headerOf(plain.cylinder), headerOf(plain.sphere), headerOf(plain.cube)}) {
        CHECK(plain.show(layer) == XR_ERROR_LAYER_INVALID);
    }
}

}  // SUITE(simulated_layer)
