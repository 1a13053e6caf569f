// The results of a bench with head motion: frames as CSV and plot, percentiles as JSON and table.
#pragma once

#include "app/bench/bench_results.h"
#include "app/bench/bounded_tiles.h"
#include "app/scores/visible_errors.h"
#include "app/view/governor/governor.h"
#include "engine/frame/counters.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace binosplat {

// One method at one pose. Errors are those of the left and right eye against their own full renders.
struct MotionFrame {
    std::string point;  // scene and view
    std::string method;
    Mode mode = Mode::kShared;
    bool exact = false;      // both eyes are full renders
    std::size_t number = 0;  // of the frame, from 0
    double time_s = 0.0;     // of the segment
    double total_ms = 0.0;
    NamedTimes stage_ms, pass_ms;     // the latter by label
    double work_rendered = 1.0;       // share of the pairs of tile and splat of both full eyes
    std::uint64_t pixels_warped = 0;  // in tiles that were not rendered
    std::array<double, 2> mean_square{};
    // Mean absolute change of the error image since the previous frame: how much the picture's change differs
    // from the full render's. 0 for the first frame.
    std::array<double, 2> flicker{};
    double full_change = 0.0;  // of the full renders, mean of both eyes
    VisibleErrors visible;
    std::optional<VisibleErrors> seen;         // through the lenses, if there is a headset: SeenThroughLens
    double warp_error = 0.0, half_loss = 0.0;  // FrameResult
    std::optional<GovernedSettings> chosen;    // if a governor chose the resolution and the bound
    std::optional<BoundedTiles> bounded;       // of both eyes, if the method has an error bound
    // The pixels that the scene's motion has changed since the previous frame, seen from this pose
    // (kLeastMoved): their share in both pictures, and their mean squared error, if there are any.
    double moved_share = 0.0;
    std::optional<double> moved_square;
    // For a streamed or moving scene: what was resident, and how many splats the frame read.
    std::optional<FrameCounters::Streaming> streaming;
    std::uint64_t splats_read = 0;

    [[nodiscard]] double worseSquare() const { return std::max(mean_square[0], mean_square[1]); }
    [[nodiscard]] double worseFlicker() const { return std::max(flicker[0], flicker[1]); }
};

// The least change of a channel, of 0 to 1, that counts as motion of a pixel.
inline constexpr double kLeastMoved = 2.0 / 255.0;

struct MotionRun {
    std::string device, config, motion;
    std::vector<MotionFrame> frames;
};

std::string motionCsv(const MotionRun& run);
// Medians, 95th and 99th percentiles and worst frames by point and method; for the error the PSNR that as
// many frames reach in both eyes, and the run's, from both eyes' mean square; and what shows of them
// (app/scores/visible_errors.h), with a headset also through its lenses. Errors are of all frames after the
// tenth, or of all if there are no more.
std::string motionJson(const MotionRun& run);
std::string motionTable(const MotionRun& run, std::size_t most_columns = SIZE_MAX);
std::string motionPlot(const MotionRun& run);

}  // namespace binosplat
