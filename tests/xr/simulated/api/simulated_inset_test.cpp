// Foveated insets (XR_VARJO_quad_views, and 1.1) on the simulated runtime: where they are, how large, and
// that the wearer sees them.
#include "tests/xr/simulated/api/simulated_direct.h"
#include "tests/xr/simulated/api/simulated_painter.h"

SUITE(simulated_inset) {

constexpr auto kInset = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO_WITH_FOVEATED_INSET;
const Extensions kQuad{XR_VARJO_QUAD_VIEWS_EXTENSION_NAME, XR_VARJO_FOVEATED_RENDERING_EXTENSION_NAME};
constexpr double kDegree = std::numbers::pi / 180.0;

using Views = std::vector<XrView>;

// "32x32 32x32 24x24 24x24"
std::string sizesOf(const std::string& script, bool moves = false, const Extensions& extensions = kQuad) {
    const InstanceFixture made(script, extensions);
    XrFoveatedViewConfigurationViewVARJO follow{XR_TYPE_FOVEATED_VIEW_CONFIGURATION_VIEW_VARJO, nullptr,
                                                XrBool32{moves}};
    const auto views = checkListOf(XrViewConfigurationView{XR_TYPE_VIEW_CONFIGURATION_VIEW, &follow},
                                   xrEnumerateViewConfigurationViews, made.instance, made.system, kInset);
    REQUIRE(views.size() == 4);
    std::uint32_t count = 0;
    CHECK(xrEnumerateEnvironmentBlendModes(made.instance, made.system, kInset, 0, &count, nullptr) ==
          XR_SUCCESS);
    std::string text;
    for (const XrViewConfigurationView& view : views) {
        text += (text.empty() ? "" : " ") + std::to_string(view.recommendedImageRectWidth) + "x" +
                std::to_string(view.recommendedImageRectHeight);
        CHECK(view.maxImageRectWidth >= view.recommendedImageRectWidth);
    }
    return text;
}

// Left, right, up and down.
void checkAngles(const XrView& view, const std::array<double, 4>& degrees) {
    const float found[] = {view.fov.angleLeft, view.fov.angleRight, view.fov.angleUp, view.fov.angleDown};
    for (std::size_t i = 0; i < 4; ++i) {
        CHECK(found[i] / kDegree == doctest::Approx(degrees[i]).epsilon(1e-5));
    }
}

struct QuadFixture : Wearer {
    explicit QuadFixture(const std::string& script) : Wearer("size 64 64\n" + script, kQuad) {
        begin(kInset);
    }

    Views locateViews(XrTime time, bool moves = true) const {
        const XrViewLocateFoveatedRenderingVARJO follow{XR_TYPE_VIEW_LOCATE_FOVEATED_RENDERING_VARJO, nullptr,
                                                        XrBool32{moves}};
        const XrViewLocateInfo info{XR_TYPE_VIEW_LOCATE_INFO, &follow, kInset, time, local};
        XrViewState state{XR_TYPE_VIEW_STATE};
        const Views views = checkListOf(XrView{XR_TYPE_VIEW}, xrLocateViews, session, &info, &state);
        REQUIRE(views.size() == 4);
        // What a program can rely on, wherever the inset is.
        for (std::size_t eye = 0; eye < 2; ++eye) {
            const XrView &context = views[eye], &inset = views[eye + 2];
            CHECK(std::memcmp(&context.pose, &inset.pose, sizeof(XrPosef)) == 0);
            CHECK(context.fov.angleLeft <= inset.fov.angleLeft);
            CHECK(inset.fov.angleRight <= context.fov.angleRight);
            CHECK(inset.fov.angleUp <= context.fov.angleUp);
            CHECK(context.fov.angleDown <= inset.fov.angleDown);
        }
        return views;
    }
    Views locateNext() const { return locateViews(frame().predictedDisplayTime); }
};

// Pictures of one colour: red for the context views, green for the left inset and blue for the right one.
struct PaintedFixture : QuadFixture {
    std::array<XrSwapchain, 3> swapchains{plain(16, {255, 0, 0, 255}), plain(16, {0, 255, 0, 255}),
                                          plain(16, {0, 0, 255, 255})};
    std::array<XrCompositionLayerProjectionView, 4> views{};
    XrCompositionLayerProjection layer = projectionOf(local, views);

    using QuadFixture::QuadFixture;
    // In the place of the eyes at a frame's time.
    XrResult showViews(XrTime time, std::uint32_t view_count = 4) {
        const Views located = locateViews(time);
        for (std::size_t i = 0; i < 4; ++i) {
            const XrSwapchainSubImage image{swapchains[i < 2 ? 0 : i - 1], {{0, 0}, {16, 16}}, 0};
            views[i] = projectionView(image, located[i].fov, located[i].pose);
        }
        layer.viewCount = view_count;
        return show(&layer);
    }
};

char colourAt(const simulated::RgbPicture& picture, std::uint32_t x, std::uint32_t y) {
    const std::map<Rgb, char> names{{{255, 0, 0}, 'r'}, {{0, 255, 0}, 'g'}, {{0, 0, 255}, 'b'}};
    const auto found = names.find(at(picture, x, y));
    return found == names.end() ? '?' : found->second;
}

TEST_CASE("the inset is listed where the program may name it, unless the script takes it away") {
    using Types = std::vector<XrViewConfigurationType>;
    const std::string without = "extension XR_VARJO_quad_views off\n";
    for (const auto& [version, extensions, script, expected, answer] :
         {std::tuple(k1_0, Extensions{}, kQuietScript, Types{kStereo}, XR_ERROR_VALIDATION_FAILURE),
          {k1_0, kQuad, kQuietScript, Types{kStereo, kInset}, XR_SUCCESS},
          {k1_1, {}, kQuietScript, Types{kStereo, kInset}, XR_SUCCESS},
          {k1_1, {}, without, Types{kStereo}, XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED}}) {
        const DirectInstance made(version, extensions, script);
        CHECK(checkListOf(XrViewConfigurationType{}, made.XR(xrEnumerateViewConfigurations), made.instance,
                          made.system) == expected);
        XrViewConfigurationProperties properties{XR_TYPE_VIEW_CONFIGURATION_PROPERTIES};
        CHECK(made.XR(xrGetViewConfigurationProperties)(made.instance, made.system, kInset, &properties) ==
              answer);
    }
}

TEST_CASE("contexts have half the pixels, insets as many a degree as the whole view, or as the script says") {
    // 64 tan 20 / tan 45 is 23.3.
    CHECK(sizesOf("size 64 64") == "32x32 32x32 24x24 24x24");
    CHECK(sizesOf("size 64 64\ninset 10") == "32x32 32x32 12x12 12x12");
    CHECK(sizesOf("size 64 64\ninset 10 size 50 40 context 20 30") == "20x30 20x30 50x40 50x40");
    CHECK(sizesOf("size 65 64\ninset 45") == "33x32 33x32 65x64 65x64");
    // Those that are to follow the gaze may be of another size.
    const std::string moving = "size 64 64\ninset 10 moving 20 16";
    CHECK(sizesOf(moving, true) == "32x32 32x32 20x16 20x16");
    CHECK(sizesOf(moving, false) == sizesOf("size 64 64\ninset 10", true));
    CHECK(sizesOf(moving, true, {XR_VARJO_QUAD_VIEWS_EXTENSION_NAME}) == sizesOf(moving, false));
}

TEST_CASE("insets lie about the gaze, with the poses of their eyes, and stay in their views") {
    const auto firstOf = [](const std::string& script) {
        return QuadFixture("frames none\n" + script).locateNext();
    };
    const Views ahead = firstOf("");
    for (const std::size_t view : {2u, 3u}) { checkAngles(ahead[view], {-20, 20, 20, -20}); }
    // To the left and down; the pitch is about the turned head's own axis.
    const double down = std::atan2(std::tan(5.0 * kDegree), std::cos(15.0 * kDegree)) / kDegree;
    checkAngles(firstOf("gaze 0 15 -5\n")[2], {-35, 5, 20 - down, -20 - down});
    checkAngles(firstOf("gaze 0 80 0\n")[3], {-45, -5, 20, -20});
    checkAngles(firstOf("gaze 0 0 80\n")[2], {-20, 20, 45, 5});
    // Straight ahead lies beside the axis of an eye that is turned outwards.
    const Views canted = firstOf("eye left cant 10\neye right cant 10\n");
    checkAngles(canted[2], {-10, 30, 20, -20});
    checkAngles(canted[3], {-30, 10, 20, -20});
    // If a view is narrower than its inset, the inset fills it.
    checkAngles(firstOf("eye left angles -15 10 45 -45\n")[2], {-15, 10, 20, -20});
    // Without a good gaze, insets lie around the middle of the lens.
    const QuadFixture lost("frames none\nrate 100\ngaze 0 15 0\nat 0.01 gaze degraded\n");
    checkAngles(lost.locateNext()[2], {-35, 5, 20, -20});
    checkAngles(lost.locateNext()[2], {-20, 20, 20, -20});
}

TEST_CASE("insets follow the gaze where a program asks for that, and the headset says whether they can") {
    for (const bool tracks : {true, false}) {
        const QuadFixture made(std::string("frames none\ngaze 0 15 0\n") +
                               (tracks ? "" : "eye-tracking off\n"));
        XrSystemFoveatedRenderingPropertiesVARJO insets{XR_TYPE_SYSTEM_FOVEATED_RENDERING_PROPERTIES_VARJO,
                                                        nullptr, 7};
        made.systemProperties(&insets);
        CHECK(insets.supportsFoveatedRendering == XrBool32{tracks});
        // Without a good gaze, insets lie around the middle of the lens.
        const std::array<double, 4> middle{-20, 20, 20, -20}, aside{-35, 5, 20, -20};
        const XrTime time = made.frame().predictedDisplayTime;
        checkAngles(made.locateViews(time, false)[2], middle);
        checkAngles(made.locateViews(time, true)[2], tracks ? aside : middle);
    }
}

TEST_CASE("a session draws as many views as it began with; the log says where the insets were") {
    PaintedFixture made("frames none\n");
    CHECK(made.showViews(kStart) == XR_SUCCESS);
    const nlohmann::json line = made.logged().at(0);
    CHECK(line["eyes"][0]["inset"]["left"].get<double>() == doctest::Approx(-20 * kDegree));
    std::string names;
    for (const auto& view : line["layers"][0]["views"]) { names += view["view"].get<std::string>() + " "; }
    CHECK(names == "left right left_inset right_inset ");
    for (const std::uint32_t count : {0u, 2u, 3u}) {
        CHECK(made.showViews(kStart, count) == XR_ERROR_VALIDATION_FAILURE);
    }
}

TEST_CASE_FIXTURE(SessionFixture, "no session begins with insets that the program may not name") {
    const XrSessionBeginInfo info{XR_TYPE_SESSION_BEGIN_INFO, nullptr, kInset};
    CHECK(xrBeginSession(session, &info) == XR_ERROR_VALIDATION_FAILURE);
}

TEST_CASE("a session in stereo draws no insets, though the headset has them") {
    const SessionFixture stereo(kQuietScript, kQuad);
    stereo.begin();
    const XrSwapchain colour = stereo.makeSwapchain();
    stereo.turn(colour);
    std::array<XrCompositionLayerProjectionView, 4> views{};
    views.fill(projectionView({colour, {{0, 0}, {64, 32}}, 0}, {-0.8f, 0.8f, 0.8f, -0.8f}));
    XrCompositionLayerProjection layer = projectionOf(stereo.local, views);
    CHECK(stereo.show(&layer) == XR_ERROR_VALIDATION_FAILURE);
    layer.viewCount = 2;
    CHECK(stereo.show(&layer) == XR_SUCCESS);
}

TEST_CASE("the wearer sees each inset in the place of what its view shows there") {
    PaintedFixture painted("rate 100\ngaze 0 0 0\ngaze 0.01 0 0\ngaze 0.02 15 0\n");
    for (int i = 0; i < 3; ++i) { REQUIRE(painted.showViews(kStart + i * 10'000'000) == XR_SUCCESS); }
    // tan 20 is 0.364 of the 32 pixels on either side: 20.4 to 43.6.
    const simulated::RgbPicture ahead = simulated::readPng(painted.written / "frame_000001.png");
    REQUIRE(ahead.size_px == glm::uvec2(128, 64));
    for (const auto& [first, colour] : {std::pair(0u, 'g'), {64u, 'b'}}) {
        for (std::uint32_t i = 0; i < 64 * 64; ++i) {
            const bool is_inset = i % 64 >= 20 && i % 64 <= 43 && i / 64 >= 20 && i / 64 <= 43;
            REQUIRE(colourAt(ahead, first + i % 64, i / 64) == (is_inset ? colour : 'r'));
        }
    }
    // From 35 degrees to the left to 5 to the right: 9.6 to 34.8.
    const simulated::RgbPicture aside = simulated::readPng(painted.written / "frame_000002.png");
    for (const auto& [column, colour] : {std::pair(8u, 'r'), {10u, 'g'}, {34u, 'g'}, {35u, 'r'}}) {
        CHECK(colourAt(aside, column, 32) == colour);
    }
}

TEST_CASE("no lens hides anything of an inset") {
    const QuadFixture made("frames none\nvisibility-mask on\n");
    XrVisibilityMaskKHR mask{XR_TYPE_VISIBILITY_MASK_KHR};
    const auto get = [&](XrViewConfigurationType type, std::uint32_t view) {
        return made.XR(xrGetVisibilityMaskKHR)(made.session, type, view,
                                               XR_VISIBILITY_MASK_TYPE_HIDDEN_TRIANGLE_MESH_KHR, &mask);
    };
    REQUIRE(get(kInset, 1) == XR_SUCCESS);
    CHECK(mask.indexCountOutput > 0);
    REQUIRE(get(kInset, 2) == XR_SUCCESS);
    CHECK(mask.indexCountOutput == 0);
    checkEach(XR_ERROR_VALIDATION_FAILURE, {get(kInset, 4), get(kStereo, 2)});
}

}  // SUITE(simulated_inset)
