// Facts about holding the frame rate, on machines that are made up: what a frame costs is a function of time, method and resolution.
#include "app/view/governor/governor.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

TEST_SUITE_BEGIN("governor");

using namespace binosplat;

namespace {

constexpr double kPeriodMs = 1000.0 / 90.0;
const GovernedSettings kWish{Mode::kPredicted, 0.22, 1.0};

// Milliseconds of a frame; time counts from the start of the run.
using Load = std::function<double(double time_s, const GovernedSettings&)>;

// `ms` is what `shared` takes at full resolution. A third of it is the same whatever the resolution; a lossy method takes `lossy` of it,
// and less with a smaller budget.
double cost(double ms, double lossy, const GovernedSettings& settings) {
    const double pixels = settings.resolution_scale * settings.resolution_scale;
    const double method = settings.mode == Mode::kShared ? 1.0 : lossy + 0.3 * (settings.budget - kWish.budget);
    return ms * method * (1.0 / 3.0 + 2.0 / 3.0 * pixels);
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
    // The longest row of frames over the period, from `first` on.
    [[nodiscard]] std::size_t longestOver(std::size_t first = 0) const {
        std::size_t row = 0, longest = 0;
        for (std::size_t i = first; i < frames.size(); ++i) {
            row = frames[i].gpu_ms > frames[i].period_ms ? row + 1 : 0;
            longest = std::max(longest, row);
        }
        return longest;
    }
    // The longest row of frames that came late, from `first` on.
    [[nodiscard]] std::size_t longestLate(std::size_t first = 0) const {
        std::size_t row = 0, longest = 0;
        for (std::size_t i = first; i < frames.size(); ++i) {
            row = frames[i].lost_periods > 0.0 ? row + 1 : 0;
            longest = std::max(longest, row);
        }
        return longest;
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

Run govern(Quality quality, double seconds, const Load& load, const std::function<double(double)>& period = {},
           const GovernedSettings& wish = kWish, const Lost& lost = {}, bool tells_of_both = true) {
    Governor governor;
    Run run;
    double time_s = 0.0;
    for (std::size_t frame = 0; time_s < seconds; ++frame) {
        governor.wish(quality, wish);
        const GovernedSettings settings = governor.settings();
        const double period_ms = period ? period(time_s) : kPeriodMs;
        const double gpu_ms = load(time_s, settings) * shiver(frame);
        const double lost_periods = lost ? lost(time_s, gpu_ms) : 0.0;
        // Twice a dominant eye that is going to be moved is a little more than what both take.
        GovernedSettings in_full = settings;
        in_full.mode = Mode::kShared;
        const double lossless_ms = tells_of_both && settings.mode != Mode::kShared ? 1.06 * load(time_s, in_full) * shiver(frame) : 0.0;
        governor.measure({gpu_ms, period_ms, false, lost_periods, lossless_ms});
        run.frames.push_back({time_s, gpu_ms, period_ms, settings, governor.isBeaten(), governor.sentence(), lost_periods});
        time_s += 1e-3 * period_ms * (1.0 + lost_periods);
    }
    return run;
}

// Times at which a load changes: 60 frames after each it has settled, and from then on changes at most once a second. Steps that were
// tried, and taken back at once, count as one change: there are so many at most.
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
    CHECK(run.last().settings == kWish);
    CHECK(run.last().sentence.empty());
}

TEST_CASE("where everything fits, nothing is lost and nothing changes") {
    const Run run = govern(Quality::kBalanced, 20.0, [](double, const GovernedSettings& s) { return cost(6.0, 0.8, s); });
    CHECK(run.changes().empty());
    CHECK(run.last().settings == GovernedSettings{Mode::kShared, 0.22, 1.0});
    CHECK(run.last().sentence.find("shared at 100 %: 6.") == 0);
}

TEST_CASE("of a load that does not change it finds what fits within 60 frames, and stays there") {
    for (const Quality quality : {Quality::kSharp, Quality::kBalanced, Quality::kFast}) {
        for (const double lossy : {0.7, 0.8, 0.9}) {
            for (const double ms : {9.5, 10.5, 11.0, 12.0, 13.0, 15.0}) {
                CAPTURE(static_cast<int>(quality));
                CAPTURE(lossy);
                CAPTURE(ms);
                const Run run = govern(quality, 60.0, [&](double, const GovernedSettings& s) { return cost(ms, lossy, s); });
                checkCalm(run, {0.0});
                if (!run.last().beaten) { CHECK(run.longestOver() <= 10); }
                CHECK(changesAfter(run, 30.0) <= 2);
                CHECK(changesAfter(run, 50.0) <= 1);
            }
        }
    }
}

TEST_CASE("a tenth of the period is spared") {
    for (const double ms : {10.5, 12.0, 14.0, 18.0}) {
        CAPTURE(ms);
        const Run run = govern(Quality::kFast, 20.0, [&](double, const GovernedSettings& s) { return cost(ms, 0.8, s); });
        std::vector<double> last;
        for (std::size_t i = run.frames.size() - 300; i < run.frames.size(); ++i) { last.push_back(run.frames[i].gpu_ms); }
        std::nth_element(last.begin(), last.begin() + 150, last.end());
        CHECK(last[150] <= 0.9 * kPeriodMs * 1.01);
        CHECK(last[150] >= 0.6 * kPeriodMs);  // and no more is given up than must be
    }
}

TEST_CASE("a load that comes and goes: quality is given up at once and given back when there is room") {
    const auto ms = [](double t) { return t < 5.0 ? 7.0 : t < 20.0 ? 16.0 : 7.0; };
    const Run run = govern(Quality::kFast, 60.0, [&](double t, const GovernedSettings& s) { return cost(ms(t), 0.8, s); });
    CHECK(run.longestOver() <= 10);
    checkCalm(run, {5.0});
    CHECK(run.frames[400].settings == GovernedSettings{Mode::kShared, 0.22, 1.0});
    const auto at = [&](double time_s) {
        return *std::find_if(run.frames.begin(), run.frames.end(), [&](const auto& frame) { return frame.time_s >= time_s; });
    };
    CHECK(at(15.0).settings.resolution_scale < 1.0);
    CHECK(run.last().settings == GovernedSettings{Mode::kShared, 0.22, 1.0});
    CHECK(at(6.0).sentence.find("took 16.") != std::string::npos);
    CHECK(changesAfter(run, 40.0) == 0);
}

TEST_CASE("a lossy method that is slower than what loses nothing is found out in one trial, and not tried again soon") {
    const Run run = govern(Quality::kFast, 40.0, [](double, const GovernedSettings& s) { return cost(14.0, 1.15, s); });
    checkCalm(run, {0.0});
    CHECK(run.longestOver() <= 10);
    CHECK(run.last().settings.mode == Mode::kShared);
    std::size_t lossy = 0;
    for (const Run::Frame& frame : run.frames) { lossy += frame.settings.mode == Mode::kShared ? 0 : 1; }
    CHECK(lossy < run.frames.size() / 8);
}

TEST_CASE("a lossy method that does not fit at all is found out in one trial as well") {
    for (const double lossy : {2.2, 3.0}) {
        CAPTURE(lossy);
        const Run run = govern(Quality::kFast, 40.0, [&](double, const GovernedSettings& s) { return cost(14.0, lossy, s); });
        checkCalm(run, {0.0}, 2);
        CHECK(run.longestOver() <= 4);
        // And all is as before.
        CHECK(run.last().settings == run.at(1.0).settings);
        CHECK(run.last().settings.mode == Mode::kShared);
        std::size_t trials = 0;
        for (const std::size_t i : run.changes()) { trials += run.frames[i].settings.mode == Mode::kShared ? 0 : 1; }
        CHECK(trials <= 2);
    }
}

TEST_CASE("a lossy method that becomes slower than what loses nothing is left") {
    const auto lossy = [](double t) { return t < 15.0 ? 0.7 : 1.4; };
    const Run run = govern(Quality::kFast, 60.0, [&](double t, const GovernedSettings& s) { return cost(12.5, lossy(t), s); });
    CHECK(run.frames[1200].settings.mode == Mode::kPredicted);
    CHECK(run.longestOver() <= 10);
    checkCalm(run, {0.0, 15.0});
    CHECK(run.last().settings.mode == Mode::kShared);
}

// Frames in a lossy method while what loses nothing would be faster.
std::size_t countInVain(const Run& run, const Load& load) {
    return static_cast<std::size_t>(std::ranges::count_if(run.frames, [&](const Run::Frame& frame) {
        GovernedSettings in_full = frame.settings;
        in_full.mode = Mode::kShared;
        return frame.settings.mode != Mode::kShared && load(frame.time_s, frame.settings) > load(frame.time_s, in_full);
    }));
}

TEST_CASE("a lossy method is also left where it still fits but what loses nothing has become faster") {
    for (const auto& [shared_ms, lossy] : {std::pair(7.5, 8.6 / 7.5), std::pair(9.0, 9.4 / 9.0)}) {
        CAPTURE(shared_ms);
        const Load load = [&](double t, const GovernedSettings& s) { return t < 20.0 ? cost(13.5, 0.67, s) : cost(shared_ms, lossy, s); };
        const Run run = govern(Quality::kBalanced, 120.0, load);
        checkCalm(run, {0.0, 20.0});
        CHECK(run.at(19.9).settings.mode == Mode::kPredicted);
        CHECK(run.at(22.0).settings.mode == Mode::kShared);
        CHECK(run.last().settings == GovernedSettings{Mode::kShared, 0.22, 1.0});
        CHECK(run.longestOver(50) == 0);
        CHECK(countInVain(run, load) <= 90);
    }
}

TEST_CASE("what a lossy method saves is followed while it is in use, so that it is not left where it saves more") {
    const Load load = [](double t, const GovernedSettings& s) { return t < 20.0 ? cost(13.5, 0.75, s) : cost(18.0, 0.5, s); };
    const Run run = govern(Quality::kBalanced, 60.0, load);
    CHECK(countInVain(run, load) == 0);
    for (const Run::Frame& frame : run.frames) {
        if (frame.time_s > 10.0) { CHECK(frame.settings.mode == Mode::kPredicted); }
    }
}

TEST_CASE("another scene is measured anew") {
    Governor governor;
    governor.wish(Quality::kBalanced, kWish);
    const auto run = [&](double ms, double lossy) {
        for (std::size_t frame = 0; frame < 900; ++frame) {
            governor.measure({.gpu_ms = cost(ms, lossy, governor.settings()) * shiver(frame), .period_ms = kPeriodMs});
        }
    };
    run(13.5, 0.67);
    CHECK(governor.settings().mode == Mode::kPredicted);
    governor.forget();
    CHECK(governor.settings() == GovernedSettings{Mode::kShared, 0.22, 1.0});
    CHECK(governor.sentence().empty());
    run(7.5, 8.6 / 7.5);
    CHECK(governor.settings() == GovernedSettings{Mode::kShared, 0.22, 1.0});
}

TEST_CASE("what the wearer chose that loses nothing is not replaced by what does") {
    for (const Mode mode : {Mode::kShared, Mode::kTwoPass, Mode::kMono}) {
        const GovernedSettings wish{mode, 0.22, 1.2};
        const Run run = govern(
            Quality::kFast, 20.0,
            [](double, const GovernedSettings& s) {
                return cost(20.0, 1.0, {Mode::kShared, 0, s.resolution_scale});
            },
            {}, wish);
        for (const Run::Frame& frame : run.frames) { CHECK(frame.settings.mode == mode); }
        CHECK(run.last().settings.resolution_scale < 1.0);
    }
}

TEST_CASE("another period is another budget") {
    const auto period = [](double t) { return t < 8.0 ? 1000.0 / 72.0 : t < 20.0 ? 1000.0 / 120.0 : 1000.0 / 72.0; };
    const Run run = govern(
        Quality::kFast, 60.0, [](double, const GovernedSettings& s) { return cost(11.0, 0.8, s); }, period);
    checkCalm(run, {8.0});
    CHECK(run.longestOver() <= 10);
    CHECK(run.frames[500].settings == GovernedSettings{Mode::kShared, 0.22, 1.0});
    CHECK(run.last().settings == GovernedSettings{Mode::kShared, 0.22, 1.0});
}

TEST_CASE("a minute in which the load and the period change") {
    const auto ms = [](double t) { return t < 8.0 ? 7.0 : t < 20.0 ? 16.0 : t < 34.0 ? 7.0 : t < 46.0 ? 13.0 : 8.5; };
    const auto period = [](double t) { return t < 28.0 ? 1000.0 / 90.0 : t < 46.0 ? 1000.0 / 72.0 : 1000.0 / 120.0; };
    const Run run = govern(
        Quality::kFast, 60.0, [&](double t, const GovernedSettings& s) { return cost(ms(t), 0.75, s); }, period);
    checkCalm(run, {0.0, 8.0, 20.0, 28.0, 34.0, 46.0});
    CHECK(run.longestOver() <= 10);
    for (const Run::Frame& frame : run.frames) { CHECK_FALSE(frame.beaten); }
    // A dozen is what six upheavals need; a governor that swings between two methods needs one a second.
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

TEST_CASE("a single slow frame, or every tenth, changes nothing") {
    std::size_t frame = 0;
    const Run run =
        govern(Quality::kBalanced, 20.0, [&](double, const GovernedSettings& s) { return ++frame % 10 == 0 ? 25.0 : cost(7.0, 0.8, s); });
    CHECK(run.changes().empty());
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
                quality, 40.0, [](double, const GovernedSettings& s) { return cost(7.0, 0.8, s); }, {}, kWish,
                [&](double t, double gpu_ms) { return lostBy(gpu_ms, t < 5.0 ? 0.0 : others_ms, kPeriodMs); });
            CHECK(run.at(4.9).settings == GovernedSettings{Mode::kShared, 0.22, 1.0});
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
        Quality::kFast, 60.0, [](double, const GovernedSettings& s) { return cost(7.0, 0.8, s); }, {}, kWish,
        [](double t, double gpu_ms) { return lostBy(gpu_ms, t > 5.0 && t < 20.0 ? 6.0 : 0.0, kPeriodMs); });
    checkCalm(run, {5.0}, 2);
    CHECK(run.longestLate() <= 10);
    CHECK(run.at(19.0).settings.resolution_scale < 1.0);
    CHECK(run.last().settings == GovernedSettings{Mode::kShared, 0.22, 1.0});
}

TEST_CASE("where displays are missed whatever is drawn nothing is given up for it but for a moment, and a message says so") {
    const Run run = govern(
        Quality::kFast, 200.0, [](double, const GovernedSettings& s) { return cost(7.0, 0.8, s); }, {}, kWish,
        [](double, double gpu_ms) { return lostBy(gpu_ms, 12.0, kPeriodMs); });
    const GovernedSettings all{Mode::kShared, 0.22, 1.0};
    CHECK(run.frames[10].settings.resolution_scale < 1.0);
    CHECK(run.frames[40].settings == all);
    CHECK(run.frames[40].sentence.find("displays are missed whatever is drawn") != std::string::npos);
    // It is looked at again after a minute, and after two.
    CHECK(run.last().settings == all);
    CHECK_FALSE(run.last().beaten);
    const auto lowered = std::ranges::count_if(run.frames, [&](const Run::Frame& frame) { return frame.settings != all; });
    CHECK(lowered > 20);
    CHECK(lowered < 100);
    CHECK(changesAfter(run, 1.0) <= 6);
}

TEST_CASE("where not even the least settings meet every display, but more of them than the best, it says so and stays with them") {
    const Run run = govern(
        Quality::kFast, 20.0, [](double, const GovernedSettings& s) { return cost(7.0, 0.8, s); }, {}, kWish,
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
        Quality::kFast, 30.0, [](double, const GovernedSettings& s) { return cost(7.0, 0.8, s); }, {}, kWish,
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
        governor.wish(Quality::kFast, wish);
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
        Quality::kFast, 10.0, [](double, const GovernedSettings& s) { return cost(7.0, 0.8, s); }, {}, kWish,
        [&](double, double) { return ++frame == 50 ? 6.0
                                     : frame > 50  ? 1.0
                                                   : 0.0; });
    CHECK(run.last().settings.resolution_scale == 1.0);
    CHECK(run.last().sentence.find("whatever is drawn") != std::string::npos);
}

TEST_CASE("misses that were others' doing and are over count again, and are no longer spoken of") {
    // First whatever is drawn, then none, then what the device is too slow for without saying it.
    const Run run = govern(
        Quality::kFast, 20.0, [](double, const GovernedSettings& s) { return cost(7.0, 0.8, s); }, {}, kWish,
        [](double t, double gpu_ms) { return t < 5.0   ? lostBy(gpu_ms, 12.0, kPeriodMs)
                                             : t < 7.0 ? 0.0
                                                       : lostBy(gpu_ms, 6.0, kPeriodMs); });
    CHECK(run.at(4.9).sentence.find("whatever is drawn") != std::string::npos);
    CHECK(run.at(6.9).sentence.find("whatever is drawn") == std::string::npos);
    CHECK(run.at(6.9).settings.resolution_scale == 1.0);
    CHECK(run.at(9.0).settings.resolution_scale < 1.0);
    CHECK(run.at(9.0).lost_periods == 0.0);
}

TEST_CASE("frames that come late now and then, or early for each that is late, change nothing") {
    const auto fits = [](double, const GovernedSettings& s) { return cost(7.0, 0.8, s); };
    std::size_t frame = 0;
    const auto hiccups = [&](double, double) { return ++frame % 10 == 0 ? 5.0 : 0.0; };
    CHECK(govern(Quality::kFast, 20.0, fits, {}, kWish, hiccups).changes().empty());
    const auto irregular = [&](double, double) { return (++frame / 3) % 2 == 0 ? 0.3 : -0.3; };
    CHECK(govern(Quality::kFast, 20.0, fits, {}, kWish, irregular).changes().empty());
    const auto alternating = [&](double, double) { return ++frame % 2 == 0 ? 0.9 : -0.9; };
    CHECK(govern(Quality::kFast, 20.0, fits, {}, kWish, alternating).changes().empty());
}

TEST_CASE("without times nothing is chosen, and a message says so") {
    const Run run = govern(Quality::kFast, 2.0, [](double, const GovernedSettings&) { return 0.0; });
    CHECK(run.changes().empty());
    CHECK(run.last().sentence.find("does not say") != std::string::npos);
}
