// Facts about holding the frame rate in the headset: on a device of which a layer says that nothing fits, or that everything does.
#include "engine/geometry.h"
#include "tests/view_runs.h"

#include <doctest/doctest.h>

#include <sstream>

TEST_SUITE_BEGIN("view_quality");

using namespace binosplat;
using namespace binosplat::test;

namespace {

// Ticks from one timestamp to the next: far more than a period on any device, and far less.
constexpr std::uint64_t kSlow = 1'000'000'000, kQuick = 1;

ViewRun runQuality(const Workplace& work, const std::string& name, std::uint64_t ticks, int frames, const std::string& view,
                   const std::string& mode = "predicted") {
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
        if (line.starts_with("frame ") && line.find(" ms; ") != std::string::npos && end != std::string::npos) {
            const std::size_t colon = line.find(": ");
            changes.push_back({std::stoi(line.substr(6)), line.substr(colon + 2, end - colon - 2)});
        }
    }
    return changes;
}

// `predicted` is wished for on a display of 30 Hz, and frames take what a layer says, see tests/faults/load.h.
constexpr int kSecond = 30;
ViewRun runLoad(const Workplace& work, const std::string& load, int frames) {
    std::ofstream(work.path / "load.toml") << "[view]\nquality = \"balanced\"\n";
    const ViewRun run = runView(
        work, "load", fmt::format("rate {}\nsize 128 128\nframes none\n", kSecond),
        fmt::format("builtin:slanted-wall --load-first --hide-panel --hide-hands --mode predicted --move-cost 0 "
                    "--frames {} --config load.toml",
                    frames),
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
        CHECK(run.outcome.output.find("ms; shared at 100 % took") != std::string::npos);
    }
}

TEST_CASE("no frame makes a kernel, also where the eyes come to look another way: all are made before the first one") {
    const Workplace work;
    for (const char* lines : {"", "eye left cant 5\n", "visibility-mask on\n"}) {
        CAPTURE(lines);
        const std::string alive = (work.path / "alive.txt").string();
        // From side by side to angles of their own.
        const ViewRun run =
            runView(work, "ready", fmt::format("rate 90\nsize 96 96\nframes none\n{}at 0.3 eye left angles -50 40 40 -50\n", lines),
                    "builtin:one-splat --load-first --hide-panel --hide-hands --mode predicted --move-cost 0 --frames 60",
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

TEST_CASE("a load that comes and goes: less resolution at once, a method that was tried and saves enough, then all as it was") {
    const Workplace work;
    // Of 33 ms: everything fits, then both eyes take 42 and one made from the other 25, then everything fits again.
    constexpr int kComes = 40, kGoes = 170;
    const ViewRun run = runLoad(work, fmt::format("0:8/5,{}:42/25,{}:8/5", kComes, kGoes), 235);
    const std::vector<Change> changes = changesOf(run);
    INFO(run.outcome.output);
    REQUIRE(changes.size() >= 4);
    CHECK(changes.front().frame > kComes);
    CHECK(changes.front().frame <= kComes + 10);
    CHECK(changes.front().settings.starts_with("shared at "));
    CHECK(widthAt(run, kComes + 15) < 128);
    for (std::size_t i = 1; i < changes.size(); ++i) {
        CAPTURE(i);
        CHECK(changes[i].frame - changes[i - 1].frame >= kSecond);
        if (changes[i].frame < kGoes) { CHECK(changes[i].settings.starts_with("predicted at ")); }
    }
    CHECK(changes[changes.size() - 2].settings == "predicted at 100");
    CHECK(widthAt(run, kGoes) == 128);
    CHECK(changes.back().frame > kGoes);
    CHECK(changes.back().settings == "shared at 100");
    CHECK(widthAt(run, run.frames.size() - 4) == 128);
}

TEST_CASE("a method that saved enough is left when rendering both eyes has become faster than it, though it fits") {
    const Workplace work;
    constexpr int kChanges = 130;
    const ViewRun run = runLoad(work, fmt::format("0:42/25,{}:28/29", kChanges), 200);
    const std::vector<Change> changes = changesOf(run);
    INFO(run.outcome.output);
    REQUIRE(changes.size() >= 2);
    const Change &last = changes.back(), &before = changes[changes.size() - 2];
    CHECK(before.settings == "predicted at 100");
    CHECK(before.frame < kChanges);
    CHECK(last.settings == "shared at 100");
    CHECK(last.frame > kChanges);
    CHECK(last.frame <= kChanges + 2 * kSecond);
    CHECK(run.outcome.output.find("predicted saves nothing here") != std::string::npos);
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
