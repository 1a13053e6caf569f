// Commands for the poses of the head and the hands.
#include "xr/simulated/script/script_files.h"
#include "xr/simulated/script/script_parser.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>

namespace simulated {

namespace {

namespace fs = std::filesystem;

// To the left about the vertical, then upwards.
glm::dquat makeTurn(double yaw_rad, double pitch_rad) {
    return glm::angleAxis(yaw_rad, glm::dvec3(0, 1, 0)) * glm::angleAxis(pitch_rad, glm::dvec3(1, 0, 0));
}

}  // namespace

Pose Parser::parsePose(Words& words, Pose pose) {
    bool is_given = false;
    if (words.takeIf("position")) {
        pose.position = words.takePosition();
        is_given = true;
    }
    if (words.takeIf("rotation")) {
        pose.orientation = words.takeRotation();
        is_given = true;
    } else if (words.takeIf("turn")) {
        const double yaw = words.takeNumber("the turn to the left in degrees", -3600.0, 3600.0);
        const double pitch = words.takeNumber("the turn upwards in degrees", -3600.0, 3600.0);
        pose.orientation = makeTurn(glm::radians(yaw), glm::radians(pitch));
        is_given = true;
    } else if (words.takeIf("look")) {
        const glm::dvec3 way = words.takePosition() - pose.position;
        if (glm::length(way) < 1e-6) {
            words.fail("the point to look at is where it looks from, must be another");
        }
        // Straight up and down have no heading: straight ahead is taken.
        const double level = std::hypot(way.x, way.z);
        const double yaw = level < 1e-9 ? 0.0 : std::atan2(-way.x, -way.z);
        pose.orientation = makeTurn(yaw, std::atan2(way.y, level));
        is_given = true;
    }
    if (!is_given) {
        words.fail(
            "the pose is missing, must be position X Y Z, or rotation X Y Z W, turn YAW PITCH or look X Y Z, "
            "or both");
    }
    return pose;
}

void Parser::addPose(Words& words, Track<Pose>& track, const Pose& at_rest) {
    const double time_s = words.takeTime();
    const Pose before = track.empty() ? at_rest : track.at(track.lastTime());
    addKey(words, track, time_s, parsePose(words, before));
}

void Parser::parseHead(Words& words) {
    if (head_motion_ && !head_.empty()) {
        words.fail("the head has a recorded motion, at most one head line can say where from");
    }
    addPose(words, head_, Script().stage_from_head.at(0.0));
    head_lines_.push_back(words.place());
}

void Parser::parseHeadMotionLine(Words& words) {
    if (head_lines_.size() > 1) {
        words.fail("the head has keys on more than one line, at most one can say where the motion starts");
    }
    const fs::path path = folder_ / words.takeText("the motion's file");
    MotionAxes axes = MotionAxes::kOpenXr;
    if (words.takeIf("axes") && words.takeChoice("the axes", {"openxr", "unity"}) == 1) {
        axes = MotionAxes::kUnity;
    }
    if (words.takeIf("start")) { motion_start_s_ = words.takeTime("the time at which the motion starts"); }
    if (words.takeIf("skip")) { motion_skip_s_ = words.takeNumber("the seconds to skip", 0.0, 1e6); }
    words.requireEnd();
    const std::string text =
        readText(path, words.place() + ": ", "a CSV file of head motion", kMostRecordingBytes);
    head_motion_ = readHeadTrack(text, path.string(), axes, script_.notes);
    if (motion_skip_s_ > head_motion_->lastTime()) {
        words.fail("the seconds to skip are {}, must be at most {}, the recording's length", motion_skip_s_,
                   head_motion_->lastTime());
    }
}

void Parser::parseController(Words& words) {
    const Side side = words.takeSide();
    addPose(words, grips_[side], Script().hands[side].stage_from_grip.at(0.0));
}

void Parser::parseAim(Words& words) {
    const Side side = words.takeSide();
    requireFirst(words, side == kLeft ? "aim left" : "aim right");
    script_.hands[side].grip_from_aim = parsePose(words, {});
}

void Parser::finishPoses() {
    for (const Side side : kSides) {
        if (!grips_[side].empty()) { script_.hands[side].stage_from_grip = grips_[side]; }
    }
    if (!head_.empty()) { script_.stage_from_head = head_; }
    if (!head_motion_) { return; }
    const Pose stage_from_start = makeLevel(script_.stage_from_head.at(0.0));
    const Pose start_from_recording = inverse(makeLevel(head_motion_->at(motion_skip_s_)));
    const Pose stage_from_recording = compose(stage_from_start, start_from_recording);
    script_.stage_from_head = Track<Pose>();
    script_.stage_from_head.add(motion_start_s_,
                                compose(stage_from_recording, head_motion_->at(motion_skip_s_)));
    for (const auto& [time_s, pose] : head_motion_->keys()) {
        if (time_s <= motion_skip_s_) { continue; }
        script_.stage_from_head.add(motion_start_s_ + time_s - motion_skip_s_,
                                    compose(stage_from_recording, pose));
    }
}

}  // namespace simulated
