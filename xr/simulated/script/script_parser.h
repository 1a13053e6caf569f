// Turns the text of a script into a Script: one function per command, in files by topic.
#pragma once

#include "xr/simulated/script/script.h"
#include "xr/simulated/script/script_words.h"

#include <filesystem>
#include <map>

namespace simulated {

inline constexpr const char* kRateMeaning = "the rate in frames per second";
inline constexpr double kLeastRate = 1.0, kMostRate = 1000.0;

template <typename Value>
void addKey(const Words& words, Track<Value>& track, double time_s, const Value& value) {
    if (!track.add(time_s, value)) {
        words.fail("the time is {}, must be after the key before, at {}", time_s, track.lastTime());
    }
}

template <typename Value>
void addStep(const Words& words, Steps<Value>& steps, double time_s, const Value& value) {
    if (!steps.add(time_s, value)) {
        words.fail("the time is {}, must be after the one of the same change before", time_s);
    }
}

class Parser {
public:
    explicit Parser(const std::string& name);

    Script parse(std::string_view text);

private:
    struct Command {
        void (Parser::*parse)(Words&);
        bool stands_once = false;
    };

    void parseLine(Words& words);
    void requireFirst(const Words& words, const std::string& what);

    // script_headset.cpp
    void parseRate(Words& words);
    void parseIrregular(Words& words);
    void parsePeriod(Words& words);
    void parseSize(Words& words);
    void parseIpd(Words& words);
    void parseEye(Words& words);
    void parseHeadsetLine(Words& words);
    void parseInset(Words& words);
    void parseBlendModes(Words& words);
    void parsePassthrough(Words& words);
    void parseRoomColour(Words& words);
    void parseMask(Words& words);
    void parseLocal(Words& words);
    void parseStage(Words& words);

    // script_runtime.cpp
    void parseImages(Words& words);
    void parseStateChanges(Words& words);
    void parseExtension(Words& words);
    std::string takeProfileName(Words& words);
    void parseProfile(Words& words);
    void parsePlugged(Words& words);
    void parseVulkanAdditions(Words& words);
    void parseNoHeadset(Words& words);
    void parseRefusedDepth(Words& words);
    void parseFrames(Words& words);

    // script_poses.cpp
    // [position x y z] [rotation x y z w | turn YAW PITCH | look x y z]; what is left out stays as it was.
    Pose parsePose(Words& words, Pose pose);
    void addPose(Words& words, Track<Pose>& track, const Pose& at_rest);
    void parseHead(Words& words);
    void parseHeadMotionLine(Words& words);
    void parseController(Words& words);
    void parseAim(Words& words);
    // The recording's first pose has the position and heading of the head line; its tilt is as recorded.
    void finishPoses();

    // script_gaze.cpp
    void parseEyeTracking(Words& words);
    void parseGaze(Words& words);
    void parseGazeTracking(Words& words, double time_s);

    // script_presses.cpp
    // A side, or "gamepad", and then one of its inputs.
    std::pair<Script::Hand*, std::string> takeInput(Words& words);
    void addPress(Words& words, bool touch_only);
    void parsePress(Words& words);
    void parseTouch(Words& words);
    void parseAxis(Words& words);

    // script_timeline.cpp
    void parseAt(Words& words);

    std::string name_;
    std::filesystem::path folder_;
    std::size_t line_ = 0;
    Script script_;
    std::map<std::string, std::size_t> seen_;  // settings and their lines
    Track<Pose> head_;
    std::vector<std::string> head_lines_;
    std::array<Track<Pose>, 2> grips_;
    std::optional<Track<Pose>> head_motion_;
    double motion_start_s_ = 0.0, motion_skip_s_ = 0.0;
    std::optional<double> last_at_s_;
};

}  // namespace simulated
