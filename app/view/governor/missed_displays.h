// Displays that were missed, and what they say of the room that others leave: the compositor, another program. Pure, as the governor is.
#pragma once

#include <cstddef>
#include <deque>

namespace binosplat {

class MissedDisplays {
public:
    // How many frames are looked at, and how many of how many are too many.
    static constexpr std::size_t kWindow = 45, kOftenOver = 5, kOftenOf = 10;

    // The settings have changed: what was missed before says nothing of them.
    void clearRecent() { recent_.clear(); }
    // Nor is it known any more what others leave.
    void forget();
    // A frame that was displayed so many periods late, at `now_s`. Later calls refer to this time.
    void add(double lost_periods, double now_s);

    // One after the other, so many of them.
    [[nodiscard]] bool comeAtOnce(std::size_t frames) const { return areLost(frames, frames); }
    // Or again and again.
    [[nodiscard]] bool come(std::size_t at_once) const { return comeAtOnce(at_once) || areLost(kOftenOver, kOftenOf); }
    [[nodiscard]] std::size_t framesSeen() const { return recent_.size(); }
    // By each of the two thirds of so many frames that lost least.
    [[nodiscard]] double usuallyLost(std::size_t last) const;

    // Of the period, what others leave: found out by what is missed, given back little by little.
    [[nodiscard]] double share() const { return share_; }
    // Displays are missed by frames that take `now_ms`: there is less room than was thought.
    void lowerShare(double now_ms, double period_ms);
    // Whenever displays are missed: raiseShare() does nothing for a while afterwards.
    void hold() { held_until_s_ = now_s_ + hold_s_; }
    void raiseShare(double period_ms);

    // They are others' doing, whatever is drawn: for a while, longer each time, they change nothing.
    void leaveAlone();
    [[nodiscard]] bool areLeftAlone() const { return now_s_ < heeds_from_s_; }

private:
    // Periods lost by the last frames, so many of them; each counts as one at most.
    [[nodiscard]] double lostIn(std::size_t last) const;
    [[nodiscard]] bool areLost(std::size_t lost, std::size_t of_last) const;

    std::deque<double> recent_;  // newest last
    double now_s_ = 0.0;
    double share_ = 1.0, held_until_s_ = 0.0, hold_s_ = 0.0;
    bool is_raised_ = false;                                         // since it was lowered last
    double missed_s_ = 0.0, heeds_from_s_ = 0.0, unheeded_s_ = 0.0;  // the last one; when they count again, and how long they did not
};

}  // namespace binosplat
