// Facts about places to go to in a scene, and about what is kept of scenes that were shown.
#include "app/view/scenes/viewpoints.h"
#include "app/view/governor/met_displays.h"
#include "app/view/scenes/recent_scenes.h"
#include "app/view/scenes/scene_list.h"
#include "app/view/scenes/seen_scenes.h"
#include "tests/run_program.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>

TEST_SUITE_BEGIN("viewpoints");

namespace viewpoints_test {

namespace fs = std::filesystem;
using namespace binosplat;
using binosplat::test::Workplace;

TEST_CASE("at a viewpoint the eyes are there, look that way and stand upright, wherever the head is in the room, at the same scale") {
    const View view{{1, 2, 3}, {1, 2.5, 5}, {0, -1, 0.1}, 60.0};
    const Pose head{glm::angleAxis(0.7, glm::dvec3(0, 1, 0)), {0.3, -0.2, 0.5}};
    const Similarity placed = placedAt(view, {{1, 0, 0, 0}, {9, 9, 9}, 2.5}, head);
    CHECK(placed.scale == 2.5);
    CHECK(glm::distance(transform(placed, head.position), view.eye) < 1e-9);
    const glm::dvec3 up = glm::normalize(view.up), ahead = view.look - view.eye;
    CHECK(glm::distance(placed.orientation * glm::dvec3(0, -1, 0), up) < 1e-9);
    const glm::dvec3 looks = transform(placed, head).orientation * glm::dvec3(0, 0, 1);
    CHECK(glm::distance(looks, glm::normalize(ahead - glm::dot(ahead, up) * up)) < 1e-9);
    // What is kept there leads back there.
    const View kept = viewOf(placed, head);
    const Similarity again = placedAt(kept, placed, head);
    CHECK(glm::distance(again.position, placed.position) < 1e-9);
}

TEST_CASE("viewpoints are the cameras beside the scene, and then those that were kept") {
    const Workplace work;
    setenv("XDG_CONFIG_HOME", (work.base / "config").c_str(), 1);
    const std::string scene = (work.path / "a.ply").string();
    std::ofstream(scene) << "x";
    CHECK(findViewpoints(scene, {}).empty());
    keepViewpoint(scene, {{0, 0, 1}, {0, 0, 2}, {0, -1, 0}, 60.0});
    keepViewpoint(scene, {{0, 0, 3}, {1, 0, 3}, {0, -1, 0}, 60.0});
    std::ofstream(work.path / "cameras.json")
        << R"([{"img_name": "door", "width": 8, "height": 8, "position": [5, 0, 0], "rotation": [[1,0,0],[0,1,0],[0,0,1]], "fx": 8, "fy": 8}])";
    const std::vector<Viewpoint> found = findViewpoints(scene, {});
    REQUIRE(found.size() == 3);
    CHECK(found[0].name == "door");
    CHECK(found[0].view.eye == glm::dvec3(5, 0, 0));
    CHECK(found[1].view.eye == glm::dvec3(0, 0, 1));
    CHECK(found[2].name == "your own 2");
    unsetenv("XDG_CONFIG_HOME");
}

TEST_CASE("a scene that was shown has a small picture and a line, and favourites come first") {
    const Workplace work;
    setenv("XDG_CONFIG_HOME", (work.base / "config").c_str(), 1);
    for (const char* name : {"a.ply", "b.ply", "c.ply"}) { std::ofstream(work.path / name) << "x"; }
    Image wide{{400, 100}, 4, {}};
    for (int y = 0; y < 100; ++y) {
        for (int x = 0; x < 400; ++x) { wide.values.insert(wide.values.end(), {x < 200 ? 0.0f : 1.0f, 0.5f, 0.0f, 1.0f}); }
    }
    const Image small = makeScenePicture(wide);
    CHECK(small.size_px == kScenePicturePx);
    CHECK(small.values.size() == small.pixelCount() * 3);
    CHECK(small.values[0] == 0.0f);
    CHECK(small.values[small.values.size() - 3] == 1.0f);
    keepSeenScene((work.path / "b.ply").string(), small, "7 splats, discs");
    toggleFavourite((work.path / "c.ply").string());
    SceneList list = listFolder(work.path.string());
    describeScenes(list);
    REQUIRE(list.entries.size() == 3);
    CHECK(list.entries[0].name == "c.ply");
    CHECK(list.entries[0].is_favourite);
    CHECK(list.entries[1].picture.key.empty());
    CHECK(list.entries[1].about == "0.0 KiB");
    CHECK(list.entries[2].about == "7 splats, discs");
    CHECK(list.entries[2].picture.rgba.size() == std::size_t{4} * kScenePicturePx.x * kScenePicturePx.y);
    toggleFavourite((work.path / "c.ply").string());
    CHECK(favouriteScenes().empty());
    unsetenv("XDG_CONFIG_HOME");
}

TEST_CASE("the rate is that of displays with a new picture") {
    MetDisplays met;
    CHECK(met.displayHz() == 0.0);
    for (int i = 0; i < 100; ++i) { met.add(10.0, 0.0); }
    CHECK(met.metHz() == doctest::Approx(100.0));
    for (int i = 0; i < 200; ++i) { met.add(10.0, 1.0); }
    CHECK(met.displayHz() == doctest::Approx(100.0));
    CHECK(met.metHz() == doctest::Approx(50.0));
}

}  // namespace viewpoints_test
