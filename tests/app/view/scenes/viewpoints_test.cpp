// Facts about places in a scene: where the eyes are at them, and how they are kept and shared.
#include "app/view/scenes/viewpoints.h"
#include "app/view/settings/view_files.h"
#include "app/view/settings/view_state.h"
#include "tests/app/camera_file.h"
#include "tests/run_program.h"

SUITE(viewpoints) {

TEST_CASE("at a viewpoint the eyes are there and upright, wherever the head is, at the same scale") {
    const View view{{1, 2, 3}, {1, 2.5, 5}, {0, -1, 0.1}, 60.0};
    const Pose head{glm::angleAxis(0.7, glm::dvec3(0, 1, 0)), {0.3, -0.2, 0.5}};
    const Similarity placed = placedAt(view, {{1, 0, 0, 0}, {9, 9, 9}, 2.5}, head);
    CHECK(placed.scale == 2.5);
    CHECK(glm::distance(transform(placed, head.position), view.eye) < 1e-9);
    const glm::dvec3 up = glm::normalize(view.up), ahead = view.look - view.eye;
    CHECK(glm::distance(placed.orientation * glm::dvec3(0, -1, 0), up) < 1e-9);
    const glm::dvec3 looks = transform(placed, head).orientation * glm::dvec3(0, 0, 1);
    CHECK(glm::distance(looks, glm::normalize(ahead - glm::dot(ahead, up) * up)) < 1e-9);
    // A viewpoint that is kept there leads back there.
    const View kept = viewOf(placed, head);
    const Similarity again = placedAt(kept, placed, head);
    CHECK(glm::distance(again.position, placed.position) < 1e-9);
}

TEST_CASE("a place is saved and asked for in the coordinates of the scene's file") {
    ViewSettings settings;
    settings.scene_from_room = Similarity{{1, 0, 0, 0}, {7, 8, 9}, 2.0};
    ViewState state(settings);
    state.countFrom({1.0, 2.0, 3.0});
    CHECK(state.takeAsked()->position == glm::dvec3(6, 6, 6));
    state.place({{1, 0, 0, 0}, {0, 0, 1}, 1.0});
    CHECK(state.withPlacement().scene_from_room->position == glm::dvec3(1, 2, 4));
    state.set(settings);
    CHECK(these(state.sceneFromRoom().position, state.sceneFromRoom().scale) ==
          these(glm::dvec3(6, 6, 6), 2.0));
}

TEST_CASE_FIXTURE(Home, "viewpoints are the cameras beside the scene, and then those that were kept") {
    const std::string scene = at("a.ply");
    write("a.ply", "x");
    CHECK(findViewpoints({}, scene, {}).empty());
    const fs::path kept = viewFileStem(scene).string() + ".viewpoints.json",
                   old = viewFileStem(scene).string() + ".viewpoints.txt";
    fs::create_directories(kept.parent_path());
    std::ofstream(old) << "0 0 1  0 0 2  0 -1 0\n0 0 3  1 0 3  0 -1 0\n";
    write("cameras.json", "[" + cameraJson("door", {5, 0, 0}) + "]");
    // Lines that are not views: one looks along its own up, and one is incomplete.
    std::ofstream(old, std::ios::app) << "0 0 1 0 0 2 0 0 1\n0 0 1 0\n";
    const std::vector<Viewpoint> found = findViewpoints({}, scene, {});
    REQUIRE(found.size() == 3);
    CHECK(these(found[0].name, found[0].view.eye, found[1].view.eye, found[2].name) ==
          these("door", glm::dvec3(5, 0, 0), glm::dvec3(0, 0, 1), "your own 2"));
    // Viewpoints are in the coordinates of the scene's file, whatever origin its positions count from.
    Scene far;
    far.origin = {4.0, 0.0, -2.0};
    const std::vector<Viewpoint> there = findViewpoints(far, scene, {});
    REQUIRE(there.size() == 3);
    CHECK(these(there[0].view.eye, there[2].view.eye, there[2].view.look) ==
          these(glm::dvec3(1, 0, 2), glm::dvec3(-4, 0, 5), glm::dvec3(-3, 0, 5)));
    CHECK(findViewpoints(far, scene, path / "cameras.json")[0].view.eye == glm::dvec3(1, 0, 2));
    // Viewpoints from older programs move to where all are kept now, in their order and with their names.
    std::vector<Viewpoint> own = keptViewpoints(scene);
    own.back().name = "\u00fcber dem Tisch \"2\"";
    std::swap(own[0], own[1]);
    keepViewpoints(scene, own);
    CHECK_FALSE(fs::exists(old));
    own = keptViewpoints(scene);
    REQUIRE(own.size() == 2);
    CHECK(these(own[0].name, own[0].view.eye, own[0].is_own, own[1].name) ==
          these("\u00fcber dem Tisch \"2\"", glm::dvec3(0, 0, 3), true, "your own 1"));
    // Viewpoints from other people lie beside the scene, and count if the user has kept none.
    CHECK(sharedViewpoints(scene) == at("a.viewpoints.json"));
    writeViewpoints(sharedViewpoints(scene), {own[1]});
    CHECK(keptViewpoints(scene).size() == 2);
    fs::remove(kept);
    REQUIRE(keptViewpoints(scene).size() == 1);
    CHECK(keptViewpoints(scene)[0].view.look == glm::dvec3(0, 0, 2));
}

TEST_CASE_FIXTURE(Home, "a list of viewpoints that is broken is one line with the place") {
    const auto with = [](const std::string& eye) {
        return R"({"viewpoints": [{"name": "a", "eye": )" + eye +
               R"(, "look": [0, 0, 1], "up": [0, -1, 0]}]})";
    };
    write("good.viewpoints.json", with("[0, 0, 0]"));
    CHECK(readViewpoints(at("good.viewpoints.json")).size() == 1);
    for (const auto& [text, part] : {std::pair(std::string("{"), "JSON"),
                                     {"{}", "viewpoints"},
                                     {with("[0, 0]"), "viewpoints[0].eye"},
                                     {with(R"([0, "x", 0])"), "viewpoints[0].eye[1]"},
                                     {with("[0, 0, 1]"), "viewpoints[0]: looks nowhere"}}) {
        write("bad.viewpoints.json", text);
        const std::string error = errorOf([&] { (void)readViewpoints(at("bad.viewpoints.json")); });
        CHECK(error.starts_with(at("bad.viewpoints.json") + ": "));
        CHECK_MESSAGE(contains(error, part), error);
    }
}

}  // SUITE(viewpoints)
