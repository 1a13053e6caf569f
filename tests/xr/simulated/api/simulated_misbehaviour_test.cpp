// Facts about a runtime that is lost, and a head that walks, seen by a program that was not written for it: hello_xr. What each call says
// while the runtime misbehaves is in simulated_session, simulated_space and simulated_swapchain.
#include "tests/shared_data.h"
#include "tests/xr/simulated/hello_xr.h"

#include <algorithm>
#include <cmath>

TEST_SUITE_BEGIN("simulated_misbehaviour");

namespace simulated_misbehaviour_test {

using namespace binosplat::test;

namespace {

// Periods of 10 ms are whole nanoseconds: frame n is displayed at n * 0.01 s exactly.
const std::string kQuiet = "rate 100\nsize 64 64\nframes none\n";

// Frames with the event.
std::size_t count(const HelloXr& run, const std::string& event) {
    return static_cast<std::size_t>(std::ranges::count_if(run.frames, [&](const Json& frame) {
        return std::ranges::any_of(frame["events"], [&](const Json& one) { return one == event; });
    }));
}

}  // namespace

TEST_CASE("a lost session is left and made anew") {
    if (!haveHelloXr()) { return; }
    const HelloXr run(kQuiet + "at 0.2 lose-session\nat 0.6 exit\n");
    CHECK_MESSAGE(run.exit_status == 0, run.output);
    CHECK(count(run, "lose-session") == 1);
    CHECK(count(run, "state FOCUSED") == 2);
    CHECK(run.output.find("XR_SESSION_STATE_LOSS_PENDING") != std::string::npos);
    // Frames count on, and the new session's are later ones.
    for (std::size_t i = 0; i < run.frames.size(); ++i) { REQUIRE(run.frames[i]["frame"] == i); }
    for (std::size_t i = 1; i < run.frames.size(); ++i) {
        REQUIRE(run.frames[i]["display_time_ns"].get<std::int64_t>() > run.frames[i - 1]["display_time_ns"].get<std::int64_t>());
    }
}

TEST_CASE("a lost instance is left and made anew") {
    if (!haveHelloXr()) { return; }
    const HelloXr run(kQuiet + "at 0.2 lose-instance\nat 0.6 exit\n");
    CHECK_MESSAGE(run.exit_status == 0, run.output);
    CHECK(count(run, "state FOCUSED") == 2);
}

TEST_CASE("submitted poses are the head's of their display time") {
    if (!haveHelloXr()) { return; }
    // A metre per second to the right, in LOCAL, whose origin is the head at time 0.
    const HelloXr run(kQuiet + "head 0 position 0 1.6 0\nhead 1 position 1 1.6 0\nat 0.4 exit\n");
    CHECK_MESSAGE(run.exit_status == 0, run.output);
    for (const std::size_t frame : {9u, 18u, 30u}) {
        const Json& logged = run.frames.at(frame);
        const double time_s = (logged["display_time_ns"].get<double>() - run.frames[0]["display_time_ns"].get<double>()) * 1e-9;
        const double left_x = logged["layers"].at(0)["views"].at(0)["pose"]["position"].at(0);
        CHECK(left_x == doctest::Approx(time_s - 0.0315).epsilon(1e-5));
    }
}

TEST_CASE("a recorded walk reaches the program as it was walked" * needsSharedData()) {
    const auto data = sharedData();
    if (!data || !haveHelloXr()) { return; }
    const HelloXr run(kQuiet + "head-motion \"" + std::filesystem::absolute(*data / "headmotion" / "User3.csv").string() +
                      "\" axes unity skip 5\nat 1 exit\n");
    CHECK_MESSAGE(run.exit_status == 0, run.output);
    double way_m = 0.0, largest_error_m = 0.0;
    for (std::size_t i = 10; i < 100; ++i) {
        const Json& frame = run.frames.at(i);
        const Json& layer = frame["layers"].at(0);
        // LOCAL is level and faces where the head faced at time 0; its heading is in the log.
        const Json& q = layer["stage_from_space"]["orientation"];
        const glm::dquat stage_from_local(q[3].get<double>(), q[0].get<double>(), q[1].get<double>(), q[2].get<double>());
        const auto vectorOf = [](const Json& json) {
            return glm::dvec3(json[0].get<double>(), json[1].get<double>(), json[2].get<double>());
        };
        for (const std::size_t eye : {0u, 1u}) {
            const glm::dvec3 submitted =
                vectorOf(layer["stage_from_space"]["position"]) + stage_from_local * vectorOf(layer["views"].at(eye)["pose"]["position"]);
            largest_error_m = std::max(largest_error_m, glm::length(submitted - vectorOf(frame["eyes"].at(eye)["pose"]["position"])));
        }
        way_m += glm::length(vectorOf(frame["head"]["position"]) - vectorOf(run.frames.at(i - 1)["head"]["position"]));
    }
    CHECK(largest_error_m < 1e-6);
    CHECK(way_m > 0.1);
    CHECK(way_m < 2.0);
}

TEST_CASE("the menu button reaches the program's quit action") {
    if (!haveHelloXr()) { return; }
    const HelloXr run(kQuiet + "press left menu 0.2 0.3\nat 3 exit\n");
    CHECK_MESSAGE(run.exit_status == 0, run.output);
    CHECK(count(run, "exit") == 0);
    CHECK(run.frames.size() < 50);
}

}  // namespace simulated_misbehaviour_test
