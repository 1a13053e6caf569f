// Chapter 9 and section 10.4 of OpenXR on the simulated runtime: a session's life, its frames, their pace,
// and how it ends.
#include "tests/xr/simulated/api/simulated_fixture.h"

SUITE(simulated_session) {

using Json = nlohmann::json;

constexpr XrDuration kPeriod = 10'000'000;  // 100 frames per second
const std::string kWholeLife = " IDLE READY SYNCHRONIZED VISIBLE FOCUSED VISIBLE SYNCHRONIZED STOPPING";

struct Begun : SessionFixture {
    explicit Begun(const std::string& script, const Extensions& extensions = {})
        : SessionFixture(kQuietScript + script, extensions) {
        begin();
    }

    std::vector<XrFrameState> frames(int count) const {
        std::vector<XrFrameState> states;
        for (int i = 0; i < count; ++i) { states.push_back(frame()); }
        return states;
    }
    // Waits for frames and begins them, until the session should stop: its states so far.
    template <class Body>
    std::string runOn(const Body& endFrame) const {
        std::string seen;
        for (int i = 0; i < 50; ++i) {
            const XrTime time = waitFrame().predictedDisplayTime;
            if (const std::string now = states(); !now.empty()) { seen += " " + now; }
            if (seen.ends_with("STOPPING")) { break; }
            CHECK(XR_SUCCEEDED(xrBeginFrame(session, nullptr)));
            endFrame(time);
        }
        return seen;
    }
    // The result of the first xrWaitFrame that fails within ten frames.
    XrResult waitForFailure() const {
        XrFrameState state{XR_TYPE_FRAME_STATE};
        XrResult result = xrWaitFrame(session, nullptr, &state);
        for (int i = 0; i < 10 && XR_SUCCEEDED(result); ++i) {
            xrBeginFrame(session, nullptr);
            endFrame(state.predictedDisplayTime);
            result = xrWaitFrame(session, nullptr, &state);
        }
        return result;
    }
};

// A hundred frames per second, and the wearer leaves after ten.
struct Leaving : Begun {
    Leaving() : Begun("rate 100\nat 0.1 exit") {}
};

TEST_CASE_FIXTURE(VulkanFixture, "a session wants a GPU and a system; its objects and events end with it") {
    XrGraphicsBindingVulkan2KHR graphics = binding(), second = graphics;
    XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO, &graphics, 0, system};
    const auto make = [&] { return xrCreateSession(instance, &info, &session); };
    checkArguments(xrCreateSession, instance, &info, &session);
    checkChanges(make, XR_ERROR_GRAPHICS_DEVICE_INVALID, to(info.next, nullptr), to(graphics.next, &second),
                 to(graphics.device, VK_NULL_HANDLE), to(graphics.queueFamilyIndex, 99));
    CHECK(with(info.systemId, 7, make) == XR_ERROR_SYSTEM_INVALID);
    CHECK(with(info.createFlags, 1, make) == XR_ERROR_VALIDATION_FAILURE);
    REQUIRE(make() == XR_SUCCESS);
    XrSession another = XR_NULL_HANDLE;
    CHECK(xrCreateSession(instance, &info, &another) == XR_ERROR_LIMIT_REACHED);

    // A handle of one type is not accepted as another.
    const XrSwapchainCreateInfo swapchain_info = swapchainInfo();
    XrSwapchain swapchain = XR_NULL_HANDLE;
    REQUIRE(xrCreateSwapchain(session, &swapchain_info, &swapchain) == XR_SUCCESS);
    checkEach(XR_ERROR_HANDLE_INVALID, {xrDestroySession(reinterpret_cast<XrSession>(swapchain)),
                                        xrDestroySpace(reinterpret_cast<XrSpace>(session)),
                                        xrDestroySwapchain(reinterpret_cast<XrSwapchain>(instance)),
                                        xrDestroySession(XR_NULL_HANDLE)});
    CHECK(xrDestroySession(session) == XR_SUCCESS);
    checkEach(XR_ERROR_HANDLE_INVALID, {xrDestroySwapchain(swapchain), xrRequestExitSession(session)});
    CHECK(states() == "");
    checkEach(XR_SUCCESS, {make(), xrDestroySession(session), make()});
    CHECK(states() == "IDLE READY");
}

