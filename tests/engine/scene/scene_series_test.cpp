// Which files of a folder are a moving scene.
#include "engine/scene/scene_series.h"

#include "engine/error.h"
#include "tests/engine/scene/ply_files.h"

#include <doctest/doctest.h>

TEST_SUITE_BEGIN("scene_series");

namespace scene_series_test {

using namespace binosplat;
using namespace binosplat::test;
namespace fs = std::filesystem;

namespace {

std::string withSplats(int splats) {
    PlyText ply = makePly();
    for (Column& column : ply.columns) { column.values.resize(static_cast<std::size_t>(splats), column.values[0]); }
    return ply.bytes();
}

struct Garden : Folder {
    void place(const std::string& name, const std::string& bytes) const { (void)write(name, bytes); }
    [[nodiscard]] std::string path() const { return fs::path(file("x")).parent_path().string(); }
    [[nodiscard]] std::string error() const {
        try {
            (void)SceneSeries(path());
        } catch (const Error& error) { return error.what(); }
        return {};
    }
    // Splats of each frame's scene.
    [[nodiscard]] std::vector<std::size_t> counts() const {
        const SceneSeries series(path());
        std::vector<std::size_t> counts;
        LoadNotes notes;
        for (std::size_t frame = 0; frame < series.size(); ++frame) { counts.push_back(series.load(series.sceneOf(frame), notes).size()); }
        return counts;
    }
};

}  // namespace

TEST_CASE("numbered files are frames in the order of their numbers, whatever else lies beside them") {
    const Garden garden;
    CHECK_FALSE(isMovingScene(garden.path()));
    garden.place("step_9.ply", withSplats(1));
    garden.place("notes_1.txt", "no scene"), garden.place("notes_2.txt", "no scene"), garden.place("notes_3.txt", "no scene");
    CHECK_FALSE(isMovingScene(garden.path()));
    CHECK_FALSE(garden.error().empty());
    garden.place("step_10.ply", withSplats(2)), garden.place("step_11.ply", withSplats(3));
    garden.place("other.ply", withSplats(9));
    CHECK(isMovingScene(garden.path()));
    CHECK(garden.counts() == std::vector<std::size_t>{1, 2, 3});
    CHECK(SceneSeries(garden.path()).lines().empty());
    CHECK(SceneSeries(garden.path()).growth() > 1.0);
    CHECK_FALSE(isMovingScene(garden.file("step_9.ply")));
    CHECK_FALSE(isMovingScene("builtin:atelier"));
}

TEST_CASE("a number that is missing shows what comes before it for longer, and numbers without any order count as they come") {
    const Garden garden;
    for (const int number : {10, 20, 50, 60}) { garden.place(fmt::format("t{:03}.ply", number), withSplats(number / 10)); }
    CHECK(garden.counts() == std::vector<std::size_t>{1, 2, 2, 2, 5, 6});
    const SceneSeries series(garden.path());
    CHECK(series.sceneCount() == 4);
    REQUIRE(series.lines().size() == 1);
    CHECK(series.lines()[0].find("2 of 6 numbered files are missing, the first after t020.ply") != std::string::npos);

    garden.place("t901.ply", withSplats(9));
    CHECK(garden.counts() == std::vector<std::size_t>{1, 2, 5, 6, 9});
    garden.place("t99999999999999999999999999.ply", withSplats(7));
    CHECK(garden.counts() == std::vector<std::size_t>{1, 2, 5, 6, 9, 7});
}

TEST_CASE("two moving scenes in one folder, and formats that differ, are refused") {
    const Garden garden;
    for (const int number : {1, 2}) { garden.place(fmt::format("a{}.ply", number), withSplats(1)); }
    CHECK(garden.error().empty());
    for (const int number : {1, 2}) { garden.place(fmt::format("b{}.ply", number), withSplats(1)); }
    CHECK(garden.error().find("expected one moving scene") != std::string::npos);
    garden.place("b3.ply", withSplats(3));  // now one is the larger
    CHECK(garden.counts() == std::vector<std::size_t>{1, 1, 3});

    // In the middle, where nobody has looked yet.
    garden.place("b2.ply", std::string(320, '\0'));
    const SceneSeries series(garden.path());
    LoadNotes notes;
    CHECK_THROWS_AS((void)series.load(1, notes), Error);
    CHECK(series.load(2, notes).size() == 3);
}

}  // namespace scene_series_test
