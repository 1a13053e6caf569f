// Facts about the simulated headset's scripts: what they say at a given time.
#include "tests/script.h"
#include "tests/xr/simulated/folder.h"
#include "xr/simulated/script/script.h"

#include <fmt/ranges.h>

SUITE(simulated_script) {

using namespace simulated;

bool isNear(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) <= 1e-12; }

glm::dvec3 forwardOf(const Pose& pose) { return pose.orientation * glm::dvec3(0.0, 0.0, -1.0); }

// `> SCRIPT`, in which \n ends a line, prints its notes. About the last one, at a given time, there are
// upright, head TIME X Y Z FORWARD_X FORWARD_Y FORWARD_Z, and in the same way LOCAL, the right grip and aim,
// and the eyes; input TIME SIDE NAME VALUE; tracked TIME SIDE true; events FROM TO NAME...; `frames`: which
// of the first ten have a picture; device RATE, SIZE, DISTANCE, NAME; inset HALF_ANGLE SIZE CONTEXT_SIZE; and
// fov SIDE LEFT RIGHT UP DOWN, in degrees.
SCRIPT(simulated_script, "xr/simulated/script/simulated_script") {
    const Folder folder;
    std::optional<Script> script;
    const auto read = [&](const std::string& text, const std::string&) {
        script = Script::parse(unescaped(text), (folder.path / "a.script").string());
        return Outcome{
            0, fmt::format("{}", fmt::join(script->notes, "\n")) + (script->notes.empty() ? "" : "\n"), ""};
    };
    ScriptHost host{read, folder.path};
    host.names = {{"FOLDER", folder.path.string()}, {"SOURCE", BINOSPLAT_SOURCE_DIR}};
    const auto poses = [&](const std::string& what, double time_s) {
        const State state = script->at(time_s);
        return what == "local"   ? script->stageFromLocal(time_s)
               : what == "grip"  ? state.controllers[kRight].stage_from_grip
               : what == "aim"   ? state.controllers[kRight].stage_from_aim
               : what == "left"  ? state.eyes[kLeft].stage_from_eye
               : what == "right" ? state.eyes[kRight].stage_from_eye
                                 : state.stage_from_head;
    };
    for (const std::string what : {"head", "upright", "left", "right", "local", "grip", "aim"}) {
        host.verbs[what] = [&, what](const std::string& words) {
            double time_s = 0.0;
            glm::dvec3 position, forward;
            std::istringstream(words) >> time_s >> position.x >> position.y >> position.z >> forward.x >>
                forward.y >> forward.z;
            const Pose pose = poses(what, time_s);
            CHECK(isNear(pose.position, position));
            CHECK(isNear(forwardOf(pose), forward));
            const bool is_level = std::abs((pose.orientation * glm::dvec3(1, 0, 0)).y) < 1e-12;
            CHECK((is_level || (what != "upright" && what != "local")));
        };
    }
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
    host.verbs["fov"] = [&](const std::string& line) {
        const Fov fov = script->at(0.0).eyes[line.starts_with("left") ? kLeft : kRight].fov;
        const std::vector<std::string> words = wordsIn(line);
        std::size_t i = 0;
        for (const double angle_rad : {fov.left_rad, fov.right_rad, fov.up_rad, fov.down_rad}) {
            CHECK(angle_rad == doctest::Approx(std::stod(words.at(++i)) * std::numbers::pi / 180.0));
        }
    };
    host.verbs["device"] = [&](const std::string& expected) {
        CHECK(fmt::format("{} Hz, {}x{}, {} m, {}", script->rate_hz, script->size_px.x, script->size_px.y,
                          script->eye_distance_m, script->system_name) == expected);
    };
    host.verbs["inset"] = [&](const std::string& line) {
        const glm::uvec2 inset = script->insetSizePx(), context = script->contextSizePx();
        const std::vector<std::string> words = wordsIn(line);
        CHECK(script->inset.half_angle_rad ==
              doctest::Approx(std::stod(words.at(0)) * std::numbers::pi / 180.0));
        CHECK(fmt::format("{}x{}", inset.x, inset.y) == words.at(1));
        CHECK(fmt::format("{}x{}", context.x, context.y) == words.at(2));
    };
    host.verbs["events"] = [&](const std::string& line) {
        const std::vector<std::string> words = wordsIn(line);
        std::vector<std::string> found(words.begin(), words.begin() + 2);
        for (const auto& event : script->eventsIn(std::stod(found[0]), std::stod(found[1]))) {
            found.emplace_back(nameOf(event.kind));
        }
        CHECK(found == words);
    };
    host.verbs["toml"] = [&](const std::string& more) {
        folder.write("h.toml", kHeadsetToml + unescaped(more));
    };
    host.verbs["frames"] = [&](const std::string& expected) {
        std::string frames;
        for (std::uint64_t frame = 0; frame < 10; ++frame) {
            const bool is_chosen = script->writes_pictures && script->frames.contains(frame);
            frames += is_chosen ? std::to_string(frame) : "";
        }
        CHECK(frames == expected);
    };
    runScript(host);
}

TEST_CASE("every script and headset's file that comes along is one") {
    std::map<std::string, int> counts;
    for (const std::string kind : {"simulated", "headsets"}) {
        const fs::path folder = fs::path(BINOSPLAT_SOURCE_DIR "/configs") / kind;
        for (const auto& entry : fs::directory_iterator(folder)) {
            CAPTURE(entry.path().string());
            CHECK_NOTHROW((void)(kind == "simulated"
                                     ? Script::load(entry.path())
                                     : Script::parse("headset " + entry.path().filename().string(),
                                                     (folder / "a").string())));
            ++counts[kind];
        }
    }
    CHECK(these((counts["simulated"] >= 2), (counts["headsets"] >= 10)) == these(true, true));
    const Script walk = Script::load(BINOSPLAT_SOURCE_DIR "/configs/simulated/walk.script");
    CHECK(walk.eventsIn(-INFINITY, INFINITY).back().kind == ScriptEvent::Kind::kExit);
}

TEST_CASE("insets lie where a headset's lenses have their middles, while there is no gaze") {
    Script script = Script::parse("eye-tracking off", "test.script");
    script.lens_centres_rad = {glm::dvec2(0.1, -0.2), glm::dvec2(-0.1, -0.2)};
    const Fov left = script.findInset(script.at(0.0), kLeft, true),
              right = script.findInset(script.at(0.0), kRight, true);
    CHECK(0.5 * (left.left_rad + left.right_rad) == doctest::Approx(0.1));
    CHECK(0.5 * (left.up_rad + left.down_rad) == doctest::Approx(-0.2));
    CHECK(0.5 * (right.left_rad + right.right_rad) == doctest::Approx(-0.1));
}

}  // SUITE(simulated_script)
