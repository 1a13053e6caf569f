// Facts about the simulated headset's scripts: what they say at a given time.
#include "tests/script.h"
#include "tests/xr/simulated/folder.h"
#include "xr/simulated/script/script.h"

#include <fmt/ranges.h>

SUITE(simulated_script) {

using namespace simulated;

constexpr double kDegree = std::numbers::pi / 180.0;
const double kHalfRoot = std::sqrt(0.5);
const double kForever = std::numeric_limits<double>::infinity();

Script parse(const std::string& text) { return Script::parse(text, "test.script"); }

bool isNear(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-12) {
    return glm::length(a - b) <= tolerance;
}
// q and -q are the same rotation.
bool isNear(const glm::dquat& a, const glm::dquat& b, double tolerance = 1e-12) {
    return 1.0 - std::abs(glm::dot(a, b)) <= tolerance;
}

glm::dvec3 forwardOf(const Pose& pose) { return pose.orientation * glm::dvec3(0.0, 0.0, -1.0); }

// `> SCRIPT`, in which \n ends a line, prints its notes. About the last one, at a given time, there are
// upright, head TIME X Y Z FORWARD_X FORWARD_Y FORWARD_Z; input TIME SIDE NAME VALUE; tracked TIME SIDE true;
// and `frames`: which of the first ten have a picture.
SCRIPT(simulated_script, "xr/simulated/script/simulated_script") {
    const Folder folder;
    std::optional<Script> script;
    const auto read = [&](const std::string& text, const std::string&) {
        script = Script::parse(unescaped(text), (folder.path / "a.script").string());
        return Outcome{
            0, fmt::format("{}", fmt::join(script->notes, "\n")) + (script->notes.empty() ? "" : "\n"), ""};
    };
    ScriptHost host{read, folder.path};
    host.names = {{"FOLDER", folder.path.string()}};
    const auto checkHead = [&](const std::string& words) {
        double time_s = 0.0;
        glm::dvec3 position, forward;
        std::istringstream(words) >> time_s >> position.x >> position.y >> position.z >> forward.x >>
            forward.y >> forward.z;
        const Pose head = script->at(time_s).stage_from_head;
        CHECK(isNear(head.position, position));
        CHECK(isNear(forwardOf(head), forward));
        return head;
    };
    host.verbs["head"] = checkHead;
    host.verbs["upright"] = [&](const std::string& words) {
        CHECK(std::abs((checkHead(words).orientation * glm::dvec3(1, 0, 0)).y) < 1e-12);
    };
    const auto controller = [&](const std::vector<std::string>& words) {
        return script->at(std::stod(words.at(0))).controllers[words.at(1) == "left" ? kLeft : kRight];
    };
    host.verbs["input"] = [&](const std::string& line) {
        const std::vector<std::string> words = wordsIn(line);
        const auto hand = controller(words);
        if (words.at(3) == "none") {
            CHECK(hand.inputs.count(words[2]) == 0);
        } else {
            CHECK(hand.input(words[2]) == doctest::Approx(std::stod(words[3])));
        }
    };
    host.verbs["tracked"] = [&](const std::string& line) {
        CHECK(controller(wordsIn(line)).tracked == (wordsIn(line).at(2) == "true"));
    };
    host.verbs["frames"] = [&](const std::string& expected) {
        std::string frames;
        for (std::uint64_t frame = 0; frame < 10; ++frame) {
            if (script->writes_pictures && script->frames.contains(frame)) {
                frames += std::to_string(frame);
            }
        }
        CHECK(frames == expected);
    };
    runScript(host);
}

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
    const Script spaced =
        parse("\xef\xbb\xbf# a comment\r\n\r\n \t rate  72 # another\r\nsize 640\t480#and another");
    CHECK(these(spaced.rate_hz, spaced.size_px) == these(72.0, glm::uvec2(640, 480)));
}

TEST_CASE("a rotation of any length is one of length 1") {
    const Script unnormalized = parse("head 0 rotation 0 3 0 3");
    CHECK(
        isNear(unnormalized.at(0.0).stage_from_head.orientation, glm::dquat(kHalfRoot, 0.0, kHalfRoot, 0.0)));
}

