// Headless sessions without a loader: the extensions that need no graphics, and objects that are destroyed in
// every order.
#include "tests/xr/simulated/api/simulated_direct.h"

SUITE(simulated_extensions) {

std::int64_t nanoseconds(const timespec& time) { return time.tv_sec * 1'000'000'000LL + time.tv_nsec; }

// The joints of a hand, as last located.
struct Hand {
    const HeadlessSession& made;
    XrHandTrackerCreateInfoEXT info;
    XrHandTrackerEXT tracker = XR_NULL_HANDLE;
    XrHandJointLocationEXT joints[XR_HAND_JOINT_COUNT_EXT];
    XrHandJointVelocityEXT speeds[XR_HAND_JOINT_COUNT_EXT];
    XrHandJointVelocitiesEXT velocities{XR_TYPE_HAND_JOINT_VELOCITIES_EXT, nullptr, XR_HAND_JOINT_COUNT_EXT,
                                        speeds};
    XrHandJointLocationsEXT locations{XR_TYPE_HAND_JOINT_LOCATIONS_EXT, &velocities, XR_TRUE,
                                      XR_HAND_JOINT_COUNT_EXT, joints};
    XrHandJointsLocateInfoEXT where{XR_TYPE_HAND_JOINTS_LOCATE_INFO_EXT};

    Hand(const HeadlessSession& session, XrHandEXT side)
        : made(session),
          info{XR_TYPE_HAND_TRACKER_CREATE_INFO_EXT, nullptr, side, XR_HAND_JOINT_SET_DEFAULT_EXT} {
        REQUIRE(made.XR(xrCreateHandTrackerEXT)(made.session, &info, &tracker) == XR_SUCCESS);
        where.baseSpace = made.makeSpace(XR_REFERENCE_SPACE_TYPE_STAGE);
    }
    XrResult locate() { return made.XR(xrLocateHandJointsEXT)(tracker, &where, &locations); }
    bool isActiveAt(double time_s) {
        where.time = kStart + std::llround(1e9 * time_s);
        REQUIRE(locate() == XR_SUCCESS);
        return locations.isActive == XR_TRUE;
    }
    double reach(XrHandJointEXT tip, XrHandJointEXT from) const {
        const XrVector3f &a = joints[tip].pose.position, &b = joints[from].pose.position;
        return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
    }
};

struct Everything : HeadlessSession {
    XrDebugUtilsMessengerEXT messenger = XR_NULL_HANDLE;
    XrActionSet set = makeActionSet("set");
    XrAction action = makeAction(set, "grip", XR_ACTION_TYPE_POSE_INPUT);
    XrSpace reference_space = makeSpace(XR_REFERENCE_SPACE_TYPE_STAGE), action_space = XR_NULL_HANDLE;
    XrHandTrackerEXT tracker = Hand(*this, XR_HAND_LEFT_EXT).tracker;
    // By name: the parent, and how to destroy it.
    std::map<std::string, std::pair<std::string, std::function<XrResult()>>> objects{
        {"messenger", {"", [&] { return XR(xrDestroyDebugUtilsMessengerEXT)(messenger); }}},
        {"set", {"", [&] { return XR(xrDestroyActionSet)(set); }}},
        {"action", {"set", [&] { return XR(xrDestroyAction)(action); }}},
        {"session", {"", [&] { return XR(xrDestroySession)(session); }}},
        {"reference space", {"session", [&] { return XR(xrDestroySpace)(reference_space); }}},
        {"action space", {"session", [&] { return XR(xrDestroySpace)(action_space); }}},
        {"tracker", {"session", [&] { return XR(xrDestroyHandTrackerEXT)(tracker); }}},
    };

    explicit Everything(bool attaches)
        : HeadlessSession(k1_1, {XR_EXT_DEBUG_UTILS_EXTENSION_NAME, XR_EXT_HAND_TRACKING_EXTENSION_NAME}) {
        const XrDebugUtilsMessengerCreateInfoEXT info{
            XR_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT, nullptr,
            XR_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT, XR_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
            [](auto...) { return XrBool32{XR_FALSE}; },    nullptr};
        REQUIRE(XR(xrCreateDebugUtilsMessengerEXT)(instance, &info, &messenger) == XR_SUCCESS);
        if (attaches) { attach({set}); }
        action_space = makeActionSpace(action);
        begin();
    }
};

TEST_CASE("time is converted to CLOCK_MONOTONIC, with which the real clock goes alike, and back") {
    for (const bool is_real : {false, true}) {
        Headset::clock = is_real ? "real" : "lockstep";
        const HeadlessSession made(k1_0, {XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME});
        Headset::clock = "lockstep";
        const auto toTime = made.XR(xrConvertTimespecTimeToTimeKHR);
        const auto toTimespec = made.XR(xrConvertTimeToTimespecTimeKHR);
        timespec now{}, back{}, after{};
        REQUIRE(clock_gettime(CLOCK_MONOTONIC, &now) == 0);
        XrTime time = 0, later = 0;
        checkEach(XR_SUCCESS, {toTime(made.instance, &now, &time), toTimespec(made.instance, time, &back)});
        CHECK(nanoseconds(back) == nanoseconds(now));
        // In lock-step, the two clocks are equal when first asked for: OpenXR's time has not begun to move.
        CHECK((is_real || (time > 0 && time <= kStart)));
        made.begin();
        REQUIRE(made.sync() == XR_SUCCESS);
        REQUIRE(clock_gettime(CLOCK_MONOTONIC, &after) == 0);
        CHECK(toTime(made.instance, &after, &later) == XR_SUCCESS);
        CHECK(later - time == nanoseconds(after) - nanoseconds(now));
        CHECK((later >= kStart || !is_real));

        checkArguments(toTime, made.instance, &now, &time);
        const auto toPlace = [&](XrInstance of, timespec* place) { return toTimespec(of, time, place); };
        checkArguments(toPlace, made.instance, &back);
        for (const XrTime bad : {XrTime{0}, XrTime{-1}, std::numeric_limits<XrTime>::max()}) {
            CHECK(toTimespec(made.instance, bad, &back) == XR_ERROR_TIME_INVALID);
        }
        for (const timespec bad : {timespec{0, 0}, timespec{-1, 0}, timespec{now.tv_sec, 1'000'000'000},
                                   timespec{now.tv_sec, -1}}) {
            CHECK(toTime(made.instance, &bad, &time) == XR_ERROR_TIME_INVALID);
        }
    }
}

TEST_CASE("whether somebody wears the headset is told when the session begins, and when it changes") {
    for (const Extensions& extensions : {Extensions{XR_EXT_USER_PRESENCE_EXTENSION_NAME}, Extensions{}}) {
        const HeadlessSession made(k1_0, extensions, "rate 10\nat 0.15 present off\nat 0.35 present on\n");
        XrSystemUserPresencePropertiesEXT presence{XR_TYPE_SYSTEM_USER_PRESENCE_PROPERTIES_EXT};
        made.systemProperties(&presence);
        CHECK(presence.supportsUserPresence == !extensions.empty());
        std::string found;  // the frame of each event, and whether somebody is present
        const auto take = [&](const std::string& when) {
            for (const auto& change : made.events<XrEventDataUserPresenceChangedEXT>(
                     XR_TYPE_EVENT_DATA_USER_PRESENCE_CHANGED_EXT)) {
                CHECK(change.session == made.session);
                found += when + (change.isUserPresent == XR_TRUE ? " on " : " off ");
            }
        };
        take("before");
        made.begin();
        take("begun");
        for (int frame = 0; frame < 6; ++frame) {
            made.sync();
            take(std::to_string(frame));
        }
        // Without the extension, no event is sent.
        CHECK(found == (extensions.empty() ? "" : "begun on 2 off 4 on "));
    }
}

TEST_CASE("the display's rate is one of a list, or the one that is fixed") {
    for (const bool is_fixed : {false, true}) {
        const HeadlessSession made(k1_0, {XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME},
                                   is_fixed ? "rate 80 fixed\n" : "rate 100\n");
        const auto request = [&](float rate) {
            return made.XR(xrRequestDisplayRefreshRateFB)(made.session, rate);
        };
        const std::vector<float> rates =
            checkListOf(0.0f, made.XR(xrEnumerateDisplayRefreshRatesFB), made.session);
        if (is_fixed) {
            CHECK(rates == std::vector<float>{80});
            checkEach(XR_SUCCESS, {request(80), request(0)});
            CHECK(request(90) == XR_ERROR_DISPLAY_REFRESH_RATE_UNSUPPORTED_FB);
            continue;
        }
        const auto current = [&] {
            float rate = 0;
            CHECK(made.XR(xrGetDisplayRefreshRateFB)(made.session, &rate) == XR_SUCCESS);
            return rate;
        };
        CHECK(rates == std::vector<float>{72, 80, 90, 100, 120});
        CHECK(current() == 100);
        checkEach(XR_ERROR_DISPLAY_REFRESH_RATE_UNSUPPORTED_FB, {request(75), request(NAN)});
        made.states();
        checkEach(XR_SUCCESS, {request(80), request(80)});
        CHECK(made.rateChanges() == "100 to 80");
        CHECK(current() == 80);
        CHECK(request(0) == XR_SUCCESS);
        CHECK(current() == 100);
        float rate = 0;
        checkArguments(made.XR(xrGetDisplayRefreshRateFB), made.session, &rate);
        CHECK(made.XR(xrRequestDisplayRefreshRateFB)(XR_NULL_HANDLE, 80) == XR_ERROR_HANDLE_INVALID);
    }
}

TEST_CASE("hands hold the script's controllers, in focus and while they are tracked") {
    const HeadlessSession made(k1_0, {XR_EXT_HAND_TRACKING_EXTENSION_NAME},
                               "rate 10\ncontroller left 0 position -0.2 1 0\n"
                               "controller left 1 position 0.8 1 0\n"
                               "axis right trigger 0 1\nat 0.25 controller right off\n");
    XrSystemHandTrackingPropertiesEXT hands{XR_TYPE_SYSTEM_HAND_TRACKING_PROPERTIES_EXT};
    made.systemProperties(&hands);
    CHECK(hands.supportsHandTracking == XR_TRUE);
    Hand left(made, XR_HAND_LEFT_EXT), right(made, XR_HAND_RIGHT_EXT);
    const auto create = made.XR(xrCreateHandTrackerEXT);
    XrHandTrackerEXT none = XR_NULL_HANDLE;
    const auto make = [&] { return create(made.session, &left.info, &none); };
    checkChanges(make, XR_ERROR_VALIDATION_FAILURE, to(left.info.hand, static_cast<XrHandEXT>(3)),
                 to(left.info.handJointSet, static_cast<XrHandJointSetEXT>(1)));
    checkArguments(create, made.session, &left.info, &none);

    CHECK_MESSAGE(!left.isActiveAt(0.1), "not in focus yet");
    CHECK(left.joints[3].locationFlags == 0);
    made.begin();
    CHECK(left.isActiveAt(0.1));
    // The palm lies beside the grip pose, at -0.1 1 0, and moves one metre per second.
    const XrVector3f& palm = left.joints[XR_HAND_JOINT_PALM_EXT].pose.position;
    CHECK(these(palm.x, palm.y) == these(doctest::Approx(-0.12), doctest::Approx(1)));
    for (const auto& joint : left.joints) {
        CHECK(these(joint.locationFlags, (joint.radius > 0)) == these(15, true));
    }
    for (const auto& speed : left.speeds) { CHECK(speed.linearVelocity.x == doctest::Approx(1)); }
    // The right trigger is pulled: the index finger bends, and no other.
    CHECK(right.isActiveAt(0.1));
    const double straight = left.reach(XR_HAND_JOINT_INDEX_TIP_EXT, XR_HAND_JOINT_INDEX_PROXIMAL_EXT);
    CHECK(straight == doctest::Approx(0.085));
    CHECK(right.reach(XR_HAND_JOINT_INDEX_TIP_EXT, XR_HAND_JOINT_INDEX_PROXIMAL_EXT) < 0.6 * straight);
    CHECK(right.reach(XR_HAND_JOINT_LITTLE_TIP_EXT, XR_HAND_JOINT_LITTLE_PROXIMAL_EXT) ==
          doctest::Approx(0.07));
    CHECK_FALSE(right.isActiveAt(0.3));

    const auto locate = [&] { return left.locate(); };
    checkChanges(locate, XR_ERROR_VALIDATION_FAILURE, to(left.locations.jointCount, 25),
                 to(left.velocities.jointCount, 25));
    CHECK(with(left.where.time, 0, locate) == XR_ERROR_TIME_INVALID);
    CHECK(with(left.where.baseSpace, XR_NULL_HANDLE, locate) == XR_ERROR_HANDLE_INVALID);
    checkArguments(made.XR(xrLocateHandJointsEXT), left.tracker, &left.where, &left.locations);
    const auto destroy = made.XR(xrDestroyHandTrackerEXT);
    CHECK(destroy(left.tracker) == XR_SUCCESS);
    checkEach(XR_ERROR_HANDLE_INVALID, {destroy(left.tracker), locate()});
}

TEST_CASE("a hand's joints turn with its controller, and those of a finger that bends with that, too") {
    const HeadlessSession made(
        k1_0, {XR_EXT_HAND_TRACKING_EXTENSION_NAME},
        "rate 10\ncontroller left 0 position 0 1 0 turn 0 0\ncontroller left 1 position 0 1 0 turn 45 0\n"
        "axis right trigger 0 0\naxis right trigger 1 1\n");
    made.begin();
    Hand left(made, XR_HAND_LEFT_EXT), right(made, XR_HAND_RIGHT_EXT);
    REQUIRE((left.isActiveAt(0.5) && right.isActiveAt(0.5)));
    for (const auto& speed : right.speeds) { CHECK(speed.velocityFlags == kMoving); }
    // A quarter of pi per second to the left, which is about +y.
    for (const auto& speed : left.speeds) {
        CHECK(these(speed.velocityFlags, speed.angularVelocity.x, speed.angularVelocity.y,
                    speed.angularVelocity.z) == these(kMoving, doctest::Approx(0),
                                                      doctest::Approx(0.25 * std::numbers::pi).epsilon(1e-3),
                                                      doctest::Approx(0)));
    }
    const auto turning = [&](XrHandJointEXT joint) {
        const XrVector3f& speed = right.speeds[joint].angularVelocity;
        return std::hypot(speed.x, speed.y, speed.z);
    };
    CHECK(turning(XR_HAND_JOINT_INDEX_TIP_EXT) > 1);
    CHECK(turning(XR_HAND_JOINT_LITTLE_TIP_EXT) == doctest::Approx(0));
}

TEST_CASE("a headless session needs no swapchains, frames or views, is in focus and ends at once") {
    for (const auto type : {0, int{XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO}, 4711}) {
        const HeadlessSession made(k1_0, {}, "rate 10\nat 0.35 focused off\nat 0.55 exit\n");
        std::uint32_t count = 9;
        CHECK(made.XR(xrEnumerateSwapchainFormats)(made.session, 0, &count, nullptr) == XR_SUCCESS);
        CHECK(count == 0);
        const XrSwapchainCreateInfo info = swapchainInfo();
        XrSwapchain swapchain = XR_NULL_HANDLE;
        CHECK(made.XR(xrCreateSwapchain)(made.session, &info, &swapchain) == XR_ERROR_VALIDATION_FAILURE);
        CHECK(made.states() == "IDLE READY");
        made.begin(static_cast<XrViewConfigurationType>(type));
        CHECK(made.states() == "SYNCHRONIZED VISIBLE FOCUSED");
        // Each xrSyncActions takes a frame's time: 0, 0.1, 0.2, 0.3 s in focus.
        for (int i = 0; i < 4; ++i) { CHECK(made.sync() == XR_SUCCESS); }
        CHECK(made.sync() == XR_SESSION_NOT_FOCUSED);
        CHECK(made.states() == "VISIBLE");
        if (type == 0) {
            CHECK(made.XR(xrRequestExitSession)(made.session) == XR_SUCCESS);
        } else {
            for (int i = 0; i < 2; ++i) { CHECK(made.sync() == XR_SESSION_NOT_FOCUSED); }
        }
        CHECK(made.states() == "SYNCHRONIZED STOPPING");
        CHECK(made.XR(xrEndSession)(made.session) == XR_SUCCESS);
    }
}

TEST_CASE("a headless session may have frames, which nobody draws; time and states then go by them") {
    const HeadlessSession made(k1_0, {}, "rate 10\nat 0 gpu-load 250 %\nat 0.15 focused off\nat 0.35 exit\n");
    const auto begin = made.XR(xrBeginFrame);
    XrFrameState state{XR_TYPE_FRAME_STATE};
    CHECK(made.XR(xrWaitFrame)(made.session, nullptr, &state) == XR_ERROR_SESSION_NOT_RUNNING);
    made.begin();
    made.states();
    checkEach(XR_ERROR_CALL_ORDER_INVALID, {begin(made.session, nullptr), made.endFrame(kStart)});
    const std::string expected[] = {"", "", "VISIBLE", "", "SYNCHRONIZED", "STOPPING"};
    for (int frame = 0; frame < 6; ++frame) {
        state = made.waitFrame();
        CHECK(these(state.shouldRender, state.predictedDisplayTime, state.predictedDisplayPeriod) ==
              these(XR_FALSE, kStart + frame * 100'000'000, 100'000'000));
        for (int i = 0; i < 2; ++i) {
            CHECK(made.sync() == (frame < 3 ? XR_SUCCESS : XR_SESSION_NOT_FOCUSED));
        }
        REQUIRE(begin(made.session, nullptr) == XR_SUCCESS);
        // Its picture would need a swapchain, which cannot exist here; even a layer without one is refused.
        const XrCompositionLayerQuad quad{XR_TYPE_COMPOSITION_LAYER_QUAD};
        CHECK(made.endFrame(state.predictedDisplayTime, {headerOf(quad)}) == XR_ERROR_LAYER_INVALID);
        REQUIRE(made.endFrame(state.predictedDisplayTime) == XR_SUCCESS);
        CHECK(made.states() == expected[frame]);
    }
    CHECK(made.XR(xrEndSession)(made.session) == XR_SUCCESS);
}

TEST_CASE("objects end in every order, each once, and with their parents") {
    std::vector<std::string> order;
    for (const auto& [name, object] : Everything(false).objects) { order.push_back(name); }
    int number = 0;
    do {
        // A share of the 5040 orders; 19 is prime, so no object keeps its place.
        if (number++ % 19 != 0) { continue; }
        const Everything made(number % 2 == 0);
        std::set<std::string> gone;
        for (const std::string& name : order) {
            const auto& destroy = made.objects.at(name).second;
            CHECK(destroy() == (gone.contains(name) ? XR_ERROR_HANDLE_INVALID : XR_SUCCESS));
            for (const auto& [other, object] : made.objects) {
                if (other == name || object.first == name) { gone.insert(other); }
            }
            CHECK(destroy() == XR_ERROR_HANDLE_INVALID);
            // What is left may be used, without what is gone.
            made.states();
            if (!gone.contains("session")) { CHECK(XR_SUCCEEDED(made.sync())); }
            if (!gone.contains("reference space") && !gone.contains("action space")) {
                made.locate(made.action_space, made.reference_space, kStart);
            }
        }
    } while (std::next_permutation(order.begin(), order.end()));
}

}  // SUITE(simulated_extensions)
