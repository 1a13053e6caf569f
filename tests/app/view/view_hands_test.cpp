// Facts about what the wearer holds and sees beside the scene: rays, hands, controllers, the way to another place, the vignette.
#include "engine/picture/metrics.h"
#include "tests/app/view/view_panel.h"

#include <doctest/doctest.h>

TEST_SUITE_BEGIN("view_hands");

namespace view_hands_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

const std::string kSmall = "rate 100\nsize 128 128\nframes every 5\n";
// Where nobody looks at what the headset shows.
const std::string kBlind = "rate 100\nsize 64 64\nframes none\n";
const std::string kScene = "builtin:slanted-wall --load-first --mode mono";
const std::string kJointless = "extension XR_EXT_hand_tracking off\n";

// Lines that put a hand at a place and let it look at another one.
std::string hand(const std::string& side, double time_s, const glm::dvec3& at, const glm::dvec3& look) {
    return fmt::format("controller {} {} position {} {} {} look {} {} {}\n", side, time_s, at.x, at.y, at.z, look.x, look.y, look.z);
}

glm::dvec3 placeOf(const nlohmann::json& quad) {
    const auto p = quad.at("pose").at("position").get<std::array<double, 3>>();
    return {p[0], p[1] + 1.6, p[2]};
}
glm::dvec3 alongOf(const nlohmann::json& quad) {
    const auto q = quad.at("pose").at("orientation").get<std::array<double, 4>>();
    return glm::dquat(q[3], q[0], q[1], q[2]) * glm::dvec3(0.0, 1.0, 0.0);
}
double heightOf(const nlohmann::json& quad) { return quad.at("size").at(1).get<double>(); }

// Pictures of hands as their joints are, parts of controllers, the strips of an arc, where one will stand, and the vignette, by their size.
std::vector<nlohmann::json> quadsAsWide(const ViewRun& run, std::size_t frame, double width_m) {
    return run.quadsWhere(frame, [&](const nlohmann::json& quad) {
        return quad.at("space") != "VIEW" && std::abs(quad.at("size").at(0).get<double>() - width_m) < 1e-4;
    });
}
std::vector<nlohmann::json> hands(const ViewRun& run, std::size_t frame) { return quadsAsWide(run, frame, 0.3); }
std::vector<nlohmann::json> knobs(const ViewRun& run, std::size_t frame) { return quadsAsWide(run, frame, 0.055); }
std::vector<nlohmann::json> handles(const ViewRun& run, std::size_t frame) { return quadsAsWide(run, frame, 0.035); }
std::vector<nlohmann::json> arc(const ViewRun& run, std::size_t frame) { return quadsAsWide(run, frame, 0.012); }
std::vector<nlohmann::json> targets(const ViewRun& run, std::size_t frame) { return quadsAsWide(run, frame, 0.5); }
std::vector<nlohmann::json> vignettes(const ViewRun& run, std::size_t frame) {
    return run.quadsWhere(frame, [](const nlohmann::json& quad) { return quad.at("space") == "VIEW"; });
}

ViewRun runHands(const Workplace& work, const std::string& name, const std::string& lines, const std::string& options = "",
                 const std::string& profile = "oculus/touch_controller", const std::string& headset = kSmall) {
    const ViewRun run =
        runView(work, name, headset + lines + "at 0.6 exit\n", kScene + options, kValidated + " SIMULATED_OPENXR_PROFILE=" + profile);
    checkClean(run);
    for (const auto& frame : run.frames) { CHECK(frame.at("layers").size() <= 16); }
    return run;
}

// The brightest of a channel in the frame's left eye.
double sumOfChannel(const Image& picture, int channel) {
    double sum = 0.0;
    for (std::size_t i = 0; i < picture.pixelCount(); ++i) {
        sum += static_cast<double>(picture.values[i * static_cast<std::size_t>(picture.channels) + static_cast<std::size_t>(channel)]);
    }
    return sum / static_cast<double>(picture.pixelCount());
}

}  // namespace

