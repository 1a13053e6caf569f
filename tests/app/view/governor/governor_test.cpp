// Facts about holding the frame rate, on machines that are made up: what a frame costs is a function of time, budget and resolution.
#include "app/view/governor/governor.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

TEST_SUITE_BEGIN("governor");

namespace governor_test {

using namespace binosplat;

namespace {

constexpr double kPeriodMs = 1000.0 / 90.0;
const GovernedSettings kWish{0.22, 1.0}, kAll{1.0, 1.0};

// Milliseconds of a frame; time counts from the start of the run.
using Load = std::function<double(double time_s, const GovernedSettings&)>;

// `ms` is what all work takes at full resolution, of which so much is `fixed` whatever the budget. A third is the same whatever the
// resolution.
double cost(double ms, double fixed, const GovernedSettings& settings) {
    const double pixels = settings.resolution_scale * settings.resolution_scale;
    return ms * (fixed + (1.0 - fixed) * settings.budget) * (1.0 / 3.0 + 2.0 / 3.0 * pixels);
}

// Small and large frames in turn, the same in every run.
double shiver(std::size_t frame) { return 1.0 + 0.04 * std::sin(12.9898 * static_cast<double>(frame)); }

struct Run {
    struct Frame {
        double time_s, gpu_ms, period_ms;
        GovernedSettings settings;
        bool beaten;
        std::string sentence;
        double lost_periods;
    };
    std::vector<Frame> frames;

