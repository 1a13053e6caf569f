// Missed displays, and the share of time that, judging by them, others leave: the compositor, another
// program. Pure, like the governor.
#pragma once

#include <cstddef>
#include <deque>

namespace binosplat {

class MissedDisplays {
public:
    // How many frames are considered, and how many misses out of how many are too many.
    static constexpr std::size_t kWindow = 45, kOftenOver = 5, kOftenOf = 10;

    // The settings have changed: earlier misses do not apply to them.
    void clearRecent() { recent_.clear(); }
    // Also forgets how much time others leave.
    void forget();
    // A frame that was displayed `lost_periods` late, at `now_s`. Later calls refer to this time.
    void add(double lost_periods, double now_s);

    // Each of the last `frames` missed a display.
    [[nodiscard]] bool comeAtOnce(std::size_t frames) const { return areLost(frames, frames); }
    // The same, or misses come often.
    [[nodiscard]] bool come(std::size_t at_once) const {
        return comeAtOnce(at_once) || areLost(kOftenOver, kOftenOf);
    }
    [[nodiscard]] std::size_t framesSeen() const { return recent_.size(); }
    // The average loss per frame over those two thirds of the `last` frames that lost least.
    [[nodiscard]] double usuallyLost(std::size_t last) const;

    // The share of the period that others leave: lowered by misses, raised again little by little.
    [[nodiscard]] double share() const { return share_; }
    // Frames that take `now_ms` miss displays: there is less time than was assumed.
    void lowerShare(double now_ms, double period_ms);
    // Call whenever displays are missed: raiseShare() does nothing for a while afterwards.
    void hold() { held_until_s_ = now_s_ + hold_s_; }
    void raiseShare(double period_ms);

    // Others cause the misses, whatever is drawn: for a while, longer each time, they are ignored.
    void leaveAlone();
    [[nodiscard]] bool areLeftAlone() const { return now_s_ < heeds_from_s_; }

private:
    // Periods lost by the `last` frames; each counts as one at most.
    [[nodiscard]] double lostIn(std::size_t last) const;
    [[nodiscard]] bool areLost(std::size_t lost, std::size_t of_last) const;

    std::deque<double> recent_;  // newest last
    double now_s_ = 0.0;
    double share_ = 1.0, held_until_s_ = 0.0, hold_s_ = 0.0;
    bool is_raised_ = false;  // since it was lowered last
    // The last miss; from when on misses count again, and for how long they do not.
    double missed_s_ = 0.0, heeds_from_s_ = 0.0, unheeded_s_ = 0.0;
};

}  // namespace binosplat
