// Choosing what fits.
#include "app/view/governor/governor.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace binosplat {

namespace {

// A tenth of the period is spared: what the compositor and the machine do besides is not ours to know.
constexpr double kTarget = 0.9;
// Settings that have not proven themselves are not to need all of it; after a change that was not enough, less.
constexpr double kUpwards = 0.85, kAgain = 0.7;
// A lossy method that saves less than this is not worth what it loses.
constexpr double kLeastSaving = 0.95;
// The dominant eye takes some hundredths more where its picture is going to be moved: two measurements had 0.98 to 1.08 and 0.97 to 1.03
// (docs/results/README.md, "dominant / mono"). The more is said, the sooner a lossy method is left.
constexpr double kMovedDominant = 1.04;
constexpr double kGuessedRatio = 0.75, kWorstGuess = 1.5;
// Pixels are not all of a frame: fewer of them save less than their share, more of them are taken to cost all of it.
constexpr double kPowerDown = 1.2, kPowerUp = 2.0;
constexpr int kSettlingFrames = 1;
constexpr std::size_t kOverAtOnce = 3, kOverAgain = 2, kTrialFrames = 8;
constexpr std::size_t kWindow = MissedDisplays::kWindow, kOftenOver = MissedDisplays::kOftenOver, kOftenOf = MissedDisplays::kOftenOf;
constexpr double kBetweenChangesSeconds = 1.0, kProvenSeconds = 3.0, kFirstBlockSeconds = 10.0, kLongestBlockSeconds = 300.0;
constexpr double kForgetRatioSeconds = 30.0, kDrift = 0.15;
// Where the least settings miss no fewer displays than the best ones did the misses are others' doing. What paces frames may follow what
// they take only after some.
constexpr std::size_t kBlameFrames = 20;
constexpr const char* kOthersMiss = "displays are missed whatever is drawn";
constexpr double kSameLost = 0.25;
constexpr double kScaleStep = 0.1;

double leastScale(Quality quality) {
    switch (quality) {
        case Quality::kSharp:
            return 0.8;
        case Quality::kBalanced:
            return 0.6;
        default:
            return 0.4;
    }
}

// What a method may be thinned to: shares of the wearer's budget.
std::vector<double> sharesOf(Mode mode, Quality quality) {
    if (mode != Mode::kPredicted) { return {1.0}; }
    return quality == Quality::kSharp ? std::vector{1.0, 0.5} : std::vector{1.0, 0.5, 0.25};
}

double medianOf(const std::deque<double>& values, std::size_t newest) {
    const std::size_t count = std::min(newest, values.size());
    std::vector<double> last(values.end() - static_cast<std::ptrdiff_t>(count), values.end());
    const auto middle = last.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(last.begin(), middle, last.end());
    return *middle;
}

std::string percent(double share) { return fmt::format("{:.0f} %", 100.0 * share); }

}  // namespace

void Governor::wish(Quality quality, const GovernedSettings& best) {
    if (quality == quality_ && best == best_) { return; }
    quality_ = quality;
    best_ = best;
    forget();
}

void Governor::forget() {
    buildLadder();
    current_ = 0;
    clearRecent();
    settling_ = kSettlingFrames;
    downs_ = 0;
    changed_s_ = now_s_;
    left_.reset();
    trial_from_.reset();
    lossless_ms_ = 0.0;
    beaten_ = false;
    misses_.forget();
    before_misses_.reset();
    why_.clear();
    sentence_.clear();
}

void Governor::buildLadder() {
    levels_.clear();
    ratios_ = {{1.0, {}}};
    if (quality_ == Quality::kOff) {
        levels_.push_back({best_, 0});
        return;
    }
    const bool lossy = reprojects(best_.mode);
    const std::vector<double> shares = lossy ? sharesOf(best_.mode, quality_) : std::vector<double>{};
    for (std::size_t i = 0; i < shares.size(); ++i) { ratios_.push_back({kGuessedRatio, {}}); }
    const int steps = static_cast<int>(std::round((1.0 - leastScale(quality_)) / kScaleStep));
    for (int step = 0; step <= steps; ++step) {
        // As many digits as are shown.
        const double scale = std::round(100.0 * best_.resolution_scale * (1.0 - kScaleStep * step)) / 100.0;
        // What loses nothing comes first at each resolution. Methods that the wearer chose for themselves are not replaced by another.
        levels_.push_back({{lossy ? Mode::kShared : best_.mode, best_.budget, scale, best_.foveation_deg}, 0});
        for (std::size_t i = 0; i < shares.size(); ++i) {
            levels_.push_back({{best_.mode, best_.budget * shares[i], scale, best_.foveation_deg}, i + 1});
        }
    }
}

