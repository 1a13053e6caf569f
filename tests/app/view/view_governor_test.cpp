// Facts about holding the frame rate where the device's own times do not tell: by script of the simulated headset frames take longer than
// the program can measure, as where a compositor or another program uses the device as well.
#include "tests/app/view/view_runs.h"

#include <doctest/doctest.h>

#include <algorithm>

TEST_SUITE_BEGIN("view_governor");

namespace view_governor_test {

using namespace binosplat::test;

namespace {

// Slow displays, so that what the program itself does fits into a period on any machine.
constexpr int kRate = 10;
constexpr int kWhole = 200;  // pixels

struct Governed : ViewRun {
    // A layer says that each frame took next to nothing.
    Governed(const std::string& quality, const std::string& load, int most_frames) {
        const Workplace work;
        std::ofstream(work.path / "view.toml") << fmt::format("[view]\nquality = \"{}\"\n", quality);
        const ViewRun run =
            runView(work, "load", fmt::format("rate {0}\nsize {1} {1}\nframes none\n{2}", kRate, kWhole, load),
                    fmt::format("builtin:one-splat --load-first --hide-panel --hide-hands --frames {} --config view.toml", most_frames),
                    kValidated + " VK_ADD_LAYER_PATH='" BINOSPLAT_FAULT_LAYER
                                 "' "
                                 "VK_INSTANCE_LAYERS=VK_LAYER_BINOSPLAT_faults BINOSPLAT_FAULT_TICKS=1");
        outcome = run.outcome;
        frames = run.frames;
        for (std::size_t i = 0; i < run.frames.size(); ++i) {
            const auto layers = run.layers(i, "projection");
            if (layers.empty()) {
                widths.push_back(widths.empty() ? kWhole : widths.back());
            } else {
                widths.push_back(layers[0].at("views").at(0).at("rect").get<std::array<int, 4>>()[2]);
            }
        }
        checkClean(run);
    }

    [[nodiscard]] double seconds(std::size_t i) const {
        return 1e-9 * (frames[i].at("display_time_ns").get<double>() - frames[0].at("display_time_ns").get<double>());
    }
    [[nodiscard]] bool isOver(std::size_t i) const {
        return frames[i].value("gpu_ms", 0.0) > 1e-6 * frames[i].at("period_ns").get<double>();
    }
    // The longest row of frames that took longer than their period.
    [[nodiscard]] std::size_t longestOver() const {
        std::size_t row = 0, longest = 0;
        for (std::size_t i = 0; i < frames.size(); ++i) {
            row = isOver(i) ? row + 1 : 0;
            longest = std::max(longest, row);
        }
        return longest;
    }
    [[nodiscard]] std::vector<std::size_t> changes() const {
        std::vector<std::size_t> found;
        for (std::size_t i = 1; i < widths.size(); ++i) {
            if (widths[i] != widths[i - 1]) { found.push_back(i); }
        }
        return found;
    }
    // From a frame on a second lies between two changes.
    void checkCalm(std::size_t first) const {
        double last_s = -10.0;
        for (const std::size_t i : changes()) {
            CAPTURE(i);
            if (i >= first) { CHECK(seconds(i) - last_s >= 1.0 - 1e-6); }
            last_s = seconds(i);
        }
    }

    std::vector<int> widths;
};

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) { ++found; }
    return found;
}

}  // namespace

TEST_CASE("displays that are missed though each frame seems to fit lower the resolution until they are met, and it stays so") {
    // 128 ms of 100 at full resolution.
    const Governed run("fast", "at 1.5 gpu-load 1600 ms-per-megapixel\n", 110);
    CHECK(run.widths[14] == kWhole);
    CHECK(run.longestOver() <= 10);
    CHECK(run.widths[80] < kWhole);
    CHECK(run.widths[80] > kWhole / 2);  // and no more is given up than must be
    CHECK_FALSE(run.isOver(80));
    run.checkCalm(80);
    CHECK(run.outcome.output.find(" and missed displays") != std::string::npos);
}

TEST_CASE("a load that is over gives the resolution back, little by little and a step a second at most") {
    const Governed run("fast", "at 1.5 gpu-load 1600 ms-per-megapixel\nat 8 gpu-load 0 ms\n", 360);
    CHECK(run.widths[75] < kWhole);
    CHECK(run.longestOver() <= 10);
    run.checkCalm(80);
    CHECK(run.widths.back() == kWhole);
}

TEST_CASE("where the least settings are too slow as well one message says so, and they stay") {
    const Governed run("sharp", "at 1.5 gpu-load 5000 ms-per-megapixel\n", 110);
    CHECK(run.widths[80] == kWhole * 8 / 10);
    CHECK(run.isOver(80));
    REQUIRE_FALSE(run.changes().empty());
    CHECK(run.changes().back() < 80);
    CHECK(run.widths.back() == kWhole * 8 / 10);
    CHECK(count(run.outcome.output, "not even that fits") == 1);
}

TEST_CASE("a runtime that states longer periods for late frames is not believed: half the rate is not what is aimed at") {
    const Governed run("fast", "period stretched\nextension XR_FB_display_refresh_rate off\nat 1.5 gpu-load 1600 ms-per-megapixel\n", 110);
    CHECK(run.longestOver() <= 10);
    CHECK(run.widths[80] < kWhole);
    CHECK_FALSE(run.isOver(80));
    run.checkCalm(80);
}

TEST_CASE("displays that are missed whatever is drawn cost no quality for long") {
    const Governed run("fast", "at 1.5 gpu-load 150 ms\n", 80);
    CHECK(run.widths[14] == kWhole);
    CHECK(*std::ranges::min_element(run.widths) < kWhole);
    CHECK(run.widths[60] == kWhole);
    CHECK(run.widths.back() == kWhole);
    CHECK(run.outcome.output.find("displays are missed whatever is drawn") != std::string::npos);
}

TEST_CASE("irregular periods, frames that nobody is to see, other rates and a headset that is taken off are no missed displays") {
    const Governed run("fast",
                       "irregular 90\nat 1 should-render off\nat 1.5 should-render on\nat 2 rate 20\nat 2.5 rate 10\nat 3 worn off\n"
                       "at 3.5 worn on\nat 4 visible off\nat 4.5 visible on\n",
                       70);
    CHECK(run.changes().empty());
    CHECK(run.widths.back() == kWhole);
    CHECK(run.outcome.output.find("missed") == std::string::npos);
}

}  // namespace view_governor_test