    [[nodiscard]] std::vector<std::size_t> changes() const {
        std::vector<std::size_t> found;
        for (std::size_t i = 1; i < frames.size(); ++i) {
            if (frames[i].settings != frames[i - 1].settings) { found.push_back(i); }
        }
        return found;
    }
    // The longest row of frames from `first` on that `are` so.
    template <typename Condition>
    [[nodiscard]] std::size_t longest(std::size_t first, const Condition& are) const {
        std::size_t row = 0, most = 0;
        for (std::size_t i = first; i < frames.size(); ++i) { most = std::max(most, row = are(frames[i]) ? row + 1 : 0); }
        return most;
    }
    [[nodiscard]] std::size_t longestOver(std::size_t first = 0) const {
        return longest(first, [](const Frame& frame) { return frame.gpu_ms > frame.period_ms; });
    }
    [[nodiscard]] std::size_t longestLate() const {
        return longest(0, [](const Frame& frame) { return frame.lost_periods > 0.0; });
    }
    [[nodiscard]] const Frame& at(double time_s) const {
        return *std::find_if(frames.begin(), frames.end(), [&](const Frame& frame) { return frame.time_s >= time_s; });
    }
    [[nodiscard]] const Frame& last() const { return frames.back(); }
};

// Periods lost by a frame that takes so long on a device that others use as well.
double lostBy(double gpu_ms, double others_ms, double period_ms) {
    return std::max(std::ceil((gpu_ms + others_ms) / period_ms - 1e-9) - 1.0, 0.0);
}

// What the runtime shows of a frame: how many periods were lost, by the time and by what it took.
using Lost = std::function<double(double time_s, double gpu_ms)>;

Run govern(Quality quality, double seconds, const Load& load, const std::function<double(double)>& period = {}, const Lost& lost = {},
           Mode mode = Mode::kTemporal, const GovernedSettings& wish = kAll) {
    Governor governor;
    Run run;
    double time_s = 0.0;
    for (std::size_t frame = 0; time_s < seconds; ++frame) {
        governor.wish(quality, mode, wish);
        const GovernedSettings settings = governor.settings();
        const double period_ms = period ? period(time_s) : kPeriodMs;
        const double gpu_ms = load(time_s, settings) * shiver(frame);
        const double lost_periods = lost ? lost(time_s, gpu_ms) : 0.0;
        governor.measure({gpu_ms, period_ms, false, lost_periods});
        run.frames.push_back({time_s, gpu_ms, period_ms, settings, governor.isBeaten(), governor.sentence(), lost_periods});
        time_s += 1e-3 * period_ms * (1.0 + lost_periods);
    }
    return run;
}

// Times at which a load changes: 60 frames after each it has settled, and from then on changes at most once a second. Steps upwards that
// were taken back at once count as one change: there are so many at most.
void checkCalm(const Run& run, const std::vector<double>& upheavals_s, std::size_t most_taken_back = 0) {
    double last_s = -10.0;
    std::size_t taken_back = 0;
    for (const std::size_t i : run.changes()) {
        const double time_s = run.frames[i].time_s;
        const bool settling = std::any_of(upheavals_s.begin(), upheavals_s.end(),
                                          [&](double from_s) { return time_s >= from_s && time_s <= from_s + 60 * 1e-3 * kPeriodMs; });
        CAPTURE(time_s);
        const bool is_calm = settling || time_s - last_s >= 1.0 - 1e-9;
        if (!is_calm) { ++taken_back; }
        CHECK(taken_back <= most_taken_back);
        last_s = time_s;
    }
}

// Changes after a time.
std::size_t changesAfter(const Run& run, double from_s) {
    const auto changes = run.changes();
    return static_cast<std::size_t>(
        std::count_if(changes.begin(), changes.end(), [&](std::size_t i) { return run.frames[i].time_s >= from_s; }));
}

}  // namespace

TEST_CASE("off, the settings are the wearer's, whatever they cost") {
    const Run run = govern(Quality::kOff, 5.0, [](double, const GovernedSettings&) { return 40.0; });
    CHECK(run.changes().empty());
    CHECK(run.last().settings == kAll);
    CHECK(run.last().sentence.empty());
}

TEST_CASE("where everything fits the budget rises from the wearer's to all work, a step a second, and stays there") {
    const Run run = govern(
        Quality::kBalanced, 30.0, [](double, const GovernedSettings& s) { return cost(6.0, 0.2, s); }, {}, {}, Mode::kTemporal, kWish);
    CHECK(run.frames[30].settings == kWish);
    checkCalm(run, {});
    CHECK(run.at(15.0).settings == kAll);
    CHECK(changesAfter(run, 15.0) == 0);
    CHECK(run.last().sentence.find("temporal at 100 %, 100 % of both eyes: ") == 0);
}

TEST_CASE("of a load that does not change it finds what fits within 60 frames, and settles") {
    for (const Quality quality : {Quality::kSharp, Quality::kBalanced, Quality::kFast}) {
        for (const double fixed : {0.05, 0.15, 0.4}) {
            for (const double ms : {9.5, 12.0, 20.0, 30.0, 40.0}) {
                CAPTURE(static_cast<int>(quality));
                CAPTURE(fixed);
                CAPTURE(ms);
                const Run run = govern(quality, 60.0, [&](double, const GovernedSettings& s) { return cost(ms, fixed, s); });
                checkCalm(run, {0.0});
                if (!run.last().beaten) { CHECK(run.longestOver() <= 10); }
                CHECK(run.longestOver(60) <= (run.last().beaten ? run.frames.size() : 3));
                CHECK(changesAfter(run, 30.0) <= 2);
            }
        }
    }
}

TEST_CASE("a tenth of the period is spared, and no more is given up than must be") {
    for (const double ms : {12.0, 20.0, 30.0, 50.0}) {
        CAPTURE(ms);
        const Run run = govern(Quality::kFast, 40.0, [&](double, const GovernedSettings& s) { return cost(ms, 0.2, s); });
        std::vector<double> last;
        for (std::size_t i = run.frames.size() - 300; i < run.frames.size(); ++i) { last.push_back(run.frames[i].gpu_ms); }
        std::nth_element(last.begin(), last.begin() + 150, last.end());
        CHECK(last[150] <= 0.9 * kPeriodMs * 1.01);
        CHECK(last[150] >= 0.6 * kPeriodMs);
    }
}

TEST_CASE("a load that comes and goes: resolution falls only where the budget is at its least, and both rise again when there is room") {
    const auto ms = [](double t) { return t < 12.0 ? 9.0 : t < 27.0 ? 40.0 : 9.0; };
    for (const auto& [quality, least] :
         {std::pair(Quality::kSharp, 0.2), std::pair(Quality::kBalanced, 0.1), std::pair(Quality::kFast, 0.05)}) {
        CAPTURE(least);
        const Run run = govern(quality, 60.0, [&](double t, const GovernedSettings& s) { return cost(ms(t), 0.2, s); });
        CHECK(run.longestOver() <= 10);
        checkCalm(run, {12.0});
        CHECK(run.at(11.9).settings == kAll);
        CHECK(run.at(13.0).sentence.find(" took ") != std::string::npos);
        CHECK(run.at(20.0).settings.budget < 0.25);
        for (const Run::Frame& frame : run.frames) {
            if (frame.settings.resolution_scale < 1.0) { CHECK(frame.settings.budget == doctest::Approx(least)); }
        }
        CHECK(run.last().settings == kAll);
        CHECK(changesAfter(run, 50.0) == 0);
    }
}

TEST_CASE("while the head stands still nothing is left to mend: the budget does not rise, and frames fit once it moves") {
    Governor governor;
    governor.wish(Quality::kBalanced, Mode::kTemporal, kWish);
    for (std::size_t frame = 0; frame < 1800; ++frame) {
        const bool moves = frame >= 900;
        const GovernedSettings settings = governor.settings();
        const GovernedSettings spent{moves ? settings.budget : 0.0, settings.resolution_scale};
        const double gpu_ms = cost(25.0, 0.15, spent) * shiver(frame);
        governor.measure({.gpu_ms = gpu_ms, .period_ms = kPeriodMs, .work = spent.budget});
        if (!moves) { CHECK(settings == kWish); }
        CHECK(gpu_ms <= kPeriodMs);
    }
    CHECK(governor.settings().budget > kWish.budget);
}

TEST_CASE("another scene is measured anew") {
    Governor governor;
    governor.wish(Quality::kBalanced, Mode::kTemporal, kWish);
    for (std::size_t frame = 0; frame < 900; ++frame) {
        governor.measure({.gpu_ms = cost(9.0, 0.2, governor.settings()) * shiver(frame), .period_ms = kPeriodMs});
    }
    CHECK(governor.settings() == kAll);
    governor.forget();
    CHECK(governor.settings() == kWish);
    CHECK(governor.sentence().empty());
}

TEST_CASE("of a method without a budget the resolution alone changes, and is never higher than the wearer's") {
    for (const Mode mode : {Mode::kShared, Mode::kTwoPass, Mode::kMono, Mode::kPaper, Mode::kAlternate}) {
        const GovernedSettings wish{0.22, 1.2};
        const Run run = govern(
            Quality::kFast, 20.0, [](double, const GovernedSettings& s) { return cost(20.0, 1.0, s); }, {}, {}, mode, wish);
        for (const Run::Frame& frame : run.frames) {
            CHECK(frame.settings.budget == 0.22);
            CHECK(frame.settings.resolution_scale <= 1.2);
        }
        CHECK(run.last().settings.resolution_scale < 1.2);
        CHECK(run.last().sentence.find(fmt::format("{} at {:.0f} %: ", nameOf(mode), 100.0 * run.last().settings.resolution_scale)) == 0);
    }
}

TEST_CASE("the budget of one eye is moved in the same way") {
    const auto ms = [](double t) { return t < 20.0 ? 8.0 : 14.0; };
    const Run run = govern(
        Quality::kFast, 60.0, [&](double t, const GovernedSettings& s) { return cost(ms(t), 0.6, s); }, {}, {}, Mode::kPredicted);
    CHECK(run.at(19.9).settings == kAll);
    CHECK(run.longestOver() <= 10);
    CHECK(run.last().settings.budget < 0.6);
    CHECK(run.last().settings.resolution_scale == 1.0);
    CHECK(run.last().sentence.find(" of an eye") != std::string::npos);
}

TEST_CASE("a minute in which the load and the period change") {
    const auto ms = [](double t) { return t < 8.0 ? 7.0 : t < 20.0 ? 16.0 : t < 34.0 ? 7.0 : t < 46.0 ? 13.0 : 8.5; };
    const auto period = [](double t) { return t < 28.0 ? 1000.0 / 90.0 : t < 46.0 ? 1000.0 / 72.0 : 1000.0 / 120.0; };
    const Run run = govern(
        Quality::kFast, 60.0, [&](double t, const GovernedSettings& s) { return cost(ms(t), 0.75, s); }, period);
    checkCalm(run, {0.0, 8.0, 20.0, 28.0, 34.0, 46.0});
    CHECK(run.longestOver() <= 10);
    for (const Run::Frame& frame : run.frames) { CHECK_FALSE(frame.beaten); }
    // Six upheavals, and the way back after them.
    CHECK(run.changes().size() <= 30);
}

TEST_CASE("where not even the least settings fit, it says so and stays with them") {
    const Run run = govern(Quality::kSharp, 20.0, [](double, const GovernedSettings& s) { return cost(60.0, 0.8, s); });
    checkCalm(run, {0.0});
    CHECK(run.last().beaten);
    CHECK(run.last().settings.resolution_scale == doctest::Approx(0.8));
    CHECK(run.last().sentence.find("not even that fits") != std::string::npos);
    CHECK(changesAfter(run, 5.0) <= 2);
}

TEST_CASE("a load that swings about the limit does not make it swing") {
    const Run run =
        govern(Quality::kFast, 120.0, [](double t, const GovernedSettings& s) { return cost(10.5 + 1.0 * std::sin(2.0 * t), 0.8, s); });
    CHECK(run.longestOver() <= 10);
    checkCalm(run, {0.0});
    CHECK(changesAfter(run, 60.0) <= 8);
}

TEST_CASE("displays that are missed although the device says that frames fit: others take their part, and there is less to use") {
    for (const Quality quality : {Quality::kBalanced, Quality::kFast}) {
        for (const double others_ms : {5.0, 6.0, 7.0}) {
            CAPTURE(static_cast<int>(quality));
            CAPTURE(others_ms);
            const Run run = govern(
                quality, 40.0, [](double, const GovernedSettings& s) { return cost(7.0, 0.8, s); }, {},
                [&](double t, double gpu_ms) { return lostBy(gpu_ms, t < 5.0 ? 0.0 : others_ms, kPeriodMs); });
            CHECK(run.at(4.9).settings == kAll);
            checkCalm(run, {5.0}, 3);
            CHECK(run.longestOver() == 0);
            if (!run.last().beaten) { CHECK(run.longestLate() <= 10); }
            CHECK(run.at(6.0).settings != run.at(4.9).settings);
            CHECK(run.at(6.0).sentence.find(" and missed displays") != std::string::npos);
            // More is tried rarely, and more rarely each time.
            CHECK(changesAfter(run, 8.0) <= 16);
        }
    }
}

TEST_CASE("what others leave again is used again") {
    const Run run = govern(
        Quality::kFast, 60.0, [](double, const GovernedSettings& s) { return cost(7.0, 0.8, s); }, {},
        [](double t, double gpu_ms) { return lostBy(gpu_ms, t > 5.0 && t < 20.0 ? 6.0 : 0.0, kPeriodMs); });
    checkCalm(run, {5.0}, 2);
    CHECK(run.longestLate() <= 10);
    CHECK(run.at(19.0).settings.resolution_scale < 1.0);
    CHECK(run.last().settings == kAll);
}

TEST_CASE("where displays are missed whatever is drawn nothing is given up for it but for a moment, and a message says so") {
    const Run run = govern(
        Quality::kFast, 200.0, [](double, const GovernedSettings& s) { return cost(7.0, 0.8, s); }, {},
        [](double, double gpu_ms) { return lostBy(gpu_ms, 12.0, kPeriodMs); });
    CHECK(run.frames[10].settings.resolution_scale < 1.0);
    CHECK(run.frames[40].settings == kAll);
    CHECK(run.frames[40].sentence.find("displays are missed whatever is drawn") != std::string::npos);
    // It is looked at again after a minute, and after two.
    CHECK(run.last().settings == kAll);
    CHECK_FALSE(run.last().beaten);
    const auto lowered = std::ranges::count_if(run.frames, [&](const Run::Frame& frame) { return frame.settings != kAll; });
    CHECK(lowered > 20);
    CHECK(lowered < 100);
    CHECK(changesAfter(run, 1.0) <= 8);  // three steps down and all the way back, twice
}

TEST_CASE("where not even the least settings meet every display, but more of them than the best, it says so and stays with them") {
    const Run run = govern(
        Quality::kFast, 20.0, [](double, const GovernedSettings& s) { return cost(7.0, 0.8, s); }, {},
        [](double, double gpu_ms) { return lostBy(3.0 * gpu_ms, 5.0, kPeriodMs); });
    checkCalm(run, {0.0});
    CHECK(run.frames[60].settings.resolution_scale == doctest::Approx(0.4));
    CHECK(run.last().beaten);
    CHECK(run.last().sentence.find("not even that fits") != std::string::npos);
    CHECK(changesAfter(run, 5.0) == 0);
}

TEST_CASE("a hitch at the least settings, which meet all displays, gives nothing back") {
    std::size_t hitch = 0;
    const Run run = govern(
        Quality::kFast, 30.0, [](double, const GovernedSettings& s) { return cost(7.0, 0.8, s); }, {},
        [&](double t, double gpu_ms) {
            const double others = lostBy(2.0 * gpu_ms, 4.0, kPeriodMs);
            return t > 9.0 && hitch < 6 ? ++hitch, 2.0 : others;
        });
    const double before = run.at(8.9).settings.resolution_scale;
    CHECK(before < 0.75);
    CHECK(run.at(8.9).lost_periods == 0.0);
    CHECK(run.at(9.5).settings.resolution_scale <= before);
    CHECK(run.at(12.0).sentence.find("whatever is drawn") == std::string::npos);
}

TEST_CASE("another wish begins anew: what was lost before it is no measure") {
    Governor governor;
    bool gave_back = false;
    for (int i = 0; i < 400; ++i) {
        GovernedSettings wish = kWish;
        if (i >= 200) { wish.budget = 0.4; }
        governor.wish(Quality::kFast, Mode::kTemporal, wish);
        const double gpu_ms = cost(7.0, 0.8, governor.settings());
        governor.measure({gpu_ms, kPeriodMs, false, lostBy(3.0 * gpu_ms, 5.0, kPeriodMs)});
        gave_back = gave_back || governor.sentence().find("whatever is drawn") != std::string::npos;
    }
    CHECK_FALSE(gave_back);
    CHECK(governor.settings().resolution_scale == doctest::Approx(0.4));
    CHECK(governor.isBeaten());
}

TEST_CASE("a spike when the misses begin does not make the least settings look better than the best ones") {
    std::size_t frame = 0;
    const Run run = govern(
        Quality::kFast, 10.0, [](double, const GovernedSettings& s) { return cost(7.0, 0.8, s); }, {},
        [&](double, double) { return ++frame == 50 ? 6.0
                                     : frame > 50  ? 1.0
                                                   : 0.0; });
    CHECK(run.last().settings.resolution_scale == 1.0);
    CHECK(run.last().sentence.find("whatever is drawn") != std::string::npos);
}

TEST_CASE("misses that were others' doing and are over count again, and are no longer spoken of") {
    // First whatever is drawn, then none, then what the device is too slow for without saying it.
    const Run run = govern(
        Quality::kFast, 20.0, [](double, const GovernedSettings& s) { return cost(7.0, 0.8, s); }, {},
        [](double t, double gpu_ms) { return t < 5.0   ? lostBy(gpu_ms, 12.0, kPeriodMs)
                                             : t < 7.0 ? 0.0
                                                       : lostBy(gpu_ms, 6.0, kPeriodMs); });
    CHECK(run.at(4.9).sentence.find("whatever is drawn") != std::string::npos);
    CHECK(run.at(6.9).sentence.find("whatever is drawn") == std::string::npos);
    CHECK(run.at(6.9).settings.resolution_scale == 1.0);
    CHECK(run.at(9.0).settings.resolution_scale < 1.0);
    CHECK(run.at(9.0).lost_periods == 0.0);
}

TEST_CASE("frames that are slow or come late now and then, or early for each that is late, change nothing") {
    const auto fits = [](double, const GovernedSettings& s) { return cost(7.0, 0.8, s); };
    std::size_t frame = 0;
    const auto slow = [&](double t, const GovernedSettings& s) { return ++frame % 10 == 0 ? 25.0 : fits(t, s); };
    CHECK(govern(Quality::kBalanced, 20.0, slow).changes().empty());
    const auto hiccups = [&](double, double) { return ++frame % 10 == 0 ? 5.0 : 0.0; };
    CHECK(govern(Quality::kFast, 20.0, fits, {}, hiccups).changes().empty());
    const auto irregular = [&](double, double) { return (++frame / 3) % 2 == 0 ? 0.3 : -0.3; };
    CHECK(govern(Quality::kFast, 20.0, fits, {}, irregular).changes().empty());
    const auto alternating = [&](double, double) { return ++frame % 2 == 0 ? 0.9 : -0.9; };
    CHECK(govern(Quality::kFast, 20.0, fits, {}, alternating).changes().empty());
}

TEST_CASE("without times nothing is chosen, and a message says so") {
    const Run run = govern(Quality::kFast, 2.0, [](double, const GovernedSettings&) { return 0.0; });
    CHECK(run.changes().empty());
    CHECK(run.last().sentence.find("does not say") != std::string::npos);
}

}  // namespace governor_test
