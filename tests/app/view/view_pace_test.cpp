// Facts about the pace of frames: the order in which the viewer submits frames and waits for them, as a layer notes it down, is played
// again on a clock where the device and the program take as long as is said here.
#include "tests/run_program.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

TEST_SUITE_BEGIN("view_pace");

namespace view_pace_test {

using namespace binosplat::test;

namespace {

struct Call {
    bool submits;       // else it waits
    std::string fence;  // "all": for whatever was submitted
};

// All in periods.
struct PlayedFrame {
    double woken, cpu_begin, cpu_end, gpu_begin, gpu_end, display;
    [[nodiscard]] bool isLate() const { return gpu_end > display; }
};

constexpr double kGpu = 0.7, kCpu = 0.4;
// xrWaitFrame returns so long before the frame is displayed, where compositors let a frame's parts overlap with the next one's.
constexpr double kLead = 2.0;

// A frame is a submission. The program waits for xrWaitFrame, works, submits; waits for the device come where the calls say.
std::vector<PlayedFrame> play(const std::vector<Call>& calls) {
    std::vector<PlayedFrame> frames;
    std::map<std::string, double> done;  // by fence
    double host = 0.0, device = 0.0;
    for (const Call& call : calls) {
        if (!call.submits) {
            host = std::max(host, call.fence == "all" ? device : done[call.fence]);
            continue;
        }
        const auto turn = static_cast<double>(frames.size());
        PlayedFrame frame{};
        frame.woken = turn;
        frame.cpu_begin = std::max(host, turn);
        frame.cpu_end = host = frame.cpu_begin + kCpu;
        frame.gpu_begin = std::max(host, device);
        frame.gpu_end = device = done[call.fence] = frame.gpu_begin + kGpu;
        frame.display = turn + kLead;
        frames.push_back(frame);
    }
    return frames;
}

std::size_t countLate(const std::vector<PlayedFrame>& frames) {
    return static_cast<std::size_t>(std::ranges::count_if(frames, &PlayedFrame::isLate));
}

// The last submissions of a run of the viewer in a headset that writes nothing, and the waits between them.
std::vector<Call> lastCallsOfViewer(std::size_t submissions) {
    const Workplace work;
    std::ofstream(work.path / "rest.script") << "size 64 64\n";
    const std::string manifest = (std::filesystem::path(BINOSPLAT_PROGRAM).parent_path() / "simulated_runtime.json").string();
    const Outcome outcome =
        work.run("view builtin:slanted-wall --load-first --frames 120",  // until every image has been in use
                 fmt::format("XDG_CONFIG_HOME=\"$PWD\" DISPLAY= WAYLAND_DISPLAY= BINOSPLAT_VALIDATION=1 XR_RUNTIME_JSON='{}' "
                             "SIMULATED_OPENXR_SCRIPT=rest.script VK_ADD_LAYER_PATH='" BINOSPLAT_FAULT_LAYER "' "
                             "VK_INSTANCE_LAYERS=VK_LAYER_BINOSPLAT_faults BINOSPLAT_FAULT_TRACE=calls.txt",
                             manifest));
    INFO("stderr: " << outcome.errors);
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.errors.empty());
    std::vector<Call> calls;
    std::ifstream trace(work.path / "calls.txt");
    for (std::string call, fence; trace >> call >> fence;) { calls.push_back({call == "submit", fence}); }
    // At the end a picture of the scene is read back, which is no frame.
    while (!calls.empty() && !calls.back().submits) { calls.pop_back(); }
    if (!calls.empty()) { calls.pop_back(); }
    std::size_t first = calls.size();
    for (std::size_t found = 0; first > 0 && found < submissions;) { found += calls[--first].submits ? 1 : 0; }
    calls.erase(calls.begin(), calls.begin() + static_cast<std::ptrdiff_t>(first));
    return calls;
}

std::vector<Call> callsOfWhoWaits(std::size_t submissions) {
    std::vector<Call> calls;
    for (std::size_t i = 0; i < submissions; ++i) { calls.insert(calls.end(), {{true, "one"}, {false, "one"}}); }
    return calls;
}

}  // namespace

TEST_CASE("the device draws a frame while the program prepares the next: at 70 % and 40 % of a period every frame makes it") {
    const std::vector<PlayedFrame> ours = play(lastCallsOfViewer(30)), waiting = play(callsOfWhoWaits(30));
    REQUIRE(ours.size() == 30);
    CHECK(countLate(ours) == 0);
    for (std::size_t i = 1; i < ours.size(); ++i) { CHECK(ours[i].cpu_begin == ours[i].woken); }
    // The same clock finds who waits for every frame late.
    CHECK(countLate(waiting) > 10);
}

}  // namespace view_pace_test
