// The view configuration with a foveated inset (XR_VARJO_quad_views, core in 1.1) on the simulated runtime: four views, where they are, and
// what of them the wearer sees.
#include "tests/xr/simulated/api/simulated_direct.h"
#include "tests/xr/simulated/api/simulated_painter.h"
#include "xr/simulated/compose/picture_file.h"

#include <array>
#include <cmath>
#include <fstream>
#include <string>

TEST_SUITE_BEGIN("simulated_inset");

namespace simulated_inset_test {

using namespace binosplat::test;

namespace {

constexpr auto kStereo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
constexpr auto kInset = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO_WITH_FOVEATED_INSET;
const double kDegree = std::acos(-1.0) / 180.0;

std::vector<XrViewConfigurationType> listed(const DirectInstance& made) {
    std::array<XrViewConfigurationType, 4> types{};
    std::uint32_t count = 0;
    const auto list = made.xr<PFN_xrEnumerateViewConfigurations>("xrEnumerateViewConfigurations");
    REQUIRE(list(made.instance, made.system, 4, &count, types.data()) == XR_SUCCESS);
    return {types.begin(), types.begin() + count};
}

struct QuadInstance : InstanceFixture {
    explicit QuadInstance(const std::string& script) : InstanceFixture(script, {XR_VARJO_QUAD_VIEWS_EXTENSION_NAME}) {}

    // "32x32 32x32 24x24 24x24"
    std::string sizes() const {
        std::array<XrViewConfigurationView, 4> views{};
        views.fill({XR_TYPE_VIEW_CONFIGURATION_VIEW});
        std::uint32_t count = 0;
        REQUIRE(xrEnumerateViewConfigurationViews(instance, system, kInset, 4, &count, views.data()) == XR_SUCCESS);
        REQUIRE(count == 4);
        std::string text;
        for (const XrViewConfigurationView& view : views) {
            text += (text.empty() ? "" : " ") + std::to_string(view.recommendedImageRectWidth) + "x" +
                    std::to_string(view.recommendedImageRectHeight);
            CHECK(view.maxImageRectWidth >= view.recommendedImageRectWidth);
        }
        return text;
    }
};

struct Angles {
    double left, right, up, down;
};
Angles degreesOf(const XrView& view) {
    return {view.fov.angleLeft / kDegree, view.fov.angleRight / kDegree, view.fov.angleUp / kDegree, view.fov.angleDown / kDegree};
}
void checkAngles(const XrView& view, const Angles& expected) {
    const Angles found = degreesOf(view);
    CHECK(found.left == doctest::Approx(expected.left).epsilon(1e-5));
    CHECK(found.right == doctest::Approx(expected.right).epsilon(1e-5));
    CHECK(found.up == doctest::Approx(expected.up).epsilon(1e-5));
    CHECK(found.down == doctest::Approx(expected.down).epsilon(1e-5));
}

using Views = std::array<XrView, 4>;

struct QuadFixture : SessionFixture {
    explicit QuadFixture(const std::string& script, const std::vector<const char*>& extensions = {XR_VARJO_QUAD_VIEWS_EXTENSION_NAME})
        : SessionFixture(script, extensions) {
        const XrSessionBeginInfo info{XR_TYPE_SESSION_BEGIN_INFO, nullptr, kInset};
        REQUIRE(xrBeginSession(session, &info) == XR_SUCCESS);
    }

    Views locate(XrTime time) const {
        const XrViewLocateInfo info{XR_TYPE_VIEW_LOCATE_INFO, nullptr, kInset, time, local};
        XrViewState state{XR_TYPE_VIEW_STATE};
        Views views{};
        views.fill({XR_TYPE_VIEW});
        std::uint32_t count = 0;
        REQUIRE(xrLocateViews(session, &info, &state, 4, &count, views.data()) == XR_SUCCESS);
        REQUIRE(count == 4);
        // What a program may rely on, wherever the inset is.
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
    Views locateNext() const { return locate(frame().predictedDisplayTime); }
};

// Pictures of a colour for the context views, which are red, and for the left and the right inset, which are green and blue.
struct PaintedFixture : QuadFixture {
    Painter painter{*this};
    std::array<XrSwapchain, 3> swapchains{};
    std::array<XrCompositionLayerProjectionView, 4> views{};
    XrCompositionLayerProjection layer{XR_TYPE_COMPOSITION_LAYER_PROJECTION};