TEST_CASE("every hand that points has a ray: to the panel where it meets it, else short and fading; a lost hand has none") {
    const Workplace work;
    const glm::dvec3 right_at(0.2, 1.2, -0.35), left_at(-0.2, 1.2, -0.35), panel_middle(-0.45, 1.5, -0.9);
    const ViewRun run =
        runHands(work, "rays",
                 hand("right", 0, right_at, panel_middle) + hand("left", 0, left_at, {-0.2, 0.2, -1.0}) + "at 0.4 controller right off\n",
                 "", "oculus/touch_controller", kBlind);
    const auto rays = run.rays(30);
    REQUIRE(rays.size() == 2);
    // The left one misses and fades; the right one ends on the panel.
    CHECK(heightOf(rays[0]) < 0.5);
    CHECK(rays[0].at("views").at(0).at("rect") != rays[1].at("views").at(0).at("rect"));
    const glm::dvec3 half = 0.5 * heightOf(rays[1]) * alongOf(rays[1]);
    const glm::dvec3 ends[]{placeOf(rays[1]) + half, placeOf(rays[1]) - half};
    CHECK(std::min(glm::distance(ends[0], right_at), glm::distance(ends[1], right_at)) < 1e-4);
    CHECK(std::min(glm::distance(ends[0], panel_middle), glm::distance(ends[1], panel_middle)) < 1e-3);
    CHECK(run.rays(50).size() == 1);
}

TEST_CASE("without the panel a ray is there while the trigger is pulled") {
    const Workplace work;
    const ViewRun run = runHands(work, "bare", "press right trigger 0.3 0.4\n", " --hide-panel", "oculus/touch_controller", kBlind);
    CHECK(run.rays(20).empty());
    CHECK(run.rays(35).size() == 1);
    CHECK(run.rays(50).empty());
}

TEST_CASE("either hand clicks on the panel") {
    const Workplace work;
    // Both point at it; the left one clicks on Quit, though the right one hovers elsewhere.
    const ViewRun run =
        runView(work, "left",
                kBlind + hand("right", 0, {0.2, 1.2, -0.35}, {-0.45, 1.7, -0.9}) +
                    "controller left 0 position -0.2 1.2 -0.35 look -0.289 1.765 -1.010\npress left trigger 0.2 0.25\nat 2 exit\n",
                kScene);
    checkClean(run);
    CHECK(run.frames.size() < 60);
}

TEST_CASE("controllers are drawn where the grips are, and only while they are tracked") {
    const Workplace work;
    const glm::dvec3 at(0.05, 1.5, -0.4);
    const ViewRun run =
        runHands(work, "controllers",
                 kJointless + hand("right", 0, at, {0.05, 1.5, -1.0}) + "at 0.2 controller left off\nat 0.4 controller right off\n",
                 " --hide-panel");
    CHECK(knobs(run, 15).size() == 2);
    CHECK(handles(run, 15).size() == 2);
    REQUIRE(knobs(run, 30).size() == 1);
    REQUIRE(handles(run, 30).size() == 1);
    // The handle lies about the grip, along its axis.
    CHECK(glm::distance(placeOf(handles(run, 30)[0]), at) < 0.02);
    CHECK(std::abs(alongOf(handles(run, 30)[0]).z) > 0.999);
    CHECK(run.layers(50, "quad").empty());
    // They are seen, and not with --hide-hands.
    CHECK(compare(run.eye(30, kLeft), run.eye(50, kLeft)).psnrDb() < 45.0);
    const ViewRun hidden = runHands(work, "none", kJointless, " --hide-panel --hide-hands");
    CHECK(hidden.layers(30, "quad").empty());
}

TEST_CASE("a runtime that finds hands shows their joints in place of controllers") {
    const Workplace work;
    const ViewRun run = runHands(
        work, "joints", hand("right", 0, {0.1, 1.5, -0.4}, {0.1, 1.5, -1.0}) + "press right squeeze 0.3 0.6\nat 0.5 controller left off\n",
        " --hide-panel");
    CHECK(hands(run, 20).size() == 2);
    CHECK(knobs(run, 20).empty());
    CHECK(hands(run, 55).size() == 1);
    CHECK(glm::distance(placeOf(hands(run, 55)[0]), {0.1, 1.5, -0.4}) < 0.1);
    // A fist is another picture than a hand that is open. The scene is in its grip, and does not move with it.
    const double likeness = compare(run.eye(20, kLeft), run.eye(40, kLeft)).psnrDb();
    CHECK(likeness < 45.0);
    CHECK(likeness > 15.0);
}

