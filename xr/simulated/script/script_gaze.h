// Where the wearer looks, as a script says it, and what the headset's eye tracker makes of that
// (XR_EXT_eye_gaze_interaction).
#pragma once

#include "xr/simulated/script/track.h"

#include <glm/vec2.hpp>

namespace simulated {

// Eye tracking. Refused: the headset has it, but the wearer denies it to this program.
enum class EyeTracking { kOn, kOff, kRefused };
// The quality of the gaze. Degraded: a direction, but not a good one.
enum class GazeTracking { kOn, kOff, kDegraded };

struct GazeScript {
    EyeTracking tracker = EyeTracking::kOn;
    // From the head's own direction: to the left, then upwards; empty: straight ahead.
    Track<glm::dvec2> turn_rad;
    Steps<GazeTracking> tracked{GazeTracking::kOn};

    // On the head, between the eyes; OpenXR's axes.
    [[nodiscard]] Pose headFromGaze(double time_s) const;
    [[nodiscard]] GazeTracking trackedAt(double time_s) const;
};

}  // namespace simulated
