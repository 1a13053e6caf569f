// The commands about the wearer's gaze.
#include "xr/simulated/script/script_gaze.h"

#include "xr/simulated/script/script_words.h"

#include <glm/trigonometric.hpp>

#include <array>

namespace simulated {

Pose GazeScript::headFromGaze(double time_s) const {
    const glm::dvec2 turn = turn_rad.empty() ? glm::dvec2(0.0) : turn_rad.at(time_s);
    return {glm::angleAxis(turn.x, glm::dvec3(0, 1, 0)) * glm::angleAxis(turn.y, glm::dvec3(1, 0, 0)), {}};
}

GazeTracking GazeScript::trackedAt(double time_s) const { return tracker == EyeTracking::kOn ? tracked.at(time_s) : GazeTracking::kOff; }

void parseEyeTracking(Words& words, GazeScript& gaze) {
    gaze.tracker = std::array{EyeTracking::kOn, EyeTracking::kOff, EyeTracking::kRefused}.at(
        words.takeChoice("whether eyes are tracked", {"on", "off", "refused"}));
}

void parseGazeKey(Words& words, GazeScript& gaze) {
    const double time_s = words.takeTime();
    const double yaw = words.takeNumber("the turn to the left in degrees", -90.0, 90.0);
    const double pitch = words.takeNumber("the turn upwards in degrees", -90.0, 90.0);
    const glm::dvec2 turn_rad = glm::radians(glm::dvec2(yaw, pitch));
    if (!gaze.turn_rad.add(time_s, turn_rad)) {
        words.fail("the time is {}, must be after the key before, at {}", time_s, gaze.turn_rad.lastTime());
    }
}

void parseGazeTracking(Words& words, double time_s, GazeScript& gaze) {
    const auto tracking = std::array{GazeTracking::kOn, GazeTracking::kOff, GazeTracking::kDegraded}.at(
        words.takeChoice("whether the gaze is tracked", {"on", "off", "degraded"}));
    if (!gaze.tracked.add(time_s, tracking)) { words.fail("the time is {}, must be after the one of the same change before", time_s); }
}

}  // namespace simulated
