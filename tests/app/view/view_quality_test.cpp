// Facts about holding the frame rate in the headset: on a device of which a layer says that nothing fits, or that everything does.
#include "engine/geometry.h"
#include "tests/app/view/view_runs.h"

#include <doctest/doctest.h>

#include <sstream>

TEST_SUITE_BEGIN("view_quality");

namespace view_quality_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

// Ticks from one timestamp to the next: far more than a period on any device, and far less.
constexpr std::uint64_t kSlow = 1'000'000'000, kQuick = 1;

ViewRun runQuality(const Workplace& work, const std::string& name, std::uint64_t ticks, int frames, const std::string& view,
                   const std::string& mode = "temporal") {
    std::ofstream(work.path / (name + ".toml")) << "[view]\n" << view;
    const ViewRun run = runView(
        work, name, "rate 90\nsize 200 200\nframes none\nvisibility-mask on\n",
        fmt::format("builtin:one-splat --load-first --hide-panel --hide-hands --mode {} --frames {} --config {}.toml", mode, frames, name),
        fmt::format("{} VK_ADD_LAYER_PATH='" BINOSPLAT_FAULT_LAYER "' "
                    "VK_INSTANCE_LAYERS=VK_LAYER_BINOSPLAT_faults BINOSPLAT_FAULT_TICKS={}",
                    kValidated, ticks));
    checkClean(run);
    return run;
}

// Of the left eye's picture.
int widthAt(const ViewRun& run, std::size_t frame) {
    return run.layers(frame, "projection").at(0).at("views").at(0).at("rect").get<std::array<int, 4>>()[2];
}

// What the governor said it changed to, up to the resolution, and in which frame.
struct Change {
    int frame;
    std::string settings;
};

std::vector<Change> changesOf(const ViewRun& run) {
    std::vector<Change> changes;
    std::istringstream output(run.outcome.output);
    for (std::string line; std::getline(output, line);) {
        const std::size_t end = line.find(" %");
        if (line.starts_with("frame ") && line.find(" both eyes; ") != std::string::npos && end != std::string::npos) {
            const std::size_t colon = line.find(": ");
            changes.push_back({std::stoi(line.substr(6)), line.substr(colon + 2, end - colon - 2)});
        }
    }
    return changes;
}

// The head moves before a display of 30 Hz, and frames take what a layer says, see tests/faults/load.h.
constexpr int kSecond = 30;
ViewRun runLoad(const Workplace& work, const std::string& load, int frames) {
    std::ofstream(work.path / "load.toml") << "[view]\nquality = \"balanced\"\n";
    const ViewRun run = runView(
        work, "load", fmt::format("rate {}\nsize 128 128\nframes none\nhead 0 position 0 1.6 0\nhead 20 position 2 1.6 0\n", kSecond),
        fmt::format("builtin:slanted-wall --load-first --hide-panel --hide-hands --frames {} --config load.toml", frames),
        fmt::format("{} VK_ADD_LAYER_PATH='" BINOSPLAT_FAULT_LAYER "' VK_INSTANCE_LAYERS=VK_LAYER_BINOSPLAT_faults BINOSPLAT_FAULT_LOAD={}",
                    kValidated, load));
    checkClean(run);
    return run;
}

}  // namespace

TEST_CASE("where nothing fits, the least settings of the quality are reached within 60 frames, and a message says so") {
    const Workplace work;
    for (const auto& [quality, least] : {std::pair("sharp", 160), std::pair("fast", 80)}) {
        const ViewRun run = runQuality(work, quality, kSlow, 70, fmt::format("quality = \"{}\"\n", quality));
        CHECK(widthAt(run, 60) == least);
        CHECK(run.outcome.output.find("; temporal at 100 %, 20 % of both eyes took ") != std::string::npos);
    }
}

