// Facts about the simulated headset's pace by script: rates that change, periods that differ, a device that is slow, images of other counts
// and orders, and states that change while a frame is open.
#include "tests/xr/simulated/api/simulated_fixture.h"
#include "xr/simulated/script/script.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <set>

TEST_SUITE_BEGIN("simulated_pace");

namespace simulated_pace_test {

using namespace binosplat::test;
using simulated::Script;
using simulated::ScriptError;

namespace {

const std::string kSmall = "size 64 64\nframes none\nrate 100\n";
constexpr XrDuration kPeriod = 10'000'000;

struct AnotherRate : SessionFixture {
    AnotherRate() : SessionFixture(kSmall + "at 0.1 rate 50", {XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME}) { begin(); }
};
struct Irregular : SessionFixture {
    Irregular() : SessionFixture(kSmall + "irregular 50") { begin(); }
};
struct Loaded : SessionFixture {
    Loaded() : SessionFixture(kSmall + "at 0.1 gpu-load 70 %\nat 0.2 gpu-load 25 ms\nat 0.4 gpu-load 0 ms") { begin(); }
};
struct Stretched : SessionFixture {
    Stretched() : SessionFixture(kSmall + "period stretched\nat 0.1 gpu-load 25 ms\nat 0.3 gpu-load 0 ms") { begin(); }
};
struct ChangesAtBegin : SessionFixture {
    ChangesAtBegin() : SessionFixture(kSmall + "state-changes at-begin\nat 0.2 worn off") { begin(); }
};

// A program that ignores that none of its frames is taken.
struct Refused : SessionFixture {
    Refused() : SessionFixture(kSmall + "at 0.1 exit") { begin(); }
    std::vector<nlohmann::json> logged() const {
        std::ifstream log(written / "frames.jsonl");
        std::vector<nlohmann::json> lines;
        for (std::string line; std::getline(log, line);) { lines.push_back(nlohmann::json::parse(line)); }
        return lines;
    }
    // Until the session is to stop.
    std::vector<XrSessionState> runOn() const {
        std::vector<XrSessionState> seen;
        for (int i = 0; i < 50; ++i) {
            const XrTime time = waitFrame().predictedDisplayTime;
            for (const XrSessionState state : states()) { seen.push_back(state); }
            if (!seen.empty() && seen.back() == XR_SESSION_STATE_STOPPING) { break; }
            CHECK(XR_SUCCEEDED(xrBeginFrame(session, nullptr)));
            CHECK(endFrame(-time) == XR_ERROR_TIME_INVALID);
            CHECK(endFrame(-time) == XR_ERROR_TIME_INVALID);
        }
        return seen;
    }
};

const std::vector<XrSessionState> kWholeLife{XR_SESSION_STATE_IDLE,         XR_SESSION_STATE_READY,   XR_SESSION_STATE_SYNCHRONIZED,
                                             XR_SESSION_STATE_VISIBLE,      XR_SESSION_STATE_FOCUSED, XR_SESSION_STATE_VISIBLE,
                                             XR_SESSION_STATE_SYNCHRONIZED, XR_SESSION_STATE_STOPPING};

XrEventDataBuffer makeEvent() { return {XR_TYPE_EVENT_DATA_BUFFER}; }

std::vector<std::uint32_t> acquireInTurn(const SessionFixture& fixture, int times) {
    const XrSwapchain swapchain = fixture.makeSwapchain();
    std::vector<std::uint32_t> found;
    for (int i = 0; i < times; ++i) {
        std::uint32_t index = 99;
        REQUIRE(xrAcquireSwapchainImage(swapchain, nullptr, &index) == XR_SUCCESS);
        found.push_back(index);
        const XrSwapchainImageWaitInfo info{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO, nullptr, XR_INFINITE_DURATION};
        REQUIRE(xrWaitSwapchainImage(swapchain, &info) == XR_SUCCESS);
        REQUIRE(xrReleaseSwapchainImage(swapchain, nullptr) == XR_SUCCESS);
    }
    std::uint32_t count = 0;
    REQUIRE(xrEnumerateSwapchainImages(swapchain, 0, &count, nullptr) == XR_SUCCESS);
    for (const std::uint32_t index : found) { CHECK(index < count); }
    return found;
}

std::string messageOf(const std::string& line) {
    try {
        (void)Script::parse(line, "a.script");
    } catch (const ScriptError& error) { return error.what(); }
    return "accepted";
}

}  // namespace

TEST_CASE_FIXTURE(AnotherRate, "a rate that the script changes counts from the next frame on, is told, and is offered") {
    XrTime before = 0;
    std::vector<XrDuration> steps;
    bool told = false;
    for (int i = 0; i < 16; ++i) {
        const XrFrameState state = frame();
        if (before != 0) { steps.push_back(state.predictedDisplayTime - before); }
        before = state.predictedDisplayTime;
        for (XrEventDataBuffer event = makeEvent(); poll(event) != XR_TYPE_UNKNOWN; event = makeEvent()) {
            if (event.type != XR_TYPE_EVENT_DATA_DISPLAY_REFRESH_RATE_CHANGED_FB) { continue; }
            const auto& change = reinterpret_cast<const XrEventDataDisplayRefreshRateChangedFB&>(event);
            CHECK(change.fromDisplayRefreshRate == 100.0f);
            CHECK(change.toDisplayRefreshRate == 50.0f);
            told = true;
        }
    }
    CHECK(told);
    CHECK(std::ranges::count(steps, kPeriod) == 10);
    CHECK(std::ranges::count(steps, 2 * kPeriod) == 5);
    float rates[16] = {};
    std::uint32_t count = 0;
    REQUIRE(function<PFN_xrEnumerateDisplayRefreshRatesFB>("xrEnumerateDisplayRefreshRatesFB")(session, 16, &count, rates) == XR_SUCCESS);
    CHECK(std::count(rates, rates + count, 50.0f) == 1);
}

TEST_CASE_FIXTURE(Irregular, "irregular periods differ, within what the script says, and time goes on") {
    XrTime before = 0;
    std::set<XrDuration> steps;
    for (int i = 0; i < 200; ++i) {
        const XrFrameState state = frame();
        if (before != 0) { steps.insert(state.predictedDisplayTime - before); }
        before = state.predictedDisplayTime;
        CHECK(state.predictedDisplayPeriod == kPeriod);
    }
    CHECK(steps.size() > 50);
    CHECK(*steps.begin() >= kPeriod / 2);
    CHECK(*steps.rbegin() <= kPeriod + kPeriod / 2);
    CHECK(std::abs(before - 1'000'000'000 - 199 * kPeriod) <= kPeriod / 4);  // and they do not drift
}

TEST_CASE_FIXTURE(Loaded, "a device that takes longer than a period misses displays, and the log says how long it takes") {
    std::vector<XrTime> times;
    for (int i = 0; i < 40; ++i) { times.push_back(frame().predictedDisplayTime); }
    const auto stepsIn = [&](double from_s, double to_s) {
        std::set<XrDuration> steps;
        for (std::size_t i = 1; i < times.size(); ++i) {
            const double time_s = 1e-9 * static_cast<double>(times[i - 1] - 1'000'000'000);
            if (time_s >= from_s && time_s < to_s) { steps.insert((times[i] - times[i - 1]) / kPeriod); }
        }
        return steps;
    };
    CHECK(stepsIn(0.0, 0.199) == std::set<XrDuration>{1});
    CHECK(stepsIn(0.2, 0.399) == std::set<XrDuration>{3});
    CHECK(stepsIn(0.41, 9.0) == std::set<XrDuration>{1});
    std::ifstream log(written / "frames.jsonl");
    std::set<double> said;
    for (std::string line; std::getline(log, line);) { said.insert(nlohmann::json::parse(line).value("gpu_ms", 0.0)); }
    CHECK(said == std::set<double>{0.0, 7.0, 25.0});
}

TEST_CASE_FIXTURE(Refused, "the script goes on and the session moves though every frame is refused, and the log has each with its reason") {
    CHECK(runOn() == kWholeLife);
    CHECK(xrEndSession(session) == XR_SUCCESS);
    CHECK(states() == std::vector<XrSessionState>{XR_SESSION_STATE_IDLE, XR_SESSION_STATE_EXITING});
    std::vector<nlohmann::json> lines = logged();
    std::vector<std::string> events;
    std::size_t refused = 0;
    for (const nlohmann::json& line : lines) {
        CHECK_FALSE(line.contains("frame"));
        for (const auto& event : line["events"]) { events.push_back(event); }
        if (!line.contains("refused")) { continue; }
        CHECK(line["refused"] == "XR_ERROR_TIME_INVALID");
        CHECK(line["display_time_ns"] == 1'000'000'000 + kPeriod * static_cast<XrTime>(refused));
        CHECK(line["reason"] == "the time is " + std::to_string(-line["display_time_ns"].get<XrTime>()) + ", must be positive");
        ++refused;
    }
    CHECK(refused == 13);
    CHECK(events == std::vector<std::string>{"state IDLE", "state READY", "state SYNCHRONIZED", "state VISIBLE", "state FOCUSED", "exit",
                                             "state VISIBLE", "state SYNCHRONIZED", "state STOPPING", "state IDLE", "state EXITING"});
}

TEST_CASE_FIXTURE(Refused, "a frame that is refused and ended again moves the session once") {
    for (int i = 0; i < 3; ++i) {
        const XrTime time = waitFrame().predictedDisplayTime;
        REQUIRE(xrBeginFrame(session, nullptr) == XR_SUCCESS);
        CHECK(endFrame(0) == XR_ERROR_TIME_INVALID);
        CHECK(endFrame(time) == XR_SUCCESS);
        CHECK(states().back() == static_cast<XrSessionState>(XR_SESSION_STATE_SYNCHRONIZED + i));
    }
    const std::vector<nlohmann::json> lines = logged();
    REQUIRE(lines.size() == 6);
    CHECK(lines[4].contains("refused"));
    CHECK(lines[5]["frame"] == 2);
}

TEST_CASE_FIXTURE(Refused, "frames that are given up move the session, too") {
    std::vector<XrSessionState> seen;
    for (int i = 0; i < 50 && (seen.empty() || seen.back() != XR_SESSION_STATE_STOPPING); ++i) {
        waitFrame();
        CHECK(XR_SUCCEEDED(xrBeginFrame(session, nullptr)));
        for (const XrSessionState state : states()) { seen.push_back(state); }
    }
    CHECK(seen == kWholeLife);
}

TEST_CASE("the log ends with the session's last states") {
    struct Ended : Refused {
        void end() const {
            while (states() != std::vector{XR_SESSION_STATE_STOPPING}) { frame(); }
            CHECK(xrEndSession(session) == XR_SUCCESS);
        }
    };
    const Ended ended;
    ended.end();
    const std::vector<nlohmann::json> lines = ended.logged();
    REQUIRE(lines.size() > 3);
    CHECK(lines[lines.size() - 3].contains("frame"));
    CHECK(lines[lines.size() - 2]["events"] == nlohmann::json{"state STOPPING"});
    CHECK(lines[lines.size() - 2]["session_state"] == "STOPPING");
    CHECK(lines.back()["events"] == nlohmann::json{"state IDLE", "state EXITING"});
}

TEST_CASE_FIXTURE(Stretched, "a stretched period is as many as the frame before took") {
    XrTime last = 0;
    std::set<XrDuration> stated;
    for (int i = 0; i < 40; ++i) {
        const XrFrameState state = frame();
        if (last != 0) { CHECK(state.predictedDisplayTime - last == state.predictedDisplayPeriod); }
        last = state.predictedDisplayTime;
        stated.insert(state.predictedDisplayPeriod);
    }
    CHECK(stated == std::set<XrDuration>{kPeriod, 3 * kPeriod});
}

TEST_CASE("a load by megapixels is that of what was drawn") {
    const Script script = Script::parse("at 1 gpu-load 4 ms-per-megapixel", "a.script");
    CHECK(script.gpu_load.at(0.0).ms(10.0, 2.0) == 0.0);
    CHECK(script.gpu_load.at(1.0).ms(10.0, 2.0) == doctest::Approx(8.0));
}

TEST_CASE_FIXTURE(ChangesAtBegin, "states change while a frame is open, and the frame may still be ended") {
    std::vector<XrSessionState> open, closed;
    const auto take = [&](std::vector<XrSessionState>& into) {
        const auto found = states();
        into.insert(into.end(), found.begin(), found.end());
    };
    take(closed);
    for (int i = 0; i < 40 && (open.empty() || open.back() != XR_SESSION_STATE_STOPPING); ++i) {
        const XrFrameState state = waitFrame();
        take(closed);
        const XrFrameBeginInfo info{XR_TYPE_FRAME_BEGIN_INFO};
        REQUIRE(xrBeginFrame(session, &info) == XR_SUCCESS);
        take(open);
        CHECK(endFrame(state.predictedDisplayTime) == XR_SUCCESS);
        take(closed);
    }
    REQUIRE_FALSE(open.empty());
    CHECK(open.front() == XR_SESSION_STATE_SYNCHRONIZED);
    CHECK(open.back() == XR_SESSION_STATE_STOPPING);
    CHECK(std::ranges::count(closed, XR_SESSION_STATE_FOCUSED) == 0);
    CHECK(xrEndSession(session) == XR_SUCCESS);
}

TEST_CASE("images come in as many, and in the order, as the script says") {
    {
        const SessionFixture two(kSmall + "images 2");
        CHECK(acquireInTurn(two, 4) == std::vector<std::uint32_t>{0, 1, 0, 1});
    }
    {
        const SessionFixture one(kSmall + "images 1");
        CHECK(acquireInTurn(one, 2) == std::vector<std::uint32_t>{0, 0});
    }
    {
        const SessionFixture reversed(kSmall + "images 4 reversed");
        CHECK(acquireInTurn(reversed, 5) == std::vector<std::uint32_t>{3, 2, 1, 0, 3});
    }
    const SessionFixture shuffled(kSmall + "images 5 shuffled");
    const auto order = acquireInTurn(shuffled, 40);
    CHECK(std::set(order.begin(), order.end()).size() == 5);
    std::size_t in_turn = 0;
    for (std::size_t i = 1; i < order.size(); ++i) {
        CHECK(order[i] != order[i - 1]);  // the one on show
        in_turn += order[i] == (order[i - 1] + 1) % 5 ? 1 : 0;
    }
    CHECK(in_turn < 30);
}

TEST_CASE("mistakes about the pace are one line") {
    const std::pair<const char*, const char*> cases[] = {
        {"images 0", "a.script:1: the number of images is 0, must be a whole number from 1 to 16"},
        {"images 3 backwards", "the order is backwards, must be in-turn, reversed or shuffled"},
        {"images 3\nimages 2", "a.script:2: images is set again, first on line 1"},
        {"irregular 91", "how much periods differ, in percent is 91, must be a number from 0 to 90"},
        {"period long", "the stated period is long, must be steady or stretched"},
        {"state-changes never", "when states change is never, must be at-begin or at-end"},
        {"at 1 rate 0", "the rate in frames per second is 0, must be a number from 1 to 1000"},
        {"at 1 gpu-load 70", "the load's unit is missing, must be %, ms or ms-per-megapixel"},
        {"at 1 gpu-load -1 ms", "the load is -1, must be a number from 0 to 100000"},
        {"at 1 gpu-load 5 %\nat 1 gpu-load 6 %", "a.script:2: the time is 1, must be after the one of the same change"},
    };
    for (const auto& [line, part] : cases) {
        const std::string message = messageOf(line);
        INFO(line, " gives: ", message);
        CHECK(message.find(part) != std::string::npos);
    }
}

}  // namespace simulated_pace_test
