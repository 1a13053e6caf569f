// Chapter 9 and section 10.4 of OpenXR on the simulated runtime: the life of a session, its frame loop, and how either ends early.
#include "tests/xr/simulated/api/simulated_fixture.h"

#include <atomic>
#include <thread>

TEST_SUITE_BEGIN("simulated_session");

namespace simulated_session_test {

using namespace binosplat::test;

namespace {

using States = std::vector<XrSessionState>;

struct ExitingFixture : SessionFixture {
    ExitingFixture() : SessionFixture("size 64 64\nframes none\nat 0.1 exit\n") {}
};
struct HiddenFixture : SessionFixture {
    HiddenFixture()
        : SessionFixture(
              "size 64 64\nframes none\nrate 10\n"
              "at 1 focused off\nat 2 visible off\nat 3 visible on\nat 3.5 focused on\nat 4 should-render off\n") {}
};
struct LosingFixture : SessionFixture {
    LosingFixture() : SessionFixture("size 64 64\nframes none\nrate 10\nat 1 lose-session\n") {}
};
struct InstanceLosingFixture : SessionFixture {
    InstanceLosingFixture() : SessionFixture("size 64 64\nframes none\nrate 10\nat 1 lose-instance\n") {}
};

// Loses and gains focus with every other frame, from the third on.
std::string restlessScript() {
    std::string script = "size 64 64\nframes none\nrate 10\n";
    for (int i = 0; i < 110; ++i) { script += "at " + std::to_string(0.25 + 0.1 * i) + (i % 2 == 0 ? " focused off\n" : " focused on\n"); }
    return script;
}
struct RestlessFixture : SessionFixture {
    RestlessFixture() : SessionFixture(restlessScript()) {}
};

}  // namespace

TEST_CASE_FIXTURE(VulkanFixture, "a session wants a graphics binding and a system") {
    XrGraphicsBindingVulkan2KHR graphics = binding();
    XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO, &graphics, 0, system};
    XrSession session = XR_NULL_HANDLE;
    CHECK(xrCreateSession(instance, nullptr, &session) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrCreateSession(instance, &info, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    info.next = nullptr;
    CHECK(xrCreateSession(instance, &info, &session) == XR_ERROR_GRAPHICS_DEVICE_INVALID);
    XrGraphicsBindingVulkan2KHR second = graphics;
    graphics.next = &second;
    info.next = &graphics;
    CHECK(xrCreateSession(instance, &info, &session) == XR_ERROR_GRAPHICS_DEVICE_INVALID);
    graphics = binding();
    graphics.device = VK_NULL_HANDLE;
    CHECK(xrCreateSession(instance, &info, &session) == XR_ERROR_GRAPHICS_DEVICE_INVALID);
    graphics = binding();
    graphics.queueFamilyIndex = 99;
    CHECK(xrCreateSession(instance, &info, &session) == XR_ERROR_GRAPHICS_DEVICE_INVALID);
    graphics = binding();
    info.systemId = 7;
    CHECK(xrCreateSession(instance, &info, &session) == XR_ERROR_SYSTEM_INVALID);
    info.systemId = system;
    info.createFlags = 1;
    CHECK(xrCreateSession(instance, &info, &session) == XR_ERROR_VALIDATION_FAILURE);
    info.createFlags = 0;
    CHECK(xrCreateSession(instance, &info, &session) == XR_SUCCESS);
    XrSession another = XR_NULL_HANDLE;
    CHECK(xrCreateSession(instance, &info, &another) == XR_ERROR_LIMIT_REACHED);
    CHECK(xrDestroySession(session) == XR_SUCCESS);
    CHECK(xrDestroySession(session) == XR_ERROR_HANDLE_INVALID);
    CHECK(xrCreateSession(instance, &info, &another) == XR_SUCCESS);
}

TEST_CASE_FIXTURE(SessionFixture, "what belongs to a session ends with it") {
    const XrSwapchain swapchain = makeSwapchain();
    CHECK(xrDestroySession(session) == XR_SUCCESS);
    CHECK(xrDestroySpace(local) == XR_ERROR_HANDLE_INVALID);
    CHECK(xrDestroySwapchain(swapchain) == XR_ERROR_HANDLE_INVALID);
    CHECK(xrRequestExitSession(session) == XR_ERROR_HANDLE_INVALID);
    CHECK(states().empty());
}

TEST_CASE_FIXTURE(SessionFixture, "a handle of one type is not taken for another") {
    CHECK(xrDestroySession(reinterpret_cast<XrSession>(local)) == XR_ERROR_HANDLE_INVALID);
    CHECK(xrDestroySpace(reinterpret_cast<XrSpace>(session)) == XR_ERROR_HANDLE_INVALID);
    CHECK(xrDestroySwapchain(reinterpret_cast<XrSwapchain>(instance)) == XR_ERROR_HANDLE_INVALID);
    CHECK(xrDestroySession(XR_NULL_HANDLE) == XR_ERROR_HANDLE_INVALID);
}

TEST_CASE_FIXTURE(SessionFixture, "a session goes from IDLE to FOCUSED, a state per frame, and is shown from VISIBLE on") {
    CHECK(states() == States{XR_SESSION_STATE_IDLE, XR_SESSION_STATE_READY});
    begin();
    CHECK(frame().shouldRender == XR_FALSE);
    CHECK(states() == States{XR_SESSION_STATE_SYNCHRONIZED});
    CHECK(frame().shouldRender == XR_FALSE);
    CHECK(states() == States{XR_SESSION_STATE_VISIBLE});
    CHECK(frame().shouldRender == XR_TRUE);
    CHECK(states() == States{XR_SESSION_STATE_FOCUSED});
    frame();
    CHECK(states().empty());
}

TEST_CASE_FIXTURE(SessionFixture, "a session begins once, when it is READY, in stereo") {
    XrSessionBeginInfo info{XR_TYPE_SESSION_BEGIN_INFO, nullptr, XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO};
    CHECK(xrBeginSession(session, &info) == XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED);
    info.primaryViewConfigurationType = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
    info.type = XR_TYPE_UNKNOWN;
    CHECK(xrBeginSession(session, &info) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrBeginSession(session, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    info.type = XR_TYPE_SESSION_BEGIN_INFO;
    CHECK(xrBeginSession(XR_NULL_HANDLE, &info) == XR_ERROR_HANDLE_INVALID);
    CHECK(xrBeginSession(session, &info) == XR_SUCCESS);
    CHECK(xrBeginSession(session, &info) == XR_ERROR_SESSION_RUNNING);
}

TEST_CASE_FIXTURE(SessionFixture, "a session that does not run has no frames") {
    XrFrameState state{XR_TYPE_FRAME_STATE};
    CHECK(xrWaitFrame(session, nullptr, &state) == XR_ERROR_SESSION_NOT_RUNNING);
    CHECK(xrBeginFrame(session, nullptr) == XR_ERROR_SESSION_NOT_RUNNING);
    CHECK(endFrame(1) == XR_ERROR_SESSION_NOT_RUNNING);
    CHECK(xrEndSession(session) == XR_ERROR_SESSION_NOT_RUNNING);
    CHECK(xrRequestExitSession(session) == XR_ERROR_SESSION_NOT_RUNNING);
}

TEST_CASE_FIXTURE(SessionFixture, "frames are waited for, begun and ended in this order") {
    begin();
    CHECK(xrBeginFrame(session, nullptr) == XR_ERROR_CALL_ORDER_INVALID);
    CHECK(endFrame(1) == XR_ERROR_CALL_ORDER_INVALID);
    const XrTime first = waitFrame().predictedDisplayTime;
    CHECK(endFrame(first) == XR_ERROR_CALL_ORDER_INVALID);
    CHECK(xrBeginFrame(session, nullptr) == XR_SUCCESS);
    CHECK(xrBeginFrame(session, nullptr) == XR_ERROR_CALL_ORDER_INVALID);
    const XrTime second = waitFrame().predictedDisplayTime;
    CHECK(xrBeginFrame(session, nullptr) == XR_FRAME_DISCARDED);
    CHECK(endFrame(second) == XR_SUCCESS);
    CHECK(endFrame(second) == XR_ERROR_CALL_ORDER_INVALID);
}

TEST_CASE_FIXTURE(SessionFixture, "a frame that was refused can be ended again") {
    begin();
    const XrTime time = waitFrame().predictedDisplayTime;
    CHECK(xrBeginFrame(session, nullptr) == XR_SUCCESS);
    CHECK(endFrame(0) == XR_ERROR_TIME_INVALID);
    CHECK(endFrame(-5) == XR_ERROR_TIME_INVALID);
    CHECK(endFrame(time) == XR_SUCCESS);
}

TEST_CASE_FIXTURE(SessionFixture, "the frame loop's structures have types") {
    begin();
    XrFrameState state{XR_TYPE_FRAME_END_INFO};
    CHECK(xrWaitFrame(session, nullptr, &state) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrWaitFrame(session, nullptr, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    const XrFrameWaitInfo wait{XR_TYPE_FRAME_BEGIN_INFO};
    state.type = XR_TYPE_FRAME_STATE;
    CHECK(xrWaitFrame(session, &wait, &state) == XR_ERROR_VALIDATION_FAILURE);
    waitFrame();
    const XrFrameBeginInfo begin_info{XR_TYPE_FRAME_WAIT_INFO};
    CHECK(xrBeginFrame(session, &begin_info) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrBeginFrame(session, nullptr) == XR_SUCCESS);
    CHECK(xrEndFrame(session, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    XrFrameEndInfo end{XR_TYPE_FRAME_END_INFO, nullptr, 1, XR_ENVIRONMENT_BLEND_MODE_ADDITIVE, 0, nullptr};
    CHECK(xrEndFrame(session, &end) == XR_ERROR_ENVIRONMENT_BLEND_MODE_UNSUPPORTED);
    end.environmentBlendMode = static_cast<XrEnvironmentBlendMode>(0);
    CHECK(xrEndFrame(session, &end) == XR_ERROR_VALIDATION_FAILURE);
}

TEST_CASE_FIXTURE(SessionFixture, "in lock-step a frame lasts one period") {
    begin();
    const XrFrameState first = frame();
    CHECK(first.predictedDisplayPeriod == 11'111'111);
    CHECK(first.predictedDisplayTime == 1'000'000'000);
    CHECK(frame().predictedDisplayTime == first.predictedDisplayTime + first.predictedDisplayPeriod);
}

TEST_CASE_FIXTURE(SessionFixture, "xrWaitFrame waits until the frame before has begun") {
    begin();
    waitFrame();
    std::atomic<bool> has_returned = false;
    std::atomic<XrResult> result = XR_ERROR_RUNTIME_FAILURE;
    std::thread second([&] {
        XrFrameState state{XR_TYPE_FRAME_STATE};
        result = xrWaitFrame(session, nullptr, &state);
        has_returned = true;
    });
    const bool was_early = has_returned;
    CHECK(xrBeginFrame(session, nullptr) == XR_SUCCESS);
    second.join();
    CHECK(!was_early);
    CHECK(result == XR_SUCCESS);
}

TEST_CASE_FIXTURE(SessionFixture, "an xrWaitFrame that waits returns when its session ends") {
    begin();
    waitFrame();
    std::atomic<XrResult> result = XR_SUCCESS;
    std::thread second([&] {
        XrFrameState state{XR_TYPE_FRAME_STATE};
        result = xrWaitFrame(session, nullptr, &state);
    });
    CHECK(xrDestroySession(session) == XR_SUCCESS);
    second.join();
    CHECK(result == XR_ERROR_HANDLE_INVALID);
}

TEST_CASE_FIXTURE(SessionFixture, "an application leaves through STOPPING, and its session ends EXITING") {
    focus();
    CHECK(xrEndSession(session) == XR_ERROR_SESSION_NOT_STOPPING);
    CHECK(xrRequestExitSession(session) == XR_SUCCESS);
    for (int i = 0; i < 3; ++i) frame();
    CHECK(states() == States{XR_SESSION_STATE_VISIBLE, XR_SESSION_STATE_SYNCHRONIZED, XR_SESSION_STATE_STOPPING});
    CHECK(xrEndSession(session) == XR_SUCCESS);
    CHECK(states() == States{XR_SESSION_STATE_IDLE, XR_SESSION_STATE_EXITING});
    const XrSessionBeginInfo info{XR_TYPE_SESSION_BEGIN_INFO, nullptr, XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO};
    CHECK(xrBeginSession(session, &info) == XR_ERROR_SESSION_NOT_READY);
}

TEST_CASE_FIXTURE(ExitingFixture, "the wearer leaves when the script says so") {
    focus();
    int frames = 0;
    States seen;
    while (seen.empty() && frames < 100) {
        frame();
        ++frames;
        seen = states();
    }
    // 0.1 s are nine periods of 1/90 s; three frames were shown before.
    CHECK(seen == States{XR_SESSION_STATE_VISIBLE});
    CHECK(frames <= 8);
}

TEST_CASE_FIXTURE(HiddenFixture, "the script hides the session, takes its focus, and lets frames go undrawn") {
    focus();  // three frames of 0.1 s
    const auto runUntil = [&](int last_frame, int first_frame) {
        XrFrameState state{};
        for (int i = first_frame; i <= last_frame; ++i) state = frame();
        return state;
    };
    CHECK(runUntil(10, 3).shouldRender == XR_TRUE);
    CHECK(states() == States{XR_SESSION_STATE_VISIBLE});
    runUntil(20, 11);
    CHECK(states() == States{XR_SESSION_STATE_SYNCHRONIZED});
    CHECK(runUntil(21, 21).shouldRender == XR_FALSE);
    runUntil(36, 22);
    CHECK(states() == States{XR_SESSION_STATE_VISIBLE, XR_SESSION_STATE_FOCUSED});
    CHECK(runUntil(41, 37).shouldRender == XR_FALSE);
    CHECK(states().empty());
}

TEST_CASE_FIXTURE(LosingFixture, "a session that is being lost says so with every success, and then fails") {
    focus();
    for (int i = 3; i < 10; ++i) frame();
    XrFrameState state{XR_TYPE_FRAME_STATE};
    CHECK(xrWaitFrame(session, nullptr, &state) == XR_SESSION_LOSS_PENDING);
    CHECK(states() == States{XR_SESSION_STATE_LOSS_PENDING});
    std::uint32_t count = 0;
    CHECK(xrEnumerateReferenceSpaces(session, 0, &count, nullptr) == XR_SESSION_LOSS_PENDING);
    CHECK(xrBeginFrame(session, nullptr) == XR_SESSION_LOSS_PENDING);
    CHECK(endFrame(state.predictedDisplayTime) == XR_SESSION_LOSS_PENDING);
    XrResult result = XR_SUCCESS;
    for (int i = 0; i < 10 && XR_SUCCEEDED(result); ++i) {
        result = xrWaitFrame(session, nullptr, &state);
        if (XR_SUCCEEDED(result)) result = xrBeginFrame(session, nullptr);
        if (XR_SUCCEEDED(result)) result = endFrame(state.predictedDisplayTime);
    }
    CHECK(result == XR_ERROR_SESSION_LOST);
    CHECK(xrEnumerateReferenceSpaces(session, 0, &count, nullptr) == XR_ERROR_SESSION_LOST);
    CHECK(xrRequestExitSession(session) == XR_ERROR_SESSION_LOST);
    CHECK(xrDestroySession(session) == XR_SUCCESS);

    // The next one is well: time went on, so the script's line is past.
    const XrGraphicsBindingVulkan2KHR graphics = binding();
    const XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO, &graphics, 0, system};
    REQUIRE(xrCreateSession(instance, &info, &session) == XR_SUCCESS);
    focus();
}

TEST_CASE_FIXTURE(InstanceLosingFixture, "an instance that is lost says when, and then fails") {
    focus();
    for (int i = 3; i < 10; ++i) frame();
    const XrTime time = waitFrame().predictedDisplayTime;
    XrEventDataBuffer event;
    REQUIRE(poll(event) == XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING);
    CHECK(reinterpret_cast<const XrEventDataInstanceLossPending&>(event).lossTime > time);
    XrResult result = XR_SUCCESS;
    XrFrameState state{XR_TYPE_FRAME_STATE};
    for (int i = 0; i < 10 && XR_SUCCEEDED(result); ++i) {
        result = xrBeginFrame(session, nullptr);
        if (XR_SUCCEEDED(result)) result = xrWaitFrame(session, nullptr, &state);
    }
    CHECK(result == XR_ERROR_INSTANCE_LOST);
    XrPath made = XR_NULL_PATH;
    CHECK(xrStringToPath(instance, "/a", &made) == XR_ERROR_INSTANCE_LOST);
    CHECK(xrPollEvent(instance, &event) == XR_ERROR_INSTANCE_LOST);
}

TEST_CASE_FIXTURE(RestlessFixture, "events that nobody polls are lost and counted") {
    begin();
    for (int i = 0; i < 100; ++i) frame();
    XrEventDataBuffer event;
    int kept = 0;
    XrStructureType type = poll(event);
    for (; type == XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED; type = poll(event)) ++kept;
    CHECK(kept == 64);
    REQUIRE(type == XR_TYPE_EVENT_DATA_EVENTS_LOST);
    // IDLE, READY, and a change with each of the frames.
    CHECK(reinterpret_cast<const XrEventDataEventsLost&>(event).lostEventCount == 102 - 64);
    CHECK(poll(event) == XR_TYPE_UNKNOWN);
}

TEST_CASE_FIXTURE(SessionFixture, "a session's events are forgotten with it") {
    CHECK(xrDestroySession(session) == XR_SUCCESS);
    const XrGraphicsBindingVulkan2KHR graphics = binding();
    const XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO, &graphics, 0, system};
    REQUIRE(xrCreateSession(instance, &info, &session) == XR_SUCCESS);
    CHECK(states() == States{XR_SESSION_STATE_IDLE, XR_SESSION_STATE_READY});
}

TEST_CASE("frames go by the display's rate from the next one on, and stay in order") {
    const SessionFixture fixture("size 64 64\nframes none\nrate 100\n", {XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME});
    const auto request = fixture.function<PFN_xrRequestDisplayRefreshRateFB>("xrRequestDisplayRefreshRateFB");
    fixture.begin();
    const XrFrameState first = fixture.frame(), second = fixture.frame();
    CHECK(second.predictedDisplayTime - first.predictedDisplayTime == 10'000'000);
    REQUIRE(request(fixture.session, 80) == XR_SUCCESS);
    const XrFrameState third = fixture.frame();
    CHECK(third.predictedDisplayTime - second.predictedDisplayTime == 12'500'000);
    CHECK(third.predictedDisplayPeriod == 12'500'000);
    REQUIRE(request(fixture.session, 0) == XR_SUCCESS);
    const XrFrameState fourth = fixture.frame();
    CHECK(fourth.predictedDisplayTime - third.predictedDisplayTime == 10'000'000);
}

}  // namespace simulated_session_test
