// `binosplat convert`, run as a program.
#include "engine/files/load_scene.h"
#include "tests/app/program_script.h"

SUITE(convert) {

SCRIPT(convert, "app/convert") { runProgramScript(); }

TEST_CASE_FIXTURE(AtWork, "a sphere can be cut out of a scene, and keeps all that its splats have") {
    const Scene wall = loadScene("builtin:slanted-wall");
    const glm::dvec3 centre(wall.positions[100]);
    const Outcome outcome = work.go(
        fmt::format("convert builtin:slanted-wall a.ply --crop {},{},{},0.5", centre.x, centre.y, centre.z));
    const Scene cut = loadScene((work.path / "a.ply").string());
    CHECK(contains(outcome.output, fmt::format("{} of 1681 splats lie within", cut.size())));
    std::size_t next = 0;
    for (std::size_t i = 0; i < wall.size(); ++i) {
        if (glm::distance(glm::dvec3(wall.positions[i]), centre) > 0.5) { continue; }
        REQUIRE(next < cut.size());
        CHECK(cut.positions[next] == wall.positions[i]);
        CHECK(std::equal(&cut.sh[3 * next], &cut.sh[3 * next] + 3, &wall.sh[3 * i]));
        ++next;
    }
    CHECK(next == cut.size());
    CHECK(next == between(1, wall.size()));
}

}  // SUITE(convert)