TEST_CASE("no frame makes a kernel, also where the eyes come to look another way: all are made before the first one") {
    const Workplace work;
    for (const auto& [mode, lines] : {std::pair("predicted", ""), std::pair("predicted", "visibility-mask on\n"),
                                      std::pair("temporal", "eye left cant 5\n"), std::pair("temporal", "visibility-mask on\n")}) {
        CAPTURE(mode);
        CAPTURE(lines);
        const std::string alive = (work.path / "alive.txt").string();
        // From side by side to angles of their own.
        const ViewRun run =
            runView(work, "ready", fmt::format("rate 90\nsize 96 96\nframes none\n{}at 0.3 eye left angles -50 40 40 -50\n", lines),
                    fmt::format("builtin:one-splat --load-first --hide-panel --hide-hands --mode {} --move-cost 0 --frames 60", mode),
                    fmt::format("{} VK_ADD_LAYER_PATH='" BINOSPLAT_FAULT_LAYER "' "
                                "VK_INSTANCE_LAYERS=VK_LAYER_BINOSPLAT_faults BINOSPLAT_FAULT_LIVE='{}'",
                                kValidated, alive));
        checkClean(run);
        std::vector<std::string> made;
        std::ifstream counts(alive);
        for (std::string line; std::getline(counts, line);) { made.push_back(line.substr(line.rfind(' ') + 1)); }
        REQUIRE(made.size() > 4);
        CHECK(made.front() == made.back());
    }
}

TEST_CASE("what the wearer set is the most there is, and it is kept where everything fits or quality is off") {
    const Workplace work;
    const ViewRun smaller = runQuality(work, "smaller", kSlow, 70, "quality = \"fast\"\nresolution-scale = 0.8\n", "shared");
    CHECK(widthAt(smaller, 3) == 160);
    CHECK(widthAt(smaller, 60) == 64);
    CHECK(widthAt(runQuality(work, "quick", kQuick, 40, "quality = \"fast\"\n", "shared"), 38) == 200);
    const ViewRun off = runQuality(work, "off", kSlow, 40, "quality = \"off\"\n", "shared");
    CHECK(widthAt(off, 38) == 200);
    CHECK(off.outcome.output.find(" took ") == std::string::npos);
}

TEST_CASE("a load that comes and goes: less budget and resolution at once, and both back once it has gone, with the same method") {
    const Workplace work;
    // Of 33 ms: everything fits, then frames take 60, then everything fits again.
    constexpr int kComes = 40, kGoes = 100;
    const ViewRun run = runLoad(work, fmt::format("0:8,{}:60,{}:8", kComes, kGoes), 300);
    const std::vector<Change> changes = changesOf(run);
    INFO(run.outcome.output);
    REQUIRE(changes.size() >= 3);
    CHECK(changes.front().frame > kComes);
    CHECK(changes.front().frame <= kComes + 10);
    CHECK(widthAt(run, kComes + 20) < 128);
    for (std::size_t i = 1; i < changes.size(); ++i) {
        CAPTURE(i);
        CHECK(changes[i].settings.starts_with("temporal at "));
        if (changes[i].frame > kGoes) { CHECK(changes[i].frame - changes[i - 1].frame >= kSecond); }
    }
    CHECK(changes.back().settings == "temporal at 100");
    CHECK(run.outcome.output.find("temporal at 100 %, 100 % of both eyes; there was room") != std::string::npos);
    CHECK(widthAt(run, run.frames.size() - 4) == 128);
}

TEST_CASE("the headset is asked for the rate that the settings name, and said to lack one that it has not") {
    const Workplace work;
    const auto periodAt = [&](const ViewRun& run, std::size_t frame) { return run.frames.at(frame).at("period_ns").get<std::int64_t>(); };
    const ViewRun chosen = runQuality(work, "chosen", kQuick, 20, "refresh-rate = 120\n", "mono");
    CHECK(periodAt(chosen, 0) == 11'111'111);
    CHECK(periodAt(chosen, 15) == 8'333'333);
    const ViewRun other = runQuality(work, "other", kQuick, 10, "refresh-rate = 75\n", "mono");
    CHECK(periodAt(other, 8) == 11'111'111);
    CHECK(other.outcome.output.find("refresh-rate is 75, this headset has 72, 80, 90, 120") != std::string::npos);
    CHECK(periodAt(runQuality(work, "left", kQuick, 10, "", "mono"), 8) == 11'111'111);
}

TEST_CASE("an unknown quality is refused") {
    const Workplace work;
    std::ofstream(work.path / "bad.toml") << "[view]\nquality = \"best\"\n";
    const Outcome outcome = work.run("view builtin:fence --simulate --frames 3 --config bad.toml");
    CHECK(outcome.exit_code == 1);
    CHECK(outcome.errors.find("bad.toml:2") != std::string::npos);
    CHECK(outcome.errors.find("must be off, sharp, balanced or fast") != std::string::npos);
}

}  // namespace view_quality_test
