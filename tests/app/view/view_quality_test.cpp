// Facts about holding the frame rate in the headset: by the device's times, or by missed displays.
#include "tests/app/view/view_acts.h"

SUITE(view_quality) {

const std::string kNothingElse = " --hide-panel --hide-hands --load-first ";

// Ticks from one timestamp to the next: far more than a period on any device, or far less.
const std::string kSlow = withFaults("BINOSPLAT_FAULT_TICKS=1000000000"),
                  kQuick = withFaults("BINOSPLAT_FAULT_TICKS=1");

// The display is slow, so that the program's work fits on any machine; frames seem to take no time.
constexpr int kWhole = 100;  // pixels

struct Governed : ViewRun {
    Governed(const std::string& quality, const std::string& load, int most_frames) {
        const Workplace work;
        static_cast<ViewRun&>(*this) =
            runView(work, "load", fmt::format("rate 10\nsize {0} {0}\nframes none\n{1}", kWhole, load),
                    fmt::format("builtin:one-splat{}--axes view --frames {}{}", kNothingElse, most_frames,
                                withConfig(work, fmt::format("[view]\nquality = \"{}\"\n", quality))),
                    kQuick);
        for (std::size_t i = 0; i < frames.size(); ++i) {
            const bool is_shown = !layers(i, "projection").empty();
            widths.push_back(is_shown ? width(i) : widths.empty() ? kWhole : widths.back());
        }
        checkClean(*this);
    }

    std::vector<int> widths;
};

TEST_CASE_FIXTURE(AtWork, "where nothing fits a quality's least settings are reached within 60 frames") {
    picturesInto(work);
    Acts acts("rate 90\nsize 200 200\nframes none\nvisibility-mask on\n");
    std::vector<double> looks;
    for (const char* button : {"", "Sharp", "Fast", "Fast"}) {
        if (*button != '\0') { acts.click(placeOf(button)); }
        looks.push_back(acts.wait(57.0 / 90.0).look(0.02));
        acts.click(placeOf("Picture")).wait(0.1);
    }
    const ViewRun run = runClean(work, acts,
                                 "builtin:one-splat --load-first --hide-hands --mode temporal" +
                                     withConfig(work, "[view]\nresolution-scale = 0.8\n"),
                                 kSlow);
    std::vector<int> widths;
    for (const double seconds : looks) { widths.push_back(run.width(run.frameAt(seconds))); }
    // 80 and 40 % of the wearer's setting, which is the maximum.
    CHECK(widths == std::vector{160, 128, 64, 160});
    // Pictures have the headset's size, whatever is left of the frames'.
    const std::vector<std::string> pictures = run.lines("/pictures/one-splat-20");
    REQUIRE(pictures.size() == looks.size());
    for (const std::string& line : pictures) {
        CHECK(readPicture(line.substr(line.find('/'))).size_px == glm::uvec2(200));
    }
    REQUIRE_FALSE(run.lines(" took ").empty());
    const std::string took = run.lines(" took ")[0];
    CHECK(contains(took, "; temporal at 80 %, errors within 34 dB took "));
    CHECK(static_cast<double>(frameOf(took)) > 90.0 * looks[0]);
    CHECK(run.periodNs(8) == 11'111'111);
}

TEST_CASE_FIXTURE(AtWork, "where everything fits nothing is given up, and the rate is the settings'") {
    const ViewRun run = runClean(work, "rate 90\nsize 200 200\nframes none\n",
                                 "builtin:one-splat --mode shared --frames 40" + kNothingElse +
                                     withConfig(work, "[view]\nquality = \"fast\"\nrefresh-rate = 120\n"),
                                 kQuick);
    CHECK(these(run.width(38), run.periodNs(0), run.periodNs(15)) == these(200, 11'111'111, 8'333'333));
}

TEST_CASE_FIXTURE(AtWork, "no frame makes a kernel, also where the eyes come to look another way") {
    for (const auto& [mode, lines] :
         {std::pair("predicted", ""), std::pair("predicted", "visibility-mask on\n"),
          std::pair("temporal", "eye left cant 5\n"), std::pair("temporal", "visibility-mask on\n")}) {
        INFO("mode ", mode, ", lines ", lines);
        // From side-by-side eyes to eyes with different angles.
        const ViewRun run = runClean(
            work,
            fmt::format("rate 90\nsize 96 96\nframes none\n{}at 0.3 eye left angles -50 40 40 -50\n", lines),
            fmt::format("builtin:one-splat{}--mode {} --move-cost 0 --frames 60", kNothingElse, mode),
            withFaults("BINOSPLAT_FAULT_LIVE=alive.txt"));
        std::vector<std::string> made = linesIn(work.bytesOf("alive.txt"));
        for (std::string& line : made) { line = line.substr(line.rfind(' ') + 1); }
        REQUIRE(made.size() > 4);
        CHECK(made.front() == made.back());
    }
}

TEST_CASE_FIXTURE(AtWork, "with a load bound and resolution fall at once, and are back once it has gone") {
    // The head moves before a display of 30 Hz. Everything fits into 33 ms but for a while
    // (tests/faults/load.cpp). Staying axes would add a border larger than a picture this small.
    constexpr std::size_t kComes = 40, kGoes = 100, kSecond = 30;
    const ViewRun run = runClean(
        work, "rate 30\nsize 64 64\nframes none\nhead 0 position 0 1.6 0\nhead 20 position 2 1.6 0\n",
        "builtin:slanted-wall --axes view --frames 300" + kNothingElse +
            withConfig(work, "[view]\nquality = \"balanced\"\n"),
        withFaults(fmt::format("BINOSPLAT_FAULT_LOAD=0:8,{}:60,{}:8", kComes, kGoes)));
    // "frame 41: temporal at 60 %, errors within 20 dB; why"
    const std::vector<std::string> changes = run.lines(" dB; ");
    INFO(run.outcome.output);
    REQUIRE(changes.size() >= 2);
    CHECK(frameOf(changes.front()) == within(kComes + 1, kComes + 10));
    CHECK(run.width(kComes + 20) < 64);
    for (std::size_t i = 1; i < changes.size(); ++i) {
        CAPTURE(i);
        CHECK(contains(changes[i], ": temporal at "));
        if (frameOf(changes[i]) > kGoes) { CHECK(frameOf(changes[i]) - frameOf(changes[i - 1]) >= kSecond); }
    }
    CHECK(contains(changes.back(), "temporal at 100 %, errors within 30 dB; better for the same time"));
    CHECK(frameOf(changes.back()) <= kGoes + kSecond);
    CHECK(run.width(run.frames.size() - 4) == 64);
    // And from the first second on, if that is how it begins.
    const ViewRun loaded = runClean(work, "rate 30\nsize 64 64\nframes none\n",
                                    "builtin:slanted-wall --axes view --frames 40" + kNothingElse +
                                        withConfig(work, "[view]\nquality = \"balanced\"\n"),
                                    withFaults("BINOSPLAT_FAULT_LOAD=0:60"));
    REQUIRE_FALSE(loaded.lines(" dB; ").empty());
    CHECK(frameOf(loaded.lines(" dB; ").front()) <= 10);
    CHECK(loaded.width(20) < 64);
}

TEST_CASE("displays missed though frames seem to fit lower the resolution until they are met") {
    constexpr std::size_t kCalm = 80;  // from this frame on, changes are at least a second apart
    // 128 ms with a period of 100, at full resolution.
    const Governed run("fast", "at 1.5 gpu-load 6400 ms-per-megapixel\nat 11 gpu-load 0 ms\n", 390);
    CHECK(run.widths[14] == kWhole);
    std::size_t row = 0;  // of frames that took longer than their period
    double changed_s = -10.0;
    for (std::size_t i = 1; i < run.frames.size(); ++i) {
        CAPTURE(i);
        const nlohmann::json& frame = run.frames[i];
        row = frame.value("gpu_ms", 0.0) > 1e-6 * frame.at("period_ns").get<double>() ? row + 1 : 0;
        CHECK(row <= (i == kCalm ? 0 : 10));
        if (run.widths[i] == run.widths[i - 1]) { continue; }
        const double now_s = ViewRun::secondsOf(frame);
        CHECK((i < kCalm || now_s - changed_s >= 1.0 - 1e-6));
        changed_s = now_s;
    }
    CHECK(run.widths[kCalm] == between(kWhole / 2, kWhole));  // no more is given up than necessary
    CHECK(run.says(" and missed displays"));
    CHECK(run.widths.back() == kWhole);
}

TEST_CASE("irregular periods, unseen frames, other rates and a headset taken off are no missed displays") {
    const Governed run("fast",
                       "irregular 90\nat 1 should-render off\nat 1.5 should-render on\nat 2 rate 20\n"
                       "at 2.5 rate 10\nat 3 worn off\nat 3.5 worn on\nat 4 visible off\nat 4.5 visible on\n",
                       70);
    CHECK(std::ranges::count(run.widths, kWhole) == std::ssize(run.widths));
    CHECK_FALSE(run.says("missed"));
}

}  // SUITE(view_quality)
