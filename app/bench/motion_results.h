// What a bench with head motion measured: frames as CSV and plot, percentiles as JSON and table.
#pragma once

#include "app/bench/bench_results.h"

#include <string>
#include <vector>

namespace binosplat {

// One method at one pose.
struct MotionFrame {
    std::string point;  // scene and view
    std::string method;
    Mode mode;
    double time_s = 0.0;  // of the recording
    double total_ms = 0.0;
    NamedTimes stage_ms;
    double mean_square = 0.0;  // of the affiliated eye against its own full render
    // Mean absolute change of the error image since the frame before: by so much the picture changes otherwise than the full render
    // does. The full render's own change beside it. 0 for the first frame.
    double flicker = 0.0, full_change = 0.0;
};

struct MotionRun {
    std::string device, config, motion;
    std::vector<MotionFrame> frames;
};

std::string motionCsv(const MotionRun& run);
// Medians, 95th and 99th percentiles by point and method; of the error: the PSNR that 95 and 99 % of the frames reach.
std::string motionJson(const MotionRun& run);
std::string motionTable(const MotionRun& run);
std::string motionPlot(const MotionRun& run);

}  // namespace binosplat
