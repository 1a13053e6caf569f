// The simulated runtime called from many threads at once: every function allows it, except with handles that
// are being destroyed.
#include "tests/xr/simulated/api/simulated_fixture.h"

#include <barrier>
#include <semaphore>

SUITE(simulated_threads) {

constexpr int kThreads = 8, kRounds = 25;

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

TEST_CASE_FIXTURE(VulkanFixture, "of many threads that make a session one gets it") {
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
        CHECK(these(made.load(), refused.load()) == these(1, kThreads - 1));
        CHECK(xrDestroySession(its) == XR_SUCCESS);
    }
}

TEST_CASE_FIXTURE(InstanceFixture, "a path is one number for all threads") {
    std::vector<std::vector<XrPath>> found(kThreads);
    inThreads(kThreads, [&](int thread) {
        for (int i = 0; i < kRounds; ++i) {
            const std::string text = "/place/number_" + std::to_string(i);
            found[static_cast<std::size_t>(thread)].push_back(path(text));
            CHECK(textOf(path(text)) == text);
        }
    });
    for (const auto& paths : found) { CHECK(paths == found.front()); }
}

TEST_CASE_FIXTURE(SessionFixture, "each thread makes, uses and destroys its own, while another runs frames") {
    const XrActionSet walking = makeActionSet("walking");
    const XrAction jump = makeAction(walking, "jump", XR_ACTION_TYPE_BOOLEAN_INPUT, {left});
    const XrAction grip = makeAction(walking, "grip", XR_ACTION_TYPE_POSE_INPUT, {left});
    REQUIRE(suggest(kSimple, {{jump, "/user/hand/left/input/select/click"},
                              {grip, "/user/hand/left/input/grip/pose"}}) == XR_SUCCESS);
    attach({walking});
    focus();
    std::atomic<int> at_work{kThreads};
    inThreads(kThreads + 1, [&](int thread) {
        while (thread == kThreads && at_work > 0) { frame(); }
        if (thread == kThreads) { return; }
        for (int i = 0; i < kRounds; ++i) {
            const XrActionSet set = makeActionSet("set_" + std::to_string(thread));
            const XrSpace space = makeSpace(XR_REFERENCE_SPACE_TYPE_VIEW), hand = makeActionSpace(grip, left);
            const XrSwapchain swapchain = makeSwapchain();
            CHECK(sync(walking) == XR_SUCCESS);
            CHECK(boolean(jump, left).isActive == XR_TRUE);
            for (const XrSpace one : {hand, space}) { CHECK(locate(one, local, kStart).locationFlags != 0); }
            states();
            turn(swapchain);
            checkEach(XR_SUCCESS, {xrDestroySwapchain(swapchain), xrDestroySpace(hand), xrDestroySpace(space),
                                   xrDestroyActionSet(set)});
        }
        --at_work;
    });
}

TEST_CASE_FIXTURE(SessionFixture, "one thread waits for frames while another ends those a period before") {
    begin();
    std::array<XrFrameState, 30> states;
    std::counting_semaphore<> waited(0);
    std::jthread waiting([&] {
        for (XrFrameState& state : states) {
            state = waitFrame();
            waited.release();
        }
    });
    for (std::size_t i = 0; i < states.size(); ++i) {
        waited.acquire();
        const XrTime time = states[i].predictedDisplayTime;
        CHECK(xrBeginFrame(session, nullptr) == XR_SUCCESS);
        // From here on, the other thread may have the next one.
        CHECK(endFrame(time) == XR_SUCCESS);
        if (i == 0) { continue; }
        CHECK(std::abs(time - states[i - 1].predictedDisplayTime - states[i].predictedDisplayPeriod) <= 1);
    }
}

}  // SUITE(simulated_threads)
