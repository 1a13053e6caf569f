// From a script's text to the script: one function per command.
#include "xr/simulated/api/profiles.h"
#include "xr/simulated/extensions.h"
#include "xr/simulated/script/script.h"
#include "xr/simulated/script/script_files.h"
#include "xr/simulated/script/script_inputs.h"
#include "xr/simulated/script/script_profile.h"
#include "xr/simulated/script/script_words.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace simulated {

namespace {

namespace fs = std::filesystem;

constexpr const char* kRateMeaning = "the rate in frames per second";
constexpr double kLeastRate = 1.0, kMostRate = 1000.0;

// To the left about the vertical, then upwards.
glm::dquat turned(double yaw_rad, double pitch_rad) {
    return glm::angleAxis(yaw_rad, glm::dvec3(0, 1, 0)) * glm::angleAxis(pitch_rad, glm::dvec3(1, 0, 0));
}

class Parser {
public:
    explicit Parser(const std::string& name) : name_(name), folder_(fs::path(name).parent_path()) {}

    Script parse(std::string_view text) {
        if (text.starts_with("\xef\xbb\xbf")) { text.remove_prefix(3); }
        for (line_ = 1; !text.empty(); ++line_) {
            const std::size_t length = std::min(text.find('\n'), text.size());
            Words words(text.substr(0, length), fmt::format("{}:{}", name_, line_));
            text.remove_prefix(std::min(length + 1, text.size()));
            if (words.isAtEnd()) { continue; }
            parseLine(words);
            words.requireEnd();
        }
        finishPoses();
        if (!script_.profile.empty()) { checkInputs(script_, *findHandProfile(script_.profile)); }
        return std::move(script_);
    }

private:
    using Command = void (Parser::*)(Words&);

    void parseLine(Words& words) {
        static const std::map<std::string, Command, std::less<>> kCommands{{"at", &Parser::parseAt},
                                                                           {"aim", &Parser::parseAim},
                                                                           {"axis", &Parser::parseAxis},
                                                                           {"blend-modes", &Parser::parseBlendModes},
                                                                           {"controller", &Parser::parseController},
                                                                           {"extension", &Parser::parseExtension},
                                                                           {"eye", &Parser::parseEye},
                                                                           {"eye-tracking", &Parser::parseEyeTrackingLine},
                                                                           {"frames", &Parser::parseFrames},
                                                                           {"gaze", &Parser::parseGazeLine},
                                                                           {"head", &Parser::parseHead},
                                                                           {"head-motion", &Parser::parseHeadMotionLine},
                                                                           {"headset", &Parser::parseHeadsetLine},
                                                                           {"images", &Parser::parseImages},
                                                                           {"ipd", &Parser::parseIpd},
                                                                           {"irregular", &Parser::parseIrregular},
                                                                           {"local", &Parser::parseLocal},
                                                                           {"no-headset-for", &Parser::parseNoHeadset},
                                                                           {"plugged", &Parser::parsePlugged},
                                                                           {"press", &Parser::parsePress},
                                                                           {"profile", &Parser::parseProfile},
                                                                           {"rate", &Parser::parseRate},
                                                                           {"refuse-depth", &Parser::parseRefusedDepth},
                                                                           {"room-colour", &Parser::parseRoomColour},
                                                                           {"size", &Parser::parseSize},
                                                                           {"stage", &Parser::parseStage},
                                                                           {"state-changes", &Parser::parseStateChanges},
                                                                           {"touch", &Parser::parseTouch},
                                                                           {"visibility-mask", &Parser::parseMask},
                                                                           {"vulkan-additions", &Parser::parseVulkanAdditions}};
        const std::string command = words.text("the command");
        const auto found = kCommands.find(command);
        if (found == kCommands.end()) {
            std::string known;
            for (const auto& [word, function] : kCommands) { known += (known.empty() ? "" : ", ") + word; }
            words.fail("{} is not a command, must be one of: {}", shown(command), known);
        }
        (this->*found->second)(words);
    }

    // Settings stand once: which of two should win, nobody could see.
    void requireFirst(const Words& words, const std::string& what) {
        const auto [earlier, is_first] = seen_.emplace(what, line_);
        if (!is_first) { words.fail("{} is set again, first on line {}, must be set once", what, earlier->second); }
    }

