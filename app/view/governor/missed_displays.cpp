// Counts missed displays, and the share of time that they leave.
#include "app/view/governor/missed_displays.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace binosplat {

namespace {

// A single late frame may have any cause, however late it is: it counts as one period. If periods are
// irregular, early frames make up for late ones, so that the sum stays below one.
constexpr double kMostLostByOne = 1.0, kLostSlack = 0.5;
// If displays are missed, there is less time than was used; after a while without a miss, the share grows
// each second.
constexpr double kLowerShare = 0.85, kRaisedPerSecond = 1.1, kFirstHoldSeconds = 10.0,
                 kLongestHoldSeconds = 300.0;
constexpr double kFirstUnheededSeconds = 60.0, kLongestUnheededSeconds = 600.0;

}  // namespace

void MissedDisplays::forget() {
    clearRecent();
    share_ = 1.0;
    held_until_s_ = hold_s_ = 0.0;
    is_raised_ = false;
    heeds_from_s_ = unheeded_s_ = 0.0;
}

void MissedDisplays::add(double lost_periods, double now_s) {
    now_s_ = now_s;
    recent_.push_back(lost_periods);
    if (recent_.size() > kWindow) { recent_.pop_front(); }
    if (lost_periods > kLostSlack) { missed_s_ = now_s; }
    if (unheeded_s_ > 0.0 && now_s - missed_s_ > unheeded_s_) { unheeded_s_ = 0.0; }
    const bool is_over = recent_.size() == kWindow && lostIn(kWindow) < kLostSlack;
    if (areLeftAlone() && is_over) { heeds_from_s_ = now_s; }
}

double MissedDisplays::lostIn(std::size_t last) const {
    const auto count = static_cast<std::ptrdiff_t>(std::min(last, recent_.size()));
    return std::accumulate(recent_.end() - count, recent_.end(), 0.0,
                           [](double sum, double lost) { return sum + std::min(lost, kMostLostByOne); });
}

double MissedDisplays::usuallyLost(std::size_t last) const {
    const auto count = static_cast<std::ptrdiff_t>(std::min(last, recent_.size()));
    std::vector<double> sorted(recent_.end() - count, recent_.end());
    std::ranges::sort(sorted);
    const auto usual = static_cast<std::ptrdiff_t>(sorted.size() - sorted.size() / 3);
    return std::accumulate(sorted.begin(), sorted.begin() + usual, 0.0) /
           static_cast<double>(std::max<std::ptrdiff_t>(usual, 1));
}

bool MissedDisplays::areLost(std::size_t lost, std::size_t of_last) const {
    return recent_.size() >= of_last && lostIn(of_last) >= static_cast<double>(lost) - kLostSlack;
}

void MissedDisplays::lowerShare(double now_ms, double period_ms) {
    if (share_ * period_ms < now_ms) { return; }  // the share is already lower
    share_ = kLowerShare * now_ms / period_ms;
    // If time was given back too early, it is given back later the next time.
    hold_s_ =
        is_raised_ ? std::min(2.0 * hold_s_, kLongestHoldSeconds) : std::max(hold_s_, kFirstHoldSeconds);
    is_raised_ = false;
}

void MissedDisplays::raiseShare(double period_ms) {
    if (now_s_ < held_until_s_) { return; }
    if (share_ >= 1.0) {  // all was given back, and not too early
        hold_s_ = 0.0;
        is_raised_ = false;
        return;
    }
    share_ = std::min(share_ * std::pow(kRaisedPerSecond, 1e-3 * period_ms), 1.0);
    is_raised_ = true;
    if (share_ == 1.0) { hold(); }  // once more, for the whole period
}

void MissedDisplays::leaveAlone() {
    unheeded_s_ = std::clamp(2.0 * unheeded_s_, kFirstUnheededSeconds, kLongestUnheededSeconds);
    heeds_from_s_ = now_s_ + unheeded_s_;
    share_ = 1.0;
    hold_s_ = 0.0;
    is_raised_ = false;
}

}  // namespace binosplat
