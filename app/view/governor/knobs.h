// What a step of resolution or of the error bound saves of time and costs in errors, learned from frames of
// `temporal`. Pure: no clock, no device. Errors are mean squares over pixels and channels, of values 0 to 1.
#pragma once

#include <array>
#include <cmath>
#include <deque>
#include <optional>
#include <vector>

namespace binosplat {

struct Knobs {
    double scale = 1.0;     // of the resolution, each way
    double bound_db = 0.0;  // every tile with a greater expected error is rendered
    bool operator==(const Knobs&) const = default;
};

// A frame that was rendered with such knobs.
struct KnobFrame {
    double ms = 0.0;
    double seconds = 0.0;     // since the one before
    double work = 0.0;        // the rendered share of both eyes' pairs
    double warp_error = 0.0;  // the expected error of the tiles that were not rendered; 0 if unknown
    // What half of the resolution would lose, as measured on a few tiles; 0 if unknown.
    double half_loss = 0.0;
    // Rendered in full, since reprojecting did not pay: the bound means nothing.
    bool is_full = false;
};

// The limits of a choice: resolution in tenths of `whole`, bounds in whole dB.
struct KnobLimits {
    double least_scale = 0.4, whole = 1.0, most_bound_db = 30.0;
};

// A resolution of `whole`, in its tenths: in whole percents.
inline double governedScale(double whole, double tenths) { return std::round(10.0 * whole * tenths) / 100.0; }

class KnobModel {
public:
    // kLeastWhileScaleGives: lower bounds are for the least resolution alone.
    static constexpr double kLeastBoundDb = 20.0, kLeastWhileScaleGives = 26.0;

    void forget() { *this = {}; }
    void add(const Knobs& knobs, const KnobFrame& frame);

    [[nodiscard]] bool knows() const { return !visits_.empty(); }
    // True while frames take another time than before at the same knobs, or are of the other kind (in full,
    // reprojected), but have not yet for long.
    [[nodiscard]] bool mayBeChanging() const;
    // The expected time and error of a frame with such knobs, while the head moves as it did recently.
    [[nodiscard]] double expectedMs(const Knobs& knobs) const { return msBy(shares_, knobs); }
    [[nodiscard]] double expectedError(const Knobs& knobs) const;
    // Among the knobs within the limits whose frames take at most this long, those with the least error; if
    // there are none, the quickest.
    [[nodiscard]] Knobs best(double most_ms, const KnobLimits& limits) const;
    // The same for frames that take `ratio` times as long as the present ones by the usual shares, whatever
    // was learned: for when it is not clear whether turning the knobs gained nothing or all became slower.
    [[nodiscard]] Knobs bestAsUsual(double ratio, const KnobLimits& limits) const;

private:
    // A frame's time is the sum of these, each times a share of its own: 1, pixels, work, pixels that are
    // rendered.
    using Terms = std::array<double, 4>;
    // A pair of knobs that was in use, with the medians of its last frames.
    struct Visit {
        Knobs knobs;
        bool is_full = false;                           // its frames were rendered in full
        std::deque<double> all_ms = {}, all_work = {};  // newest last
        double ms = 0.0, work = 0.0;
        double weight = 1.0;  // old visits count for less
    };
    [[nodiscard]] double workAt(double bound_db) const;
    [[nodiscard]] double msBy(const Terms& shares, const Knobs& knobs) const {
        return sumOf(termsOf(knobs.scale, full_ ? 1.0 : workAt(knobs.bound_db)), shares);
    }
    [[nodiscard]] Knobs bestBy(const Terms& shares, double most_ms, const KnobLimits& limits) const;
    [[nodiscard]] Terms usualShares() const;
    [[nodiscard]] static Terms termsOf(double scale, double work);
    [[nodiscard]] static double sumOf(const Terms& terms, const Terms& shares);
    void enter(const Knobs& knobs, bool is_full);
    void learnWork(const Visit& before, const Visit& now);
    // Takes all visits for slower, or quicker, if frames at the same knobs and work are for a long time, or
    // still are with other knobs.
    void noteChange(const KnobFrame& frame);
    void scaleTimes(double ratio, std::size_t visits);
    void fit();

    std::vector<Visit> visits_;  // the present one last
    double work_ = 0.0;          // at the present bound, while the head moves
    double work_per_db_ = 0.0;   // its growth, when the bound was changed last
    double warp_error_ = 0.0;    // likewise
    double loss_ = 0.0;          // of the resolution r: loss_ * (1/r^3 - 1)
    int losses_ = 0;             // number of measurements
    bool full_ = false;          // the last frame was
    std::size_t of_kind_ = 0;    // frames in a row that were alike in that
    bool knows_work_ = false;    // a frame was reprojected
    Terms shares_{};             // as fitted to the visits
    Terms settled_{};            // the same after the first frames at the present knobs
    std::size_t settling_ = 0;   // how many of these are still to come
    std::size_t changed_ = 0;    // frames in a row that took that many times as long as expected
    double changed_ratio_ = 1.0;
    double doubted_ratio_ = 1.0;  // before the knobs were turned; 1: none
    Terms shares_before_{};
};

}  // namespace binosplat