    void parseRate(Words& words) {
        requireFirst(words, "rate");
        script_.rate_hz = words.number(kRateMeaning, kLeastRate, kMostRate);
    }

    void parseIrregular(Words& words) {
        requireFirst(words, "irregular");
        script_.irregularity = 0.01 * words.number("how much periods differ, in percent", 0.0, 90.0);
    }

    void parseImages(Words& words) {
        requireFirst(words, "images");
        script_.images = static_cast<std::uint32_t>(words.count("the number of images", 1, 16));
        if (words.isAtEnd()) { return; }
        constexpr std::array kOrders{Script::ImageOrder::kInTurn, Script::ImageOrder::kReversed, Script::ImageOrder::kShuffled};
        script_.image_order = kOrders.at(words.choice("the order", {"in-turn", "reversed", "shuffled"}));
    }

    void parseStateChanges(Words& words) {
        requireFirst(words, "state-changes");
        script_.changes_state_at_begin = words.choice("when states change", {"at-begin", "at-end"}) == 0;
    }

    // "70 %", "8 ms" or "3 ms-per-megapixel".
    static GpuLoad parseLoad(Words& words) {
        const double amount = words.number("the load", 0.0, 1e5);
        switch (words.choice("the load's unit", {"%", "ms", "ms-per-megapixel"})) {
            case 0:
                return {GpuLoad::Unit::kShareOfPeriod, amount / 100.0};
            case 1:
                return {GpuLoad::Unit::kMs, amount};
            default:
                return {GpuLoad::Unit::kMsPerMegapixel, amount};
        }
    }

    void parseSize(Words& words) {
        requireFirst(words, "size");
        const auto width = static_cast<std::uint32_t>(words.count("the width in pixels", 1, 16384));
        script_.size_px = {width, static_cast<std::uint32_t>(words.count("the height in pixels", 1, 16384))};
    }

    void parseIpd(Words& words) {
        requireFirst(words, "ipd");
        script_.eye_distance_m = words.number("the eye distance in metres", 0.0, 1.0);
    }

    void parseEye(Words& words) {
        const Side side = words.side();
        const std::string eye = side == kLeft ? "eye left " : "eye right ";
        if (words.choice("what is set", {"angles", "cant"}) == 0) {
            requireFirst(words, eye + "angles");
            script_.fovs[side].setInitial(words.angles());
        } else {
            requireFirst(words, eye + "cant");
            script_.cant_rad[side] = glm::radians(words.number("the turn outwards in degrees", -45.0, 45.0));
        }
    }

    void parseEyeTrackingLine(Words& words) {
        requireFirst(words, "eye-tracking");
        parseEyeTracking(words, script_.gaze);
    }
    void parseGazeLine(Words& words) { parseGazeKey(words, script_.gaze); }

    void parseHeadsetLine(Words& words) {
        for (const char* set_by_it : {"size", "ipd", "eye left angles", "eye left cant", "eye right angles", "eye right cant"}) {
            if (seen_.contains(set_by_it)) { words.fail("headset sets {}, too, must stand before it", set_by_it); }
        }
        requireFirst(words, "headset");
        const fs::path path = folder_ / words.text("the headset's file");
        const files::HeadsetFile headset = readHeadset(readText(path, words.place() + ": ", "a TOML file of a headset"), path.string());
        script_.system_name = headset.name;
        script_.size_px = {headset.size_px[0], headset.size_px[1]};
        script_.eye_distance_m = headset.eye_distance_m;
        script_.cant_rad = {headset.canting_rad, headset.canting_rad};
        for (const Side side : kSides) {
            const auto& [left_rad, right_rad, up_rad, down_rad] = headset.angles[side];
            script_.fovs[side].setInitial({left_rad, right_rad, up_rad, down_rad});
        }
    }

