// Holding the frame rate: how much of the eyes is rendered again, and how large their pictures are, so that frames fit into the runtime's
// period, as measured here and now. Pure: no clock, no device; a frame goes in, the settings of the next come out.
#pragma once

#include "app/view/governor/missed_displays.h"
#include "engine/mode.h"

#include <deque>
#include <optional>
#include <string>

namespace binosplat {

// How little work and resolution may become. kOff: nothing is chosen, the settings stay as the wearer made them.
enum class Quality { kOff, kSharp, kBalanced, kFast };
inline constexpr const char* kQualityNames[] = {"off", "sharp", "balanced", "fast"};

// What is chosen.
struct GovernedSettings {
    double budget = 0.0;            // of modes that have one, see hasBudget: the share of work that is rendered again
    double resolution_scale = 1.0;  // each way
    bool operator==(const GovernedSettings&) const = default;
};

// A frame that was rendered with the settings last chosen.
struct GovernedFrame {
    double gpu_ms = 0.0;     // 0: the device does not tell
    double period_ms = 0.0;  // what the runtime gives a frame
    bool is_old = false;     // drawn with settings from before: it says nothing of the present ones, but time has passed
    // Periods that passed before the frame was displayed beyond its own, as the runtime shows: independent of the device's own times.
    double lost_periods = 0.0;
    double work = 1.0;  // of the budget's kind, the share that was rendered again: less than the budget where there was nothing to mend
};

// Whether a share of work is rendered again: of an eye's (kPredicted), of both eyes' (kTemporal).
constexpr bool hasBudget(Mode mode) { return mode == Mode::kPredicted || mode == Mode::kTemporal; }

class Governor {
public:
    // From the next frame on. Another wish, or quality, begins anew, with the wearer's own settings: no resolution is higher, while the
    // budget goes as far as all work.
    void wish(Quality quality, Mode mode, const GovernedSettings& own);
    // From the next frame on another scene is shown: what was measured says nothing of it.
    void forget();
    // Takes what the last frame cost. The settings change at most three times while a new load is found out, and then at most once a
    // second.
    void measure(const GovernedFrame& frame);

    [[nodiscard]] const GovernedSettings& settings() const { return settings_; }
    // What it does and why, for people; empty where it does nothing.
    [[nodiscard]] const std::string& sentence() const { return sentence_; }
    // Whether not even the least settings fit.
    [[nodiscard]] bool isBeaten() const { return beaten_; }

private:
    void clearRecent();
    [[nodiscard]] std::size_t countOver(std::size_t of_last) const;
    // What frames may take: the period, or as much of it as others leave.
    [[nodiscard]] double roomMs() const { return misses_.share() * period_ms_; }
    // Whether to give up quality has gained nothing: then it is given back, and for a while misses change nothing.
    [[nodiscard]] bool missesWhateverIsDrawn() const;
    void leaveMissesAlone();
    // The resolution, in tenths of the wearer's, that is expected to take this much of what the present one does.
    [[nodiscard]] double scaleFor(double ratio) const;
    // What is expected to take this much of what the present settings do where `work` is rendered again: first the budget becomes less,
    // then the resolution.
    [[nodiscard]] GovernedSettings lowered(double ratio, double work) const;
    // And the other way round, where all of the budget is spent.
    [[nodiscard]] GovernedSettings raised(double ratio) const;
    // What to do about frames that took too long, and about those that did not.
    void makeItFit(double now_ms, std::size_t frames);
    void giveBack(double now_ms);
    void stepDown(const GovernedSettings& to, const std::string& why);
    void step(const GovernedSettings& to, const std::string& why);
    [[nodiscard]] std::string describeSettings() const;
    void describe(double now_ms, const std::string& why);

    Quality quality_ = Quality::kOff;
    Mode mode_ = Mode::kTemporal;
    GovernedSettings own_, settings_;
    double now_s_ = 0.0, period_ms_ = 0.0;
    std::deque<double> recent_ms_, recent_work_;  // since the last change, newest last
    int settling_ = 0;                            // frames that still show what the change itself cost
    int downs_ = 0;                               // changes in a row that were not enough
    double changed_s_ = 0.0, lowered_s_ = 0.0;
    bool is_raised_ = false;  // by the last change
    double wait_s_ = 0.0;     // after settings were lowered, until something is given back: longer each time that this was too early
    std::string why_, sentence_;
    bool beaten_ = false;
    MissedDisplays misses_;
    struct Before {
        GovernedSettings settings;
        double lost = 0.0;  // by a frame
    };
    std::optional<Before> before_misses_;  // and before anything was given up for them
};

}  // namespace binosplat
