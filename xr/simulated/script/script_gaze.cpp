// Commands for the wearer's gaze.
#include "xr/simulated/script/script_gaze.h"

#include "xr/simulated/script/script_parser.h"

#include <glm/trigonometric.hpp>

#include <array>

namespace simulated {

Pose GazeScript::headFromGaze(double time_s) const {
    const glm::dvec2 turn = turn_rad.empty() ? glm::dvec2(0.0) : turn_rad.at(time_s);
    return {glm::angleAxis(turn.x, glm::dvec3(0, 1, 0)) * glm::angleAxis(turn.y, glm::dvec3(1, 0, 0)), {}};
}

GazeTracking GazeScript::trackedAt(double time_s) const {
    return tracker == EyeTracking::kOn ? tracked.at(time_s) : GazeTracking::kOff;
}

void Parser::parseEyeTracking(Words& words) {
    script_.gaze.tracker = std::array{EyeTracking::kOn, EyeTracking::kOff, EyeTracking::kRefused}.at(
        words.takeChoice("whether eyes are tracked", {"on", "off", "refused"}));
}

void Parser::parseGaze(Words& words) {
    const double time_s = words.takeTime();
    const double yaw = words.takeNumber("the turn to the left in degrees", -90.0, 90.0);
    const double pitch = words.takeNumber("the turn upwards in degrees", -90.0, 90.0);
    addKey(words, script_.gaze.turn_rad, time_s, glm::radians(glm::dvec2(yaw, pitch)));
}

void Parser::parseGazeTracking(Words& words, double time_s) {
    const auto tracking = std::array{GazeTracking::kOn, GazeTracking::kOff, GazeTracking::kDegraded}.at(
        words.takeChoice("whether the gaze is tracked", {"on", "off", "degraded"}));
    addStep(words, script_.gaze.tracked, time_s, tracking);
}

}  // namespace simulated