void Governor::clearRecent() {
    recent_ms_.clear();
    misses_.clearRecent();
    recent_ratios_.clear();
}

double Governor::median(std::size_t frames) const { return medianOf(recent_ms_, frames); }

double Governor::ratioByOwnFrames(std::size_t frames) const {
    return recent_ratios_.size() < kTrialFrames ? 0.0 : kMovedDominant * medianOf(recent_ratios_, frames);
}

std::size_t Governor::countOver(std::size_t of_last) const {
    const std::size_t count = std::min(of_last, recent_ms_.size());
    return static_cast<std::size_t>(
        std::count_if(recent_ms_.end() - static_cast<std::ptrdiff_t>(count), recent_ms_.end(), [&](double ms) { return ms > period_ms_; }));
}

bool Governor::missesWhateverIsDrawn() const {
    return beaten_ && before_misses_ && before_misses_->level != current_ && misses_.framesSeen() >= kBlameFrames &&
           misses_.usuallyLost(MissedDisplays::kOftenOf) >= before_misses_->lost - kSameLost;
}

void Governor::leaveMissesAlone() {
    misses_.leaveAlone();
    beaten_ = false;
    downs_ = 0;
    left_.reset();
    const Before before = *std::exchange(before_misses_, std::nullopt);
    current_ = before.level;
    step(current_, before.ms, kOthersMiss);
}

double Governor::expectedMs(std::size_t level, double now_ms) const {
    if (hasTriedInVain() && trial_from_->level == level) { return trial_from_->ms; }
    const Level &to = levels_[level], &from = levels_[current_];
    const double scale = to.settings.resolution_scale / from.settings.resolution_scale;
    return now_ms * ratios_[to.method].value / ratios_[from.method].value * std::pow(scale, scale < 1.0 ? kPowerDown : kPowerUp);
}

bool Governor::pays(std::size_t method) const {
    return method == 0 || (ratios_[method].measured_s && ratios_[method].value <= kLeastSaving);
}

std::size_t Governor::bestWithin(double most_ms, double now_ms) const {
    std::size_t cheapest = levels_.size();
    for (std::size_t i = 0; i < levels_.size(); ++i) {
        const Level& level = levels_[i];
        if (!pays(level.method)) { continue; }
        const double ms = expectedMs(i, now_ms);
        if (ms <= most_ms && now_s_ >= level.blocked_s) { return i; }
        if (cheapest == levels_.size() || ms < expectedMs(cheapest, now_ms)) { cheapest = i; }
    }
    return cheapest;
}

// Ratios of methods follow from what the lossless one took last and what the current one takes now.
void Governor::learn(double now_ms, bool is_over) {
    const Level& level = levels_[current_];
    const double full_ms = now_ms / std::pow(level.settings.resolution_scale / best_.resolution_scale, kPowerDown);
    if (level.method == 0) {
        lossless_ms_ = full_ms;
        // A method that was found slow may have become faster, as the view changes.
        for (std::size_t m = 1; m < ratios_.size(); ++m) {
            Ratio& ratio = ratios_[m];
            const bool is_old = ratio.measured_s && now_s_ - *ratio.measured_s > ratio.forget_s;
            if (is_old && ratio.value > kLeastSaving) { ratio = {kGuessedRatio, {}, 0.0, ratio.forget_s}; }
        }
        return;
    }
    Ratio& ratio = ratios_[level.method];
    const double by_own_frames = ratioByOwnFrames(is_over ? kOverAtOnce : kWindow);
    const bool follows = ratio.measured_s.has_value();
    // A trial that is over the period has said enough. What a method saves changes with the view: its own frames tell, if any do.
    if (follows ? by_own_frames <= 0.0 : lossless_ms_ <= 0.0 || (!is_over && recent_ms_.size() < kTrialFrames)) { return; }
    const double value = by_own_frames > 0.0 ? by_own_frames : full_ms / lossless_ms_;
    if (follows) {
        lossless_ms_ = full_ms / value;
        // The others move their pixels as well.
        for (std::size_t m = 1; m < ratios_.size(); ++m) {
            if (ratios_[m].measured_s && m != level.method) { ratios_[m].value *= value / ratio.value; }
        }
    } else {
        ratio.forget_s = std::min(std::max(2.0 * ratio.forget_s, kForgetRatioSeconds), kLongestBlockSeconds);
    }
    ratio.value = value;
    ratio.measured_s = now_s_;
    ratio.own_ms = full_ms;
}

