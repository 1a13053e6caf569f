// Facts about where eyes are at first: where the program chooses, at a camera of the scene, or as options
// say.
#include "app/options/start_view.h"
#include "app/options/camera_options.h"
#include "engine/builtin/procedural.h"
#include "engine/files/load_scene.h"
#include "engine/files/scene_folder.h"
#include "engine/setup/output_files.h"
#include "tests/app/camera_file.h"
#include "tests/app/options/parsed.h"
#include "tests/run_program.h"

SUITE(start_view) {

TEST_CASE("eyes look at their lenses or where they are said to") {
    Headset headset;
    headset.size_px = {64, 64};
    headset.angles = {ViewAngles{-0.8, 0.6, 0.7, -0.7}, ViewAngles{-0.6, 0.8, 0.7, -0.7}};
    headset.canting_rad = 0.1;
    headset.lens_centres = {glm::dvec3(-0.1, 0.0, 1.0), glm::dvec3(0.1, 0.0, 1.0)};
    CameraFiles files;
    files.headset = headset;
    const auto gazes = [&](const std::string& words) {
        const RunOptions options = renderOptions(words);
        return gazesOf(makeCameras(options, files, Scene{}), options.stereo);
    };
    CHECK(!gazes("")[kLeft]);
    CHECK(!gazes("--gaze 0,0,1")[kRight]);
    const auto at_lenses = gazes("--foveation 15");
    REQUIRE(at_lenses[kLeft]);
    CHECK(these(at_lenses[kLeft]->clear_rad, at_lenses[kLeft]->direction, at_lenses[kRight]->direction) ==
          these(doctest::Approx(glm::radians(15.0)), headset.lens_centres[kLeft],
                headset.lens_centres[kRight]));
    // For eyes that are turned outwards, the direction ahead of the head points inwards.
    const auto ahead = gazes("--foveation 15 --gaze 0,0,1");
    CHECK(ahead[kLeft]->direction.x == doctest::Approx(std::sin(0.1)));
    CHECK(ahead[kRight]->direction.x == doctest::Approx(-std::sin(0.1)));
    // The single eye of mono looks midway between both eyes' gazes, or where the options say.
    const auto of_one = gazes("--mode mono --foveation 15");
    REQUIRE(of_one[0]);
    CHECK_FALSE(of_one[1]);
    CHECK(std::abs(of_one[0]->direction.x) < 1e-12);
    CHECK(of_one[0]->direction.z > 1.0);
    CHECK(gazes("--mode mono --foveation 15 --gaze 1,0,2")[0]->direction == glm::dvec3(1, 0, 2));
    CHECK(parse<BenchOptions>("bench a --out b --foveation 1 --gaze 1,0,1").run.stereo.gaze ==
          glm::dvec3(1, 0, 1));
}

TEST_CASE("eyes stand half their distance from the middle") {
    RunOptions options = renderOptions("--eye 1,2,3 --look 1,2,5 --ipd 0.08 --size 200x100 --fov-x 90");
    options.metres_per_unit = 2.0;
    const Cameras cameras = makeCameras(options, {}, makeBox("box.ply"));
    CHECK(cameras.eye_distance == doctest::Approx(0.04));
    // Up is -y by default, so the camera's x is the world's x here.
    CHECK(glm::length(cameras.eyes[kLeft].world_from_camera.position - glm::dvec3(0.98, 2.0, 3.0)) < 1e-12);
    CHECK(glm::length(cameras.eyes[kRight].world_from_camera.position - glm::dvec3(1.02, 2.0, 3.0)) < 1e-12);
    CHECK(these(cameras.middle.intrinsics.fx, cameras.middle.intrinsics.fy, cameras.middle.intrinsics.cx,
                cameras.middle.intrinsics.cy) ==
          these(doctest::Approx(100.0), doctest::Approx(100.0), 100.0, 50.0));
}

TEST_CASE("a file is framed whole, upright where its y is up, and from afar where it is one wide splat") {
    Scene scene = makeBox("box.ply");
    const Cameras cameras = makeCameras(renderOptions(""), {}, scene);
    const Intrinsics& k = cameras.middle.intrinsics;
    for (const glm::vec3& p : scene.positions) {
        const glm::dvec3 c = transform(inverse(cameras.middle.world_from_camera), glm::dvec3(p));
        CHECK(c.z > 0.2);
        CHECK(std::abs(k.fx * c.x / c.z) < 512.0);
        CHECK(std::abs(k.fy * c.y / c.z) < 512.0);
    }
    CHECK_NOTHROW(makeCameras(renderOptions(""), {}, Scene{}));
    // The near plane is as near as the scene is small, or where the options put it.
    Scene small = scene;
    for (glm::vec3& p : small.positions) { p *= 0.01f / static_cast<float>(coreSize(scene)); }
    CHECK(cameras.near == doctest::Approx(0.2 * std::min(coreSize(scene), 1.0)));
    CHECK(makeCameras(renderOptions(""), {}, small).near == doctest::Approx(0.002));
    CHECK(makeCameras(renderOptions("--near 0.3"), {}, small).near == 0.3);
    const View trained = startView(scene, {60.0}).view;
    scene.y_up = true;
    const View upright = startView(scene, {60.0}).view;
    CHECK(trained.up == glm::dvec3(0.0, -1.0, 0.0));
    CHECK(these(upright.up, upright.look, upright.eye.z - upright.look.z) ==
          these(glm::dvec3(0.0, 1.0, 0.0), trained.look, doctest::Approx(trained.look.z - trained.eye.z)));
    CHECK(upright.eye.z > upright.look.z);
    Scene one;
    one.name = "one.ply";
    one.positions = {glm::vec3(1.0f, 2.0f, 3.0f)};
    CHECK(startView(one, {60.0}).view.eye.z == doctest::Approx(2.0));
    one.scales = {glm::vec2(0.1f, 4.0f)};
    CHECK(startView(one, {60.0}).view.eye.z == doctest::Approx(3.0 - 24.0));
}

TEST_CASE_FIXTURE(AtWork, "cameras lie in a scene's folder, beside it, or where training leaves them") {
    const fs::path garden = work.path / "garden", iteration = garden / "point_cloud/iteration_7000",
                   sog = work.path / "sog";
    const fs::path scene = work.path / "a.ply", beside = work.path / "cameras.json",
                   trained = garden / "cameras.json";
    fs::create_directories(iteration);
    fs::create_directories(sog);
    for (const fs::path& file : {iteration / "point_cloud.ply", scene, sog / "meta.json"}) {
        writeText(file, "x");
    }
    const auto with = [&](const std::string& options) {
        return parse<RenderOptions>(fmt::format("render {} --out out {}", garden.string(), options))
            .run.camera;
    };
    CHECK(findCameraFile(scene).empty());
    writeText(beside, "[]");
    CHECK(these(findCameraFile(scene), findCameraFile(sog), findCameraFile(work.path / "sog/")) ==
          these(beside, beside, beside));
    CHECK(findCameraFile(garden).empty());  // these cameras belong to another scene
    CHECK(errorOf([&] { with("--view 1"); }).starts_with("--view is given without --cameras"));
    writeText(trained, "[]");
    writeText(sog / "cameras.json", "[]");
    CHECK(these(findCameraFile(garden), findCameraFile(iteration / "point_cloud.ply"), findCameraFile(sog)) ==
          these(trained, trained, sog / "cameras.json"));
    CHECK(findCameraFile(sog / "meta.json") == sog / "cameras.json");
    const auto viewed = parse<ViewOptions>("view " + scene.string() + " --view 3").run.camera;
    CHECK(these(viewed.cameras_file, viewed.view) == these(beside.string(), 3));
    CHECK(parse<ViewOptions>("view a --cameras c.json").run.camera.cameras_file == "c.json");
    CHECK(these(with("--view 1").cameras_file, with("--view 1").view, with("").cameras_file.empty()) ==
          these(trained.string(), 1, true));
    CHECK(with("--view 1 --cameras other.json").cameras_file == "other.json");
    CHECK(errorOf([&] { with("--view 1 --eye 0,0,0"); }) ==
          "--view and --eye contradict each other, must be one of them");
    writeText(work.path / "a.toml", "headset = \"quest2\"\n");
    CHECK(with("--view 1 --config " + (work.path / "a.toml").string()).headset.empty());
    writeText(work.path / "b.toml", "cameras = \"b.json\"\n");
    CHECK(with("--view 1 --config " + (work.path / "b.toml").string()).cameras_file ==
          (work.path / "b.json").string());
    const auto bench = parse<BenchOptions>("bench " + garden.string() + " --out out --view 1");
    CHECK(these(bench.run.camera.cameras_file, bench.asked.cameras_file) ==
          these(trained.string(), trained.string()));
    CHECK(errorOf([&] { parseLine("bench " + garden.string() + " builtin:fence --out out --view 1"); }) !=
          "");
    writeText(garden / "meta.json", "{}");  // a SOG scene is not the output of a training
    CHECK(with("--view 1").cameras_file == trained.string());
}

TEST_CASE_FIXTURE(AtWork, "one stands at the first camera that sees the scene, along the mean up of all") {
    Scene scene = makeBox((work.path / "box.ply").string());
    const auto camera = [&](const char* name, const glm::dvec3& at, const char* rotation) {
        return cameraJson(name, scene.origin + at, rotation, {100, 80}, 80.0);
    };
    const fs::path file = work.path / "cameras.json";
    // At 0, and in the coordinates of a country, in which files and options are.
    for (const glm::dvec3& origin : {glm::dvec3(500'000.0, -4'200'000.0, 0.0), glm::dvec3(0.0)}) {
        scene.origin = origin;
        // The first looks away; the others look along z, tilted by 0.2 to one side and to the other.
        const std::string away = camera("away", {0, 0, -9}, "[[-1, 0, 0], [0, 1, 0], [0, 0, -1]]"),
                          right = camera("right", {0, 0, -9},
                                         "[[0.98, -0.198997487, 0], [0.198997487, 0.98, 0], [0, 0, 1]]"),
                          left = camera("left", {1, 0, -9},
                                        "[[0.98, 0.198997487, 0], [-0.198997487, 0.98, 0], [0, 0, 1]]");
        writeText(file, "[" + away + "," + right + "," + left + "]");
        const StartView start = startView(scene);
        CAPTURE(start.why);
        CHECK(start.why.starts_with("at camera 1 (right) of "));
        CHECK(these(start.up_why, start.view.eye) == these("the mean of all cameras'", glm::dvec3(0, 0, -9)));
        CHECK(glm::distance(start.view.up, glm::dvec3(0, -1, 0)) < 1e-6);
        CHECK(glm::distance(glm::normalize(start.view.look - start.view.eye), glm::dvec3(0, 0, 1)) < 1e-6);
        CHECK(start.view.look.z == doctest::Approx(0.0));  // among the splats
        // A given place or camera comes first.
        const RunOptions placed =
            renderOptions(fmt::format("--eye {:.0f},{:.0f},{:.0f}", origin.x, origin.y, origin.z + 5.0));
        CHECK(startView(scene, placed.camera, 1.0).eye == glm::dvec3(0, 0, 5));
        const Cameras cameras = makeCameras(placed, {}, scene);
        CHECK(these(cameras.middle.world_from_camera.position, cameras.view->up, cameras.view->eye,
                    cameras.origin) ==
              these(glm::dvec3(0, 0, 5), start.view.up, origin + glm::dvec3(0, 0, 5), origin));
        CHECK(startView(scene, renderOptions("--view 2 --cameras " + file.string()).camera, 1.0).eye ==
              glm::dvec3(1, 0, -9));
        // Cameras of another scene and broken ones are reported and ignored.
        writeText(file, "[" + away + "]");
        CHECK(startView(scene).why.ends_with("cameras.json sees the scene"));
        CHECK(startView(scene).why.starts_with("outside"));
    }
    writeText(file, "[{}]");
    CHECK(contains(startView(scene).why, "not at a camera: " + file.string() + ": camera 0"));
    CHECK(startView(loadScene("builtin:fence")).why == "at the built-in scene's own view");
    // A drone's cameras look straight down, facing either way; z is up in what they see.
    Scene ground = makeBuiltin("builtin:atelier", 5000);
    for (glm::vec3& p : ground.positions) { p = {p.x, p.z, -p.y}; }
    ground.rotations.assign(ground.size(), glm::quat(1, 0, 0, 0));
    ground.name = scene.name;
    writeText(file, "[" + camera("there", {0, 2, 8}, "[[1, 0, 0], [0, -1, 0], [0, 0, -1]]") + "," +
                        camera("back", {0, 3, 8}, "[[-1, 0, 0], [0, 1, 0], [0, 0, -1]]") + "]");
    const StartView above = startView(ground);
    CAPTURE(above.up_why);
    CHECK(above.up_why.starts_with("that of the floor beneath the cameras"));
    CHECK(above.up_why.ends_with("; this camera looks along it and keeps its own"));
    CHECK(above.view.eye == glm::dvec3(0, 2, 8));
}

TEST_CASE("the up of cameras that all look straight down is the ground's; before a wall it is their own") {
    // A field of 40 by 40 with boxes on it, whose up is `up`.
    const auto field = [](const glm::dvec3& up, const glm::dvec3& u) {
        Scene scene;
        const glm::dvec3 v = glm::cross(up, u);
        const auto add = [&](double x, double y, double h) {
            scene.positions.emplace_back(x * u + y * v + h * up);
        };
        for (int x = -20; x < 20; ++x) {
            for (int y = -20; y < 20; ++y) {
                for (const double part : {0.1, 0.4, 0.7}) {
                    add(x + part, y + part, 0.02 * ((x * 7 + y * 5) % 5));
                }
                if (x % 8 != 0 || y % 8 != 0) { continue; }
                for (int i = 0; i < 48; ++i) { add(x + 0.2 * (i % 4), y + 0.2 * (i / 4 % 4), i / 16); }
            }
        }
        const glm::quat turn(glm::quat_cast(glm::dmat3(u, v, up)));
        scene.rotations.assign(scene.size(), turn);
        scene.scales.assign(scene.size(), glm::vec2(0.3f));
        scene.opacities.assign(scene.size(), 0.9f);
        return scene;
    };
    // Cameras above the field, `apart` from one another, that look down with the tops of pictures along u.
    const auto grid = [](const glm::dvec3& up, const glm::dvec3& u, double apart) {
        std::vector<FileCamera> cameras;
        for (int i = 0; i < 16; ++i) {
            const glm::dvec3 at = apart * ((i % 4 - 1.5) * u + (i / 4 - 1.5) * glm::cross(up, u)) + 20.0 * up;
            cameras.push_back({"", Eye{lookAt(at, at - up, u), {}, {100, 80}}});
        }
        return cameras;
    };
    const glm::dvec3 y_down(0.0, -1.0, 0.0), z_up(0.0, 0.0, 1.0), x(1.0, 0.0, 0.0);
    for (const glm::dvec3& up : {y_down, z_up}) {
        const auto found = upOfCameras(grid(up, x, 8.0), field(up, x));
        REQUIRE(found);
        CAPTURE(found->why);
        CHECK(glm::dot(found->up, up) > 0.999);
        CHECK(contains(found->why, "straight down"));
        // Cameras that are close together, as if held by hand in front of a wall, are believed.
        const auto close = upOfCameras(grid(up, x, 1.0), field(up, x));
        REQUIRE(close);
        CHECK(glm::dot(close->up, x) > 0.999);
        CHECK(close->why == "the mean of all cameras'");
    }
    // Only a wall may look like the ground does. Cameras in front of a wall stay level and turn about the
    // vertical; cameras that look down stay plumb, and turn as well.
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    // Turned by this many degrees about their own up, line of sight and right.
    const auto shaken = [&](double about_up, double about_sight, double about_right) {
        std::vector<FileCamera> cameras = grid(-z_up, x, 8.0);
        for (FileCamera& camera : cameras) {
            const auto by = [&](double degrees, const glm::dvec3& axis) {
                return glm::angleAxis(glm::radians(degrees) * normal(random), axis);
            };
            glm::dquat& turn = camera.eye.world_from_camera.orientation;
            turn = by(about_up, x) * turn;
            turn = turn * by(about_right, {1.0, 0.0, 0.0}) * by(about_sight, {0.0, 0.0, 1.0});
        }
        return upOfCameras(cameras, field(-z_up, x));
    };
    for (int i = 0; i < 20; ++i) {
        for (const auto& found : {shaken(6.0, 1.0, 5.0), shaken(2.0, 0.3, 0.3), shaken(1.0, 0.0, 6.0)}) {
            REQUIRE(found);
            CHECK(glm::dot(found->up, x) > 0.98);
            CHECK(found->why == "the mean of all cameras'");
        }
        for (const auto& found :
             {shaken(0.5, 2.0, 0.5), shaken(2.0, 3.0, 2.0), shaken(0.2, 0.0, 0.2), shaken(3.0, 3.0, 1.0)}) {
            REQUIRE(found);
            CHECK(glm::dot(found->up, -z_up) > 0.999);
        }
    }
    // Cameras in front of a wall with a street at its foot are believed, however far apart they are.
    Scene wall = field(-z_up, x);
    for (double u = -20.0; u < 20.0; u += 0.5) {
        for (double w = 0.0; w < 16.0; w += 0.5) {
            wall.positions.emplace_back(20.0, u, -w);
            wall.rotations.emplace_back(glm::quat_cast(glm::dmat3(glm::cross(z_up, x), z_up, x)));
        }
    }
    wall.scales.assign(wall.size(), glm::vec2(0.3f));
    wall.opacities.assign(wall.size(), 0.9f);
    const auto before_wall = upOfCameras(grid(-z_up, -x, 8.0), wall);
    REQUIRE(before_wall);
    CHECK(glm::dot(before_wall->up, -x) > 0.999);
    CHECK_FALSE(upOfCameras({}, wall));
}

}  // SUITE(start_view)