    // [position x y z] [rotation x y z w | turn YAW PITCH | look x y z]; what is left out stays as it was.
    Pose parsePose(Words& words, Pose pose) {
        bool is_given = false;
        if (words.takeIf("position")) {
            pose.position = words.position();
            is_given = true;
        }
        if (words.takeIf("rotation")) {
            pose.orientation = words.rotation();
            is_given = true;
        } else if (words.takeIf("turn")) {
            const double yaw = words.number("the turn to the left in degrees", -3600.0, 3600.0);
            const double pitch = words.number("the turn upwards in degrees", -3600.0, 3600.0);
            pose.orientation = turned(glm::radians(yaw), glm::radians(pitch));
            is_given = true;
        } else if (words.takeIf("look")) {
            const glm::dvec3 way = words.position() - pose.position;
            if (glm::length(way) < 1e-6) { words.fail("the point to look at is where it looks from, must be another"); }
            // Straight up and down have no heading: as if ahead.
            const double level = std::hypot(way.x, way.z);
            const double yaw = level < 1e-9 ? 0.0 : std::atan2(-way.x, -way.z);
            pose.orientation = turned(yaw, std::atan2(way.y, level));
            is_given = true;
        }
        if (!is_given) {
            words.fail("the pose is missing, must be position X Y Z, or rotation X Y Z W, turn YAW PITCH or look X Y Z, or both");
        }
        return pose;
    }

    void addPose(Words& words, Track<Pose>& track, const Pose& at_rest) {
        const double time_s = words.time();
        const Pose before = track.empty() ? at_rest : track.at(track.lastTime());
        if (!track.add(time_s, parsePose(words, before))) {
            words.fail("the time is {}, must be after the key before, at {}", time_s, track.lastTime());
        }
    }

    void parseHead(Words& words) {
        if (head_motion_ && !head_.empty()) { words.fail("the head has a recorded motion, at most one head line can say where from"); }
        addPose(words, head_, Script().stage_from_head.at(0.0));
        head_lines_.push_back(words.place());
    }

    void parseHeadMotionLine(Words& words) {
        requireFirst(words, "head-motion");
        if (head_lines_.size() > 1) { words.fail("the head has keys on more than one line, at most one can say where the motion starts"); }
        const fs::path path = folder_ / words.text("the motion's file");
        MotionAxes axes = MotionAxes::kOpenXr;
        if (words.takeIf("axes") && words.choice("the axes", {"openxr", "unity"}) == 1) { axes = MotionAxes::kUnity; }
        if (words.takeIf("start")) { motion_start_s_ = words.time("the time at which the motion starts"); }
        if (words.takeIf("skip")) { motion_skip_s_ = words.number("the seconds to skip", 0.0, 1e6); }
        words.requireEnd();
        head_motion_ = headTrack(readText(path, words.place() + ": ", "a CSV file of head motion"), path.string(), axes);
        if (motion_skip_s_ > head_motion_->lastTime()) {
            words.fail("the seconds to skip are {}, must be at most {}, the recording's length", motion_skip_s_, head_motion_->lastTime());
        }
    }

    void parseController(Words& words) {
        const Side side = words.side();
        addPose(words, grips_[side], Script().hands[side].stage_from_grip.at(0.0));
    }

    void parseAim(Words& words) {
        const Side side = words.side();
        requireFirst(words, side == kLeft ? "aim left" : "aim right");
        script_.hands[side].grip_from_aim = parsePose(words, {});
    }

    std::string inputName(Words& words, Script::Hand& hand) {
        const std::string name = words.text("the input");
        if (!kindOfInput(name)) {
            std::string known;
            for (const auto& [one, kind] : kInputs) { known += (known.empty() ? "" : ", ") + std::string(one); }
            words.fail("{} is not an input, must be one of: {}", shown(name), known);
        }
        hand.input_places.try_emplace(name, words.place());
        return name;
    }

    void addPress(Words& words, bool touch_only) {
        Script::Hand& hand = script_.hands[words.side()];
        std::string input = inputName(words, hand);
        const double from_s = words.time("the time from which on");
        const double to_s = words.time("the time until which");
        if (from_s >= to_s) { words.fail("it lasts from {} to {}, must end after it begins", from_s, to_s); }
        hand.presses.push_back({std::move(input), from_s, to_s, touch_only});
    }
    void parsePress(Words& words) { addPress(words, false); }
    void parseTouch(Words& words) { addPress(words, true); }

    void parseAxis(Words& words) {
        Script::Hand& hand = script_.hands[words.side()];
        const std::string input = inputName(words, hand);
        const InputKind kind = *kindOfInput(input);
        if (kind == InputKind::kButton) { words.fail("{} has no axis, must be trigger, squeeze, thumbstick or trackpad", input); }
        const double time_s = words.time();
        glm::dvec2 value(0.0);
        if (kind == InputKind::kStick) {
            value.x = words.number("the axis to the right", -1.0, 1.0);
            value.y = words.number("the axis upwards", -1.0, 1.0);
        } else {
            value.x = words.number("the value", 0.0, 1.0);
        }
        Track<glm::dvec2>& track = hand.axes[input];
        if (!track.add(time_s, value)) { words.fail("the time is {}, must be after the key before, at {}", time_s, track.lastTime()); }
    }

