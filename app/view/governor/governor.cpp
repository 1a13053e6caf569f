// Chooses the settings that fit.
#include "app/view/governor/governor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace binosplat {

namespace {

// A tenth of the period is left free, since we cannot know what else the compositor and the machine are
// doing. Settings that are still unproven, and changes without need, must take even less; so must a change
// after one that was not enough.
constexpr double kTarget = 0.9, kCalmly = 0.85, kAgain = 0.8;  // kAgain: times as much for each
// A smaller rise in the budget is not worth a change; if a smaller share of it is spent, it does not
// determine the frame time.
constexpr double kLeastRise = 1.1, kSpent = 0.75;
// Pixels are not all of a frame's cost: fewer of them save less than their share, more are assumed to cost
// all of it.
constexpr double kPowerDown = 1.2, kPowerUp = 2.0;
constexpr int kSettlingFrames = 1;
constexpr std::size_t kOverAtOnce = 3, kOverAgain = 2, kCalmFrames = 8;
constexpr std::size_t kWindow = MissedDisplays::kWindow, kOftenOver = MissedDisplays::kOftenOver,
                      kOftenOf = MissedDisplays::kOftenOf;
// As many frames as there are in half a second, if these are fewer than kWindow.
constexpr std::size_t kFewestFrames = 12;
constexpr double kWindowSeconds = 0.5;
constexpr double kBetweenChangesSeconds = 1.0, kProvenSeconds = 3.0, kFirstWaitSeconds = 10.0,
                 kLongestWaitSeconds = 300.0;
// If the lowest settings miss as many displays as the best ones did, something else causes the misses. Pacing
// may take some frames to react to frame times.
constexpr std::size_t kBlameFrames = 20;
constexpr const char* kOthersMiss = "displays are missed whatever is drawn";
constexpr double kSameLost = 0.25;

// By what factor a step must improve the picture, in terms of its squared error.
constexpr double kBetter = 0.8, kMoreDb = 2.0;
// For a picture that is this much better, frames may use nearly all of their time.
constexpr double kMuchBetter = 0.5, kBoldly = 0.89;

struct Limits {
    double budget, scale;  // the lowest
    double bound_db;       // the highest
};

Limits limitsOf(Quality quality) {
    return quality == Quality::kSharp      ? Limits{0.2, 0.8, 34.0}
           : quality == Quality::kBalanced ? Limits{0.1, 0.6, 30.0}
                                           : Limits{0.05, 0.4, 27.0};
}

// The cost of a frame regardless of the budget, in units of the cost of all work: by docs/results/motion.md
// `temporal` takes 0.22 of `two-pass` for culling, sorting and warping, and 0.28 for 0.21 of the work;
// `predicted` the dominant eye and the reprojection.
double fixedWork(Mode mode) { return mode == Mode::kTemporal ? 0.17 : 1.0; }
// The share of fixedWork that is assumed when raising.
constexpr double kFixedUpwards = 0.5;

double medianOf(const std::deque<double>& values, std::size_t newest) {
    const std::size_t count = std::min(newest, values.size());
    std::vector<double> last(values.end() - static_cast<std::ptrdiff_t>(count), values.end());
    const auto middle = last.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(last.begin(), middle, last.end());
    return *middle;
}

void keep(std::deque<double>& recent, double value) {
    recent.push_back(value);
    if (recent.size() > kWindow) { recent.pop_front(); }
}

// Rounded to as many digits as are shown.
double inHundredths(double value) { return std::floor(100.0 * value + 1e-6) / 100.0; }

std::string percent(double share) { return fmt::format("{:.0f} %", 100.0 * share); }

}  // namespace

void Governor::wish(Quality quality, Mode mode, const GovernedSettings& own) {
    if (quality == quality_ && mode == mode_ && own == own_) { return; }
    quality_ = quality;
    mode_ = mode;
    own_ = own;
    forget();
}

double leastScale(Quality quality) { return limitsOf(quality).scale; }

void Governor::forget() {
    settings_ = own_;
    if (turnsKnobs()) {
        settings_.error_bound_db = limitsOf(quality_).bound_db;
        // A lower one would leave tiles under the bound, without the model's knowledge.
        settings_.budget = 1.0;
    }
    model_.forget();
    clearRecent();
    settling_ = kSettlingFrames;
    downs_ = 0;
    changed_s_ = lowered_s_ = now_s_;
    is_raised_ = false;
    wait_s_ = 0.0;
    beaten_ = false;
    misses_.forget();
    before_misses_.reset();
    why_.clear();
    sentence_.clear();
}

void Governor::clearRecent() {
    recent_ms_.clear();
    recent_work_.clear();
    misses_.clearRecent();
}

std::size_t Governor::countOver(std::size_t of_last) const {
    const std::size_t count = std::min(of_last, recent_ms_.size());
    return static_cast<std::size_t>(std::count_if(recent_ms_.end() - static_cast<std::ptrdiff_t>(count),
                                                  recent_ms_.end(),
                                                  [&](double ms) { return ms > period_ms_; }));
}

