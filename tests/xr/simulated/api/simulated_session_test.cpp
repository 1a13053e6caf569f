// Chapter 9 and section 10.4 of OpenXR on the simulated runtime: a session's life, its frames, their pace,
// and how it ends.
#include "tests/xr/simulated/api/simulated_fixture.h"

SUITE(simulated_session) {

using Json = nlohmann::json;

const std::string kSmall = "size 64 64\nframes none\n";
constexpr XrDuration kPeriod = 10'000'000;  // 100 frames per second
const States kWholeLife{XR_SESSION_STATE_IDLE,         XR_SESSION_STATE_READY,
                        XR_SESSION_STATE_SYNCHRONIZED, XR_SESSION_STATE_VISIBLE,
                        XR_SESSION_STATE_FOCUSED,      XR_SESSION_STATE_VISIBLE,
                        XR_SESSION_STATE_SYNCHRONIZED, XR_SESSION_STATE_STOPPING};

struct Begun : SessionFixture {
    explicit Begun(const std::string& script, const Extensions& extensions = {})
        : SessionFixture(kSmall + script, extensions) {
        begin();
    }

    std::vector<XrFrameState> frames(int count) const {
        std::vector<XrFrameState> states;
        for (int i = 0; i < count; ++i) { states.push_back(frame()); }
        return states;
    }
};

// A hundred frames per second, and the wearer leaves after ten.
struct Leaving : Begun {
    Leaving() : Begun("rate 100\nat 0.1 exit") {}

    // Waits for frames and passes on their times, until the session should stop.
    template <class Body>
    States runOn(const Body& body) const {
        States seen;
        for (int i = 0; i < 50; ++i) {
            const XrTime time = waitFrame().predictedDisplayTime;
            for (const XrSessionState state : states()) { seen.push_back(state); }
            if (!seen.empty() && seen.back() == XR_SESSION_STATE_STOPPING) { break; }
            CHECK(XR_SUCCEEDED(xrBeginFrame(session, nullptr)));
            body(time);
        }
        return seen;
    }
};

// The result of the first call that fails within ten frames.
XrResult failureOf(const SessionFixture& made) {
    XrResult result = XR_SUCCESS;
    XrFrameState state{XR_TYPE_FRAME_STATE};
    for (int i = 0; i < 10 && XR_SUCCEEDED(result); ++i) {
        result = xrWaitFrame(made.session, nullptr, &state);
        if (XR_SUCCEEDED(result)) { result = xrBeginFrame(made.session, nullptr); }
        if (XR_SUCCEEDED(result)) { result = made.endFrame(state.predictedDisplayTime); }
    }
    return result;
}

TEST_CASE_FIXTURE(VulkanFixture,
                  "a session wants a graphics binding and a system; its objects and events end with it") {
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

    const XrSwapchainCreateInfo swapchain_info = swapchainInfo();
    XrSwapchain swapchain = XR_NULL_HANDLE;
    REQUIRE(xrCreateSwapchain(session, &swapchain_info, &swapchain) == XR_SUCCESS);
    const XrSpace space = makeSpace(XR_REFERENCE_SPACE_TYPE_LOCAL);
    // A handle of one type is not accepted as another.
    checkEach(XR_ERROR_HANDLE_INVALID, {xrDestroySession(reinterpret_cast<XrSession>(space)),
                                        xrDestroySpace(reinterpret_cast<XrSpace>(session)),
                                        xrDestroySwapchain(reinterpret_cast<XrSwapchain>(instance)),
                                        xrDestroySession(XR_NULL_HANDLE)});

    CHECK(xrDestroySession(session) == XR_SUCCESS);
    checkEach(XR_ERROR_HANDLE_INVALID, {xrDestroySession(session), xrDestroySpace(space),
                                        xrDestroySwapchain(swapchain), xrRequestExitSession(session)});
    CHECK(states().empty());
    checkEach(XR_SUCCESS, {make(), xrDestroySession(session), make()});
    CHECK(states() == States{XR_SESSION_STATE_IDLE, XR_SESSION_STATE_READY});
}

TEST_CASE_FIXTURE(
    SessionFixture,
    "a session begins once, when it is READY, in stereo, and goes from IDLE to FOCUSED, a state per frame") {
    XrFrameState state{XR_TYPE_FRAME_STATE};
    checkEach(XR_ERROR_SESSION_NOT_RUNNING,
              {xrWaitFrame(session, nullptr, &state), xrBeginFrame(session, nullptr), endFrame(1),
               xrEndSession(session), xrRequestExitSession(session)});

    XrSessionBeginInfo info{XR_TYPE_SESSION_BEGIN_INFO, nullptr, kStereo};
    const auto begin = [&] { return xrBeginSession(session, &info); };
    CHECK(with(info.primaryViewConfigurationType, XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO, begin) ==
          XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED);
    checkArguments(xrBeginSession, session, &info);
    CHECK(states() == States{XR_SESSION_STATE_IDLE, XR_SESSION_STATE_READY});
    CHECK(begin() == XR_SUCCESS);
    CHECK(begin() == XR_ERROR_SESSION_RUNNING);

    // Frames should be drawn from VISIBLE on; in lock-step, a frame lasts one period.
    state = frame();
    CHECK(these(state.shouldRender, state.predictedDisplayPeriod, state.predictedDisplayTime) ==
          these(XR_FALSE, 11'111'111, kStart));
    CHECK(states() == States{XR_SESSION_STATE_SYNCHRONIZED});
    state = frame();
    CHECK(these(state.shouldRender, state.predictedDisplayTime) ==
          these(XR_FALSE, kStart + state.predictedDisplayPeriod));
    CHECK(states() == States{XR_SESSION_STATE_VISIBLE});
    CHECK(frame().shouldRender == XR_TRUE);
    CHECK(states() == States{XR_SESSION_STATE_FOCUSED});
    frame();
    CHECK(states().empty());

    CHECK(xrEndSession(session) == XR_ERROR_SESSION_NOT_STOPPING);
    CHECK(xrRequestExitSession(session) == XR_SUCCESS);
    for (int i = 0; i < 3; ++i) { frame(); }
    CHECK(states() ==
          States{XR_SESSION_STATE_VISIBLE, XR_SESSION_STATE_SYNCHRONIZED, XR_SESSION_STATE_STOPPING});
    CHECK(xrEndSession(session) == XR_SUCCESS);
    CHECK(states() == States{XR_SESSION_STATE_IDLE, XR_SESSION_STATE_EXITING});
    CHECK(begin() == XR_ERROR_SESSION_NOT_READY);
}

TEST_CASE_FIXTURE(SessionFixture,
                  "frames are waited for, begun and ended in this order, in structures of their types") {
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

    XrFrameEndInfo info{XR_TYPE_FRAME_END_INFO,           nullptr, second,
                        XR_ENVIRONMENT_BLEND_MODE_OPAQUE, 0,       nullptr};
    const auto end = [&] { return xrEndFrame(session, &info); };
    checkArguments(xrEndFrame, session, &info);
    CHECK(with(info.environmentBlendMode, XR_ENVIRONMENT_BLEND_MODE_ADDITIVE, end) ==
          XR_ERROR_ENVIRONMENT_BLEND_MODE_UNSUPPORTED);
    CHECK(with(info.environmentBlendMode, static_cast<XrEnvironmentBlendMode>(0), end) ==
          XR_ERROR_VALIDATION_FAILURE);
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
    const SessionFixture made(kSmall +
                              "rate 10\nat 1 focused off\nat 2 visible off\nat 3 visible on\nat 3.5 focused "
                              "on\nat 4 should-render off\n");
    made.focus();  // three frames of 0.1 s
    int shown = 2;
    const auto runTo = [&](int frame) {
        XrFrameState state{};
        for (; shown < frame; ++shown) { state = made.frame(); }
        return state.shouldRender == XR_TRUE;
    };
    CHECK(runTo(10));
    CHECK(made.states() == States{XR_SESSION_STATE_VISIBLE});
    runTo(20);
    CHECK(made.states() == States{XR_SESSION_STATE_SYNCHRONIZED});
    CHECK_FALSE(runTo(21));
    runTo(36);
    CHECK(made.states() == States{XR_SESSION_STATE_VISIBLE, XR_SESSION_STATE_FOCUSED});
    CHECK_FALSE(runTo(41));
    CHECK(made.states().empty());
}

TEST_CASE("a session that is being lost says so with every success, and then fails; the next one is well") {
    SessionFixture made(kSmall + "rate 10\nat 1 lose-session\n");
    const XrSession session = made.session;
    made.focus();
    for (int i = 3; i < 10; ++i) { made.frame(); }
    XrFrameState state{XR_TYPE_FRAME_STATE};
    CHECK(xrWaitFrame(session, nullptr, &state) == XR_SESSION_LOSS_PENDING);
    CHECK(made.states() == States{XR_SESSION_STATE_LOSS_PENDING});
    std::uint32_t count = 0;
    CHECK(xrEnumerateReferenceSpaces(session, 0, &count, nullptr) == XR_SESSION_LOSS_PENDING);
    CHECK(xrBeginFrame(session, nullptr) == XR_SESSION_LOSS_PENDING);
    CHECK(made.endFrame(state.predictedDisplayTime) == XR_SESSION_LOSS_PENDING);
    checkEach(XR_ERROR_SESSION_LOST,
              {failureOf(made), xrEnumerateReferenceSpaces(session, 0, &count, nullptr),
               xrRequestExitSession(session)});
    CHECK(xrDestroySession(session) == XR_SUCCESS);
    // Time has moved on, so the script's line is in the history.
    made.makeSession();
    made.focus();
}

TEST_CASE("an instance that is lost says when, and then fails") {
    const SessionFixture made(kSmall + "rate 10\nat 1 lose-instance\n");
    made.focus();
    for (int i = 3; i < 10; ++i) { made.frame(); }
    const XrTime time = made.waitFrame().predictedDisplayTime;
    XrEventDataBuffer event;
    REQUIRE(made.poll(event) == XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING);
    CHECK(reinterpret_cast<const XrEventDataInstanceLossPending&>(event).lossTime > time);
    CHECK(XR_SUCCEEDED(xrBeginFrame(made.session, nullptr)));
    CHECK(failureOf(made) == XR_ERROR_INSTANCE_LOST);
    XrPath path = XR_NULL_PATH;
    checkEach(XR_ERROR_INSTANCE_LOST,
              {xrStringToPath(made.instance, "/a", &path), xrPollEvent(made.instance, &event)});
}

TEST_CASE("events that nobody polls are lost and counted") {
    // Loses and regains focus in every second frame, from the third on.
    std::string script = "rate 10\n";
    for (int i = 0; i < 110; ++i) {
        script += "at " + std::to_string(0.25 + 0.1 * i) + (i % 2 == 0 ? " focused off\n" : " focused on\n");
    }
    const Begun made(script);
    made.frames(100);
    XrEventDataBuffer event;
    int kept = 0;
    XrStructureType type = made.poll(event);
    for (; type == XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED; type = made.poll(event)) { ++kept; }
    CHECK(kept == 64);
    REQUIRE(type == XR_TYPE_EVENT_DATA_EVENTS_LOST);
    // IDLE, READY, and a change with each of the frames.
    CHECK(reinterpret_cast<const XrEventDataEventsLost&>(event).lostEventCount == 102 - 64);
    CHECK(made.poll(event) == XR_TYPE_UNKNOWN);
}

TEST_CASE(
    "frames go by the display's rate from the next one on: that which the program requests, or the script, "
    "which tells of it") {
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
    std::vector<XrDuration> steps;
    for (int i = 0; i < 12; ++i) { steps.push_back(step()); }
    CHECK(these(std::ranges::find(steps, 2 * kPeriod) - steps.begin(),
                std::ranges::count(steps, 2 * kPeriod)) == these(7, 5));
    const auto changes = made.events<XrEventDataDisplayRefreshRateChangedFB>(
        XR_TYPE_EVENT_DATA_DISPLAY_REFRESH_RATE_CHANGED_FB);
    REQUIRE(changes.size() == 1);
    CHECK(these(changes[0].fromDisplayRefreshRate, changes[0].toDisplayRefreshRate) == these(100.0f, 50.0f));
    float rates[16] = {};
    std::uint32_t count = 0;
    REQUIRE(made.XR(xrEnumerateDisplayRefreshRatesFB)(made.session, 16, &count, rates) == XR_SUCCESS);
    CHECK(std::count(rates, rates + count, 50.0f) == 1);
}

TEST_CASE(
    "irregular periods differ, within what the script says, and do not drift; a stretched one is as many as "
    "the frame before took") {
    std::set<XrDuration> steps, stated;
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

    before = kStart - kPeriod;
    for (const XrFrameState& state :
         Begun("rate 100\nperiod stretched\nat 0.1 gpu-load 25 ms\nat 0.3 gpu-load 0 ms").frames(40)) {
        CHECK(state.predictedDisplayTime - before == state.predictedDisplayPeriod);
        before = state.predictedDisplayTime;
        stated.insert(state.predictedDisplayPeriod);
    }
    CHECK(stated == std::set<XrDuration>{kPeriod, 3 * kPeriod});
}

TEST_CASE("a device that takes longer than a period misses displays, and the log says how long it takes") {
    const Begun made("rate 100\nat 0.1 gpu-load 70 %\nat 0.2 gpu-load 25 ms\nat 0.4 gpu-load 0 ms");
    const std::vector<XrFrameState> frames = made.frames(40);
    const auto stepsIn = [&](double from_s, double to_s) {
        std::set<XrDuration> steps;
        for (std::size_t i = 1; i < frames.size(); ++i) {
            const XrTime time = frames[i - 1].predictedDisplayTime;
            const double time_s = 1e-9 * static_cast<double>(time - kStart);
            if (time_s >= from_s && time_s < to_s) {
                steps.insert((frames[i].predictedDisplayTime - time) / kPeriod);
            }
        }
        return steps;
    };
    CHECK(these(stepsIn(0.0, 0.199), stepsIn(0.2, 0.399), stepsIn(0.41, 9.0)) ==
          these(std::set<XrDuration>{1}, std::set<XrDuration>{3}, std::set<XrDuration>{1}));
    std::set<double> said;
    for (const Json& line : made.logged()) { said.insert(line.value("gpu_ms", 0.0)); }
    CHECK(said == std::set<double>{0.0, 7.0, 25.0});
}

TEST_CASE_FIXTURE(Leaving,
                  "the script goes on and the session moves though every frame is refused, and the log has "
                  "each with its reason") {
    const auto refuse = [&](XrTime time) {
        for (int i = 0; i < 2; ++i) { CHECK(endFrame(-time) == XR_ERROR_TIME_INVALID); }
    };
    CHECK(runOn(refuse) == kWholeLife);
    CHECK(xrEndSession(session) == XR_SUCCESS);
    CHECK(states() == States{XR_SESSION_STATE_IDLE, XR_SESSION_STATE_EXITING});
    std::vector<std::string> events;
    XrTime refused = 0;
    for (const Json& line : logged()) {
        CHECK_FALSE(line.contains("frame"));
        for (const auto& event : line["events"]) { events.push_back(event); }
        if (!line.contains("refused")) { continue; }
        CHECK(these(line["refused"], line["display_time_ns"]) ==
              these("XR_ERROR_TIME_INVALID", kStart + kPeriod * refused));
        CHECK(line["reason"] ==
              "the time is " + std::to_string(-line["display_time_ns"].get<XrTime>()) + ", must be positive");
        ++refused;
    }
    CHECK(refused == 13);
    CHECK(events == std::vector<std::string>{"state IDLE", "state READY", "state SYNCHRONIZED",
                                             "state VISIBLE", "state FOCUSED", "exit", "state VISIBLE",
                                             "state SYNCHRONIZED", "state STOPPING", "state IDLE",
                                             "state EXITING"});
}

TEST_CASE_FIXTURE(
    Leaving,
    "a frame that is refused and ended again moves the session once, and the log ends with its last states") {
    for (int i = 0; i < 3; ++i) {
        const XrTime time = waitFrame().predictedDisplayTime;
        REQUIRE(xrBeginFrame(session, nullptr) == XR_SUCCESS);
        CHECK(endFrame(0) == XR_ERROR_TIME_INVALID);
        CHECK(endFrame(time) == XR_SUCCESS);
        CHECK(states().back() == static_cast<XrSessionState>(XR_SESSION_STATE_SYNCHRONIZED + i));
    }
    std::vector<Json> lines = logged();
    REQUIRE(lines.size() == 6);
    CHECK(these(lines[4].contains("refused"), lines[5]["frame"]) == these(true, 2));
    while (states() != States{XR_SESSION_STATE_STOPPING}) { frame(); }
    CHECK(xrEndSession(session) == XR_SUCCESS);
    lines = logged();
    CHECK(these(lines[lines.size() - 3].contains("frame"), lines[lines.size() - 2]["events"],
                lines[lines.size() - 2]["session_state"]) == these(true, Json{"state STOPPING"}, "STOPPING"));
    CHECK(lines.back()["events"] == Json{"state IDLE", "state EXITING"});
}

TEST_CASE_FIXTURE(Leaving, "frames that are given up move the session, too") {
    CHECK(runOn([](XrTime) {}) == kWholeLife);
}

TEST_CASE("states change while a frame is open, where the script says so, and the frame may still be ended") {
    const Begun made("rate 100\nstate-changes at-begin\nat 0.2 worn off");
    States open, closed;
    const auto take = [&](States& into) {
        for (const XrSessionState state : made.states()) { into.push_back(state); }
    };
    take(closed);
    for (int i = 0; i < 40 && (open.empty() || open.back() != XR_SESSION_STATE_STOPPING); ++i) {
        const XrFrameState state = made.waitFrame();
        take(closed);
        const XrFrameBeginInfo info{XR_TYPE_FRAME_BEGIN_INFO};
        REQUIRE(xrBeginFrame(made.session, &info) == XR_SUCCESS);
        take(open);
        CHECK(made.endFrame(state.predictedDisplayTime) == XR_SUCCESS);
        take(closed);
    }
    REQUIRE_FALSE(open.empty());
    CHECK(these(open.front(), open.back()) ==
          these(XR_SESSION_STATE_SYNCHRONIZED, XR_SESSION_STATE_STOPPING));
    CHECK(std::ranges::count(closed, XR_SESSION_STATE_FOCUSED) == 0);
    CHECK(xrEndSession(made.session) == XR_SUCCESS);
}

}  // SUITE(simulated_session)