    template <typename Value>
    void addStep(Words& words, Steps<Value>& steps, double time_s, const Value& value) {
        if (!steps.add(time_s, value)) { words.fail("the time is {}, must be after the one of the same change before", time_s); }
    }

    void parseAt(Words& words) {
        double time_s = words.time();
        if (last_at_s_ && time_s < *last_at_s_) {
            words.fail("the time is {}, must not be before the `at` before, at {}", time_s, *last_at_s_);
        }
        last_at_s_ = time_s;
        const auto addEvent = [&](ScriptEvent::Kind kind, std::uint32_t count = 1) { script_.events.push_back({time_s, kind, count}); };
        switch (words.choice("what happens", {"should-render", "visible", "focused", "slow-images", "lose-session", "lose-instance", "exit",
                                              "eye", "controller", "worn", "head", "recentre", "present", "rate", "gpu-load", "gaze"})) {
            case 0:
                return addStep(words, script_.should_render, time_s, words.onOff("whether to render"));
            case 1:
                return addStep(words, script_.visible, time_s, words.onOff("whether it is visible"));
            case 2:
                return addStep(words, script_.focused, time_s, words.onOff("whether it has the focus"));
            case 3:
                return addEvent(ScriptEvent::Kind::kSlowImages,
                                static_cast<std::uint32_t>(words.count("the number of slow images", 1, 1000000)));
            case 4:
                return addEvent(ScriptEvent::Kind::kLoseSession);
            case 5:
                return addEvent(ScriptEvent::Kind::kLoseInstance);
            case 6:
                return addEvent(ScriptEvent::Kind::kExit);
            case 7: {
                const Side side = words.side();
                (void)words.choice("what changes", {"angles"});
                return addStep(words, script_.fovs[side], time_s, words.angles());
            }
            case 8: {
                const Side side = words.side();
                return addStep(words, script_.hands[side].tracked, time_s, words.onOff("whether it is tracked"));
            }
            case 9:
                return addStep(words, script_.worn, time_s, words.onOff("whether it is worn"));
            case 10: {
                const std::size_t known = words.choice("whether it is tracked", {"on", "off", "turn-only"});
                addStep(words, script_.head_turn_known, time_s, known != 1);
                return addStep(words, script_.head_place_known, time_s, known == 0);
            }
            case 11:
                script_.recentres_s.push_back(time_s);
                // The program is told before.
                time_s -= ScriptEvent::kNoticeSeconds;
                script_.events.insert(std::ranges::upper_bound(script_.events, time_s, {}, &ScriptEvent::time_s),
                                      {time_s, ScriptEvent::Kind::kRecentre, 1});
                return;
            case 12:
                return addStep(words, script_.present, time_s, words.onOff("whether somebody wears the headset"));
            case 13:
                script_.events.push_back({time_s, ScriptEvent::Kind::kRate, 1, words.number(kRateMeaning, kLeastRate, kMostRate)});
                return;
            case 14:
                return addStep(words, script_.gpu_load, time_s, parseLoad(words));
            default:
                return parseGazeTracking(words, time_s, script_.gaze);
        }
    }

    void parseExtension(Words& words) {
        const std::string name = words.text("the extension's name");
        if (!isExtension(name)) {
            std::string known;
            for (const Extension& extension : kExtensions) { known += (known.empty() ? "" : ", ") + std::string(extension.name); }
            words.fail("{} is no extension of this runtime, must be one of: {}", shown(name), known);
        }
        (void)words.choice("what to do with it", {"off"});
        if (!script_.extensions_off.insert(name).second) { words.fail("{} is off already, must be named once", shown(name)); }
    }

    void parseProfile(Words& words) {
        requireFirst(words, "profile");
        const std::string name = words.text("the controllers' profile");
        if (findHandProfile(name) == nullptr) {
            words.fail("{} is not a profile of controllers, must be one of: {}", shown(name), handProfiles());
        }
        script_.profile = name;
    }

