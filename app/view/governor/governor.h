// Holding the frame rate: which method, share of work and resolution fit into the runtime's period, as measured here and now. Pure: no
// clock, no device; a frame goes in, the settings of the next come out.
#pragma once

#include "app/view/governor/missed_displays.h"
#include "engine/mode.h"

#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace binosplat {

// What may be given up first, and how far. kOff: nothing, the settings stay as the wearer made them.
enum class Quality { kOff, kSharp, kBalanced, kFast };
inline constexpr const char* kQualityNames[] = {"off", "sharp", "balanced", "fast"};

// What is chosen; and what the wearer would have if every frame fitted.
struct GovernedSettings {
    Mode mode = Mode::kPredicted;
    double budget = 0.0;            // of `predicted`: the share of an eye's work that is rendered again
    double resolution_scale = 1.0;  // each way
    double foveation_deg = 0.0;     // not chosen here, but what was measured with another one no longer counts
    bool operator==(const GovernedSettings&) const = default;
};

// A frame that was rendered with the settings last chosen.
struct GovernedFrame {
    double gpu_ms = 0.0;     // 0: the device does not tell
    double period_ms = 0.0;  // what the runtime gives a frame
    bool is_old = false;     // drawn with settings from before: it says nothing of the present ones, but time has passed
    // Periods that passed before the frame was displayed beyond its own, as the runtime shows: independent of the device's own times.
    double lost_periods = 0.0;
    // Where one eye was made from the other: what both would have taken in full, by what this frame's own dominant eye took. 0: unknown.
    double lossless_ms = 0.0;
};

class Governor {
public:
    // From the next frame on. Another wish, or quality, begins anew.
    void wish(Quality quality, const GovernedSettings& best);
    // From the next frame on another scene is shown: what was measured says nothing of it.
    void forget();
    // Takes what the last frame cost. The settings change at most three times while a new load is found out, and then at most once a
    // second.
    void measure(const GovernedFrame& frame);

    [[nodiscard]] const GovernedSettings& settings() const { return levels_[current_].settings; }
    // What it does and why, for people; empty where it does nothing.
    [[nodiscard]] const std::string& sentence() const { return sentence_; }
    // Whether not even the least settings fit.
    [[nodiscard]] bool isBeaten() const { return beaten_; }

private:
    // The ladder, best first. Costs need not fall along it: a lossy method may well be slower.
    struct Level {
        GovernedSettings settings;
        std::size_t method = 0;     // 0: loses nothing
        double blocked_s = 0.0;     // not chosen before this time: it did not keep what it promised
        double block_length_s = 0;  // doubles whenever that comes again
    };
    // What a method costs in relation to the lossless one, at equal resolution.
    struct Ratio {
        double value;
        std::optional<double> measured_s;  // when; empty: guessed, and not chosen before it was tried
        double own_ms = 0.0;               // what the method itself took then
        double forget_s = 0.0;             // how long one that saves nothing is not tried again
    };

    void buildLadder();
    void clearRecent();
    [[nodiscard]] double median(std::size_t frames) const;
    // What a frame takes of what both eyes would in full, by the parts of so many frames of its own. 0: unknown.
    [[nodiscard]] double ratioByOwnFrames(std::size_t frames) const;
    [[nodiscard]] std::size_t countOver(std::size_t of_last) const;
    // What frames may take: the period, or as much of it as others leave.
    [[nodiscard]] double roomMs() const { return misses_.share() * period_ms_; }
    // Whether to give up quality has gained nothing: then it is given back, and for a while misses change nothing.
    [[nodiscard]] bool missesWhateverIsDrawn() const;
    void leaveMissesAlone();
    // Of a level, from what the current one costs now.
    [[nodiscard]] double expectedMs(std::size_t level, double now_ms) const;
    // The best level expected to fit into `most_ms`; the cheapest if none does.
    [[nodiscard]] std::size_t bestWithin(double most_ms, double now_ms) const;
    // Whether the method is known to be faster than what loses nothing, or is just that.
    [[nodiscard]] bool pays(std::size_t method) const;
    void learn(double now_ms, bool is_over);
    // A step upwards that did not keep what it promised is not tried again soon.
    void takeBack();
    // A method that nobody has measured yet, at a resolution where it cannot do harm: if what is guessed of it would allow better settings
    // than the present ones.
    [[nodiscard]] std::optional<std::size_t> worthTrying(double now_ms) const;
    // What to do about frames that took too long, and about those that did not.
    void makeItFit(double now_ms);
    void giveBack(double now_ms);
    [[nodiscard]] bool hasTriedInVain() const { return trial_from_ && !pays(levels_[current_].method); }
    // Where to go from a method that saves nothing: where it was tried from, which fitted, or what fits by what is known.
    [[nodiscard]] std::size_t awayFrom(double most_ms, double now_ms) const;
    void step(std::size_t level, double now_ms, const std::string& why);
    void describe(double now_ms, const std::string& why);

    Quality quality_ = Quality::kOff;
    GovernedSettings best_;
    std::vector<Level> levels_{Level{}};
    std::vector<Ratio> ratios_;
    std::size_t current_ = 0;
    double now_s_ = 0.0, period_ms_ = 0.0;
    std::deque<double> recent_ms_;      // since the last change, newest last
    std::deque<double> recent_ratios_;  // likewise: of frames that know what both eyes would have taken
    int settling_ = 0;                  // frames that still show what the change itself cost
    int downs_ = 0;                     // changes in a row that were not enough
    double changed_s_ = 0.0;
    std::optional<std::size_t> left_;  // the level before the last change upwards
    // The level before the last change, and what it took, where that change was to see what a method takes.
    struct TrialFrom {
        std::size_t level = 0;
        double ms = 0.0;
    };
    std::optional<TrialFrom> trial_from_;
    double lossless_ms_ = 0.0;  // last measured, at full resolution's price
    std::string why_, sentence_;
    bool beaten_ = false;
    MissedDisplays misses_;
    struct Before {
        std::size_t level = 0;
        double ms = 0.0, lost = 0.0;  // of a frame
    };
    std::optional<Before> before_misses_;  // and before anything was given up for them
};

}  // namespace binosplat
