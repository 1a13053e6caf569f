// Where one stands at first: at a camera that lies with the scene, or where the options say.
#include "app/options/start_view.h"
#include "app/options/camera_options.h"
#include "app/view/placement/placement.h"
#include "engine/scene/scene_folder.h"
#include "engine/setup/output_files.h"
#include "tests/run_program.h"

#include <doctest/doctest.h>

TEST_SUITE_BEGIN("start_view");

namespace start_view_test {

namespace fs = std::filesystem;
using namespace binosplat;
using binosplat::test::Workplace;

namespace {

template <typename Chosen>
Chosen parse(std::vector<std::string> words) {
    std::vector<const char*> arguments{"binosplat"};
    for (const std::string& word : words) { arguments.push_back(word.c_str()); }
    return std::get<Chosen>(parseOptions(static_cast<int>(arguments.size()), arguments.data()));
}

RunOptions render(std::vector<std::string> words) {
    words.insert(words.begin(), {"render", "builtin:one-splat", "--out", "out"});
    return parse<RenderOptions>(words).run;
}

// A scene that fills the box from (-1, -2, -3) to (1, 2, 3).
Scene makeBox() {
    Scene scene;
    for (int i = 0; i <= 100; ++i) {
        const float t = static_cast<float>(i) / 50.0f - 1.0f;
        scene.positions.emplace_back(t, 2.0f * t, 3.0f * t);
    }
    return scene;
}

}  // namespace

TEST_CASE("cameras lie with a scene in its folder, beside it, or where training leaves them") {
    const Workplace work;
    const fs::path garden = work.path / "garden", iteration = garden / "point_cloud/iteration_7000";
    fs::create_directories(iteration);
    fs::create_directories(work.path / "sog");
    for (const fs::path& file : {iteration / "point_cloud.ply", work.path / "a.ply", work.path / "sog/meta.json"}) { writeText(file, "x"); }
    CHECK(findCameraFile(work.path / "a.ply").empty());
    writeText(work.path / "cameras.json", "[]");
    CHECK(findCameraFile(work.path / "a.ply") == work.path / "cameras.json");
    CHECK(findCameraFile(work.path / "sog") == work.path / "cameras.json");
    CHECK(findCameraFile(work.path / "sog/") == work.path / "cameras.json");
    CHECK(findCameraFile(garden).empty());  // of another scene
    writeText(garden / "cameras.json", "[]");
    writeText(work.path / "sog/cameras.json", "[]");
    CHECK(findCameraFile(garden) == garden / "cameras.json");
    CHECK(findCameraFile(iteration / "point_cloud.ply") == garden / "cameras.json");
    CHECK(findCameraFile(work.path / "sog") == work.path / "sog/cameras.json");
    CHECK(findCameraFile(work.path / "sog/meta.json") == work.path / "sog/cameras.json");
    const auto view = parse<ViewOptions>({"view", (work.path / "a.ply").string(), "--view", "3"});
    CHECK(view.run.camera.cameras_file == (work.path / "cameras.json").string());
    CHECK(view.run.camera.view == 3);
    CHECK(parse<ViewOptions>({"view", "a.ply", "--cameras", "c.json"}).run.camera.cameras_file == "c.json");
}

TEST_CASE("one stands at the first camera that sees the scene, upright along the mean up of all") {
    const Workplace work;
    Scene scene = makeBox();
    scene.name = (work.path / "box.ply").string();
    const auto camera = [](const char* name, const char* position, const char* rotation) {
        return fmt::format(R"({{"img_name": "{}", "position": {}, "rotation": {}, "width": 100, "height": 80, "fx": 80, "fy": 80}})", name,
                           position, rotation);
    };
    // The first looks away from the scene; the second looks along z, tilted by 0.2 to one side as the third is to the other.
    const std::string away = camera("away", "[0, 0, -9]", "[[-1, 0, 0], [0, 1, 0], [0, 0, -1]]"),
                      right = camera("right", "[0, 0, -9]", "[[0.98, -0.198997487, 0], [0.198997487, 0.98, 0], [0, 0, 1]]"),
                      left = camera("left", "[1, 0, -9]", "[[0.98, 0.198997487, 0], [-0.198997487, 0.98, 0], [0, 0, 1]]");
    writeText(work.path / "cameras.json", "[" + away + "," + right + "," + left + "]");
    const StartView start = startView(scene);
    CAPTURE(start.why);
    CHECK(start.why.starts_with("at camera 1 (right) of "));
    CHECK(start.why.find("the mean of all cameras'") != std::string::npos);
    CHECK(start.view.eye == glm::dvec3(0, 0, -9));
    CHECK(glm::distance(start.view.up, glm::dvec3(0, -1, 0)) < 1e-6);
    CHECK(glm::distance(glm::normalize(start.view.look - start.view.eye), glm::dvec3(0, 0, 1)) < 1e-6);
    CHECK(start.view.look.z == doctest::Approx(0.0));  // among the splats
    // A place that is given wins, and so does a camera.
    RunOptions options = render({"--eye", "0,0,5"});
    CHECK(startView(scene, options.camera, 1.0).eye == glm::dvec3(0, 0, 5));
    CHECK(makeCameras(options, {}, scene).view->up == start.view.up);
    options = render({"--cameras", (work.path / "cameras.json").string(), "--view", "2"});
    CHECK(startView(scene, options.camera, 1.0).eye == glm::dvec3(1, 0, -9));
    // Cameras of another scene and broken ones are said, and left.
    writeText(work.path / "cameras.json", "[" + away + "]");
    CHECK(startView(scene).why.ends_with("cameras.json sees the scene"));
    CHECK(startView(scene).why.starts_with("outside"));
    writeText(work.path / "cameras.json", "[{}]");
    CHECK(startView(scene).why.find("not at a camera: " + (work.path / "cameras.json").string() + ": camera 0") != std::string::npos);
    CHECK(startView(loadScene("builtin:fence")).why == "at the built-in scene's own view");
}

TEST_CASE("a wearer starts at the camera that is asked for, upright") {
    const Workplace work;
    Scene scene = makeBox();
    scene.name = (work.path / "box.ply").string();
    // It looks down by some 37 degrees, along (0, 0.6, 0.8).
    writeText(
        work.path / "c.json",
        R"([{"position": [1, 2, 3], "rotation": [[1, 0, 0], [0, 0.8, 0.6], [0, -0.6, 0.8]], "width": 8, "height": 8, "fx": 9, "fy": 9}])");
    const CameraOptions camera = parse<ViewOptions>({"view", scene.name, "--cameras", (work.path / "c.json").string()}).run.camera;
    const Similarity start = startPlacement(startView(scene, camera, 1.0), 1.0);
    CHECK(glm::distance(start.position, glm::dvec3(1, 2, 3)) < 1e-12);
    // Up is the camera's.
    CHECK(glm::distance(start.orientation * glm::dvec3(0, -1, 0), glm::dvec3(0, -0.8, 0.6)) < 1e-6);
}

}  // namespace start_view_test