bool Governor::missesWhateverIsDrawn() const {
    return beaten_ && before_misses_ && before_misses_->settings != settings_ &&
           misses_.framesSeen() >= kBlameFrames &&
           misses_.usuallyLost(MissedDisplays::kOftenOf) >= before_misses_->lost - kSameLost;
}

void Governor::leaveMissesAlone() {
    misses_.leaveAlone();
    beaten_ = false;
    downs_ = 0;
    step(std::exchange(before_misses_, std::nullopt)->settings, kOthersMiss);
}

double Governor::scaleFor(double ratio) const {
    const double tenths_now = std::round(10.0 * settings_.resolution_scale / own_.resolution_scale);
    const double tenths =
        std::floor(tenths_now * std::pow(ratio, 1.0 / (ratio < 1.0 ? kPowerDown : kPowerUp)) + 1e-6);
    return governedScale(own_.resolution_scale, std::clamp(tenths, 10.0 * limitsOf(quality_).scale, 10.0));
}

KnobLimits Governor::knobLimits() const {
    const Limits limits = limitsOf(quality_);
    return {limits.scale, own_.resolution_scale, limits.bound_db};
}

GovernedSettings Governor::with(const Knobs& knobs) const {
    return {settings_.budget, knobs.scale, knobs.bound_db};
}

GovernedSettings Governor::bestWithin(double most_ms) const {
    return with(model_.best(most_ms, knobLimits()));
}

bool Governor::isBetter(const GovernedSettings& to) const {
    const double enough_db = std::min(settings_.error_bound_db + kMoreDb, limitsOf(quality_).bound_db);
    const bool is_more = to != settings_ && to.resolution_scale >= settings_.resolution_scale &&
                         to.error_bound_db >= enough_db;
    return is_more || model_.expectedError({to.resolution_scale, to.error_bound_db}) <
                          kBetter * model_.expectedError(knobs());
}

GovernedSettings Governor::lowered(double ratio, double work, bool as_usual) const {
    if (turnsKnobs() && as_usual) { return with(model_.bestAsUsual(ratio, knobLimits())); }
    if (turnsKnobs()) { return bestWithin(ratio * model_.expectedMs(knobs())); }
    GovernedSettings to = settings_;
    if (hasBudget(mode_)) {
        const double taken = std::min(work, to.budget) + fixedWork(mode_),
                     least = std::min(limitsOf(quality_).budget, to.budget);
        to.budget = std::clamp(inHundredths(taken * ratio - fixedWork(mode_)), least, to.budget);
        ratio *= taken / (std::min(work, to.budget) + fixedWork(mode_));
    }
    if (ratio < 1.0) { to.resolution_scale = scaleFor(ratio); }
    return to;
}

GovernedSettings Governor::raised(double ratio) const {
    GovernedSettings to = settings_;
    if (ratio <= 1.0) { return to; }
    to.resolution_scale = scaleFor(ratio);
    ratio /= std::pow(to.resolution_scale / settings_.resolution_scale, kPowerUp);
    const bool is_spent = hasBudget(mode_) && medianOf(recent_work_, kWindow) >= kSpent * to.budget;
    if (!is_spent || to.resolution_scale < own_.resolution_scale) { return to; }
    const double fixed = kFixedUpwards * fixedWork(mode_);
    const double budget = std::clamp(inHundredths((to.budget + fixed) * ratio - fixed), to.budget, 1.0);
    if (budget == 1.0 || budget >= kLeastRise * to.budget) { to.budget = budget; }
    return to;
}

void Governor::measure(const GovernedFrame& frame) {
    const double seconds = 1e-3 * frame.period_ms * (1.0 + std::max(frame.lost_periods, 0.0));
    now_s_ += seconds;
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
    keep(recent_ms_, frame.gpu_ms);
    keep(recent_work_, frame.work);
    if (turnsKnobs()) {
        model_.add(knobs(),
                   {frame.gpu_ms, seconds, frame.work, frame.warp_error, frame.half_loss, frame.is_full});
    }
    misses_.add(frame.lost_periods, now_s_);
    if (!misses_.areLeftAlone() && why_ == kOthersMiss) { why_.clear(); }

    const std::size_t at_once = downs_ > 0 ? kOverAgain : kOverAtOnce;
    const bool takes_too_long =
        countOver(at_once) == at_once || (recent_ms_.size() >= kOftenOf && countOver(kOftenOf) >= kOftenOver);
    const bool is_over = takes_too_long || (!misses_.areLeftAlone() && misses_.come(at_once));
    const double now_ms = medianOf(recent_ms_, is_over ? at_once : kWindow);
    if (!is_over) { return giveBack(now_ms); }
    if (!takes_too_long) {
        if (!before_misses_) {
            before_misses_ = {settings_,
                              misses_.usuallyLost(misses_.comeAtOnce(at_once) ? kOverAtOnce : kOftenOf)};
        }
        misses_.lowerShare(now_ms, period_ms_);
    }
    misses_.hold();
    makeItFit(now_ms, at_once, takes_too_long);
    if (!takes_too_long && missesWhateverIsDrawn()) { leaveMissesAlone(); }
}