TEST_CASE(
    "LOCAL stands where the head is at time zero without its tilt, or where the script says, until it is "
    "recentred") {
    const Script script = parse("head -1 position 0 0 0 turn 0 0\nhead 1 position 2 3.2 0 turn 60 0");
    const Pose local = script.stageFromLocal();
    CHECK(isNear(local.position, {1.0, 1.6, 0.0}));
    CHECK(isNear(forwardOf(local), {-0.5, 0.0, -std::sqrt(0.75)}));
    CHECK(isNear(forwardOf(parse("head 0 turn 90 40").stageFromLocal()), {-1.0, 0.0, 0.0}));
    // If the head looks straight up, its right-hand side stays.
    CHECK(isNear(parse("head 0 turn 30 90").stageFromLocal().orientation * glm::dvec3(1, 0, 0),
                 {std::sqrt(0.75), 0.0, -0.5}));

    const Script said = parse(
        "local position 3 0.5 1 turn 90 0\nhead 0 position 0 1.6 0\nhead 2 position 2 1.6 0 turn 0 30\nat 1 "
        "recentre\nat 2 recentre");
    CHECK(isNear(said.stageFromLocal(0.999).position, {3.0, 0.5, 1.0}));
    CHECK(isNear(forwardOf(said.stageFromLocal(0.0)), {-1.0, 0.0, 0.0}));
    CHECK(isNear(said.stageFromLocal(1.0).position, {1.0, 1.6, 0.0}));
    CHECK(isNear(said.stageFromLocal(9.0).position, {2.0, 1.6, 0.0}));
    CHECK(isNear(forwardOf(said.stageFromLocal(9.0)), {0.0, 0.0, -1.0}));
    CHECK(these(said.eventsIn(0.5, 1.5).size(), said.eventsIn(0.5, 1.5).at(0).kind) ==
          these(1, ScriptEvent::Kind::kRecentre));
}

TEST_CASE("controllers move and aim from their grip") {
    const Script script = parse(
        "controller right 0 position 0 1 0 turn 90 0\ncontroller right 2 position 0 3 0\naim right position "
        "0 0 -0.1 turn 0 90\n");
    const auto [left, right] = script.at(1.0).controllers;
    CHECK(isNear(right.stage_from_grip.position, {0.0, 2.0, 0.0}));
    // In front of a hand that is turned to the left is -x.
    CHECK(isNear(right.stage_from_aim.position, {-0.1, 2.0, 0.0}));
    CHECK(isNear(forwardOf(right.stage_from_aim), {0.0, 1.0, 0.0}));
    CHECK(isNear(left.stage_from_grip.position, {-0.2, 1.2, -0.35}));
}

TEST_CASE("events happen once in the frame that reaches them") {
    const Script script = parse("at -1 slow-images 3\nat 1 lose-session\nat 1 lose-instance\nat 2 exit");
    const auto first = script.eventsIn(-kForever, 0.0);
    REQUIRE(first.size() == 1);
    CHECK(these(first[0].kind, first[0].count) == these(ScriptEvent::Kind::kSlowImages, 3));
    CHECK(script.eventsIn(0.0, 0.999).empty());
    const auto at_one = script.eventsIn(0.999, 1.0);
    REQUIRE(at_one.size() == 2);
    CHECK(these(at_one[0].kind, at_one[1].kind) ==
          these(ScriptEvent::Kind::kLoseSession, ScriptEvent::Kind::kLoseInstance));
    CHECK(these(script.eventsIn(1.0, 1.5).empty(), script.eventsIn(1.5, 7.0).size()) == these(true, 1));
    CHECK(std::string(nameOf(ScriptEvent::Kind::kExit)) == "exit");
}