void Governor::takeBack() {
    if (!left_ || now_s_ - changed_s_ >= kProvenSeconds) { return; }
    Level& failed = levels_[current_];
    failed.block_length_s = std::min(std::max(2.0 * failed.block_length_s, kFirstBlockSeconds), kLongestBlockSeconds);
    failed.blocked_s = now_s_ + failed.block_length_s;
}

std::optional<std::size_t> Governor::worthTrying(double now_ms) const {
    for (std::size_t m = 1; m < ratios_.size(); ++m) {
        // A smaller share of the work is looked at once a larger one has paid.
        if (ratios_[m].measured_s || (m > 1 && !pays(m - 1))) { continue; }
        const auto isBetter = [&](std::size_t i) { return levels_[i].method == m && expectedMs(i, now_ms) <= kUpwards * roomMs(); };
        std::size_t promised = 0;
        while (promised < current_ && !isBetter(promised)) { ++promised; }
        if (promised == current_) { continue; }
        for (std::size_t i = promised; i < levels_.size(); ++i) {
            const bool is_higher = levels_[i].settings.resolution_scale > settings().resolution_scale;
            if (levels_[i].method != m || is_higher) { continue; }
            // Should it be as slow as that, it still does no harm.
            if (expectedMs(i, now_ms) / ratios_[m].value * ratios_[levels_[current_].method].value * kWorstGuess <= roomMs()) { return i; }
        }
    }
    return std::nullopt;
}

void Governor::measure(const GovernedFrame& frame) {
    now_s_ += 1e-3 * frame.period_ms * (1.0 + std::max(frame.lost_periods, 0.0));
    period_ms_ = frame.period_ms;
    if (quality_ == Quality::kOff || frame.is_old) { return; }
    if (frame.gpu_ms <= 0.0) {
        sentence_ = "the device does not say how long frames take";
        return;
    }
    if (settling_ > 0) {
        --settling_;
        return;
    }
    recent_ms_.push_back(frame.gpu_ms);
    if (recent_ms_.size() > kWindow) { recent_ms_.pop_front(); }
    misses_.add(frame.lost_periods, now_s_);
    if (!misses_.areLeftAlone() && why_ == kOthersMiss) { why_.clear(); }
    if (frame.lossless_ms > 0.0) { recent_ratios_.push_back(frame.gpu_ms / frame.lossless_ms); }
    if (recent_ratios_.size() > kWindow) { recent_ratios_.pop_front(); }

    const std::size_t at_once = downs_ > 0 ? kOverAgain : kOverAtOnce;
    const bool takes_too_long = countOver(at_once) == at_once || (recent_ms_.size() >= kOftenOf && countOver(kOftenOf) >= kOftenOver);
    const bool is_over = takes_too_long || (!misses_.areLeftAlone() && misses_.come(at_once));
    const double now_ms = median(is_over ? at_once : kWindow);
    learn(now_ms, is_over);
    if (is_over) {
        if (!takes_too_long) {
            if (!before_misses_) {
                before_misses_ = {current_, now_ms, misses_.usuallyLost(misses_.comeAtOnce(at_once) ? kOverAtOnce : kOftenOf)};
            }
            misses_.lowerShare(now_ms, period_ms_);
        }
        misses_.hold();
        makeItFit(now_ms);
        if (!takes_too_long && missesWhateverIsDrawn()) { leaveMissesAlone(); }
    } else {
        giveBack(now_ms);
    }
}

