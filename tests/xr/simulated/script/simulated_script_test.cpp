// Facts about the simulated headset's scripts: what they say at a time.
#include "tests/shared_data.h"
#include "xr/simulated/extensions.h"
#include "xr/simulated/script/script.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <numbers>
#include <string>

TEST_SUITE_BEGIN("simulated_script");

namespace simulated_script_test {

using namespace simulated;

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
const double kHalfRoot = std::sqrt(0.5);
const double kForever = std::numeric_limits<double>::infinity();

Script parse(const std::string& text) { return Script::parse(text, "test.script"); }

bool isNear(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-12) { return glm::length(a - b) <= tolerance; }
// q and -q turn alike.
bool isNear(const glm::dquat& a, const glm::dquat& b, double tolerance = 1e-12) { return 1.0 - std::abs(glm::dot(a, b)) <= tolerance; }

glm::dvec3 forwardOf(const Pose& pose) { return pose.orientation * glm::dvec3(0.0, 0.0, -1.0); }

// A file beside which scripts can stand; gone with the test.
struct Folder {
    std::filesystem::path path = std::filesystem::temp_directory_path() / ("binosplat_script_" + std::to_string(::getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() { std::filesystem::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    void write(const std::string& name, const std::string& text) const { std::ofstream(path / name) << text; }
    [[nodiscard]] Script script(const std::string& text) const { return Script::parse(text, (path / "a.script").string()); }
};

}  // namespace

TEST_CASE("an empty script is the resting headset") {
    const Script script = parse("");
    CHECK(script.rate_hz == 90.0);
    CHECK(script.size_px == glm::uvec2(1024, 1024));
    CHECK_FALSE(script.visibility_mask);
    const State state = script.at(12.5);
    CHECK(state.stage_from_head.position == glm::dvec3(0.0, 1.6, 0.0));
    CHECK(isNear(forwardOf(state.stage_from_head), {0.0, 0.0, -1.0}));
    CHECK(isNear(state.eyes[kLeft].stage_from_eye.position, {-0.0315, 1.6, 0.0}));
    CHECK(isNear(state.eyes[kRight].stage_from_eye.position, {0.0315, 1.6, 0.0}));
    CHECK(state.eyes[kLeft].fov.left_rad == doctest::Approx(-45.0 * kDegree));
    CHECK(state.eyes[kRight].fov.up_rad == doctest::Approx(45.0 * kDegree));
    CHECK(state.controllers[kLeft].tracked);
    CHECK(state.controllers[kLeft].stage_from_grip.position.x < 0.0);
    CHECK(state.controllers[kRight].stage_from_grip.position.x > 0.0);
    CHECK(state.should_render);
    CHECK(script.eventsIn(-kForever, kForever).empty());
}

TEST_CASE("comments, blanks and carriage returns do not count") {
    const Script script = parse("\xef\xbb\xbf# a comment\r\n\r\n \t rate  72 # another\r\nsize 640\t480#and another");
    CHECK(script.rate_hz == 72.0);
    CHECK(script.size_px == glm::uvec2(640, 480));
}

TEST_CASE("head keys move on straight lines") {
    const Script script = parse("head 1 position 0 1 0\nhead 3 position 4 2 -8\n");
    CHECK(script.at(0.0).stage_from_head.position == glm::dvec3(0.0, 1.0, 0.0));
    CHECK(isNear(script.at(1.5).stage_from_head.position, {1.0, 1.25, -2.0}));
    CHECK(isNear(script.at(2.0).stage_from_head.position, {2.0, 1.5, -4.0}));
    CHECK(script.at(3.0).stage_from_head.position == glm::dvec3(4.0, 2.0, -8.0));
    CHECK(script.at(9.0).stage_from_head.position == glm::dvec3(4.0, 2.0, -8.0));
}

TEST_CASE("orientations move on great arcs") {
    // From ahead to a quarter turn to the left (+90 degrees about y): a third of the way is 30 degrees, looking along (-1/2, 0, -cos 30).
    const Script script = parse("head 0 rotation 0 0 0 1\nhead 3 rotation 0 0.70710678118654752 0 0.70710678118654752");
    CHECK(isNear(forwardOf(script.at(1.0).stage_from_head), {-0.5, 0.0, -std::sqrt(0.75)}));
    CHECK(isNear(forwardOf(script.at(3.0).stage_from_head), {-1.0, 0.0, 0.0}));
}

TEST_CASE("orientations take the shorter arc") {
    // -q is the same rotation as q: half-way between q and -q' with q' 90 degrees on is still 45 degrees.
    const Script script = parse("head 0 rotation 0 0 0 1\nhead 1 rotation 0 -0.70710678118654752 0 -0.70710678118654752");
    CHECK(isNear(forwardOf(script.at(0.5).stage_from_head), {-kHalfRoot, 0.0, -kHalfRoot}));
}

TEST_CASE("rotations are made to length one") {
    const Script script = parse("head 0 rotation 0 3 0 3");
    CHECK(isNear(script.at(0.0).stage_from_head.orientation, glm::dquat(kHalfRoot, 0.0, kHalfRoot, 0.0)));
}

TEST_CASE("looks go to a point of the room upright") {
    const Pose down = parse("head 0 position 1 2 3 look 1 0 1").at(0).stage_from_head;
    CHECK(isNear(forwardOf(down), glm::dvec3(0.0, -1.0, -1.0) / std::sqrt(2.0)));
    // Upright: the right-hand side stays level.
    const Pose askew = parse("head 0 position 0 1 0 look 3 5 -2").at(0).stage_from_head;
    CHECK(isNear(forwardOf(askew), glm::normalize(glm::dvec3(3.0, 4.0, -2.0))));
    CHECK(std::abs((askew.orientation * glm::dvec3(1, 0, 0)).y) < 1e-12);
    CHECK(isNear(forwardOf(parse("head 0 position 0 1 0 look 0 9 0").at(0).stage_from_head), {0.0, 1.0, 0.0}));
    // From where the head is said to be before.
    CHECK(isNear(forwardOf(parse("head 0 position 5 1 0\nhead 1 look 6 1 0").at(1).stage_from_head), {1.0, 0.0, 0.0}));
}

TEST_CASE("turns go left then up") {
    CHECK(isNear(forwardOf(parse("head 0 turn 90 0").at(0).stage_from_head), {-1.0, 0.0, 0.0}));
    CHECK(isNear(forwardOf(parse("head 0 turn 0 90").at(0).stage_from_head), {0.0, 1.0, 0.0}));
    // Up by 30 degrees after a quarter to the left.
    CHECK(isNear(forwardOf(parse("head 0 turn 90 30").at(0).stage_from_head), {-std::sqrt(0.75), 0.5, 0.0}));
}

TEST_CASE("what a pose leaves out stays as it was") {
    const Script script = parse("head 0 position 1 2 3 turn 90 0\nhead 1 position 4 5 6\nhead 2 turn 0 0");
    CHECK(isNear(forwardOf(script.at(1.0).stage_from_head), {-1.0, 0.0, 0.0}));
    CHECK(script.at(2.0).stage_from_head.position == glm::dvec3(4.0, 5.0, 6.0));
    CHECK(parse("head 0 turn 5 0").at(0.0).stage_from_head.position == glm::dvec3(0.0, 1.6, 0.0));
}

TEST_CASE("eyes turn outwards and stand beside the nose") {
    const Script script = parse("ipd 0.07\neye left cant 10\neye right cant 5\nhead 0 position 0 0 0 turn 90 0");
    const State state = script.at(0.0);
    // The wearer looks along -x; to the left of that is +z.
    CHECK(isNear(state.eyes[kLeft].stage_from_eye.position, {0.0, 0.0, 0.035}));
    CHECK(isNear(state.eyes[kRight].stage_from_eye.position, {0.0, 0.0, -0.035}));
    CHECK(isNear(forwardOf(state.eyes[kLeft].stage_from_eye), {-std::cos(10 * kDegree), 0.0, std::sin(10 * kDegree)}));
    CHECK(isNear(forwardOf(state.eyes[kRight].stage_from_eye), {-std::cos(5 * kDegree), 0.0, -std::sin(5 * kDegree)}));
}

TEST_CASE("eye angles are left, right, up, down") {
    const Fov fov = parse("eye right angles -40 54 44 -55").at(0.0).eyes[kRight].fov;
    CHECK(fov == Fov{-40 * kDegree, 54 * kDegree, 44 * kDegree, -55 * kDegree});
}

TEST_CASE("angles change at their time") {
    const Script script = parse("eye left angles -40 40 40 -40\nat 1 eye left angles -30 30 30 -30\nat 2 eye left angles -20 20 20 -20");
    const auto left = [&](double time_s) { return script.at(time_s).eyes[kLeft].fov.left_rad / kDegree; };
    CHECK(left(0.999) == doctest::Approx(-40.0));
    CHECK(left(1.0) == doctest::Approx(-30.0));
    CHECK(left(1.999) == doctest::Approx(-30.0));
    CHECK(left(2.0) == doctest::Approx(-20.0));
    CHECK(script.at(5.0).eyes[kRight].fov.left_rad / kDegree == doctest::Approx(-45.0));
}

TEST_CASE("LOCAL stands where the head is at time zero without its tilt") {
    const Script script = parse("head -1 position 0 0 0 turn 0 0\nhead 1 position 2 3.2 0 turn 60 0");
    const Pose local = script.stageFromLocal();
    CHECK(isNear(local.position, {1.0, 1.6, 0.0}));
    CHECK(isNear(forwardOf(local), {-0.5, 0.0, -std::sqrt(0.75)}));
    CHECK(isNear(forwardOf(parse("head 0 turn 90 40").stageFromLocal()), {-1.0, 0.0, 0.0}));
}

TEST_CASE("LOCAL stands where the script says until it is recentred") {
    const Script script =
        parse("local position 3 0.5 1 turn 90 0\nhead 0 position 0 1.6 0\nhead 2 position 2 1.6 0 turn 0 30\nat 1 recentre\nat 2 recentre");
    CHECK(isNear(script.stageFromLocal(0.999).position, {3.0, 0.5, 1.0}));
    CHECK(isNear(forwardOf(script.stageFromLocal(0.0)), {-1.0, 0.0, 0.0}));
    CHECK(isNear(script.stageFromLocal(1.0).position, {1.0, 1.6, 0.0}));
    CHECK(isNear(script.stageFromLocal(9.0).position, {2.0, 1.6, 0.0}));
    CHECK(isNear(forwardOf(script.stageFromLocal(9.0)), {0.0, 0.0, -1.0}));
    CHECK(script.eventsIn(0.5, 1.5).size() == 1);
    CHECK(script.eventsIn(0.5, 1.5).at(0).kind == ScriptEvent::Kind::kRecentre);
}

TEST_CASE("what is known of the head and whether it is worn change at their time") {
    const Script script = parse("at 1 head off\nat 2 head turn-only\nat 3 head on\nat 4 worn off\nat 5 worn on");
    const auto known = [&](double time_s) {
        const State state = script.at(time_s);
        return std::pair(state.head_turn_known, state.head_place_known);
    };
    CHECK((known(0.5) == std::pair(true, true)));
    CHECK((known(1.5) == std::pair(false, false)));
    CHECK((known(2.5) == std::pair(true, false)));
    CHECK((known(3.5) == std::pair(true, true)));
    CHECK(script.at(3.9).worn);
    CHECK_FALSE(script.at(4.5).worn);
    CHECK(script.at(5.0).worn);
}

TEST_CASE("controllers move and aim from their grip") {
    const Script script =
        parse("controller right 0 position 0 1 0 turn 90 0\ncontroller right 2 position 0 3 0\naim right position 0 0 -0.1 turn 0 90\n");
    const ControllerState right = script.at(1.0).controllers[kRight];
    CHECK(isNear(right.stage_from_grip.position, {0.0, 2.0, 0.0}));
    // Ahead of a hand that is turned to the left is -x.
    CHECK(isNear(right.stage_from_aim.position, {-0.1, 2.0, 0.0}));
    CHECK(isNear(forwardOf(right.stage_from_aim), {0.0, 1.0, 0.0}));
    CHECK(isNear(script.at(1.0).controllers[kLeft].stage_from_grip.position, {-0.2, 1.2, -0.35}));
}

TEST_CASE("presses last from their beginning until before their end") {
    const Script script = parse("press right trigger 1 2\npress left a 1 2");
    const auto right = [&](double time_s, const char* input) { return script.at(time_s).controllers[kRight].input(input); };
    CHECK(right(0.999, "trigger/value") == 0.0);
    CHECK(right(1.0, "trigger/value") == 1.0);
    CHECK(right(1.5, "trigger/click") == 1.0);
    CHECK(right(1.5, "trigger/touch") == 1.0);
    CHECK(right(2.0, "trigger/value") == 0.0);
    CHECK(right(1.5, "squeeze/value") == 0.0);
    CHECK(right(1.5, "a/click") == 0.0);
    CHECK(script.at(1.5).controllers[kLeft].input("a/click") == 1.0);
    CHECK(script.at(1.5).controllers[kLeft].inputs.count("a/value") == 0);
}

TEST_CASE("gestures have a value and are ready") {
    const Script script = parse("press right pinch_ext 1 2\ntouch right pinch_ext 3 4\naxis left grasp_ext 0 0\naxis left grasp_ext 1 1");
    const auto right = [&](double time_s, const char* input) { return script.at(time_s).controllers[kRight].input(input); };
    CHECK(right(1.5, "pinch_ext/value") == 1.0);
    CHECK(right(1.5, "pinch_ext/ready_ext") == 1.0);
    CHECK(right(3.5, "pinch_ext/value") == 0.0);
    CHECK(right(3.5, "pinch_ext/ready_ext") == 1.0);
    CHECK(script.at(0.5).controllers[kLeft].input("grasp_ext/value") == doctest::Approx(0.5));
    CHECK(script.at(0.5).controllers[kLeft].input("grasp_ext/ready_ext") == 1.0);
}

TEST_CASE("touches do not press") {
    const ControllerState left = parse("touch left thumbstick 0 1").at(0.5).controllers[kLeft];
    CHECK(left.input("thumbstick/touch") == 1.0);
    CHECK(left.input("thumbstick/click") == 0.0);
}

TEST_CASE("axes are linear between their times") {
    const Script script = parse("axis left thumbstick 0 -1 0\naxis left thumbstick 4 1 0.5\naxis left squeeze 0 0\naxis left squeeze 1 1");
    const auto left = [&](double time_s, const char* input) { return script.at(time_s).controllers[kLeft].input(input); };
    CHECK(left(1.0, "thumbstick/x") == doctest::Approx(-0.5));
    CHECK(left(1.0, "thumbstick/y") == doctest::Approx(0.125));
    CHECK(left(9.0, "thumbstick/x") == 1.0);
    CHECK(left(1.0, "thumbstick/touch") == 1.0);
    CHECK(left(0.25, "squeeze/value") == doctest::Approx(0.25));
    CHECK(left(0.25, "squeeze/touch") == 1.0);
    CHECK(left(0.89, "squeeze/click") == 0.0);
    CHECK(left(0.91, "squeeze/click") == 1.0);
    CHECK(left(0.0, "squeeze/touch") == 0.0);
}

TEST_CASE("a controller that is not tracked rests") {
    const Script script = parse("press right trigger 0 9\nat 1 controller right off\nat 2 controller right on");
    CHECK(script.at(0.5).controllers[kRight].tracked);
    CHECK_FALSE(script.at(1.0).controllers[kRight].tracked);
    CHECK(script.at(1.5).controllers[kRight].input("trigger/value") == 0.0);
    CHECK(script.at(2.0).controllers[kRight].input("trigger/value") == 1.0);
    CHECK(script.at(1.5).controllers[kLeft].tracked);
}

TEST_CASE("rendering, visibility and focus change at their times") {
    const Script script = parse("at 1 should-render off\nat 2 visible off\nat 2 should-render on\nat 3 focused off");
    CHECK(script.at(0.9).should_render);
    CHECK_FALSE(script.at(1.0).should_render);
    CHECK(script.at(2.0).should_render);
    CHECK_FALSE(script.at(2.0).visible);
    CHECK(script.at(2.0).focused);
    CHECK_FALSE(script.at(3.0).focused);
}

TEST_CASE("events happen once in the frame that reaches them") {
    const Script script = parse("at -1 slow-images 3\nat 1 lose-session\nat 1 lose-instance\nat 2 exit");
    const auto first = script.eventsIn(-kForever, 0.0);
    REQUIRE(first.size() == 1);
    CHECK(first[0].kind == ScriptEvent::Kind::kSlowImages);
    CHECK(first[0].count == 3);
    CHECK(script.eventsIn(0.0, 0.999).empty());
    const auto at_one = script.eventsIn(0.999, 1.0);
    REQUIRE(at_one.size() == 2);
    CHECK(at_one[0].kind == ScriptEvent::Kind::kLoseSession);
    CHECK(at_one[1].kind == ScriptEvent::Kind::kLoseInstance);
    CHECK(script.eventsIn(1.0, 1.5).empty());
    CHECK(script.eventsIn(1.5, 7.0).size() == 1);
    CHECK(std::string(nameOf(ScriptEvent::Kind::kExit)) == "exit");
}

TEST_CASE("frames are chosen by number") {
    const auto chosen = [](const std::string& text) {
        const Script script = parse(text);
        std::string frames;
        for (std::uint64_t frame = 0; frame < 10; ++frame) {
            if (script.writes_pictures && script.frames.contains(frame)) { frames += std::to_string(frame); }
        }
        return frames;
    };
    CHECK(chosen("") == "0123456789");
    CHECK(chosen("frames all") == "0123456789");
    CHECK(chosen("frames none").empty());
    CHECK(chosen("frames every 4") == "048");
    CHECK(chosen("frames from 3 to 5") == "345");
    CHECK(chosen("frames from 1 to 8 every 3") == "147");
}

TEST_CASE("extensions and the mask can be switched") {
    const Script script = parse("extension XR_KHR_visibility_mask off\nvisibility-mask on");
    CHECK_FALSE(script.allowsExtension("XR_KHR_visibility_mask"));
    CHECK(script.allowsExtension("XR_KHR_vulkan_enable2"));
    CHECK(script.visibility_mask);
}

TEST_CASE("headset files give size, distance, canting and angles") {
    const Script script = Script::parse("headset index.toml\nipd 0.064", std::string(BINOSPLAT_SOURCE_DIR) + "/configs/headsets/a.script");
    CHECK(script.system_name == "Valve Index");
    CHECK(script.size_px == glm::uvec2(2468, 2740));
    CHECK(script.eye_distance_m == 0.064);
    const State state = script.at(0.0);
    CHECK(state.eyes[kLeft].fov.left_rad == doctest::Approx(-51.9821 * kDegree));
    CHECK(state.eyes[kRight].fov.down_rad == doctest::Approx(-54.6016 * kDegree));
    CHECK(isNear(forwardOf(state.eyes[kLeft].stage_from_eye), {-std::sin(5 * kDegree), 0.0, -std::cos(5 * kDegree)}));
}

TEST_CASE("an inset has an angle and sizes, which follow from the eyes' where nobody says them") {
    const Script usual = Script::parse("size 1000 800", "a.script");
    CHECK(usual.contextSizePx() == glm::uvec2(500, 400));
    // tan 20 is 0.36397.
    CHECK(usual.insetSizePx() == glm::uvec2(364, 292));
    const Script small = Script::parse("size 1000 800\ninset 10 context 300 200", "a.script");
    CHECK(small.contextSizePx() == glm::uvec2(300, 200));
    CHECK(small.insetSizePx() == glm::uvec2(177, 142));
    CHECK(Script::parse("inset 10 size 300 200", "a.script").insetSizePx() == glm::uvec2(300, 200));
}

TEST_CASE("insets lie where a headset's lenses have their middles, while there is no gaze") {
    Script script = Script::parse("eye-tracking off", "a.script");
    script.lens_centres_rad = {glm::dvec2(0.1, -0.2), glm::dvec2(-0.1, -0.2)};
    const Fov left = script.findInset(script.at(0.0), kLeft), right = script.findInset(script.at(0.0), kRight);
    CHECK(0.5 * (left.left_rad + left.right_rad) == doctest::Approx(0.1));
    CHECK(0.5 * (left.up_rad + left.down_rad) == doctest::Approx(-0.2));
    CHECK(0.5 * (right.left_rad + right.right_rad) == doctest::Approx(-0.1));
}

TEST_CASE("every headset of the project is read") {
    std::size_t headsets = 0;
    for (const auto& entry : std::filesystem::directory_iterator(std::string(BINOSPLAT_SOURCE_DIR) + "/configs/headsets")) {
        INFO(entry.path().string());
        CHECK_NOTHROW((void)Script::parse("headset " + entry.path().filename().string(), (entry.path().parent_path() / "a").string()));
        ++headsets;
    }
    CHECK(headsets >= 10);
}

TEST_CASE("recorded motion starts where the head line says and keeps its tilt") {
    const Folder folder;
    // A recording that faces a quarter turn to the left and moves 1 m ahead of there: that is ahead of the wearer, too. Its second
    // pose also looks up by 60 degrees.
    folder.write("m.csv",
                 "time_s,x,y,z,qx,qy,qz,qw\n10,5,1,5,0,0.70710678118654752,0,0.70710678118654752\n"
                 "11,4,1.5,5,0.35355339059327373,0.61237243569579447,-0.35355339059327373,0.61237243569579447\n");
    const Script script = folder.script("head 0 position 0 1.6 0\nhead-motion m.csv start 2");
    CHECK(isNear(script.at(0.0).stage_from_head.position, {0.0, 1.6, 0.0}));
    CHECK(isNear(forwardOf(script.at(2.0).stage_from_head), {0.0, 0.0, -1.0}));
    CHECK(isNear(script.at(2.5).stage_from_head.position, {0.0, 1.85, -0.5}, 1e-9));
    CHECK(isNear(script.at(9.0).stage_from_head.position, {0.0, 2.1, -1.0}, 1e-9));
    CHECK(isNear(forwardOf(script.at(3.0).stage_from_head), {0.0, std::sqrt(0.75), -0.5}, 1e-9));
}

TEST_CASE("a recording that begins tilted stays tilted as it was") {
    const Folder folder;
    // Looks up by 60 degrees at first and moves a metre up: up in STAGE, too, and not along the tilted head's axes.
    folder.write("m.csv", "0,0,0,0,0.5,0,0,0.86602540378443865\n1,0,1,0,0,0,0,1\n");
    const Script script = folder.script("head 0 position 0 1.6 0\nhead-motion m.csv");
    CHECK(isNear(forwardOf(script.at(0.0).stage_from_head), {0.0, std::sqrt(0.75), -0.5}, 1e-9));
    CHECK(isNear(script.at(1.0).stage_from_head.position, {0.0, 2.6, 0.0}, 1e-9));
    CHECK(isNear(forwardOf(script.at(1.0).stage_from_head), {0.0, 0.0, -1.0}, 1e-9));
}

TEST_CASE("Unity recordings are mirrored") {
    const Folder folder;
    // Left-handed with z ahead: a positive turn about y looks right, and +z is ahead.
    folder.write("m.csv", "0,0,0,0,0,0,0,1\n1,1,0,2,0,0.70710678118654752,0,0.70710678118654752\n");
    const State state = folder.script("head 0 position 0 0 0\nhead-motion m.csv axes unity").at(1.0);
    CHECK(isNear(state.stage_from_head.position, {1.0, 0.0, -2.0}));
    CHECK(isNear(forwardOf(state.stage_from_head), {1.0, 0.0, 0.0}));
}

TEST_CASE("the beginning of a recording can be skipped") {
    const Folder folder;
    folder.write("m.csv", "0,0,0,0,0,0,0,1\n2,2,0,0,0,0,0,1\n4,2,0,8,0,0,0,1\n");
    const Script script = folder.script("head 0 position 0 0 0\nhead-motion m.csv skip 1");
    CHECK(isNear(script.at(0.0).stage_from_head.position, {0.0, 0.0, 0.0}));
    CHECK(isNear(script.at(1.0).stage_from_head.position, {1.0, 0.0, 0.0}));
    CHECK(isNear(script.at(2.0).stage_from_head.position, {1.0, 0.0, 4.0}));
}

TEST_CASE("recordings in ticks are read" * binosplat::test::needsSharedData()) {
    const auto data = binosplat::test::sharedData();
    if (!data) { return; }
    const Script script = Script::parse("head-motion User3.csv axes unity", (*data / "headmotion" / "a.script").string());
    // The second line comes 15.9744 ms after the first, 3.2 mm away from it; it is half there at half the time.
    const auto walked = [&](double time_s) {
        return glm::length(script.at(time_s).stage_from_head.position - script.at(0.0).stage_from_head.position);
    };
    const double whole = glm::length(glm::dvec3(0.111800678 - 0.110972665, 0.0893199742 - 0.08962741, 0.092439 - 0.09279076));
    CHECK(walked(0.0159744) == doctest::Approx(whole).epsilon(1e-6));
    CHECK(walked(0.0079872) == doctest::Approx(0.5 * whole).epsilon(1e-6));
    CHECK(script.at(0.0).stage_from_head.position == glm::dvec3(0.0, 1.6, 0.0));
}

TEST_CASE("the same time gives the same state") {
    const Script script = Script::load(std::string(BINOSPLAT_SOURCE_DIR) + "/configs/simulated/walk.script");
    const State once = script.at(1.7);
    (void)script.at(3.0);
    const State again = script.at(1.7);
    CHECK(once.stage_from_head.position == again.stage_from_head.position);
    CHECK(once.controllers[kRight].stage_from_aim.orientation == again.controllers[kRight].stage_from_aim.orientation);
    CHECK(script.eventsIn(-kForever, kForever).back().kind == ScriptEvent::Kind::kExit);
}

TEST_CASE("the gaze moves from key to key on the head and may be lost") {
    const Script script = parse("head 0 turn 90 0\ngaze 1 0 0\ngaze 2 20 -10\nat 3 gaze degraded\nat 4 gaze off\nat 5 gaze on\n");
    const auto onHead = [](const State& state) {
        return transform(inverse(state.stage_from_head), transform(state.device(kGaze).stage_from_aim, {0, 0, -1}));
    };
    CHECK(glm::distance(onHead(script.at(0.0)), {0, 0, -1}) < 1e-9);
    const double yaw = glm::radians(10.0), pitch = glm::radians(-5.0);
    CHECK(glm::distance(onHead(script.at(1.5)), {-std::sin(yaw) * std::cos(pitch), std::sin(pitch), -std::cos(yaw) * std::cos(pitch)}) <
          1e-9);
    CHECK(script.at(2.5).gaze_is_good);
    CHECK_FALSE(script.at(3.5).gaze_is_good);
    CHECK(script.at(3.5).device(kGaze).tracked);
    CHECK_FALSE(script.at(4.5).device(kGaze).tracked);
    CHECK(script.at(5.5).device(kGaze).tracked);
    CHECK(parse("").gaze.tracker == EyeTracking::kOn);
    CHECK(glm::distance(onHead(parse("").at(1.0)), {0, 0, -1}) < 1e-9);
    CHECK_FALSE(parse("eye-tracking refused").at(0.0).device(kGaze).tracked);
}

TEST_CASE("the documented example is the file") {
    const std::string root = BINOSPLAT_SOURCE_DIR;
    const auto readAll = [](const std::string& path) {
        std::ifstream stream(path);
        return std::string{std::istreambuf_iterator<char>(stream), {}};
    };
    const std::string page = readAll(root + "/docs/simulated_script.md"), example = readAll(root + "/configs/simulated/walk.script");
    REQUIRE(example.size() > 100);
    CHECK(page.find("```\n" + example + "```\n") != std::string::npos);
    // The list of commands comes from the message about one that does not exist.
    std::string known;
    try {
        (void)parse("?");
    } catch (const ScriptError& error) { known = error.what(); }
    known = known.substr(known.rfind(": ") + 2);
    std::size_t commands = 0;
    for (std::size_t begin = 0; begin < known.size(); ++commands) {
        const std::size_t end = std::min(known.find(", ", begin), known.size());
        const std::string command = known.substr(begin, end - begin);
        INFO(command);
        CHECK(page.find("`" + command + " ") != std::string::npos);
        begin = end + 2;
    }
    CHECK(commands == 32);
}

TEST_CASE("every extension of the runtime is documented") {
    std::ifstream stream(std::string(BINOSPLAT_SOURCE_DIR) + "/docs/openxr_runtime.md");
    const std::string page{std::istreambuf_iterator<char>(stream), {}};
    for (const Extension& extension : kExtensions) {
        INFO(extension.name);
        CHECK(page.find(std::string("`").append(extension.name).append("`")) != std::string::npos);
    }
}

TEST_CASE("every script that comes along is one") {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(std::string(BINOSPLAT_SOURCE_DIR) + "/configs/simulated")) {
        CAPTURE(entry.path().string());
        CHECK_NOTHROW(Script::load(entry.path()));
        ++count;
    }
    CHECK(count >= 2);
}

}  // namespace simulated_script_test