TEST_CASE("the wearer teleports to where the stick's arc ended, and says where that will be beforehand") {
    const Workplace work;
    std::ofstream(work.path / "teleport.toml") << "[view]\nlocomotion = \"teleport\"\nhands = false\n";
    const std::string push =
        "axis left thumbstick 0.2 0 0\naxis left thumbstick 0.21 0 1\naxis left thumbstick 0.35 0 1\naxis left thumbstick 0.36 0 0\n";
    const std::string aim = hand("left", 0, {-0.2, 1.2, -0.35}, {-0.2, 1.0, -1.0});
    const ViewRun run = runHands(work, "teleport", aim + push, " --hide-panel --config teleport.toml --eye 0,0,0 --look 0,0,9 --up 0,-1,0");
    CHECK(arc(run, 30).size() == 6);
    REQUIRE(targets(run, 30).size() == 1);
    const glm::dvec3 target = placeOf(targets(run, 30)[0]);
    CHECK(target.y == doctest::Approx(0.01));
    CHECK(target.x == doctest::Approx(-0.2));
    CHECK(target.z < -1.5);
    CHECK(run.layers(45, "quad").empty());
    CHECK(vignettes(run, 25).empty());
    // The scene is as it would be seen from there.
    const ViewRun there =
        runHands(work, "there", "",
                 fmt::format(" --hide-panel --hide-hands --eye {},0,{} --look {},0,9 --up 0,-1,0", target.x, -target.z, target.x));
    CHECK(compare(run.eye(50, kLeft), there.eye(50, kLeft)).psnrDb() > 45.0);
    CHECK(compare(run.eye(50, kLeft), run.eye(10, kLeft)).psnrDb() < 30.0);
}

TEST_CASE("the floor is where the runtime says, and the trigger teleports controllers that have no stick") {
    const Workplace work;
    std::ofstream(work.path / "teleport.toml") << "[view]\nlocomotion = \"teleport\"\nhands = false\n";
    const std::string options = " --hide-panel --config teleport.toml", pull = "press right select 0.2 0.4\n";
    const std::string away = "head 0 position 0 1.3 0\ncontroller right 0 position 0.2 0.9 -0.35\n";
    const ViewRun low = runHands(work, "low", away + pull, options, "khr/simple_controller", kBlind);
    REQUIRE(targets(low, 30).size() == 1);
    // 1.3 m below the head, by STAGE; without any floor as far below as people are high.
    CHECK(targets(low, 30)[0].at("pose").at("position").at(1).get<double>() == doctest::Approx(-1.29));
    const ViewRun floorless = runHands(work, "floorless", away + pull + "stage off\nextension XR_EXT_local_floor off\n", options,
                                       "khr/simple_controller", kBlind);
    CHECK(targets(floorless, 30).at(0).at("pose").at("position").at(1).get<double>() == doctest::Approx(-1.59));
}

TEST_CASE("the view's edge is dark while a stick moves the wearer, its middle is not, and both can be switched off") {
    const Workplace work;
    // Slowly: the scene hardly moves.
    const std::string walk =
        "axis left thumbstick 0.05 0 0\naxis left thumbstick 0.06 0 0.2\naxis left thumbstick 0.22 0 0.2\n"
        "axis left thumbstick 0.23 0 0\n";
    const std::string options = " --hide-panel --hide-hands --background 1,1,1";
    const ViewRun run = runHands(work, "dark", walk, options);
    CHECK(vignettes(run, 5).empty());
    CHECK(vignettes(run, 20).size() == 1);
    CHECK(run.layers(57, "quad").empty());
    const Image before = run.eye(5, kLeft), during = run.eye(20, kLeft), after = run.eye(55, kLeft);
    const auto at = [](const Image& picture, std::uint32_t x, std::uint32_t y) {
        return picture.values[(std::size_t{y} * picture.size_px.x + x) * static_cast<std::size_t>(picture.channels)];
    };
    CHECK(at(during, 2, 2) < 0.5f * at(before, 2, 2));
    CHECK(at(during, 64, 2) < 0.7f * at(before, 64, 2));
    CHECK(sumOfChannel(after, 0) > 0.9 * sumOfChannel(before, 0));
    CHECK(sumOfChannel(during, 0) < 0.9 * sumOfChannel(before, 0));
    std::ofstream(work.path / "clear.toml") << "[view]\nvignette = false\n";
    const ViewRun clear = runHands(work, "clear", walk, options + " --config clear.toml");
    CHECK(clear.layers(20, "quad").empty());
    // The same step; the middle is the same.
    CHECK(at(clear.eye(20, kLeft), 64, 64) == at(during, 64, 64));
}

