// The simulated runtime called from many threads at once: every function allows it, except with handles that
// are being destroyed.
#include "tests/xr/simulated/api/simulated_fixture.h"

#include <barrier>
#include <condition_variable>
#include <mutex>
#include <queue>

SUITE(simulated_threads) {

constexpr int kThreads = 8, kRounds = 25;

// Failures in the threads are counted, since doctest's own assertions would print from all of them.
struct Failures {
    std::atomic<int> count{0};
    void expect(bool holds) {
        if (!holds) { ++count; }
    }
};

// All start together; the number says which one it is.
void inThreads(int threads, const std::function<void(int)>& work) {
    std::barrier start(threads);
    std::vector<std::jthread> running;
    for (int i = 0; i < threads; ++i) {
        running.emplace_back([&, i] {
            start.arrive_and_wait();
            work(i);
        });
    }
}

TEST_CASE_FIXTURE(VulkanFixture,
                  "of many threads that make a session one gets it, and a path is one number for all") {
    const XrGraphicsBindingVulkan2KHR graphics = binding();
    const XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO, &graphics, 0, system};
    for (int round = 0; round < 5; ++round) {
        std::atomic<int> made{0}, refused{0};
        std::atomic<XrSession> its{XR_NULL_HANDLE};
        inThreads(kThreads, [&](int) {
            XrSession mine = XR_NULL_HANDLE;
            const XrResult result = xrCreateSession(instance, &info, &mine);
            made += result == XR_SUCCESS ? 1 : 0;
            refused += result == XR_ERROR_LIMIT_REACHED ? 1 : 0;
            if (result == XR_SUCCESS) { its = mine; }
        });
        CHECK(made == 1);
        CHECK(refused == kThreads - 1);
        CHECK(xrDestroySession(its) == XR_SUCCESS);
    }

    std::vector<std::vector<XrPath>> found(kThreads);
    Failures failures;
    inThreads(kThreads, [&](int thread) {
        for (int i = 0; i < kRounds; ++i) {
            const std::string text = "/place/number_" + std::to_string(i);
            XrPath path = XR_NULL_PATH;
            failures.expect(xrStringToPath(instance, text.c_str(), &path) == XR_SUCCESS);
            char back[XR_MAX_PATH_LENGTH] = "";
            std::uint32_t count = 0;
            failures.expect(xrPathToString(instance, path, sizeof back, &count, back) == XR_SUCCESS &&
                            text == back);
            found[static_cast<std::size_t>(thread)].push_back(path);
        }
    });
    CHECK(failures.count == 0);
    for (const auto& paths : found) { CHECK(paths == found.front()); }
}