TEST_CASE("extensions and the mask are switched, and a load is by what was drawn") {
    const Script script = parse("extension XR_KHR_visibility_mask off\nvisibility-mask on");
    CHECK_FALSE(script.allowsExtension("XR_KHR_visibility_mask"));
    CHECK(script.allowsExtension("XR_KHR_vulkan_enable2"));
    CHECK(script.visibility_mask);
    const Script loaded = parse("at 1 gpu-load 4 ms-per-megapixel");
    CHECK(these(loaded.gpu_load.at(0.0).ms(10.0, 2.0), loaded.gpu_load.at(1.0).ms(10.0, 2.0)) ==
          these(0.0, doctest::Approx(8.0)));
}

TEST_CASE(
    "headset files give size, distance, canting, angles and insets, and every one of the project is read") {
    const Script script = Script::parse("headset index.toml\nipd 0.064",
                                        std::string(BINOSPLAT_SOURCE_DIR) + "/configs/headsets/a.script");
    CHECK(these(script.system_name, script.size_px, script.eye_distance_m) ==
          these("Valve Index", glm::uvec2(2468, 2740), 0.064));
    const State state = script.at(0.0);
    CHECK(state.eyes[kLeft].fov.left_rad == doctest::Approx(-51.9821 * kDegree));
    CHECK(state.eyes[kRight].fov.down_rad == doctest::Approx(-54.6016 * kDegree));
    CHECK(isNear(forwardOf(state.eyes[kLeft].stage_from_eye),
                 {-std::sin(5 * kDegree), 0.0, -std::cos(5 * kDegree)}));
    std::size_t headsets = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(BINOSPLAT_SOURCE_DIR) + "/configs/headsets")) {
        INFO(entry.path().string());
        CHECK_NOTHROW((void)Script::parse("headset " + entry.path().filename().string(),
                                          (entry.path().parent_path() / "a").string()));
        ++headsets;
    }
    CHECK(headsets >= 10);

    const Folder folder;
    const auto readWith = [&](const std::string& inset) {
        folder.write("h.toml", kHeadsetToml + inset);
        return Script::parse("headset h.toml", (folder.path / "a.script").string());
    };
    const Script full =
        readWith("[inset]\nhalf_angle_deg = 15\nsize = \"60x50\"\ncontext_size = \"40x30\"\n");
    CHECK(these(full.inset.half_angle_rad, full.insetSizePx(), full.contextSizePx()) ==
          these(doctest::Approx(0.2617994), glm::uvec2(60, 50), glm::uvec2(40, 30)));
    CHECK(readWith("[inset]\nhalf_angle_deg = 15\n").contextSizePx() == glm::uvec2(50, 50));
    CHECK(readWith("").inset.half_angle_rad == doctest::Approx(0.3490659));
}

TEST_CASE("insets lie where a headset's lenses have their middles, while there is no gaze") {
    Script script = parse("eye-tracking off");
    script.lens_centres_rad = {glm::dvec2(0.1, -0.2), glm::dvec2(-0.1, -0.2)};
    const Fov left = script.findInset(script.at(0.0), kLeft, true),
              right = script.findInset(script.at(0.0), kRight, true);
    CHECK(0.5 * (left.left_rad + left.right_rad) == doctest::Approx(0.1));
    CHECK(0.5 * (left.up_rad + left.down_rad) == doctest::Approx(-0.2));
    CHECK(0.5 * (right.left_rad + right.right_rad) == doctest::Approx(-0.1));
}

TEST_CASE("the same time gives the same state, and every script that comes along is one") {
    const Script script = Script::load(std::string(BINOSPLAT_SOURCE_DIR) + "/configs/simulated/walk.script");
    const State once = script.at(1.7);
    (void)script.at(3.0);
    const State again = script.at(1.7);
    CHECK(once.stage_from_head.position == again.stage_from_head.position);
    CHECK(once.controllers[kRight].stage_from_aim.orientation ==
          again.controllers[kRight].stage_from_aim.orientation);
    CHECK(script.eventsIn(-kForever, kForever).back().kind == ScriptEvent::Kind::kExit);
    std::size_t count = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(BINOSPLAT_SOURCE_DIR) + "/configs/simulated")) {
        CAPTURE(entry.path().string());
        CHECK_NOTHROW(Script::load(entry.path()));
        ++count;
    }
    CHECK(count >= 2);
}

}  // SUITE(simulated_script)
