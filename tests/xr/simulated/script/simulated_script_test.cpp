// Facts about the simulated headset's scripts: what they say at a time.
#include "tests/xr/simulated/folder.h"
#include "xr/simulated/script/script.h"

SUITE(simulated_script) {

using namespace simulated;

constexpr double kDegree = std::numbers::pi / 180.0;
const double kHalfRoot = std::sqrt(0.5);
const double kForever = std::numeric_limits<double>::infinity();

Script parse(const std::string& text) { return Script::parse(text, "test.script"); }

bool isNear(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-12) { return glm::length(a - b) <= tolerance; }
// q and -q turn alike.
bool isNear(const glm::dquat& a, const glm::dquat& b, double tolerance = 1e-12) { return 1.0 - std::abs(glm::dot(a, b)) <= tolerance; }

glm::dvec3 forwardOf(const Pose& pose) { return pose.orientation * glm::dvec3(0.0, 0.0, -1.0); }

// Files beside which scripts can stand.
struct ScriptFolder : Folder {
    [[nodiscard]] Script script(const std::string& text) const { return Script::parse(text, (path / "a.script").string()); }
};

// Where the head is at a time, and where it looks.
struct HeadCase {
    const char* script;
    double time_s;
    glm::dvec3 position, forward;
};

TEST_CASE("an empty script is the resting headset; comments, blanks and carriage returns do not count") {
    const Script script = parse("");
    CHECK(these(script.rate_hz, script.size_px) == these(90.0, glm::uvec2(1024, 1024)));
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
    const Script spaced = parse("\xef\xbb\xbf# a comment\r\n\r\n \t rate  72 # another\r\nsize 640\t480#and another");
    CHECK(these(spaced.rate_hz, spaced.size_px) == these(72.0, glm::uvec2(640, 480)));
}

TEST_CASE("the head goes on straight lines and the shorter great arcs from key to key; what a pose leaves out stays as it was") {
    constexpr const char* kWalk = "head 1 position 0 1 0\nhead 3 position 4 2 -8\n";
    // From ahead to a quarter turn to the left (+90 degrees about y): a third of the way is 30 degrees, looking along (-1/2, 0, -cos 30).
    constexpr const char* kArc = "head 0 rotation 0 0 0 1\nhead 3 rotation 0 0.70710678118654752 0 0.70710678118654752";
    // -q is the same rotation as q: half-way between q and -q' with q' 90 degrees on is still 45 degrees.
    constexpr const char* kLongArc = "head 0 rotation 0 0 0 1\nhead 1 rotation 0 -0.70710678118654752 0 -0.70710678118654752";
    constexpr const char* kParts = "head 0 position 1 2 3 turn 90 0\nhead 1 position 4 5 6\nhead 2 turn 0 0";
    const double cosine = std::sqrt(0.75);
    const glm::dvec3 ahead(0, 0, -1), left(-1, 0, 0), resting(0, 1.6, 0);
    for (const HeadCase& one : {HeadCase{kWalk, 0.0, {0, 1, 0}, ahead},
                                {kWalk, 1.5, {1, 1.25, -2}, ahead},
                                {kWalk, 2.0, {2, 1.5, -4}, ahead},
                                {kWalk, 3.0, {4, 2, -8}, ahead},
                                {kWalk, 9.0, {4, 2, -8}, ahead},
                                {kArc, 1.0, resting, {-0.5, 0, -cosine}},
                                {kArc, 3.0, resting, left},
                                {kLongArc, 0.5, resting, {-kHalfRoot, 0, -kHalfRoot}},
                                {kParts, 1.0, {4, 5, 6}, left},
                                {kParts, 2.0, {4, 5, 6}, ahead},
                                // Turns go left, then up.
                                {"head 0 turn 90 0", 0.0, resting, left},
                                {"head 0 turn 0 90", 0.0, resting, {0, 1, 0}},
                                {"head 0 turn 90 30", 0.0, resting, {-cosine, 0.5, 0}},
                                // Looks go to a point of the room, from where the head is said to be before.
                                {"head 0 position 1 2 3 look 1 0 1", 0.0, {1, 2, 3}, {0, -kHalfRoot, -kHalfRoot}},
                                {"head 0 position 0 1 0 look 3 5 -2", 0.0, {0, 1, 0}, glm::normalize(glm::dvec3(3, 4, -2))},
                                {"head 0 position 0 1 0 look 0 9 0", 0.0, {0, 1, 0}, {0, 1, 0}},
                                {"head 0 position 5 1 0\nhead 1 look 6 1 0", 1.0, {5, 1, 0}, {1, 0, 0}}}) {
        INFO("one.script ", one.script, ", one.time_s ", one.time_s);
        const Pose head = parse(one.script).at(one.time_s).stage_from_head;
        CHECK(isNear(head.position, one.position));
        CHECK(isNear(forwardOf(head), one.forward));
        // Upright: the right-hand side stays level.
        CHECK(std::abs((head.orientation * glm::dvec3(1, 0, 0)).y) < 1e-12);
    }
    const Script unnormalized = parse("head 0 rotation 0 3 0 3");
    CHECK(isNear(unnormalized.at(0.0).stage_from_head.orientation, glm::dquat(kHalfRoot, 0.0, kHalfRoot, 0.0)));
}

TEST_CASE("LOCAL stands where the head is at time zero without its tilt, or where the script says, until it is recentred") {
    const Script script = parse("head -1 position 0 0 0 turn 0 0\nhead 1 position 2 3.2 0 turn 60 0");
    const Pose local = script.stageFromLocal();
    CHECK(isNear(local.position, {1.0, 1.6, 0.0}));
    CHECK(isNear(forwardOf(local), {-0.5, 0.0, -std::sqrt(0.75)}));
    CHECK(isNear(forwardOf(parse("head 0 turn 90 40").stageFromLocal()), {-1.0, 0.0, 0.0}));
    // Of a head that looks straight up it keeps the right.
    CHECK(isNear(parse("head 0 turn 30 90").stageFromLocal().orientation * glm::dvec3(1, 0, 0), {std::sqrt(0.75), 0.0, -0.5}));

    const Script said =
        parse("local position 3 0.5 1 turn 90 0\nhead 0 position 0 1.6 0\nhead 2 position 2 1.6 0 turn 0 30\nat 1 recentre\nat 2 recentre");
    CHECK(isNear(said.stageFromLocal(0.999).position, {3.0, 0.5, 1.0}));
    CHECK(isNear(forwardOf(said.stageFromLocal(0.0)), {-1.0, 0.0, 0.0}));
    CHECK(isNear(said.stageFromLocal(1.0).position, {1.0, 1.6, 0.0}));
    CHECK(isNear(said.stageFromLocal(9.0).position, {2.0, 1.6, 0.0}));
    CHECK(isNear(forwardOf(said.stageFromLocal(9.0)), {0.0, 0.0, -1.0}));
    CHECK(these(said.eventsIn(0.5, 1.5).size(), said.eventsIn(0.5, 1.5).at(0).kind) == these(1, ScriptEvent::Kind::kRecentre));
}

TEST_CASE("controllers move and aim from their grip") {
    const Script script =
        parse("controller right 0 position 0 1 0 turn 90 0\ncontroller right 2 position 0 3 0\naim right position 0 0 -0.1 turn 0 90\n");
    const auto [left, right] = script.at(1.0).controllers;
    CHECK(isNear(right.stage_from_grip.position, {0.0, 2.0, 0.0}));
    // Ahead of a hand that is turned to the left is -x.
    CHECK(isNear(right.stage_from_aim.position, {-0.1, 2.0, 0.0}));
    CHECK(isNear(forwardOf(right.stage_from_aim), {0.0, 1.0, 0.0}));
    CHECK(isNear(left.stage_from_grip.position, {-0.2, 1.2, -0.35}));
}

TEST_CASE("presses last from their beginning until before their end, touches do not press, gestures are ready, and axes are linear") {
    struct InputCase {
        const char* script;
        Side side;
        const char* input;
        double time_s, value;
    };
    constexpr const char* kPress = "press right trigger 1 2\npress left a 1 2\ntouch left thumbstick 0 1";
    constexpr const char* kAxes =
        "axis left thumbstick 0 -1 0\naxis left thumbstick 4 1 0.5\naxis left squeeze 0 0\naxis left squeeze 1 1\n"
        "axis right grasp_ext 0 0\naxis right grasp_ext 1 1\npress right pinch_ext 1 2\ntouch right pinch_ext 3 4";
    constexpr const char* kUntracked = "press right trigger 0 9\nat 1 controller right off\nat 2 controller right on";
    for (const InputCase& one : {InputCase{kPress, kRight, "trigger/value", 0.999, 0.0},
                                 {kPress, kRight, "trigger/value", 1.0, 1.0},
                                 {kPress, kRight, "trigger/click", 1.5, 1.0},
                                 {kPress, kRight, "trigger/touch", 1.5, 1.0},
                                 {kPress, kRight, "trigger/value", 2.0, 0.0},
                                 {kPress, kRight, "squeeze/value", 1.5, 0.0},
                                 {kPress, kRight, "a/click", 1.5, 0.0},
                                 {kPress, kLeft, "a/click", 1.5, 1.0},
                                 {kPress, kLeft, "thumbstick/touch", 0.5, 1.0},
                                 {kPress, kLeft, "thumbstick/click", 0.5, 0.0},
                                 {kAxes, kLeft, "thumbstick/x", 1.0, -0.5},
                                 {kAxes, kLeft, "thumbstick/y", 1.0, 0.125},
                                 {kAxes, kLeft, "thumbstick/x", 9.0, 1.0},
                                 {kAxes, kLeft, "thumbstick/touch", 1.0, 1.0},
                                 {kAxes, kLeft, "squeeze/value", 0.25, 0.25},
                                 {kAxes, kLeft, "squeeze/touch", 0.25, 1.0},
                                 {kAxes, kLeft, "squeeze/click", 0.89, 0.0},
                                 {kAxes, kLeft, "squeeze/click", 0.91, 1.0},
                                 {kAxes, kLeft, "squeeze/touch", 0.0, 0.0},
                                 {kAxes, kRight, "grasp_ext/value", 0.5, 0.5},
                                 {kAxes, kRight, "grasp_ext/ready_ext", 0.5, 1.0},
                                 {kAxes, kRight, "pinch_ext/value", 1.5, 1.0},
                                 {kAxes, kRight, "pinch_ext/ready_ext", 1.5, 1.0},
                                 {kAxes, kRight, "pinch_ext/value", 3.5, 0.0},
                                 {kAxes, kRight, "pinch_ext/ready_ext", 3.5, 1.0},
                                 // A controller that is not tracked rests.
                                 {kUntracked, kRight, "trigger/value", 1.5, 0.0},
                                 {kUntracked, kRight, "trigger/value", 2.0, 1.0}}) {
        INFO(one.script, " ", one.input, " at ", one.time_s);
        CHECK(parse(one.script).at(one.time_s).controllers[one.side].input(one.input) == doctest::Approx(one.value));
    }
    CHECK(parse(kPress).at(1.5).controllers[kLeft].inputs.count("a/value") == 0);
    const Script untracked = parse(kUntracked);
    CHECK(untracked.at(0.5).controllers[kRight].tracked);
    CHECK_FALSE(untracked.at(1.0).controllers[kRight].tracked);
    CHECK(untracked.at(1.5).controllers[kLeft].tracked);
}

TEST_CASE("events happen once in the frame that reaches them") {
    const Script script = parse("at -1 slow-images 3\nat 1 lose-session\nat 1 lose-instance\nat 2 exit");
    const auto first = script.eventsIn(-kForever, 0.0);
    REQUIRE(first.size() == 1);
    CHECK(these(first[0].kind, first[0].count) == these(ScriptEvent::Kind::kSlowImages, 3));
    CHECK(script.eventsIn(0.0, 0.999).empty());
    const auto at_one = script.eventsIn(0.999, 1.0);
    REQUIRE(at_one.size() == 2);
    CHECK(these(at_one[0].kind, at_one[1].kind) == these(ScriptEvent::Kind::kLoseSession, ScriptEvent::Kind::kLoseInstance));
    CHECK(these(script.eventsIn(1.0, 1.5).empty(), script.eventsIn(1.5, 7.0).size()) == these(true, 1));
    CHECK(std::string(nameOf(ScriptEvent::Kind::kExit)) == "exit");
}

TEST_CASE("frames are chosen by number, extensions and the mask are switched, and a load is by what was drawn") {
    const auto chosen = [](const std::string& text) {
        const Script script = parse(text);
        std::string frames;
        for (std::uint64_t frame = 0; frame < 10; ++frame) {
            if (script.writes_pictures && script.frames.contains(frame)) { frames += std::to_string(frame); }
        }
        return frames;
    };
    for (const auto& [text, frames] :
         {std::pair("", "0123456789"), std::pair("frames all", "0123456789"), std::pair("frames none", ""),
          std::pair("frames every 4", "048"), std::pair("frames from 3 to 5", "345"), std::pair("frames from 1 to 8 every 3", "147")}) {
        CHECK(chosen(text) == frames);
    }
    const Script script = parse("extension XR_KHR_visibility_mask off\nvisibility-mask on");
    CHECK_FALSE(script.allowsExtension("XR_KHR_visibility_mask"));
    CHECK(script.allowsExtension("XR_KHR_vulkan_enable2"));
    CHECK(script.visibility_mask);
    const Script loaded = parse("at 1 gpu-load 4 ms-per-megapixel");
    CHECK(these(loaded.gpu_load.at(0.0).ms(10.0, 2.0), loaded.gpu_load.at(1.0).ms(10.0, 2.0)) == these(0.0, doctest::Approx(8.0)));
}

TEST_CASE("headset files give size, distance, canting, angles and insets, and every one of the project is read") {
    const Script script = Script::parse("headset index.toml\nipd 0.064", std::string(BINOSPLAT_SOURCE_DIR) + "/configs/headsets/a.script");
    CHECK(these(script.system_name, script.size_px, script.eye_distance_m) == these("Valve Index", glm::uvec2(2468, 2740), 0.064));
    const State state = script.at(0.0);
    CHECK(state.eyes[kLeft].fov.left_rad == doctest::Approx(-51.9821 * kDegree));
    CHECK(state.eyes[kRight].fov.down_rad == doctest::Approx(-54.6016 * kDegree));
    CHECK(isNear(forwardOf(state.eyes[kLeft].stage_from_eye), {-std::sin(5 * kDegree), 0.0, -std::cos(5 * kDegree)}));
    std::size_t headsets = 0;
    for (const auto& entry : std::filesystem::directory_iterator(std::string(BINOSPLAT_SOURCE_DIR) + "/configs/headsets")) {
        INFO(entry.path().string());
        CHECK_NOTHROW((void)Script::parse("headset " + entry.path().filename().string(), (entry.path().parent_path() / "a").string()));
        ++headsets;
    }
    CHECK(headsets >= 10);

    const ScriptFolder folder;
    const auto readWith = [&](const std::string& inset) {
        folder.write("h.toml", kHeadsetToml + inset);
        return folder.script("headset h.toml");
    };
    const Script full = readWith("[inset]\nhalf_angle_deg = 15\nsize = \"60x50\"\ncontext_size = \"40x30\"\n");
    CHECK(these(full.inset.half_angle_rad, full.insetSizePx(), full.contextSizePx()) ==
          these(doctest::Approx(0.2617994), glm::uvec2(60, 50), glm::uvec2(40, 30)));
    CHECK(readWith("[inset]\nhalf_angle_deg = 15\n").contextSizePx() == glm::uvec2(50, 50));
    CHECK(readWith("").inset.half_angle_rad == doctest::Approx(0.3490659));
}

TEST_CASE("insets lie where a headset's lenses have their middles, while there is no gaze") {
    Script script = parse("eye-tracking off");
    script.lens_centres_rad = {glm::dvec2(0.1, -0.2), glm::dvec2(-0.1, -0.2)};
    const Fov left = script.findInset(script.at(0.0), kLeft, true), right = script.findInset(script.at(0.0), kRight, true);
    CHECK(0.5 * (left.left_rad + left.right_rad) == doctest::Approx(0.1));
    CHECK(0.5 * (left.up_rad + left.down_rad) == doctest::Approx(-0.2));
    CHECK(0.5 * (right.left_rad + right.right_rad) == doctest::Approx(-0.1));
}

TEST_CASE_FIXTURE(ScriptFolder, "recorded motion starts where the head line says and keeps its tilt") {
    // A recording that faces a quarter turn to the left and moves 1 m ahead of there: that is ahead of the wearer, too. Its second
    // pose also looks up by 60 degrees.
    write("m.csv",
          "time_s,x,y,z,qx,qy,qz,qw\n10,5,1,5,0,0.70710678118654752,0,0.70710678118654752\n"
          "11,4,1.5,5,0.35355339059327373,0.61237243569579447,-0.35355339059327373,0.61237243569579447\n");
    // Looks up by 60 degrees at first and moves a metre up: up in STAGE, too, and not along the tilted head's axes.
    write("tilted.csv", "0,0,0,0,0.5,0,0,0.86602540378443865\n1,0,1,0,0,0,0,1\n");
    // Of Unity: left-handed with z ahead, so a positive turn about y looks right, and +z is ahead.
    write("unity.csv", "0,0,0,0,0,0,0,1\n1,1,0,2,0,0.70710678118654752,0,0.70710678118654752\n");
    write("long.csv", "0,0,0,0,0,0,0,1\n2,2,0,0,0,0,0,1\n4,2,0,8,0,0,0,1\n");
    write("cut.csv", "0,0,0,0,0,0,0,1\n1,2,0,0,0,0,0,1\n2,9,0");
    const std::vector<std::string> notes = script("head-motion cut.csv").notes;
    REQUIRE(notes.size() == 1);
    CHECK(notes[0].ends_with(
        "cut.csv:3: 3 columns, must be 8: time, position x, y, z, orientation x, y, z, w; the last row, cut off, is left out"));
    constexpr const char* kStanding = "head 0 position 0 1.6 0\nhead-motion m.csv start 2";
    constexpr const char* kTilted = "head 0 position 0 1.6 0\nhead-motion tilted.csv";
    constexpr const char* kUnity = "head 0 position 0 0 0\nhead-motion unity.csv axes unity";
    constexpr const char* kSkipped = "head 0 position 0 0 0\nhead-motion long.csv skip 1";
    const glm::dvec3 ahead(0, 0, -1), upwards(0, std::sqrt(0.75), -0.5);
    for (const HeadCase& one : {HeadCase{kStanding, 0.0, {0, 1.6, 0}, ahead},
                                {kStanding, 2.0, {0, 1.6, 0}, ahead},
                                {kStanding, 3.0, {0, 2.1, -1}, upwards},
                                {kStanding, 9.0, {0, 2.1, -1}, upwards},
                                {kTilted, 0.0, {0, 1.6, 0}, upwards},
                                {kTilted, 1.0, {0, 2.6, 0}, ahead},
                                {kUnity, 1.0, {1, 0, -2}, {1, 0, 0}},
                                {kSkipped, 0.0, {0, 0, 0}, ahead},
                                {kSkipped, 1.0, {1, 0, 0}, ahead},
                                {kSkipped, 2.0, {1, 0, 4}, ahead}}) {
        INFO("one.script ", one.script, ", one.time_s ", one.time_s);
        const Pose head = script(one.script).at(one.time_s).stage_from_head;
        CHECK(isNear(head.position, one.position, 1e-9));
        CHECK(isNear(forwardOf(head), one.forward, 1e-9));
    }
    CHECK(isNear(script(kStanding).at(2.5).stage_from_head.position, {0.0, 1.85, -0.5}, 1e-9));
}

TEST_CASE("the same time gives the same state, and every script that comes along is one") {
    const Script script = Script::load(std::string(BINOSPLAT_SOURCE_DIR) + "/configs/simulated/walk.script");
    const State once = script.at(1.7);
    (void)script.at(3.0);
    const State again = script.at(1.7);
    CHECK(once.stage_from_head.position == again.stage_from_head.position);
    CHECK(once.controllers[kRight].stage_from_aim.orientation == again.controllers[kRight].stage_from_aim.orientation);
    CHECK(script.eventsIn(-kForever, kForever).back().kind == ScriptEvent::Kind::kExit);
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(std::string(BINOSPLAT_SOURCE_DIR) + "/configs/simulated")) {
        CAPTURE(entry.path().string());
        CHECK_NOTHROW(Script::load(entry.path()));
        ++count;
    }
    CHECK(count >= 2);
}

}  // SUITE(simulated_script)
