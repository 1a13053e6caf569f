// Facts about holding the frame rate on simulated machines.
#include "app/view/governor/governor.h"
#include "tests/suite.h"

SUITE(governor) {

using enum Quality;
using enum Mode;
constexpr double kPeriodMs = 1000.0 / 90.0;
const GovernedSettings kWish{0.22, 1.0}, kAll{1.0, 1.0};

// The settings of `temporal` where everything fits.
GovernedSettings allOf(Quality quality) {
    return {1.0, 1.0, quality == kSharp ? 34.0 : quality == kBalanced ? 30.0 : 27.0};
}

// The share of the work that an error bound takes in these tests.
double workOf(const GovernedSettings& settings) {
    return settings.error_bound_db > 0.0 ? 0.5 * std::exp2((settings.error_bound_db - 30.0) / 4.3)
                                         : settings.budget;
}

// `ms` is the time of all the work at full resolution: a share, `fixed`, does not depend on the budget, a
// third not on the resolution. Small and large frames alternate, the same way in every run.
double cost(double ms, double fixed, const GovernedSettings& settings, std::size_t frame) {
    const double pixels = settings.resolution_scale * settings.resolution_scale;
    const double shiver = 1.0 + 0.04 * std::sin(12.9898 * static_cast<double>(frame));
    return ms * (fixed + (1.0 - fixed) * workOf(settings)) * (1.0 / 3.0 + 2.0 / 3.0 * pixels) * shiver;
}

// Periods lost to a frame of this length on a device that other programs use as well.
double lostBy(double gpu_ms, double others_ms) {
    return std::max(std::ceil((gpu_ms + others_ms) / kPeriodMs - 1e-9) - 1.0, 0.0);
}

using Over = std::function<double(double time_s)>;
struct Machine {
    Quality quality = kFast;
    double seconds = 20.0;  // length of the run
    Over ms = [](double) { return 7.0; };
    double fixed = 0.8;
    Over period_ms = [](double) { return kPeriodMs; };
    // Periods that each frame lost, as the runtime reports it.
    std::function<double(double time_s, double gpu_ms)> lost = {};
    Mode mode = kTemporal;
    GovernedSettings wish = kAll;
    int late = 0;  // frames from a change until it is drawn
};

struct Run {
    struct Frame {
        double time_s, gpu_ms, period_ms;
        GovernedSettings settings;
        bool beaten;
        std::string sentence;
        double lost_periods;
    };
    std::vector<Frame> frames;

    explicit Run(const Machine& machine) {
        Governor governor;
        double time_s = 0.0;
        GovernedSettings chosen, settings;
        int late = 0;
        while (time_s < machine.seconds) {
            governor.wish(machine.quality, machine.mode, machine.wish);
            const bool is_new = std::exchange(chosen, governor.settings()) != governor.settings();
            late = is_new ? machine.late : std::max(late - 1, 0);
            if (late == 0 || frames.empty()) { settings = chosen; }
            const double period_ms = machine.period_ms(time_s);
            const double gpu_ms = cost(machine.ms(time_s), machine.fixed, settings, frames.size());
            const double lost_periods = machine.lost ? machine.lost(time_s, gpu_ms) : 0.0;
            governor.measure({gpu_ms, period_ms, settings != chosen, lost_periods, workOf(settings)});
            frames.push_back({time_s, gpu_ms, period_ms, settings, governor.isBeaten(), governor.sentence(),
                              lost_periods});
            time_s += 1e-3 * period_ms * (1.0 + lost_periods);
        }
    }

    // Frames after this time that changed the settings.
    [[nodiscard]] std::vector<std::size_t> changes(double from_s = 0.0) const {
        std::vector<std::size_t> found;
        for (std::size_t i = 1; i < frames.size(); ++i) {
            const bool changes = frames[i].settings != frames[i - 1].settings;
            if (changes && frames[i].time_s >= from_s) { found.push_back(i); }
        }
        return found;
    }
    // The longest run of frames from `first` on for which `are` holds.
    template <typename Condition>
    [[nodiscard]] std::size_t longest(std::size_t first, const Condition& are) const {
        std::size_t row = 0, most = 0;
        for (std::size_t i = first; i < frames.size(); ++i) {
            most = std::max(most, row = are(frames[i]) ? row + 1 : 0);
        }
        return most;
    }
    [[nodiscard]] std::size_t longestOver(std::size_t first = 0) const {
        return longest(first, [](const Frame& frame) { return frame.gpu_ms > frame.period_ms; });
    }
    [[nodiscard]] std::size_t longestLate() const {
        return longest(0, [](const Frame& frame) { return frame.lost_periods > 0.0; });
    }
    [[nodiscard]] const Frame& at(double time_s) const {
        return *std::ranges::lower_bound(frames, time_s, {}, &Frame::time_s);
    }
    [[nodiscard]] const Frame& last() const { return frames.back(); }
    [[nodiscard]] bool says(const std::string& part, double time_s) const {
        return contains(at(time_s).sentence, part);
    }
    [[nodiscard]] bool saysAtLast(const std::string& part) const { return contains(last().sentence, part); }
};

// 60 frames after each change of the load, `upheavals_s`, the settings have settled, and then change at most
// once a second. A step up that is taken back at once counts as one change; there are at most this many.
void checkCalm(const Run& run, const std::vector<double>& upheavals_s, std::size_t most_taken_back = 0) {
    double last_s = -10.0;
    std::size_t taken_back = 0;
    for (const std::size_t i : run.changes()) {
        const double time_s = run.frames[i].time_s;
        const bool settling = std::ranges::any_of(upheavals_s, [&](double from_s) {
            return time_s >= from_s && time_s <= from_s + 60 * 1e-3 * kPeriodMs;
        });
        CAPTURE(time_s);
        taken_back += !settling && time_s - last_s < 1.0 - 1e-9;
        CHECK(taken_back <= most_taken_back);
        last_s = time_s;
    }
}

Over constantly(double value) {
    return [=](double) { return value; };
}

TEST_CASE("a change that is drawn some frames later is judged by frames that show it") {
    for (const Mode mode : {kTemporal, kPredicted, kShared}) {
        CAPTURE(nameOf(mode));
        Machine machine{.ms = [](double time_s) { return time_s < 5.0 || time_s > 10.0 ? 7.0 : 25.0; },
                        .mode = mode};
        const Run prompt(machine);
        machine.late = 8;
        const Run late(machine);
        CHECK(late.changes().size() <= prompt.changes().size() + 1);
        CHECK(late.at(9.5).gpu_ms < kPeriodMs);
        CHECK(late.last().settings == prompt.last().settings);
    }
}

TEST_CASE("off, or without the device's times, the settings are the wearer's") {
    const Run off({.quality = kOff, .seconds = 5.0, .ms = constantly(40.0), .fixed = 1.0});
    CHECK(off.changes().empty());
    CHECK(off.last().settings == kAll);
    CHECK(off.last().sentence.empty());
    const Run without({.seconds = 2.0, .ms = constantly(0.0)});
    CHECK(without.changes().empty());
    CHECK(without.saysAtLast("does not say"));
}

TEST_CASE("where everything fits the budget rises to all work, a step a second, and stays there") {
    const Run run(
        {.quality = kBalanced, .seconds = 30.0, .ms = constantly(6.0), .mode = kPredicted, .wish = kWish});
    CHECK(run.frames[30].settings == kWish);
    checkCalm(run, {});
    CHECK(run.at(15.0).settings == kAll);
    CHECK(run.changes(15.0).empty());
    CHECK(run.last().sentence.starts_with("predicted at 100 %, 100 % of an eye: "));
    const Run bound({.quality = kBalanced, .ms = constantly(6.0)});
    CHECK(bound.changes().empty());
    CHECK(bound.last().sentence.starts_with("temporal at 100 %, errors within 30 dB: "));
}

TEST_CASE("it finds what fits a load within 60 frames, settles, and gives up no more than it must") {
    for (const Quality quality : {kSharp, kBalanced, kFast}) {
        for (const double fixed : {0.05, 0.2, 0.4}) {
            for (const double ms : {9.5, 12.0, 20.0, 30.0, 50.0}) {
                INFO("quality ", static_cast<int>(quality), ", fixed ", fixed, ", ms ", ms);
                const Run run({.quality = quality, .seconds = 60.0, .ms = constantly(ms), .fixed = fixed});
                checkCalm(run, {0.0});
                if (!run.last().beaten) { CHECK(run.longestOver() <= 10); }
                CHECK(run.longestOver(60) <= (run.last().beaten ? run.frames.size() : 3));
                CHECK(run.changes(30.0).size() <= 2);
                if (quality != kFast || fixed != 0.2 || ms < 30.0) { continue; }
                // A tenth of the period is kept free.
                std::vector<double> last;
                for (std::size_t i = run.frames.size() - 300; i < run.frames.size(); ++i) {
                    last.push_back(run.frames[i].gpu_ms);
                }
                std::ranges::nth_element(last, last.begin() + 150);
                CHECK(last[150] == within(0.6 * kPeriodMs, 0.9 * kPeriodMs * 1.01));
            }
        }
    }
}

TEST_CASE("resolution falls only where the budget is at its least, and both rise when there is room") {
    const Over ms = [](double t) { return t < 12.0 ? 9.0 : t < 27.0 ? 24.0 : 9.0; };
    for (const auto& [quality, least] :
         {std::pair(kSharp, 0.2), std::pair(kBalanced, 0.1), std::pair(kFast, 0.05)}) {
        CAPTURE(least);
        const Run run({.quality = quality, .seconds = 60.0, .ms = ms, .fixed = 0.4, .mode = kPredicted});
        CHECK(run.longestOver() <= 10);
        checkCalm(run, {12.0});
        CHECK(run.at(11.9).settings == kAll);
        CHECK(run.says(" took ", 13.0));
        CHECK(run.at(20.0).settings.budget < 0.25);
        for (const Run::Frame& frame : run.frames) {
            if (frame.settings.resolution_scale < 1.0) {
                CHECK(frame.settings.budget == doctest::Approx(least));
            }
        }
        CHECK(run.last().settings == kAll);
        CHECK(run.changes(50.0).empty());
    }
}

TEST_CASE("a load that grows takes three steps in a row, the third of which is not down to the least") {
    const Over ms = [](double t) { return std::clamp(9.0 + 60.0 * (t - 2.0), 9.0, 15.0); };
    const Run run({.ms = ms, .fixed = 1.0, .mode = kPredicted});
    CHECK(run.longestOver() <= 10);
    REQUIRE(run.changes().size() >= 3);
    CHECK(run.frames[run.changes()[2]].time_s < 2.2);
    CHECK(run.frames[run.changes()[2]].settings.resolution_scale >= 0.5 - 1e-9);
}

TEST_CASE("while the head stands still the budget does not rise, and frames fit once it moves") {
    Governor governor;
    governor.wish(kBalanced, kPredicted, kWish);
    for (std::size_t frame = 0; frame < 1800; ++frame) {
        const bool moves = frame >= 900;
        const GovernedSettings settings = governor.settings();
        const GovernedSettings spent{moves ? settings.budget : 0.0, settings.resolution_scale};
        const double gpu_ms = cost(14.0, 0.5, spent, frame);
        governor.measure({.gpu_ms = gpu_ms, .period_ms = kPeriodMs, .work = spent.budget});
        if (!moves) { CHECK(settings == kWish); }
        CHECK(gpu_ms <= kPeriodMs);
    }
    CHECK(governor.settings().budget > kWish.budget);
}

TEST_CASE_FIXTURE(Governor, "another scene is measured anew, and another wish begins anew") {
    wish(kBalanced, kPredicted, kWish);
    for (std::size_t frame = 0; frame < 900; ++frame) {
        measure({.gpu_ms = cost(9.0, 0.6, settings(), frame), .period_ms = kPeriodMs});
    }
    CHECK(settings() == kAll);
    forget();
    CHECK(settings() == kWish);
    CHECK(sentence().empty());
    Governor other;
    for (std::size_t frame = 0; frame < 400; ++frame) {
        other.wish(kFast, kTemporal, {frame < 200 ? kWish.budget : 0.4, 1.0});
        const double gpu_ms = cost(7.0, 0.8, other.settings(), 0);
        other.measure({gpu_ms, kPeriodMs, false, lostBy(3.0 * gpu_ms, 5.0)});
        CHECK_FALSE(contains(other.sentence(), "whatever is drawn"));
    }
    CHECK(other.settings().resolution_scale == doctest::Approx(0.4));
    CHECK(other.isBeaten());
}

TEST_CASE("without a budget the resolution alone changes, never above the wearer's") {
    for (const Mode mode : {kShared, kTwoPass, kMono, kPaper, kAlternate}) {
        const Run run({.ms = constantly(20.0), .fixed = 1.0, .mode = mode, .wish = {0.22, 1.2}});
        for (const Run::Frame& frame : run.frames) {
            CHECK(frame.settings.budget == 0.22);
            CHECK(frame.settings.resolution_scale <= 1.2);
        }
        const double scale = run.last().settings.resolution_scale;
        CHECK(scale < 1.2);
        CHECK(run.last().sentence.starts_with(fmt::format("{} at {:.0f} %: ", nameOf(mode), 100.0 * scale)));
    }
    const Over ms = [](double t) { return t < 20.0 ? 8.0 : 14.0; };
    const Run one({.seconds = 60.0, .ms = ms, .fixed = 0.6, .mode = kPredicted});
    CHECK(one.at(19.9).settings == kAll);
    CHECK(one.longestOver() <= 10);
    CHECK(one.last().settings.budget < 0.6);
    CHECK(one.last().settings.resolution_scale == 1.0);
}

TEST_CASE("a changing load and period, and a load that swings about the limit, are calm") {
    const Over load = [](double t) {
        return t < 8.0 ? 7.0 : t < 20.0 ? 16.0 : t < 34.0 ? 7.0 : t < 46.0 ? 13.0 : 8.5;
    };
    const Over period_ms = [](double t) { return 1000.0 / (t < 28.0 ? 90.0 : t < 46.0 ? 72.0 : 120.0); };
    const Run minute({.seconds = 60.0, .ms = load, .fixed = 0.75, .period_ms = period_ms});
    checkCalm(minute, {0.0, 8.0, 20.0, 28.0, 34.0, 46.0});
    CHECK(minute.longestOver() <= 10);
    for (const Run::Frame& frame : minute.frames) { CHECK_FALSE(frame.beaten); }
    CHECK(minute.changes().size() <= 30);  // six upheavals, and the way back after each
    const Run swing({.seconds = 120.0, .ms = [](double t) { return 10.5 + 1.0 * std::sin(2.0 * t); }});
    CHECK(swing.longestOver() <= 10);
    checkCalm(swing, {0.0});
    CHECK(swing.changes(60.0).size() <= 8);
}

TEST_CASE("where not even the least settings fit, it says so and stays with them") {
    const Run slow({.quality = kSharp, .ms = constantly(60.0)});
    checkCalm(slow, {0.0});
    CHECK(slow.last().beaten);
    CHECK(slow.last().settings.resolution_scale == doctest::Approx(0.8));
    CHECK(slow.saysAtLast("not even that fits"));
    CHECK(slow.changes(5.0).size() <= 2);
    const Run late({.lost = [](double, double gpu_ms) { return lostBy(3.0 * gpu_ms, 5.0); }});
    checkCalm(late, {0.0});
    CHECK(late.frames[60].settings.resolution_scale == doctest::Approx(0.4));
    CHECK(late.last().beaten);
    CHECK(late.saysAtLast("not even that fits"));
    CHECK(late.changes(5.0).empty());
}

TEST_CASE("displays that are missed although frames fit: others take their part, and less is used") {
    for (const Quality quality : {kBalanced, kFast}) {
        for (const double others_ms : {5.0, 6.0, 7.0}) {
            INFO("quality ", static_cast<int>(quality), ", others_ms ", others_ms);
            const auto lost = [&](double t, double ms) { return lostBy(ms, t < 5.0 ? 0.0 : others_ms); };
            const Run run({.quality = quality, .seconds = 40.0, .lost = lost});
            CHECK(run.at(4.9).settings == allOf(quality));
            checkCalm(run, {5.0}, 3);
            CHECK(run.longestOver() == 0);
            if (!run.last().beaten) { CHECK(run.longestLate() <= 10); }
            CHECK(run.at(6.0).settings != allOf(quality));
            CHECK(run.says(" and missed displays", 6.0));
            // Higher settings are tried rarely, and more and more rarely.
            CHECK(run.changes(8.0).size() <= 16);
        }
    }
    // When the other programs stop, the time is used again.
    const Run run({.seconds = 60.0, .lost = [](double t, double gpu_ms) {
                       return lostBy(gpu_ms, t > 5.0 && t < 20.0 ? 6.0 : 0.0);
                   }});
    checkCalm(run, {5.0}, 2);
    CHECK(run.longestLate() <= 10);
    CHECK(run.at(19.0).settings.resolution_scale < 1.0);
    CHECK(run.last().settings == allOf(kFast));
}

TEST_CASE("where displays are missed whatever is drawn nothing is given up for it, and a message says so") {
    const Run run({.seconds = 200.0, .lost = [](double, double gpu_ms) { return lostBy(gpu_ms, 12.0); }});
    CHECK(run.frames[10].settings.resolution_scale < 1.0);
    CHECK(run.frames[40].settings == allOf(kFast));
    CHECK(contains(run.frames[40].sentence, "displays are missed whatever is drawn"));
    // Lower settings are tried again after a minute, and then after two.
    CHECK(these(run.last().settings, run.last().beaten) == these(allOf(kFast), false));
    CHECK(std::ranges::count(run.frames, allOf(kFast), &Run::Frame::settings) ==
          between(std::ssize(run.frames) - 100, std::ssize(run.frames) - 20));
    CHECK(run.changes(1.0).size() <= 8);  // three steps down and all the way back, twice
    // Once these misses are over, the message disappears and misses count again: the next ones come from a
    // load that the device's own times do not show.
    const auto in_turn = [](double t, double gpu_ms) {
        return t < 5.0 ? lostBy(gpu_ms, 12.0) : t < 7.0 ? 0.0 : lostBy(gpu_ms, 6.0);
    };
    const Run again({.lost = in_turn});
    CHECK(again.says("whatever is drawn", 4.9));
    CHECK_FALSE(again.says("whatever is drawn", 6.9));
    CHECK(again.at(6.9).settings.resolution_scale == 1.0);
    CHECK(again.at(9.0).settings.resolution_scale < 1.0);
    CHECK(again.at(9.0).lost_periods == 0.0);
    // A spike when displays begin to be missed does not make the lowest settings look better than the best.
    std::size_t frame = 0;
    const Run spike({.seconds = 10.0, .lost = [&](double, double) {
                         return ++frame == 50 ? 6.0 : frame > 50 ? 1.0 : 0.0;
                     }});
    CHECK(spike.last().settings.resolution_scale == 1.0);
    CHECK(spike.saysAtLast("whatever is drawn"));
}

TEST_CASE("a hitch at the least settings, which meet all displays, gives nothing back") {
    std::size_t hitch = 0;
    const auto lost = [&](double t, double gpu_ms) {
        return t > 9.0 && hitch < 6 ? ++hitch, 2.0 : lostBy(2.0 * gpu_ms, 4.0);
    };
    const Run run({.seconds = 30.0, .lost = lost});
    const double before = run.at(8.9).settings.resolution_scale;
    CHECK(before < 0.75);
    CHECK(run.at(8.9).lost_periods == 0.0);
    CHECK(run.at(9.5).settings.resolution_scale <= before);
    CHECK_FALSE(run.says("whatever is drawn", 12.0));
}

TEST_CASE("frames that are slow or come late now and then, or early for each that is late, change nothing") {
    std::size_t frame = 0;
    const Over slow = [&](double) { return ++frame % 10 == 0 ? 25.0 : 7.0; };
    CHECK(Run({.quality = kBalanced, .ms = slow, .fixed = 1.0}).changes().empty());
    const std::vector<std::function<double()>> shapes{[&] { return ++frame % 10 == 0 ? 5.0 : 0.0; },
                                                      [&] { return (++frame / 3) % 2 == 0 ? 0.3 : -0.3; },
                                                      [&] { return ++frame % 2 == 0 ? 0.9 : -0.9; }};
    for (const auto& lost : shapes) {
        CHECK(Run({.lost = [&](double, double) { return lost(); }}).changes().empty());
    }
}

}  // SUITE(governor)