TEST_CASE_FIXTURE(SessionFixture, "a session begins once, when READY, in stereo, and has a state per frame") {
    XrFrameState state{XR_TYPE_FRAME_STATE};
    checkEach(XR_ERROR_SESSION_NOT_RUNNING,
              {xrWaitFrame(session, nullptr, &state), xrBeginFrame(session, nullptr), endFrame(1),
               xrEndSession(session), xrRequestExitSession(session)});
    XrSessionBeginInfo info{XR_TYPE_SESSION_BEGIN_INFO, nullptr, kStereo};
    const auto begin = [&] { return xrBeginSession(session, &info); };
    CHECK(with(info.primaryViewConfigurationType, XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO, begin) ==
          XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED);
    checkArguments(xrBeginSession, session, &info);
    CHECK(states() == "IDLE READY");
    CHECK(begin() == XR_SUCCESS);
    CHECK(begin() == XR_ERROR_SESSION_RUNNING);

    // Frames should be drawn from VISIBLE on; in lock-step, a frame lasts one period.
    XrTime time = kStart;
    for (const std::string expected : {"SYNCHRONIZED", "VISIBLE", "FOCUSED", ""}) {
        const bool is_drawn = expected == "FOCUSED" || expected.empty();
        state = frame();
        CHECK(these(state.shouldRender, state.predictedDisplayPeriod, state.predictedDisplayTime) ==
              these(is_drawn, 11'111'111, time));
        CHECK(states() == expected);
        time += state.predictedDisplayPeriod;
    }
    CHECK(xrEndSession(session) == XR_ERROR_SESSION_NOT_STOPPING);
    CHECK(xrRequestExitSession(session) == XR_SUCCESS);
    for (int i = 0; i < 3; ++i) { frame(); }
    CHECK(states() == "VISIBLE SYNCHRONIZED STOPPING");
    CHECK(xrEndSession(session) == XR_SUCCESS);
    CHECK(states() == "IDLE EXITING");
    CHECK(begin() == XR_ERROR_SESSION_NOT_READY);
}