void Governor::makeItFit(double now_ms) {
    const Level& level = levels_[current_];
    takeBack();
    // What a lossy method saves is no longer known once its cost has changed: what loses nothing is asked first.
    if (level.method != 0 && ratios_[level.method].measured_s) {
        const double before_ms = ratios_[level.method].own_ms;
        const double full_ms = now_ms / std::pow(level.settings.resolution_scale / best_.resolution_scale, kPowerDown);
        if (std::abs(full_ms - before_ms) > kDrift * before_ms && full_ms > lossless_ms_) { ratios_[level.method].value = 1.0; }
    }
    std::size_t next = awayFrom((downs_ == 0 ? kTarget : kAgain) * roomMs(), now_ms);
    if (downs_ >= 2) {
        next = current_;
        for (std::size_t i = 0; i < levels_.size(); ++i) {
            if (pays(levels_[i].method) && expectedMs(i, now_ms) < expectedMs(next, now_ms)) { next = i; }
        }
    }
    beaten_ = next == current_ || expectedMs(next, now_ms) >= now_ms;
    if (beaten_) {
        describe(now_ms, "not even that fits");
        return;
    }
    ++downs_;
    left_.reset();
    step(next, now_ms,
         fmt::format("{} at {} took {:.1f} of {:.1f} ms{}", nameOf(level.settings.mode), percent(level.settings.resolution_scale), now_ms,
                     period_ms_, now_ms > period_ms_ ? "" : " and missed displays"));
}

std::size_t Governor::awayFrom(double most_ms, double now_ms) const {
    return hasTriedInVain() ? trial_from_->level : bestWithin(most_ms, now_ms);
}

void Governor::giveBack(double now_ms) {
    const Level& level = levels_[current_];
    beaten_ = false;
    misses_.raiseShare(period_ms_);
    if (recent_ms_.size() >= kTrialFrames) { downs_ = 0; }
    if (recent_ms_.size() >= kBlameFrames) { before_misses_.reset(); }
    const bool is_calm = now_s_ - changed_s_ >= kBetweenChangesSeconds;
    // A lossy method that turned out slower than what loses nothing is left, over the period or not.
    if (is_calm && level.method != 0 && ratios_[level.method].measured_s && ratios_[level.method].value > kLeastSaving) {
        const std::string why = fmt::format("{} saves nothing here", nameOf(level.settings.mode));
        left_.reset();
        step(awayFrom(kTarget * roomMs(), now_ms), now_ms, why);
        return;
    }
    if (is_calm && recent_ms_.size() >= kWindow) {
        const std::size_t next = bestWithin(kUpwards * roomMs(), now_ms);
        if (next < current_) {
            left_ = current_;
            step(next, now_ms, fmt::format("there was room, {:.1f} of {:.1f} ms", now_ms, period_ms_));
            return;
        }
        // Under the period, but with less to spare than a tenth.
        if (now_ms > kTarget * period_ms_ && next != current_) {
            takeBack();
            left_.reset();
            step(next, now_ms, fmt::format("{:.1f} of {:.1f} ms left too little room", now_ms, period_ms_));
            return;
        }
        if (const auto trial = worthTrying(now_ms)) {
            left_.reset();
            const TrialFrom from{current_, now_ms};
            step(*trial, now_ms, "to see what it takes");
            trial_from_ = from;
            return;
        }
    }
    describe(now_ms, why_);
}

void Governor::step(std::size_t level, double now_ms, const std::string& why) {
    const double expected_ms = expectedMs(level, now_ms);
    trial_from_.reset();
    current_ = level;
    clearRecent();
    settling_ = kSettlingFrames;
    changed_s_ = now_s_;
    why_ = why;
    describe(expected_ms, why);
}

void Governor::describe(double now_ms, const std::string& why) {
    const GovernedSettings& now = settings();
    std::string what = fmt::format("{} at {}", nameOf(now.mode), percent(now.resolution_scale));
    if (now.mode == Mode::kPredicted) { what += fmt::format(", {} of an eye", percent(now.budget)); }
    sentence_ = fmt::format("{}: {:.1f} of {:.1f} ms{}{}", what, now_ms, period_ms_, why.empty() ? "" : "; ", why);
}

}  // namespace binosplat