    explicit PaintedFixture(const std::string& script) : QuadFixture(script) {
        constexpr std::array<std::uint32_t, 3> kColours{0xff0000ff, 0xff00ff00, 0xffff0000};
        for (std::size_t i = 0; i < 3; ++i) {
            swapchains[i] = painter.makeSwapchain(VK_FORMAT_R8G8B8A8_SRGB, 16, 16);
            painter.paint(swapchains[i], 16, 16, std::vector<std::uint32_t>(256, kColours[i]));
        }
        layer.space = local;
        layer.viewCount = 4;
        layer.views = views.data();
    }
    XrResult show(std::uint32_t view_count = 4) {
        const XrTime time = waitFrame().predictedDisplayTime;
        REQUIRE(xrBeginFrame(session, nullptr) == XR_SUCCESS);
        const Views located = locate(time);
        for (std::size_t i = 0; i < 4; ++i) {
            views[i] = {XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW,
                        nullptr,
                        located[i].pose,
                        located[i].fov,
                        {swapchains[i < 2 ? 0 : i - 1], {{0, 0}, {16, 16}}, 0}};
        }
        layer.viewCount = view_count;
        const XrResult result = endFrame(time, {reinterpret_cast<const XrCompositionLayerBaseHeader*>(&layer)});
        if (XR_FAILED(result)) { REQUIRE(endFrame(time) == XR_SUCCESS); }
        return result;
    }
    simulated::RgbPicture picture(const std::string& name) const { return simulated::readPng(written / name); }
};

char colourAt(const simulated::RgbPicture& picture, std::uint32_t x, std::uint32_t y) {
    const std::uint8_t* const pixel = picture.bytes.data() + 3 * (std::size_t{y} * picture.size_px.x + x);
    const auto is = [&](int r, int g, int b) { return pixel[0] == r && pixel[1] == g && pixel[2] == b; };
    return is(255, 0, 0) ? 'r' : is(0, 255, 0) ? 'g' : is(0, 0, 255) ? 'b' : '?';
}

}  // namespace

TEST_CASE("the inset is listed where the program may name it, and the script does not take it away") {
    using Types = std::vector<XrViewConfigurationType>;
    CHECK(listed(DirectInstance(k1_0, {})) == Types{kStereo});
    CHECK(listed(DirectInstance(k1_0, {XR_VARJO_QUAD_VIEWS_EXTENSION_NAME})) == Types{kStereo, kInset});
    CHECK(listed(DirectInstance(k1_1, {})) == Types{kStereo, kInset});
    CHECK(listed(DirectInstance(k1_1, {}, std::string(kQuietScript) + "extension XR_VARJO_quad_views off\n")) == Types{kStereo});
}

TEST_CASE("contexts are of half the pixels, insets of as many a degree as the whole view would be") {
    // 64 tan 20 / tan 45 is 23.3.
    const QuadInstance made("size 64 64\nframes none\n");
    CHECK(made.sizes() == "32x32 32x32 24x24 24x24");
    std::uint32_t count = 0;
    CHECK(xrEnumerateViewConfigurationViews(made.instance, made.system, kInset, 0, &count, nullptr) == XR_SUCCESS);
    CHECK(count == 4);
    std::array<XrViewConfigurationView, 4> views{};
    views.fill({XR_TYPE_VIEW_CONFIGURATION_VIEW});
    CHECK(xrEnumerateViewConfigurationViews(made.instance, made.system, kInset, 2, &count, views.data()) == XR_ERROR_SIZE_INSUFFICIENT);
    views[3].type = XR_TYPE_VIEW;
    CHECK(xrEnumerateViewConfigurationViews(made.instance, made.system, kInset, 4, &count, views.data()) == XR_ERROR_VALIDATION_FAILURE);
    XrEnvironmentBlendMode mode{};
    CHECK(xrEnumerateEnvironmentBlendModes(made.instance, made.system, kInset, 1, &count, &mode) == XR_SUCCESS);
}

TEST_CASE("the script may say the sizes, and how large an inset is") {
    CHECK(QuadInstance("size 64 64\nframes none\ninset 10\n").sizes() == "32x32 32x32 12x12 12x12");
    CHECK(QuadInstance("size 64 64\nframes none\ninset 10 size 50 40 context 20 30\n").sizes() == "20x30 20x30 50x40 50x40");
    CHECK(QuadInstance("size 65 64\nframes none\ninset 45\n").sizes() == "33x32 33x32 65x64 65x64");
}

TEST_CASE("insets lie about the gaze, with the poses of their eyes, and stay in their views") {
    const std::string quiet = "size 64 64\nframes none\n";
    for (const std::size_t view : {2u, 3u}) { checkAngles(QuadFixture(quiet).locateNext()[view], {-20, 20, 20, -20}); }
    // To the left, and down; the pitch is about the turned head's own axis.
    const double down = std::atan2(std::tan(5.0 * kDegree), std::cos(15.0 * kDegree)) / kDegree;
    checkAngles(QuadFixture(quiet + "gaze 0 15 -5\n").locateNext()[2], {-35, 5, 20 - down, -20 - down});
    checkAngles(QuadFixture(quiet + "gaze 0 80 0\n").locateNext()[3], {-45, -5, 20, -20});
}

TEST_CASE("a gaze straight ahead is beside the axis of an eye that is turned outwards") {
    const QuadFixture canted("size 64 64\nframes none\neye left cant 10\neye right cant 10\n");
    const Views views = canted.locateNext();
    checkAngles(views[2], {-10, 30, 20, -20});
    checkAngles(views[3], {-30, 10, 20, -20});
}

TEST_CASE("without a good gaze insets lie about the lens's middle") {
    const std::string quiet = "size 64 64\nframes none\nrate 100\ngaze 0 15 0\n";
    checkAngles(QuadFixture(quiet + "eye-tracking off\n").locateNext()[2], {-20, 20, 20, -20});
    const QuadFixture lost(quiet + "at 0.01 gaze degraded\n");
    checkAngles(lost.locateNext()[2], {-35, 5, 20, -20});
    checkAngles(lost.locateNext()[2], {-20, 20, 20, -20});
}

TEST_CASE("a view that is narrower than its inset is all inset") {
    const QuadFixture narrow("size 64 64\nframes none\neye left angles -15 10 45 -45\n");
    checkAngles(narrow.locateNext()[2], {-15, 10, 20, -20});
}

TEST_CASE("a session draws as many views as it began with") {
    PaintedFixture painted("size 64 64\nframes none\n");
    CHECK(painted.show() == XR_SUCCESS);
    CHECK(painted.show(2) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(painted.show(3) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(painted.show(0) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(painted.show() == XR_SUCCESS);
}

TEST_CASE("a session in stereo draws no insets, though the headset has them") {
    const SessionFixture stereo(kQuietScript, {XR_VARJO_QUAD_VIEWS_EXTENSION_NAME});
    stereo.begin();
    const XrSwapchain colour = stereo.makeSwapchain();
    stereo.turn(colour);
    std::array<XrCompositionLayerProjectionView, 4> views{};
    views.fill(
        {XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW, nullptr, kIdentity, {-0.8f, 0.8f, 0.8f, -0.8f}, {colour, {{0, 0}, {64, 32}}, 0}});
    XrCompositionLayerProjection layer{XR_TYPE_COMPOSITION_LAYER_PROJECTION, nullptr, 0, stereo.local, 4, views.data()};
    const XrTime time = stereo.waitFrame().predictedDisplayTime;
    REQUIRE(xrBeginFrame(stereo.session, nullptr) == XR_SUCCESS);
    CHECK(stereo.endFrame(time, {reinterpret_cast<const XrCompositionLayerBaseHeader*>(&layer)}) == XR_ERROR_VALIDATION_FAILURE);
    layer.viewCount = 2;
    CHECK(stereo.endFrame(time, {reinterpret_cast<const XrCompositionLayerBaseHeader*>(&layer)}) == XR_SUCCESS);
}

TEST_CASE("four views are located at once, and no fewer") {
    const QuadFixture made(kQuietScript);
    const XrViewLocateInfo info{XR_TYPE_VIEW_LOCATE_INFO, nullptr, kInset, made.frame().predictedDisplayTime, made.local};
    XrViewState state{XR_TYPE_VIEW_STATE};
    Views views{};
    views.fill({XR_TYPE_VIEW});
    std::uint32_t count = 0;
    CHECK(xrLocateViews(made.session, &info, &state, 0, &count, nullptr) == XR_SUCCESS);
    CHECK(count == 4);
    CHECK(xrLocateViews(made.session, &info, &state, 2, &count, views.data()) == XR_ERROR_SIZE_INSUFFICIENT);
}

TEST_CASE("a session does not begin with an inset that the program may not name") {
    const SessionFixture made;
    const XrSessionBeginInfo info{XR_TYPE_SESSION_BEGIN_INFO, nullptr, kInset};
    CHECK(xrBeginSession(made.session, &info) == XR_ERROR_VALIDATION_FAILURE);
}

TEST_CASE("the wearer sees each inset in the place of what its view shows there") {
    PaintedFixture painted("size 64 64\nrate 100\ngaze 0 0 0\ngaze 0.01 0 0\ngaze 0.02 15 0\n");
    for (int i = 0; i < 3; ++i) { REQUIRE(painted.show() == XR_SUCCESS); }
    // tan 20 is 0.364 of the 32 pixels to either side: 20.4 to 43.6.
    const simulated::RgbPicture ahead = painted.picture("frame_000001.png");
    REQUIRE(ahead.size_px == glm::uvec2(128, 64));
    for (const std::uint32_t row : {20u, 32u, 43u}) {
        CHECK(colourAt(ahead, 19, row) == 'r');
        CHECK(colourAt(ahead, 20, row) == 'g');
        CHECK(colourAt(ahead, 43, row) == 'g');
        CHECK(colourAt(ahead, 44, row) == 'r');
        CHECK(colourAt(ahead, 64 + 19, row) == 'r');
        CHECK(colourAt(ahead, 64 + 20, row) == 'b');
        CHECK(colourAt(ahead, 64 + 43, row) == 'b');
        CHECK(colourAt(ahead, 64 + 44, row) == 'r');
    }
    for (const std::uint32_t column : {0u, 32u, 63u, 64u, 96u}) {
        CHECK(colourAt(ahead, column, 19) == 'r');
        CHECK(colourAt(ahead, column, 44) == 'r');
    }
    // From 35 degrees to the left to 5 to the right: 9.6 to 34.8.
    const simulated::RgbPicture aside = painted.picture("frame_000002.png");
    CHECK(colourAt(aside, 8, 32) == 'r');
    CHECK(colourAt(aside, 10, 32) == 'g');
    CHECK(colourAt(aside, 34, 32) == 'g');
    CHECK(colourAt(aside, 35, 32) == 'r');
}

TEST_CASE("the log names the four views, and where the insets were") {
    PaintedFixture painted("size 64 64\nframes none\n");
    REQUIRE(painted.show() == XR_SUCCESS);
    std::ifstream log(painted.written / "frames.jsonl");
    std::string line;
    REQUIRE(std::getline(log, line));
    std::size_t place = line.find("\"inset\":{\"left\":-0.349");
    CHECK(place != std::string::npos);
    for (const char* const name : {"left", "right", "left_inset", "right_inset"}) {
        place = line.find("\"view\":\"" + std::string(name) + "\"", place);
        CHECK_MESSAGE(place != std::string::npos, name);
    }
}

TEST_CASE("no lens hides anything of an inset") {
    const QuadFixture made("size 64 64\nframes none\nvisibility-mask on\n",
                           {XR_VARJO_QUAD_VIEWS_EXTENSION_NAME, XR_KHR_VISIBILITY_MASK_EXTENSION_NAME});
    const auto get = made.function<PFN_xrGetVisibilityMaskKHR>("xrGetVisibilityMaskKHR");
    const auto countOf = [&](std::uint32_t view) {
        XrVisibilityMaskKHR mask{XR_TYPE_VISIBILITY_MASK_KHR};
        REQUIRE(get(made.session, kInset, view, XR_VISIBILITY_MASK_TYPE_HIDDEN_TRIANGLE_MESH_KHR, &mask) == XR_SUCCESS);
        return mask.indexCountOutput;
    };
    CHECK(countOf(1) > 0);
    CHECK(countOf(2) == 0);
    XrVisibilityMaskKHR mask{XR_TYPE_VISIBILITY_MASK_KHR};
    const auto hidden = XR_VISIBILITY_MASK_TYPE_HIDDEN_TRIANGLE_MESH_KHR;
    CHECK(get(made.session, kInset, 4, hidden, &mask) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(get(made.session, kStereo, 2, hidden, &mask) == XR_ERROR_VALIDATION_FAILURE);
}

}  // namespace simulated_inset_test
