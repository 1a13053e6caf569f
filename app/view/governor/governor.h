// Holds the frame rate: chooses how much of the eyes is rendered again, and how large their pictures are, so
// that frames fit into the runtime's period, as measured. Pure: no clock, no device; a frame goes in, the
// next frame's settings come out.
#pragma once

#include "app/view/governor/knobs.h"
#include "app/view/governor/missed_displays.h"
#include "engine/mode.h"

#include <deque>
#include <optional>
#include <string>

namespace binosplat {

// The bound of the errors that are left visible (34, 30, 27 dB), and how little work and resolution may
// become. kOff: nothing is governed, and the settings stay as the wearer made them.
enum class Quality { kOff, kSharp, kBalanced, kFast };
inline constexpr const char* kQualityNames[] = {"off", "sharp", "balanced", "fast"};

// How far resolution may fall.
[[nodiscard]] double leastScale(Quality quality);

// The chosen settings.
struct GovernedSettings {
    // For modes with a budget, see hasBudget: the share of work that is rendered again.
    double budget = 0.0;
    double resolution_scale = 1.0;  // each way
    double error_bound_db = 0.0;    // for `temporal`, in place of a lower budget; 0: none
    bool operator==(const GovernedSettings&) const = default;
};

// A frame that was rendered with the settings last chosen.
struct GovernedFrame {
    double gpu_ms = 0.0;     // 0: the device does not measure it
    double period_ms = 0.0;  // the runtime's time for a frame
    // Drawn with earlier settings: it says nothing about the present ones, but time has passed.
    bool is_old = false;
    // Periods beyond its own that passed before the frame was displayed, by the runtime's times: independent
    // of the device's.
    double lost_periods = 0.0;
    // The share that was rendered again: less than the budget if there was less to re-render.
    double work = 1.0;
    double warp_error = 0.0, half_loss = 0.0;  // see KnobFrame
    bool is_full = false;                      // likewise
};

// True if a share of work is rendered again: of one eye's (kPredicted), of both eyes' (kTemporal).
constexpr bool hasBudget(Mode mode) { return mode == Mode::kPredicted || mode == Mode::kTemporal; }

class Governor {
public:
    // From the next frame on. Another wish or quality starts over with the wearer's own settings: the
    // resolution never exceeds them, while the budget may rise to all work.
    void wish(Quality quality, Mode mode, const GovernedSettings& own);
    // From the next frame on, another scene is shown: the measurements do not apply to it.
    void forget();
    // Takes the last frame's cost. The settings change a few times while adapting to a new load, and then at
    // most once a second.
    void measure(const GovernedFrame& frame);

    [[nodiscard]] const GovernedSettings& settings() const { return settings_; }
    // What it does and why, for people; empty if it does nothing.
    [[nodiscard]] const std::string& sentence() const { return sentence_; }
    // True if not even the lowest settings fit.
    [[nodiscard]] bool isBeaten() const { return beaten_; }

private:
    void clearRecent();
    [[nodiscard]] std::size_t countOver(std::size_t of_last) const;
    // The time for a frame: the period, or the share of it that others leave.
    [[nodiscard]] double roomMs() const { return misses_.share() * period_ms_; }
    // True if giving up quality has gained nothing: then it is given back, and misses are ignored for a
    // while.
    [[nodiscard]] bool missesWhateverIsDrawn() const;
    void leaveMissesAlone();
    // The resolution, in tenths of the wearer's, whose expected cost is `ratio` times the present one's.
    [[nodiscard]] double scaleFor(double ratio) const;
    // Settings whose expected cost is `ratio` times that of the present ones, if `work` is rendered again:
    // first the budget is lowered, then the resolution.
    [[nodiscard]] GovernedSettings lowered(double ratio, double work, bool as_usual = false) const;
    // The reverse; the budget rises only if it is spent.
    [[nodiscard]] GovernedSettings raised(double ratio) const;
    // `temporal`: the resolution and bound that the model chooses for frames of at most this time.
    [[nodiscard]] GovernedSettings bestWithin(double most_ms) const;
    [[nodiscard]] GovernedSettings with(const Knobs& knobs) const;
    [[nodiscard]] KnobLimits knobLimits() const;
    // True if they are worth a change: clearly less error, or both knobs higher.
    [[nodiscard]] bool isBetter(const GovernedSettings& to) const;
    [[nodiscard]] bool turnsKnobs() const { return mode_ == Mode::kTemporal && quality_ != Quality::kOff; }
    [[nodiscard]] Knobs knobs() const { return {settings_.resolution_scale, settings_.error_bound_db}; }
    // Reactions to frames that took too long, and to those that did not.
    void makeItFit(double now_ms, std::size_t frames, bool takes_too_long);
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
    int settling_ = 0;                            // frames that still include the cost of the change itself
    int downs_ = 0;                               // changes in a row that were not enough
    double changed_s_ = 0.0, lowered_s_ = 0.0;
    bool is_raised_ = false;  // the last change was a rise
    // From lowering the settings until something is given back: longer each time that this was too early.
    double wait_s_ = 0.0;
    std::string why_, sentence_;
    bool beaten_ = false;
    MissedDisplays misses_;
    KnobModel model_;
    struct Before {
        GovernedSettings settings;
        double lost = 0.0;  // per frame
    };
    std::optional<Before> before_misses_;  // before quality was given up for them
};

}  // namespace binosplat