    void parsePlugged(Words& words) {
        requireFirst(words, "plugged");
        script_.plugged = words.onOff("whether the headset is plugged in");
    }

    void parseBlendModes(Words& words) {
        requireFirst(words, "blend-modes");
        script_.blend_modes.clear();
        do {
            const auto mode = static_cast<Script::BlendMode>(words.choice("a blend mode", {"opaque", "additive", "alpha-blend"}));
            if (std::ranges::find(script_.blend_modes, mode) != script_.blend_modes.end()) {
                words.fail("a blend mode stands there twice, must be named once");
            }
            script_.blend_modes.push_back(mode);
        } while (!words.isAtEnd());
    }

    void parseRoomColour(Words& words) {
        requireFirst(words, "room-colour");
        for (int c = 0; c < 3; ++c) { script_.room_colour[c] = words.number("the room's colour", 0.0, 1.0); }
    }

    void parseMask(Words& words) {
        requireFirst(words, "visibility-mask");
        const std::size_t choice = words.choice("whether there is a mask", {"on", "off", "broken"});
        script_.visibility_mask = choice == 0;
        script_.visibility_mask_is_broken = choice == 2;
    }

    void parseVulkanAdditions(Words& words) {
        requireFirst(words, "vulkan-additions");
        script_.adds_vulkan_features = words.onOff("whether the runtime asks for Vulkan features of its own");
    }

    void parseLocal(Words& words) {
        requireFirst(words, "local");
        script_.stage_from_local = parsePose(words, {});
    }

    void parseStage(Words& words) {
        requireFirst(words, "stage");
        script_.has_stage = words.onOff("whether there is a STAGE");
    }

    void parseNoHeadset(Words& words) {
        requireFirst(words, "no-headset-for");
        script_.calls_without_headset = static_cast<std::uint32_t>(words.count("the number of calls", 1, 1000000));
    }

    void parseRefusedDepth(Words& words) {
        requireFirst(words, "refuse-depth");
        const bool images = words.choice("what is refused", {"images", "layers"}) == 0;
        script_.depth = images ? Script::Depth::kNoImages : Script::Depth::kNoLayers;
    }

    void parseFrames(Words& words) {
        requireFirst(words, "frames");
        constexpr std::uint64_t kMost = 1'000'000'000;
        if (words.takeIf("none")) {
            script_.writes_pictures = false;
            return;
        }
        if (words.takeIf("all")) { return; }
        bool is_given = false;
        if (words.takeIf("from")) {
            script_.frames.first = words.count("the first frame", 0, kMost);
            if (!words.takeIf("to")) { words.fail("the last frame is missing, must be from A to B"); }
            script_.frames.last = words.count("the last frame", script_.frames.first, kMost);
            is_given = true;
        }
        if (words.takeIf("every")) {
            script_.frames.every = words.count("how many frames apart", 1, kMost);
            is_given = true;
        }
        if (!is_given) { words.fail("the frames are missing, must be all, none, every N, or from A to B [every N]"); }
    }

    // The recording's first pose lies where the head line says, facing there; its tilt is as recorded.
    void finishPoses() {
        for (const Side side : kSides) {
            if (!grips_[side].empty()) { script_.hands[side].stage_from_grip = grips_[side]; }
        }
        if (!head_.empty()) { script_.stage_from_head = head_; }
        if (!head_motion_) { return; }
        const Pose stage_from_start = levelled(script_.stage_from_head.at(0.0));
        const Pose start_from_recording = inverse(levelled(head_motion_->at(motion_skip_s_)));
        const Pose stage_from_recording = compose(stage_from_start, start_from_recording);
        script_.stage_from_head = Track<Pose>();
        script_.stage_from_head.add(motion_start_s_, compose(stage_from_recording, head_motion_->at(motion_skip_s_)));
        for (const auto& [time_s, pose] : head_motion_->keys()) {
            if (time_s <= motion_skip_s_) { continue; }
            script_.stage_from_head.add(motion_start_s_ + time_s - motion_skip_s_, compose(stage_from_recording, pose));
        }
    }

    std::string name_;
    fs::path folder_;
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

}  // namespace

Script Script::parse(std::string_view text, const std::string& name) { return Parser(name).parse(text); }

Script Script::load(const fs::path& path) { return parse(readText(path, "", "a script"), path.string()); }

}  // namespace simulated