TEST_CASE("the room shows behind the scene where the headset and the wearer let it, in every mode") {
    const Workplace work;
    std::ofstream(work.path / "through.toml") << "[view]\npassthrough = true\n";
    const std::string options = "builtin:slanted-wall --load-first --hide-panel --hide-hands --eye 0,0,-6 --look 0,0,3 --up 0,-1,0";
    const auto run = [&](const std::string& name, const std::string& modes, const std::string& more,
                         const std::string& room = "0.2 0.9 0.4") {
        const ViewRun seen = runView(work, name, kSmall + "room-colour " + room + "\n" + modes + "at 0.2 exit\n", options + more);
        checkClean(seen);
        return seen;
    };
    // A pixel of the picture's corner, where the fence is not.
    const auto corner = [](const Image& picture) { return glm::vec3(picture.values[0], picture.values[1], picture.values[2]); };
    const glm::vec3 red(1.0f, 0.0f, 0.0f), green(0.2f, 0.9f, 0.4f);
    const auto isNear = [](const glm::vec3& a, const glm::vec3& b) { return glm::length(a - b) < 0.02f; };
    const std::string blends = "blend-modes opaque alpha-blend\n", through = " --config through.toml";
    for (const std::string mode : {"mono", "two-pass", "predicted"}) {
        CAPTURE(mode);
        const std::string in_mode = " --background 1,0,0 --mode " + mode;
        const ViewRun seen = run("seen-" + mode, blends, in_mode + through);
        CHECK(seen.frames.at(15).at("blend_mode") == "ALPHA_BLEND");
        CHECK(seen.layers(15, "projection").at(0).at("flags") == nlohmann::json::array({"blend_texture_source_alpha"}));
        for (const int side : {kLeft, kRight}) { CHECK(isNear(corner(seen.eye(15, side)), green)); }
    }
    const ViewRun opaque = run("opaque", blends, " --background 1,0,0 --mode mono");
    CHECK(opaque.frames.at(15).at("blend_mode") == "OPAQUE");
    for (const int side : {kLeft, kRight}) { CHECK(isNear(corner(opaque.eye(15, side)), red)); }
    // Where the scene is, it is as it was: over its own black, and over a room that is black.
    const std::string black = " --mode mono --background 0,0,0";
    const ViewRun in_the_dark = run("dark", blends, black + through, "0 0 0");
    CHECK(compare(in_the_dark.eye(15, kLeft), run("black", blends, black).eye(15, kLeft)).psnrDb() > 40.0);
    // A headset that adds light to the room's.
    const ViewRun additive = run("additive", "blend-modes additive\n", " --background 1,0,0 --mode mono" + through);
    CHECK(additive.frames.at(15).at("blend_mode") == "ADDITIVE");
    CHECK(isNear(corner(additive.eye(15, kLeft)), green));
    // One that shuts the room out.
    const ViewRun shut = run("shut", "", " --background 1,0,0 --mode mono" + through);
    CHECK(shut.frames.at(15).at("blend_mode") == "OPAQUE");
    CHECK(isNear(corner(shut.eye(15, kLeft)), red));
}

TEST_CASE("while the scene loads, the room shows where the wearer wants it") {
    const Workplace work;
    std::ofstream(work.path / "through.toml") << "[view]\npassthrough = true\n";
    const ViewRun run =
        runView(work, "waiting", "rate 100\nsize 32 32\nblend-modes alpha-blend opaque\nroom-colour 0.2 0.9 0.4\nat 0.05 exit\n",
                "builtin:atelier --hide-panel --hide-hands --config through.toml");
    checkClean(run);
    const Image seen = run.eye(3, kLeft);
    CHECK(seen.values[1] == doctest::Approx(0.9).epsilon(0.01));
}

TEST_CASE("how one moves and what is seen is chosen on the panel") {
    const Workplace work;
    const std::string small = kBlind + "blend-modes opaque alpha-blend\ncontroller left 0 position -0.2 1.2 -0.35 turn 0 -80\n";
    const Panel panel = panelOf(runView(work, "look", small + "at 0.1 exit\n", kScene), 8);
    const ViewRun run =
        runView(work, "choose", small + clickOn(panel, {{0.856, 0.499}, {0.045, 0.665}, {0.262, 0.665}, {0.746, 0.665}}), kScene);
    checkClean(run);
    for (const char* change : {"locomotion = \"teleport\"", "vignette = false", "hands = false", "passthrough = true"}) {
        INFO(change << " in " << run.outcome.output);
        CHECK(run.outcome.output.find(change) != std::string::npos);
    }
    CHECK(hands(run, 20).size() == 2);
    CHECK(hands(run, 80).empty());
    CHECK(run.frames.at(20).at("blend_mode") == "OPAQUE");
    CHECK(run.frames.at(95).at("blend_mode") == "ALPHA_BLEND");
}

}  // namespace view_hands_test
