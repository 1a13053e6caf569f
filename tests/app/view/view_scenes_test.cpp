// Facts about what is shown: scenes that move, the room behind them, saved pictures, and which way is up.
#include "app/options/start_view.h"
#include "app/view/scenes/scene_up.h"
#include "engine/files/load_scene.h"
#include "tests/app/camera_file.h"
#include "tests/app/view/view_acts.h"
#include "tests/engine/stream/moving_frames.h"

SUITE(view_scenes) {

// Scenes take their time to load, but frames in lock-step come as fast as they can.
const std::string kWhileLoading = kValidated + " SIMULATED_OPENXR_CLOCK=real";

TEST_CASE_FIXTURE(AtWork, "a moving scene plays, rests, steps and goes to a frame") {
    writeSliding((work.path / "slide").string(), 12, 2000);
    const std::string arguments = "slide --load-first --mode shared --hide-hands --scene-rate 15 ";
    const ViewRun played =
        runClean(work, "rate 45\nsize 96 96\npress right a 1 1.2\npress left x 2 2.2\nat 3 exit\n",
                 arguments + "--hide-panel", kWhileLoading);
    INFO(played.outcome.output);
    checkOrder(played, {"a moving scene of 12 frames, 15 a second", "paused at frame", "plays from frame"});
    // The scene moves, and stands still while it is paused.
    const double begin_s = ViewRun::secondsOf(played.frames.front());
    std::size_t others = 0, same_at_rest = 0, at_rest = 0;
    for (std::size_t frame = 8; frame + 3 < played.frames.size(); ++frame) {
        const bool is_rest = ViewRun::secondsOf(played.frames[frame]) - begin_s == between(1.4, 1.9),
                   same = played.eye(frame, 0).values == played.eye(frame + 1, 0).values;
        at_rest += is_rest;
        same_at_rest += is_rest && same;
        others += !is_rest && !same;
    }
    CHECK(others > 3);
    CHECK(at_rest > 3);
    CHECK(same_at_rest == at_rest);
    glm::dvec2 end = placeOfTime("frame", false);
    end.x = 0.96;
    Acts acts("rate 90\nsize 64 64\nframes none\n");
    acts.click(placeOfTime("Time", true, PanelPage::kView)).click(placeOfTime("Pause", true));
    for (const char* widget : {"Step on", "Step on", "Step back"}) { acts.click(placeOfTime(widget, false)); }
    acts.click(end).click(placeOfTime("Step on", false)).click(placeOfTime("Play", false));
    const ViewRun run = runClean(work, acts, arguments);
    INFO(run.outcome.output);
    // After the last frame comes the first.
    checkOrder(run, {"paused at frame 12 of 12", "paused at frame 1 of 12", "plays from frame 1 of 12",
                     "scene frames that came late: ", "frames that waited for them: 0\n"});
    CHECK(run.lines("plays from frame 1 of 12").size() == 1);
    CHECK(run.lines("paused at frame ").size() >= 6);
    CHECK(run.lines("scene frames that came late: ").size() == 1);
}

TEST_CASE_FIXTURE(AtWork, "a picture of both eyes is a file of its own, also of what the lenses hide") {
    picturesInto(work);
    const auto take = [&](const std::string& mask, const std::string& options) {
        Acts acts("rate 50\nsize 160 160\nframes from 10 to 10\nvisibility-mask " + mask + "\n");
        acts.wait(0.05).click(placeOf("Picture")).click(placeOf("Picture")).point(kBeside).wait(0.1);
        const ViewRun run = runClean(work, acts, kWall + " --mode shared" + options);
        CHECK(run.says("the lenses hide ") == (mask == "on"));
        return run;
    };
    const auto filesOf = [&](const ViewRun& run) {
        std::vector<fs::path> files;
        for (const std::string& line : run.lines(work.path.string() + "/pictures/slanted-wall-20")) {
            files.emplace_back(line.substr(line.find('/')));
        }
        return files;
    };
    const std::string all = withConfig(work, "[view]\npicture-both-eyes = true\n");
    const ViewRun run = take("off", all), masked = take("on", all);
    REQUIRE(these(filesOf(run).size(), filesOf(masked).size()) == these(2, 2));
    const Image both = readPicture(filesOf(run)[0]);
    REQUIRE(both.size_px == glm::uvec2(320, 160));
    for (const fs::path& file : {filesOf(run)[1], filesOf(masked)[0], filesOf(masked)[1]}) {
        CHECK(readPicture(file).values == both.values);
    }
    CHECK(std::ranges::distance(fs::directory_iterator(work.path / "pictures")) == 4);
    // One eye's picture, at the headset's size whatever size the frames have.
    const ViewRun one = take("off", withConfig(work, "[view]\nresolution-scale = 0.5\n"));
    const Image dominant = readPicture(filesOf(one).at(0));
    CHECK(dominant.size_px == glm::uvec2(160, 160));
    CHECK(compare(dominant, sideOf(both, kLeft)).psnrDb() > 50.0);
    // As the wearer sees it, on the right, where no panel hangs.
    const auto isSame = [](const glm::vec3& a, const glm::vec3& b) { return std::abs(a.r - b.r) < 0.01f; };
    for (const int side : {kLeft, kRight}) {
        const auto right = [](const Image& eye) { return partOf(eye, {120, 0}, {160, 160}); };
        CHECK(countPixels(right(run.eye(10, side)), right(sideOf(both, side)), isSame) > 40 * 160 * 99 / 100);
    }
}

// A place from which the wall does not fill the picture, and what is in the picture's corner then.
const std::string kAfar = kWall + " --mode mono --eye 0,0,-6 --look 0,0,3 --up 0,-1,0 --background ";
const glm::vec3 kRed(1.0f, 0.0f, 0.0f), kGreenRoom(0.2f, 0.9f, 0.4f);
bool isCorner(const ViewRun& run, double seconds, const glm::vec3& colour, int side = kLeft) {
    return glm::distance(colourOf(run.eye(run.pictureAt(seconds), side), 0, 0), colour) < 0.02f;
}

TEST_CASE_FIXTURE(AtWork, "the room shows behind the scene where headset and wearer let it, in every mode") {
    const auto begin = [](const std::string& modes, const std::string& room) {
        return "rate 50\nsize 128 128\nframes every 5\nblend-modes " + modes + "\nroom-colour " + room + "\n";
    };
    const std::string both = "opaque alpha-blend", green_room = "0.2 0.9 0.4";
    // That the room is offered as a layer, too, changes nothing.
    Acts acts(begin(both, green_room) + "passthrough on\n");
    const double opaque = acts.look();
    acts.click(placeOf("Passthrough", true));
    std::vector<double> looks{acts.look()};
    acts.click(placeOf("Method", true));
    for (const char* mode : {"two-pass", "predicted"}) {
        acts.click(onMethod(mode));
        looks.push_back(acts.look());
    }
    const ViewRun run = runClean(work, acts, kAfar + "1,0,0");
    CHECK(run.frames.at(run.pictureAt(opaque)).at("blend_mode") == "OPAQUE");
    for (const int side : {kLeft, kRight}) { CHECK(isCorner(run, opaque, kRed, side)); }
    for (const double seconds : looks) {
        CAPTURE(seconds);
        const std::size_t frame = run.pictureAt(seconds);
        CHECK(run.frames[frame].at("blend_mode") == "ALPHA_BLEND");
        CHECK(run.layers(frame, "passthrough").empty());
        CHECK(run.layers(frame, "projection").at(0).at("flags") ==
              nlohmann::json::array({"blend_texture_source_alpha"}));
        for (const int side : {kLeft, kRight}) { CHECK(isCorner(run, seconds, kGreenRoom, side)); }
    }
    // The scene itself looks the same over its own black as over a black room.
    Acts dark(begin(both, "0 0 0"));
    const double own = dark.look();
    dark.press("right b").click(placeOf("Passthrough", true)).press("right b");
    const double through = dark.look();
    const ViewRun in_the_dark = runClean(work, dark, kAfar + "0,0,0 --hide-panel");
    CHECK(in_the_dark.layers(in_the_dark.pictureAt(own), "quad").empty());
    CHECK(in_the_dark.at(through).at("blend_mode") == "ALPHA_BLEND");
    CHECK(in_the_dark.likeness(in_the_dark.pictureAt(own), in_the_dark.pictureAt(through)) > 40.0);
    // A headset that adds its light to the room's.
    const ViewRun additive = runClean(work, begin("additive", green_room) + "at 0.3 exit\n",
                                      kAfar + "1,0,0" + withConfig(work, "[view]\npassthrough = true\n"));
    CHECK(additive.frames.at(10).at("blend_mode") == "ADDITIVE");
    CHECK(isCorner(additive, 0.2, kGreenRoom));
}

TEST_CASE_FIXTURE(AtWork, "where the room is a layer, it lies below the scene while the wearer wants it") {
    Acts acts("rate 50\nsize 128 128\nframes every 5\npassthrough on\nroom-colour 0.2 0.9 0.4\n");
    const double opaque = acts.look();
    const double through = acts.click(placeOf("Passthrough", true)).look();
    const double again = acts.click(placeOf("Passthrough", true)).look();
    // The validation layer of OpenXR's SDK refuses layers that it does not know.
    const ViewRun run = runView(work, "run", acts, kAfar + "1,0,0", kAlone);
    checkEnded(run);
    for (const double seconds : {opaque, through, again}) {
        CAPTURE(seconds);
        const nlohmann::json& frame = run.frames.at(run.pictureAt(seconds));
        const bool sees = seconds == through;
        CHECK(frame.at("blend_mode") == "OPAQUE");
        CHECK(frame.at("layers").at(0).at("type") == (sees ? "passthrough" : "projection"));
        CHECK(run.layers(run.pictureAt(seconds), "projection").at(0).at("flags").empty() == !sees);
        CHECK(isCorner(run, seconds, sees ? kGreenRoom : kRed));
    }
}

TEST_CASE_FIXTURE(AtWork, "what was cropped to a sphere stands in the room, which shows all around it") {
    // Of the wall z = 4 + x, the disc of radius 1 about (0, 0, 4): here a quarter of a metre, a metre away.
    constexpr double kUnitsPerMetre = 4.0;
    constexpr glm::dvec3 kMiddle(0.0, 0.0, 4.0);
    const glm::vec3 room(0.9f, 0.1f, 0.9f);
    work.go("convert builtin:slanted-wall disc.ply --crop 0,0,4,1");
    const ViewRun run = runClean(
        work,
        "rate 50\nsize 128 128\nframes from 12 to 12\nblend-modes opaque alpha-blend\n"
        "room-colour 0.9 0.1 0.9\nat 0.3 exit\n",
        "disc.ply --load-first --mode two-pass --hide-panel --hide-hands --metres-per-unit 0.25 --eye 0,0,0 "
        "--look 0,0,4 --up 0,-1,0" +
            withConfig(work, "[view]\npassthrough = true\n"));
    for (const int side : {kLeft, kRight}) {
        CAPTURE(side);
        const Image seen = run.eye(12, side);
        const LoggedEye eye = run.loggedEye(12, static_cast<std::size_t>(side));
        const glm::dvec3 from = kUnitsPerMetre * inScene(eye.position - glm::dvec3(0.0, 1.6, 0.0));
        std::size_t solid = 0, not_solid = 0, open = 0, not_open = 0;
        for (std::uint32_t y = 0; y < seen.size_px.y; ++y) {
            for (std::uint32_t x = 0; x < seen.size_px.x; ++x) {
                const glm::dvec2 share = glm::dvec2(x + 0.5, y + 0.5) / glm::dvec2(seen.size_px);
                const glm::dvec3 along =
                    inScene(eye.orientation * glm::dvec3(glm::mix(eye.left, eye.right, share.x),
                                                         glm::mix(eye.up, eye.down, share.y), -1.0));
                const glm::dvec3 meets = from + (4.0 + from.x - from.z) / (along.z - along.x) * along;
                const double radius = glm::distance(meets, kMiddle);
                const glm::vec3 colour = colourOf(seen, x, y);
                const glm::vec3 wall(0.5 + 0.15 * std::sqrt(2.0) * meets.x, 0.5 + 0.15 * meets.y, 0.5);
                // The outermost splats reach over the sphere.
                if (along.z <= along.x || radius > 1.3) {
                    ++(glm::distance(colour, room) < 0.01f ? open : not_open);
                } else if (radius < 0.8) {
                    ++(glm::distance(colour, wall) < 0.05f ? solid : not_solid);
                }
            }
        }
        CHECK(these(not_open, not_solid) == these(0u, 0u));
        CHECK(open > 10000);
        CHECK(solid > 200);
    }
}

TEST_CASE_FIXTURE(AtWork, "a picture that cannot be written is a message, and no end") {
    fs::create_directories(work.base / "config");
    work.write("../config/user-dirs.dirs", "XDG_PICTURES_DIR=\"/proc/no-such-folder\"\n");
    Acts acts("rate 50\nsize 64 64\nframes none\n");
    acts.click(placeOf("Picture")).wait(0.1);
    const ViewRun run = runClean(work, acts, "builtin:one-splat --load-first --mode mono");
    CHECK(run.says("/proc/no-such-folder: cannot be "));
}

TEST_CASE_FIXTURE(AtWork, "up in a trained scene is the up of its cameras, or else of its floor") {
    // In the file, the floor of the atelier is tilted by some 30 degrees.
    const fs::path folder = work.path / "trained" / "point_cloud" / "iteration_30000",
                   file = folder / "point_cloud.ply";
    fs::create_directories(folder);
    const glm::dquat tilt = glm::angleAxis(0.5, glm::dvec3(0.0, 0.0, 1.0));
    Scene scene = loadScene("builtin:atelier", 3000);
    for (std::size_t i = 0; i < scene.size(); ++i) {
        scene.positions[i] = glm::vec3(tilt * glm::dvec3(scene.positions[i]));
        scene.rotations[i] = glm::quat(tilt * glm::dquat(scene.rotations[i]));
    }
    scene.sh.assign(scene.size() * 3, 0.5f);
    scene.sh_degree = 0;
    writePly(scene, file.string());
    const auto upOf = [](const fs::path& source) {
        const Scene loaded = loadScene(source.string());
        return upOfScene(loaded, source, startView(loaded, CameraOptions{}, 1.0).up);
    };
    // The file's y points down, as in all scenes with cameras.
    const glm::dvec3 up = tilt * builtinView("builtin:atelier")->up;
    CHECK(glm::dot(upOf(file), up) > std::cos(glm::radians(2.0)));
    // These cameras were held differently, and decide.
    work.write("trained/cameras.json",
               "[" + cameraJson("a", {0, 0, 0}, "[[0.8, 0.6, 0], [-0.6, 0.8, 0], [0, 0, 1]]") + "]");
    for (const fs::path& source : {file, work.path / "trained"}) {
        CHECK(glm::length(upOf(source) - glm::dvec3(-0.6, -0.8, 0.0)) < 1e-5);
    }
    // A file that cannot be read counts as none.
    work.write("trained/cameras.json", "[{");
    CHECK(glm::dot(upOf(file), up) > std::cos(glm::radians(2.0)));
}

}  // SUITE(view_scenes)
