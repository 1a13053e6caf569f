// XR_MND_headless on the simulated runtime: sessions without graphics. There is no loader here.
#include "tests/xr/simulated/api/simulated_direct.h"

TEST_SUITE_BEGIN("simulated_headless");

namespace simulated_headless_test {

using namespace binosplat::test;

namespace {

constexpr XrTime kStart = 1'000'000'000;
using States = std::vector<XrSessionState>;

}  // namespace

TEST_CASE("a headless session has no swapchains, needs no frames, and is in focus at once") {
    const HeadlessSession made(k1_0, {}, "rate 10\nat 0.35 focused off\nat 0.55 exit\n");
    std::uint32_t count = 9;
    CHECK(made.xr<PFN_xrEnumerateSwapchainFormats>("xrEnumerateSwapchainFormats")(made.session, 0, &count, nullptr) == XR_SUCCESS);
    CHECK(count == 0);
    const XrSwapchainCreateInfo info = swapchainInfo();
    XrSwapchain swapchain = XR_NULL_HANDLE;
    CHECK(made.xr<PFN_xrCreateSwapchain>("xrCreateSwapchain")(made.session, &info, &swapchain) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(made.states() == States{XR_SESSION_STATE_IDLE, XR_SESSION_STATE_READY});
    made.begin();
    CHECK(made.states() == States{XR_SESSION_STATE_SYNCHRONIZED, XR_SESSION_STATE_VISIBLE, XR_SESSION_STATE_FOCUSED});
    // Each xrSyncActions is a frame's time: 0, 0.1, 0.2, 0.3 s in focus.
    for (int i = 0; i < 4; ++i) CHECK(made.sync() == XR_SUCCESS);
    CHECK(made.sync() == XR_SESSION_NOT_FOCUSED);
    CHECK(made.states() == States{XR_SESSION_STATE_VISIBLE});
    CHECK(made.sync() == XR_SESSION_NOT_FOCUSED);
    CHECK(made.sync() == XR_SESSION_NOT_FOCUSED);
    CHECK(made.states() == States{XR_SESSION_STATE_SYNCHRONIZED, XR_SESSION_STATE_STOPPING});
    CHECK(made.xr<PFN_xrEndSession>("xrEndSession")(made.session) == XR_SUCCESS);
}

TEST_CASE("a headless session may have frames, which nobody draws; time and states then go by them alone") {
    const HeadlessSession made(k1_0, {}, "rate 10\nat 0 gpu-load 250 %\nat 0.15 focused off\nat 0.35 exit\n");
    const auto wait = made.xr<PFN_xrWaitFrame>("xrWaitFrame");
    const auto begin = made.xr<PFN_xrBeginFrame>("xrBeginFrame");
    const auto end = made.xr<PFN_xrEndFrame>("xrEndFrame");
    XrFrameState state{XR_TYPE_FRAME_STATE};
    CHECK(wait(made.session, nullptr, &state) == XR_ERROR_SESSION_NOT_RUNNING);
    made.begin();
    made.states();
    CHECK(begin(made.session, nullptr) == XR_ERROR_CALL_ORDER_INVALID);
    XrFrameEndInfo info{XR_TYPE_FRAME_END_INFO, nullptr, kStart, XR_ENVIRONMENT_BLEND_MODE_OPAQUE, 0, nullptr};
    CHECK(end(made.session, &info) == XR_ERROR_CALL_ORDER_INVALID);
    const States expected[] = {{}, {}, {XR_SESSION_STATE_VISIBLE}, {}, {XR_SESSION_STATE_SYNCHRONIZED}, {XR_SESSION_STATE_STOPPING}};
    for (int frame = 0; frame < 6; ++frame) {
        state.shouldRender = XR_TRUE;
        REQUIRE(wait(made.session, nullptr, &state) == XR_SUCCESS);
        CHECK(state.shouldRender == XR_FALSE);
        CHECK(state.predictedDisplayTime == kStart + frame * 100'000'000);
        CHECK(state.predictedDisplayPeriod == 100'000'000);
        for (int i = 0; i < 2; ++i) CHECK(made.sync() == (frame < 3 ? XR_SUCCESS : XR_SESSION_NOT_FOCUSED));
        REQUIRE(begin(made.session, nullptr) == XR_SUCCESS);
        // Its picture would need a swapchain, which there cannot be; even one that names none is refused as a layer.
        const XrCompositionLayerQuad quad{XR_TYPE_COMPOSITION_LAYER_QUAD};
        const auto* const layer = reinterpret_cast<const XrCompositionLayerBaseHeader*>(&quad);
        info = {XR_TYPE_FRAME_END_INFO, nullptr, state.predictedDisplayTime, XR_ENVIRONMENT_BLEND_MODE_OPAQUE, 1, &layer};
        CHECK(end(made.session, &info) == XR_ERROR_LAYER_INVALID);
        info.layerCount = 0;
        REQUIRE(end(made.session, &info) == XR_SUCCESS);
        CHECK(made.states() == expected[frame]);
    }
    CHECK(made.xr<PFN_xrEndSession>("xrEndSession")(made.session) == XR_SUCCESS);
}

TEST_CASE("a headless session begins whatever view configuration it names") {
    for (const auto type :
         {static_cast<XrViewConfigurationType>(0), XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO, static_cast<XrViewConfigurationType>(4711)}) {
        const HeadlessSession made(k1_0, {});
        const XrSessionBeginInfo info{XR_TYPE_SESSION_BEGIN_INFO, nullptr, type};
        CHECK(made.xr<PFN_xrBeginSession>("xrBeginSession")(made.session, &info) == XR_SUCCESS);
        CHECK(made.states().back() == XR_SESSION_STATE_FOCUSED);
    }
}

TEST_CASE("a headless session ends at once when it is asked to") {
    const HeadlessSession made(k1_0, {});
    made.begin();
    CHECK(made.xr<PFN_xrRequestExitSession>("xrRequestExitSession")(made.session) == XR_SUCCESS);
    CHECK(made.xr<PFN_xrEndSession>("xrEndSession")(made.session) == XR_SUCCESS);
}

TEST_CASE("without the extension a session needs graphics") {
    const DirectInstance made(k1_1, {});
    const XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO, nullptr, 0, made.system};
    XrSession session = XR_NULL_HANDLE;
    CHECK(made.xr<PFN_xrCreateSession>("xrCreateSession")(made.instance, &info, &session) == XR_ERROR_GRAPHICS_DEVICE_INVALID);
}

}  // namespace simulated_headless_test