void Governor::makeItFit(double now_ms, std::size_t frames, bool takes_too_long) {
    // If something else causes the missed displays, no step is enough; the lowest settings soon show that.
    const bool is_least = downs_ >= 2 && !takes_too_long;
    const double most_ms = is_least ? 0.0 : kTarget * std::pow(kAgain, downs_) * roomMs();
    const double work = medianOf(recent_work_, frames);
    const GovernedSettings to = lowered(std::min(most_ms / now_ms, 1.0), work, downs_ == 1);
    beaten_ = to == settings_;
    if (beaten_) { return describe(now_ms, "not even that fits"); }
    ++downs_;
    stepDown(to, fmt::format("{} took {:.1f} of {:.1f} ms{}", describeSettings(), now_ms, period_ms_,
                             now_ms > period_ms_ ? "" : " and missed displays"));
}

void Governor::giveBack(double now_ms) {
    beaten_ = false;
    misses_.raiseShare(period_ms_);
    if (recent_ms_.size() >= kCalmFrames) { downs_ = 0; }
    if (recent_ms_.size() >= kBlameFrames) { before_misses_.reset(); }
    if (is_raised_ && now_s_ - changed_s_ >= wait_s_ + kProvenSeconds) { wait_s_ = 0.0; }
    const auto enough = static_cast<std::size_t>(
        std::clamp(std::round(1e3 * kWindowSeconds / period_ms_), 1.0 * kFewestFrames, 1.0 * kWindow));
    if (now_s_ - changed_s_ < kBetweenChangesSeconds || recent_ms_.size() < enough) {
        return describe(now_ms, why_);
    }
    const double work = medianOf(recent_work_, kWindow);
    // Within the period, but with less than a tenth to spare.
    if (now_ms > kTarget * period_ms_) {
        const GovernedSettings to = lowered(kCalmly * roomMs() / now_ms, work);
        if (to != settings_) {
            return stepDown(to,
                            fmt::format("{:.1f} of {:.1f} ms left too little to spare", now_ms, period_ms_));
        }
    } else if (now_s_ - lowered_s_ >= wait_s_ && turnsKnobs()) {
        // What is known of higher knobs is about to be corrected.
        if (model_.mayBeChanging()) { return describe(now_ms, why_); }
        const GovernedSettings calm = bestWithin(kCalmly * roomMs()), bold = bestWithin(kBoldly * roomMs());
        const bool is_bold = model_.expectedError({bold.resolution_scale, bold.error_bound_db}) <
                             kMuchBetter * model_.expectedError(knobs());
        if (is_bold || isBetter(calm)) {
            const GovernedSettings& to = is_bold ? bold : calm;
            is_raised_ =
                model_.expectedMs({to.resolution_scale, to.error_bound_db}) > model_.expectedMs(knobs());
            return step(to, fmt::format("better for the same time, {:.1f} of {:.1f} ms", now_ms, period_ms_));
        }
    } else if (now_s_ - lowered_s_ >= wait_s_) {
        // A still head leaves nothing to re-render: once it moves, frames take what the budget allows.
        const double spent_ms = hasBudget(mode_) ? now_ms * (settings_.budget + fixedWork(mode_)) /
                                                       (std::min(work, settings_.budget) + fixedWork(mode_))
                                                 : now_ms;
        const GovernedSettings to = raised(kCalmly * roomMs() / spent_ms);
        if (to != settings_) {
            is_raised_ = true;
            return step(to, fmt::format("there was time to spare, {:.1f} of {:.1f} ms", now_ms, period_ms_));
        }
    }
    describe(now_ms, why_);
}

void Governor::stepDown(const GovernedSettings& to, const std::string& why) {
    // If quality was given back too early, it is given back later the next time.
    if (is_raised_ && now_s_ - changed_s_ < kProvenSeconds) {
        wait_s_ = std::clamp(2.0 * wait_s_, kFirstWaitSeconds, kLongestWaitSeconds);
    }
    is_raised_ = false;
    lowered_s_ = now_s_;
    step(to, why);
}

void Governor::step(const GovernedSettings& to, const std::string& why) {
    settings_ = to;
    clearRecent();
    settling_ = kSettlingFrames;
    changed_s_ = now_s_;
    why_ = why;
    sentence_ = fmt::format("{}; {}", describeSettings(), why);
}

std::string Governor::describeSettings() const {
    std::string text = fmt::format("{} at {}", nameOf(mode_), percent(settings_.resolution_scale));
    if (turnsKnobs()) {
        text += fmt::format(", errors within {:.0f} dB", settings_.error_bound_db);
    } else if (hasBudget(mode_)) {
        text += fmt::format(", {} of {}", percent(settings_.budget),
                            mode_ == Mode::kTemporal ? "both eyes" : "an eye");
    }
    return text;
}

void Governor::describe(double now_ms, const std::string& why) {
    sentence_ = fmt::format("{}: {:.1f} of {:.1f} ms{}{}", describeSettings(), now_ms, period_ms_,
                            why.empty() ? "" : "; ", why);
}

}  // namespace binosplat