TEST_CASE_FIXTURE(SessionFixture, "frames are waited for, begun and ended, in structures of their types") {
    begin();
    checkEach(XR_ERROR_CALL_ORDER_INVALID, {xrBeginFrame(session, nullptr), endFrame(1)});
    XrFrameState state{XR_TYPE_FRAME_END_INFO};
    checkEach(XR_ERROR_VALIDATION_FAILURE,
              {xrWaitFrame(session, nullptr, &state), xrWaitFrame(session, nullptr, nullptr)});
    const XrFrameWaitInfo wait{XR_TYPE_FRAME_BEGIN_INFO};
    state.type = XR_TYPE_FRAME_STATE;
    CHECK(xrWaitFrame(session, &wait, &state) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(endFrame(waitFrame().predictedDisplayTime) == XR_ERROR_CALL_ORDER_INVALID);
    const XrFrameBeginInfo begin_info{XR_TYPE_FRAME_WAIT_INFO};
    CHECK(xrBeginFrame(session, &begin_info) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrBeginFrame(session, nullptr) == XR_SUCCESS);
    CHECK(xrBeginFrame(session, nullptr) == XR_ERROR_CALL_ORDER_INVALID);
    const XrTime second = waitFrame().predictedDisplayTime;
    CHECK(xrBeginFrame(session, nullptr) == XR_FRAME_DISCARDED);

    XrFrameEndInfo info{XR_TYPE_FRAME_END_INFO, nullptr, second, XR_ENVIRONMENT_BLEND_MODE_OPAQUE};
    const auto end = [&] { return xrEndFrame(session, &info); };
    checkArguments(xrEndFrame, session, &info);
    CHECK(with(info.environmentBlendMode, XR_ENVIRONMENT_BLEND_MODE_ADDITIVE, end) ==
          XR_ERROR_ENVIRONMENT_BLEND_MODE_UNSUPPORTED);
    CHECK(with(info.environmentBlendMode, XrEnvironmentBlendMode{}, end) == XR_ERROR_VALIDATION_FAILURE);
    // A frame whose end was refused can be ended again.
    checkChanges(end, XR_ERROR_TIME_INVALID, to(info.displayTime, 0), to(info.displayTime, -5));
    CHECK(end() == XR_SUCCESS);
    CHECK(end() == XR_ERROR_CALL_ORDER_INVALID);
}

TEST_CASE_FIXTURE(SessionFixture, "xrWaitFrame waits until the frame before has begun, or its session ends") {
    begin();
    waitFrame();
    for (const bool ends : {false, true}) {
        std::atomic<bool> has_returned = false;
        std::atomic<XrResult> result = XR_ERROR_RUNTIME_FAILURE;
        std::thread second([&] {
            XrFrameState state{XR_TYPE_FRAME_STATE};
            result = xrWaitFrame(session, nullptr, &state);
            has_returned = true;
        });
        const bool was_early = has_returned;
        CHECK((ends ? xrDestroySession(session) : xrBeginFrame(session, nullptr)) == XR_SUCCESS);
        second.join();
        CHECK_FALSE(was_early);
        CHECK(result == (ends ? XR_ERROR_HANDLE_INVALID : XR_SUCCESS));
    }
}

TEST_CASE("the script hides the session, takes its focus, and lets frames go undrawn") {
    const Begun made(
        "rate 10\nat 1 focused off\nat 2 visible off\nat 3 visible on\nat 3.5 focused on\nat 4 should-render "
        "off\n");
    std::string found;
    bool was_drawn = false;
    for (int shown = 0; shown <= 41; ++shown) {
        const bool is_drawn = made.frame().shouldRender == XR_TRUE;
        if (is_drawn != std::exchange(was_drawn, is_drawn)) {
            found += fmt::format("{} {}, ", shown, is_drawn ? "drawn" : "not drawn");
        }
        if (const std::string now = made.states(); !now.empty()) {
            found += fmt::format("{} {}, ", shown, now);
        }
    }
    CHECK(found ==
          "0 IDLE READY SYNCHRONIZED, 1 VISIBLE, 2 drawn, 2 FOCUSED, 10 VISIBLE, 20 SYNCHRONIZED, "
          "21 not drawn, 30 VISIBLE, 31 drawn, 35 FOCUSED, 40 not drawn, ");
}

TEST_CASE("a session that is being lost says so with every success, and then fails; the next one is well") {
    Begun made("rate 10\nat 1 lose-session\n");
    const XrSession session = made.session;
    made.frames(10);
    made.states();
    XrFrameState state{XR_TYPE_FRAME_STATE};
    std::uint32_t count = 0;
    CHECK(xrWaitFrame(session, nullptr, &state) == XR_SESSION_LOSS_PENDING);
    CHECK(made.states() == "LOSS_PENDING");
    checkEach(XR_SESSION_LOSS_PENDING,
              {xrEnumerateReferenceSpaces(session, 0, &count, nullptr), xrBeginFrame(session, nullptr),
               made.endFrame(state.predictedDisplayTime)});
    checkEach(XR_ERROR_SESSION_LOST,
              {made.waitForFailure(), xrEnumerateReferenceSpaces(session, 0, &count, nullptr),
               xrRequestExitSession(session)});
    CHECK(xrDestroySession(session) == XR_SUCCESS);
    // Time has moved on, so the script's line is in the history.
    made.makeSession();
    made.focus();
}

TEST_CASE("an instance that is lost says when, and then fails") {
    const Begun made("rate 10\nat 1 lose-instance\n");
    made.frames(10);
    made.states();
    const XrTime time = made.waitFrame().predictedDisplayTime;
    XrEventDataBuffer event;
    REQUIRE(made.poll(event) == XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING);
    CHECK(reinterpret_cast<const XrEventDataInstanceLossPending&>(event).lossTime > time);
    CHECK(XR_SUCCEEDED(xrBeginFrame(made.session, nullptr)));
    XrPath path = XR_NULL_PATH;
    checkEach(XR_ERROR_INSTANCE_LOST, {made.waitForFailure(), xrStringToPath(made.instance, "/a", &path),
                                       xrPollEvent(made.instance, &event)});
}

TEST_CASE("events that nobody polls are lost and counted") {
    // Loses and regains focus in every second frame, from the third on.
    std::string script = "rate 10\n";
    for (int i = 0; i < 110; ++i) {
        script += fmt::format("at {} focused {}\n", 0.25 + 0.1 * i, i % 2 == 0 ? "off" : "on");
    }
    const Begun made(script);
    made.frames(100);
    XrEventDataBuffer event;
    int kept = 0;
    while (made.poll(event) == XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED) { ++kept; }
    CHECK(kept == 64);
    REQUIRE(event.type == XR_TYPE_EVENT_DATA_EVENTS_LOST);
    // IDLE, READY, and a change with each of the frames.
    CHECK(reinterpret_cast<const XrEventDataEventsLost&>(event).lostEventCount == 102 - 64);
    CHECK(made.poll(event) == XR_TYPE_UNKNOWN);
}

TEST_CASE("frames go by the display's rate from the next one on, as the program requests it, or the script") {
    const Begun made("rate 100\nat 0.1 rate 50", {XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME});
    const auto request = made.XR(xrRequestDisplayRefreshRateFB);
    XrFrameState state = made.frame();
    const auto step = [&] {
        const XrTime before = std::exchange(state, made.frame()).predictedDisplayTime;
        return state.predictedDisplayTime - before;
    };
    CHECK(step() == kPeriod);
    REQUIRE(request(made.session, 80) == XR_SUCCESS);
    CHECK(step() == 12'500'000);
    CHECK(state.predictedDisplayPeriod == 12'500'000);
    REQUIRE(request(made.session, 0) == XR_SUCCESS);
    CHECK(step() == kPeriod);
    made.states();
    // From 0.0325 s on.
    for (int i = 0; i < 12; ++i) { CHECK(step() == (i < 7 ? kPeriod : 2 * kPeriod)); }
    CHECK(made.rateChanges() == "100 to 50");
    float rates[16] = {};
    std::uint32_t count = 0;
    REQUIRE(made.XR(xrEnumerateDisplayRefreshRatesFB)(made.session, 16, &count, rates) == XR_SUCCESS);
    CHECK(std::count(rates, rates + count, 50.0f) == 1);
}

TEST_CASE("irregular periods differ, within what the script says, and do not drift") {
    std::set<XrDuration> steps;
    XrTime before = kStart;
    for (const XrFrameState& state : Begun("rate 100\nirregular 50").frames(200)) {
        if (state.predictedDisplayTime != kStart) { steps.insert(state.predictedDisplayTime - before); }
        before = state.predictedDisplayTime;
        CHECK(state.predictedDisplayPeriod == kPeriod);
    }
    CHECK(steps.size() > 50);
    CHECK(*steps.begin() >= kPeriod / 2);
    CHECK(*steps.rbegin() <= kPeriod + kPeriod / 2);
    CHECK(std::abs(before - kStart - 199 * kPeriod) <= kPeriod / 4);
}

TEST_CASE("a device that takes longer than a period misses displays, which a stretched period counts") {
    for (const std::string period : {"steady", "stretched"}) {
        const Begun made(
            "rate 100\nat 0.1 gpu-load 70 %\nat 0.2 gpu-load 25 ms\nat 0.4 gpu-load 0 ms\nperiod " + period);
        XrTime before = kStart - kPeriod;
        for (const XrFrameState& state : made.frames(40)) {
            const bool is_slow = before >= kStart + 20 * kPeriod && before < kStart + 40 * kPeriod;
            const XrDuration step = state.predictedDisplayTime - before;
            CHECK(step == (is_slow ? 3 : 1) * kPeriod);
            CHECK(state.predictedDisplayPeriod == (period == "stretched" ? step : kPeriod));
            before = state.predictedDisplayTime;
        }
        std::set<double> said;
        for (const Json& line : made.logged()) { said.insert(line.value("gpu_ms", 0.0)); }
        CHECK(said == std::set<double>{0.0, 7.0, 25.0});
    }
}

TEST_CASE_FIXTURE(Leaving, "the session moves though every frame is refused, and the log has the reasons") {
    const auto refuse = [&](XrTime time) {
        for (int i = 0; i < 2; ++i) { CHECK(endFrame(-time) == XR_ERROR_TIME_INVALID); }
    };
    CHECK(runOn(refuse) == kWholeLife);
    CHECK(xrEndSession(session) == XR_SUCCESS);
    std::string events;
    XrTime refused = 0;
    for (const Json& line : logged()) {
        CHECK_FALSE(line.contains("frame"));
        for (const std::string event : line["events"]) { events += event + ", "; }
        if (!line.contains("refused")) { continue; }
        const XrTime time = kStart + kPeriod * refused++;
        CHECK(these(line["refused"], line["display_time_ns"], line["reason"]) ==
              these("XR_ERROR_TIME_INVALID", time, fmt::format("the time is {}, must be positive", -time)));
    }
    CHECK(refused == 13);
    CHECK(events ==
          "state IDLE, state READY, state SYNCHRONIZED, state VISIBLE, state FOCUSED, exit, state VISIBLE, "
          "state SYNCHRONIZED, state STOPPING, state IDLE, state EXITING, ");
}

TEST_CASE_FIXTURE(Leaving, "a frame that is refused and ended again moves the session once") {
    const auto endTwice = [&](XrTime time) {
        CHECK(endFrame(0) == XR_ERROR_TIME_INVALID);
        CHECK(endFrame(time) == XR_SUCCESS);
    };
    CHECK(runOn(endTwice) == kWholeLife);
    CHECK(xrEndSession(session) == XR_SUCCESS);
    const std::vector<Json> lines = logged();
    REQUIRE(lines.size() == 28);
    for (std::size_t i = 0; i < 26; ++i) { CHECK(lines[i].contains(i % 2 == 0 ? "refused" : "frame")); }
    CHECK(lines[25]["frame"] == 12);
    // The log ends with the last states.
    CHECK(these(lines[26]["events"], lines[26]["session_state"]) ==
          these(Json{"state STOPPING"}, "STOPPING"));
    CHECK(lines[27] == Json{{"session_state", "EXITING"},
                            {"display_time_ns", lines[26]["display_time_ns"]},
                            {"events", {"state IDLE", "state EXITING"}}});
}

TEST_CASE_FIXTURE(Leaving, "frames that are given up move the session, too") {
    CHECK(runOn([](XrTime) {}) == kWholeLife);
}

TEST_CASE("states change while a frame is open, where the script says so, and the frame may still be ended") {
    const Begun made("rate 100\nstate-changes at-begin\nat 0.2 worn off");
    std::string seen = " " + made.states();
    for (int i = 0; i < 40 && !seen.ends_with("STOPPING"); ++i) {
        const XrFrameState state = made.waitFrame();
        CHECK(made.states() == "");
        const XrFrameBeginInfo info{XR_TYPE_FRAME_BEGIN_INFO};
        REQUIRE(xrBeginFrame(made.session, &info) == XR_SUCCESS);
        if (const std::string now = made.states(); !now.empty()) { seen += " " + now; }
        CHECK(made.endFrame(state.predictedDisplayTime) == XR_SUCCESS);
        CHECK(made.states() == "");
    }
    CHECK(seen == kWholeLife);
    CHECK(xrEndSession(made.session) == XR_SUCCESS);
}

}  // SUITE(simulated_session)
