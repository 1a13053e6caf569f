// The methods that a bench compares: each is a mode with its own settings, in pictures of full or lower
// resolution.
#pragma once

#include "app/options/options.h"

#include <optional>
#include <string>
#include <vector>

namespace binosplat {

struct BenchMethod {
    std::string name;
    StereoOptions stereo;
    // Share of width and height; pictures are scaled up before they are scored, as a compositor does.
    double resolution = 1.0;
    // The time that a governor keeps frames of `temporal` within; 0: no governor. Unset: as --frame-time
    // says.
    std::optional<FrameTime> frame_time = {};

    // True if both eyes equal two full renders.
    [[nodiscard]] bool isExact() const { return rendersBothInFull(stereo.mode) && resolution == 1.0; }
};

// One [[methods]] table: name, mode, and any of depth, order, resampling, per-eye, margin, budget, gap-px,
// center-roi, edge-bounds, edge-samples, hole-error, newcomer-error and move-cost, and resolution and
// frame-time. Missing keys are as in `base`. A key with an array stands for a method per entry, several such
// keys for every combination, each named "name key=value ...", or "name@0.6" by its resolution. Throws Error
// with file and line.
std::vector<BenchMethod> readMethods(const SettingsTable& table, const RunOptions& base);

// A mode with the settings of `base`, named as the mode.
BenchMethod plainMethod(Mode mode, const RunOptions& base);

}  // namespace binosplat
