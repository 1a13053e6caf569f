// The program's side of a foveated inset: found where the headset has one, located, and drawn as four views.
#include "xr/extensions/foveated_inset.h"
#include "engine/gpu/commands.h"
#include "tests/xr/simulated/api/simulated_fixture.h"
#include "xr/extensions/vulkan_enable2.h"
#include "xr/layers.h"
#include "xr/simulated/compose/picture_file.h"

#include <cmath>

TEST_SUITE_BEGIN("foveated_inset");

namespace foveated_inset_test {

using namespace binosplat;
using binosplat::test::Headset;

namespace {

xr::InstanceOptions withInset() {
    xr::InstanceOptions options;
    options.foveated_inset = true;
    return options;
}

ContextOptions optionsOf(const xr::Instance& instance) {
    ContextOptions options;
    options.validation = BINOSPLAT_TEST_VALIDATION;
    options.maker = xr::deviceMaker(instance);
    return options;
}

// Context and inset of an eye, of one colour each.
struct DrawnEye {
    xr::Swapchain context, inset;

    DrawnEye(const xr::Session& session, const xr::InsetSizes& sizes)
        : context(session, "a context", sizes.context_px, vk::Format::eR8G8B8A8Srgb, xr::ImageUse::kCopy),
          inset(session, "an inset", sizes.inset_px, vk::Format::eR8G8B8A8Srgb, xr::ImageUse::kCopy) {}
};

void paint(const Context& context, xr::Swapchain& swapchain, const glm::vec4& colour) {
    const vk::Image image = swapchain.acquire();
    Commands commands(context);
    commands.begin();
    commands.clearImage(image, colour);
    commands.submitAndWait();
    swapchain.release();
}

}  // namespace

TEST_CASE("an inset is found where it is asked for, and the headset has it") {
    const Headset headset("size 64 64\nframes none\n");
    CHECK_FALSE(xr::findInset(xr::Instance{}).has_value());
    const std::optional<xr::InsetSizes> sizes = xr::findInset(xr::Instance(withInset()));
    REQUIRE(sizes.has_value());
    CHECK(sizes->context_px == glm::uvec2(32, 32));
    CHECK(sizes->inset_px == glm::uvec2(24, 24));
    const Headset without("size 64 64\nframes none\nextension XR_VARJO_quad_views off\n");
    CHECK_FALSE(xr::findInset(xr::Instance(withInset())).has_value());
}

TEST_CASE("a session in stereo has no insets") {
    const Headset headset("size 64 64\nframes none\n");
    const xr::Instance instance(withInset());
    const Context context(optionsOf(instance));
    xr::Session session(instance, context);
    while (session.beginFrame() == xr::FrameOutcome::kWait) {}
    CHECK(session.locateEyes().has_value());
    CHECK_FALSE(session.insets().has_value());
    session.endFrame({});
    context.requireNoValidationMessages();
}

TEST_CASE("a session with insets locates them about the gaze, and the wearer sees them over their contexts") {
    const Headset headset("size 64 64\ngaze 0 15 0\n");
    const xr::Instance instance(withInset());
    const Context context(optionsOf(instance));
    {
        xr::Session session(instance, context, xr::kStereoWithInset);
        const std::optional<xr::InsetSizes> sizes = xr::findInset(instance);
        REQUIRE(sizes.has_value());
        std::array<DrawnEye, 2> eyes{DrawnEye(session, *sizes), DrawnEye(session, *sizes)};
        xr::FrameOutcome outcome = session.beginFrame();
        while (outcome != xr::FrameOutcome::kRender) {
            if (outcome == xr::FrameOutcome::kSkip) { session.endFrame({}); }
            outcome = session.beginFrame();
        }
        const std::optional<std::array<xr::EyeView, 2>> located = session.locateEyes();
        REQUIRE(located.has_value());
        REQUIRE(session.insets().has_value());
        const double degree = std::acos(-1.0) / 180.0;
        CHECK((*session.insets())[0].angleLeft / degree == doctest::Approx(-35.0).epsilon(1e-5));
        CHECK((*session.insets())[1].angleRight / degree == doctest::Approx(5.0).epsilon(1e-5));

        std::array<xr::LayerEye, 4> views;
        for (std::size_t e = 0; e < 2; ++e) {
            paint(context, eyes[e].context, {1.0f, 0.0f, 0.0f, 1.0f});
            paint(context, eyes[e].inset, {0.0f, 1.0f, 0.0f, 1.0f});
            views[e].view = (*located)[e];
            views[e].colour = &eyes[e].context;
            views[e].part_px = sizes->context_px;
            views[e + 2].view = {(*located)[e].pose, (*session.insets())[e]};
            views[e + 2].colour = &eyes[e].inset;
            views[e + 2].part_px = sizes->inset_px;
        }
        xr::Layers layers(session);
        layers.addEyesAndInsets(views, false);
        session.endFrame(layers.list());
    }
    context.requireNoValidationMessages();
    const std::filesystem::directory_iterator files(headset.written);
    const auto picture = std::find_if(begin(files), end(files), [](const auto& file) { return file.path().extension() == ".png"; });
    REQUIRE(picture != end(files));
    const simulated::RgbPicture seen = simulated::readPng(picture->path());
    const auto at = [&](std::uint32_t x, std::uint32_t y) {
        const std::size_t i = 3 * (std::size_t{y} * seen.size_px.x + x);
        return std::array<int, 3>{seen.bytes[i], seen.bytes[i + 1], seen.bytes[i + 2]};
    };
    // From 35 degrees to the left to 5 to the right: pixels 9.6 to 34.8 of 64.
    for (const std::uint32_t first : {0u, 64u}) {
        CHECK(at(first + 8, 32) == std::array{255, 0, 0});
        CHECK(at(first + 10, 32) == std::array{0, 255, 0});
        CHECK(at(first + 34, 32) == std::array{0, 255, 0});
        CHECK(at(first + 36, 32) == std::array{255, 0, 0});
    }
}

}  // namespace foveated_inset_test