TEST_CASE_FIXTURE(SessionFixture,
                  "each thread makes, uses and destroys its own, while another thread runs frames") {
    const XrActionSet walking = makeActionSet("walking");
    const XrPath left = path("/user/hand/left");
    const XrAction jump = makeAction(walking, "jump", XR_ACTION_TYPE_BOOLEAN_INPUT, {left});
    const XrAction grip = makeAction(walking, "grip", XR_ACTION_TYPE_POSE_INPUT, {left});
    REQUIRE(suggest(kSimple, {{jump, path("/user/hand/left/input/select/click")},
                              {grip, path("/user/hand/left/input/grip/pose")}}) == XR_SUCCESS);
    attach({walking});
    focus();
    const XrSwapchainCreateInfo swapchain_info = swapchainInfo();
    const XrSwapchainImageWaitInfo wait{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO, nullptr, XR_INFINITE_DURATION};
    const XrReferenceSpaceCreateInfo space_info{XR_TYPE_REFERENCE_SPACE_CREATE_INFO, nullptr,
                                                XR_REFERENCE_SPACE_TYPE_VIEW, kIdentity};
    const XrActionSpaceCreateInfo hand_info{XR_TYPE_ACTION_SPACE_CREATE_INFO, nullptr, grip, left, kIdentity};
    const XrActionStateGetInfo get{XR_TYPE_ACTION_STATE_GET_INFO, nullptr, jump, left};
    Failures failures;
    const auto succeeds = [&](XrResult result) { failures.expect(result == XR_SUCCESS); };
    std::atomic<int> at_work{kThreads};
    inThreads(kThreads + 1, [&](int thread) {
        while (thread == kThreads && at_work > 0) {
            XrFrameState state{XR_TYPE_FRAME_STATE};
            succeeds(xrWaitFrame(session, nullptr, &state));
            succeeds(xrBeginFrame(session, nullptr));
            const XrFrameEndInfo end{XR_TYPE_FRAME_END_INFO,           nullptr, state.predictedDisplayTime,
                                     XR_ENVIRONMENT_BLEND_MODE_OPAQUE, 0,       nullptr};
            succeeds(xrEndFrame(session, &end));
        }
        for (int i = 0; i < kRounds && thread < kThreads; ++i) {
            XrActionSetCreateInfo set_info{XR_TYPE_ACTION_SET_CREATE_INFO};
            std::strcpy(set_info.actionSetName, ("set_" + std::to_string(thread)).c_str());
            std::strcpy(set_info.localizedActionSetName, ("Set " + std::to_string(thread)).c_str());
            XrActionSet set = XR_NULL_HANDLE;
            XrSpace space = XR_NULL_HANDLE, hand = XR_NULL_HANDLE;
            XrSwapchain swapchain = XR_NULL_HANDLE;
            succeeds(xrCreateActionSet(instance, &set_info, &set));
            succeeds(xrCreateReferenceSpace(session, &space_info, &space));
            succeeds(xrCreateActionSpace(session, &hand_info, &hand));
            succeeds(xrCreateSwapchain(session, &swapchain_info, &swapchain));
            const XrActiveActionSet active{walking, XR_NULL_PATH};
            const XrActionsSyncInfo sync_info{XR_TYPE_ACTIONS_SYNC_INFO, nullptr, 1, &active};
            succeeds(xrSyncActions(session, &sync_info));
            XrActionStateBoolean state{XR_TYPE_ACTION_STATE_BOOLEAN};
            succeeds(xrGetActionStateBoolean(session, &get, &state));
            failures.expect(state.isActive == XR_TRUE);
            for (const XrSpace one : {hand, space}) {
                XrSpaceLocation location{XR_TYPE_SPACE_LOCATION};
                succeeds(xrLocateSpace(one, local, kStart, &location));
                failures.expect(location.locationFlags != 0);
            }
            XrEventDataBuffer event{XR_TYPE_EVENT_DATA_BUFFER};
            failures.expect(XR_SUCCEEDED(xrPollEvent(instance, &event)));
            std::uint32_t index = 0;
            succeeds(xrAcquireSwapchainImage(swapchain, nullptr, &index));
            succeeds(xrWaitSwapchainImage(swapchain, &wait));
            succeeds(xrReleaseSwapchainImage(swapchain, nullptr));
            succeeds(xrDestroySwapchain(swapchain));
            succeeds(xrDestroySpace(hand));
            succeeds(xrDestroySpace(space));
            succeeds(xrDestroyActionSet(set));
        }
        if (thread < kThreads) { --at_work; }
    });
    CHECK(failures.count == 0);
}

TEST_CASE_FIXTURE(
    SessionFixture,
    "one thread waits for frames while another ends the ones before, each a period after the other") {
    begin();
    constexpr int kFrames = 30;
    std::mutex lock;
    std::condition_variable changed;
    std::queue<XrFrameState> waited;
    Failures failures;
    std::jthread waiting([&] {
        for (int i = 0; i < kFrames; ++i) {
            XrFrameState state{XR_TYPE_FRAME_STATE};
            failures.expect(XR_SUCCEEDED(xrWaitFrame(session, nullptr, &state)));
            const std::lock_guard guard(lock);
            waited.push(state);
            changed.notify_one();
        }
    });
    XrTime last = 0;
    for (int i = 0; i < kFrames; ++i) {
        std::unique_lock guard(lock);
        changed.wait(guard, [&] { return !waited.empty(); });
        const XrFrameState state = waited.front();
        waited.pop();
        guard.unlock();
        CHECK(xrBeginFrame(session, nullptr) == XR_SUCCESS);
        // From here on, the other thread may have the next one.
        CHECK(endFrame(state.predictedDisplayTime) == XR_SUCCESS);
        if (i > 0) { CHECK(std::abs(state.predictedDisplayTime - last - state.predictedDisplayPeriod) <= 1); }
        last = state.predictedDisplayTime;
    }
    waiting.join();
    CHECK(failures.count == 0);
}

}  // SUITE(simulated_threads)
