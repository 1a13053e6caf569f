// `binosplat convert`, run as a program.
#include "engine/scene/scene.h"
#include "tests/run_program.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

TEST_SUITE_BEGIN("convert");

namespace convert_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

std::ptrdiff_t fileCount(const Workplace& work) {
    return std::distance(std::filesystem::directory_iterator(work.path), std::filesystem::directory_iterator());
}

void checkRefused(const Workplace& work, const std::string& arguments, int exit_code, const std::string& part) {
    const Outcome outcome = work.run(arguments);
    CHECK(outcome.exit_code == exit_code);
    CHECK(outcome.errors.find(part) != std::string::npos);
    CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
}

}  // namespace

TEST_CASE("a scene goes through PLY unchanged and through SPZ within its quanta") {
    const Workplace work;
    REQUIRE(work.run("convert builtin:slanted-wall a.ply").exit_code == 0);
    const Outcome outcome = work.run("convert a.ply b.spz");
    REQUIRE(outcome.exit_code == 0);
    CHECK(outcome.output.find("b.spz: 1681 splats (discs), SH degree 0") == 0);
    REQUIRE(work.run("convert b.spz c.ply").exit_code == 0);
    CHECK(fileCount(work) == 3);

    const Scene made = loadScene("builtin:slanted-wall");
    const Scene ply = loadScene((work.path / "a.ply").string()), spz = loadScene((work.path / "c.ply").string());
    REQUIRE(ply.size() == made.size());
    REQUIRE(spz.size() == made.size());
    CHECK(ply.positions == made.positions);
    CHECK(ply.sh == made.sh);
    for (std::size_t i = 0; i < made.size(); ++i) {
        CHECK(glm::distance(spz.positions[i], made.positions[i]) < 2e-5f);
        CHECK(std::abs(spz.opacities[i] - made.opacities[i]) < 0.002f);
    }
}

#ifdef BINOSPLAT_SOG
TEST_CASE("a scene goes through SOG and back, and stays discs") {
    const Workplace work;
    const Outcome outcome = work.run("convert builtin:slanted-wall a.sog");
    INFO(outcome.errors);
    REQUIRE(outcome.exit_code == 0);
    CHECK(outcome.output.find("a.sog: 1681 splats (discs), SH degree 0") == 0);
    REQUIRE(work.run("convert a.sog b.ply").exit_code == 0);
    REQUIRE(work.run("convert b.ply b.sog").exit_code == 0);
    CHECK(fileCount(work) == 3);
    const Scene made = loadScene("builtin:slanted-wall"), back = loadScene((work.path / "b.sog").string());
    REQUIRE(back.size() == made.size());
    CHECK_FALSE(back.isGaussian3d());
    checkRefused(work, "convert builtin:slanted-wall b.ply/c.sog", 1, "b.ply must be a directory");
    std::filesystem::create_directory(work.path / "d.sog");
    checkRefused(work, "convert builtin:slanted-wall d.sog", 1, "d.sog: is a directory");
    CHECK(fileCount(work) == 4);
}
#else
TEST_CASE("a build without libwebp says that it cannot write SOG") {
    const Workplace work;
    checkRefused(work, "convert builtin:one-splat a.sog", 1, "a.sog: this build cannot write SOG");
    CHECK(work.isEmpty());
}
#endif

TEST_CASE("each format says in one line what it loses") {
    const Workplace work;
    const auto lossOf = [&](const std::string& arguments) {
        const Outcome outcome = work.run("convert " + arguments);
        INFO(outcome.errors);
        CHECK(outcome.exit_code == 0);
        const std::size_t at = outcome.output.find("\n  loses: ");
        REQUIRE(at != std::string::npos);
        return outcome.output.substr(at + 10, outcome.output.find('\n', at + 1) - at - 10);
    };
    CHECK(lossOf("builtin:slanted-wall a.ply") == "nothing");
    CHECK(
        lossOf("a.ply a.spz") ==
        "positions in steps of 1.53e-05 units, scales of 6 %; colours and opacities of 8 bits; rotations of 10 bits a component; that its "
        "splats are discs (render it with --flatten)");
    CHECK(lossOf("a.spz b.spz").find("discs") == std::string::npos);
#ifdef BINOSPLAT_SOG
    CHECK(lossOf("a.ply a.sog") ==
          "the order of the splats; positions of 16 bits over the logarithm of the scene's extent; scales and colours of 256 values each; "
          "rotations and opacities of 8 bits");
#endif
}

TEST_CASE("a sphere can be cut out of a scene, and keeps all that its splats have") {
    const Workplace work;
    const Scene wall = loadScene("builtin:slanted-wall");
    const glm::dvec3 centre(wall.positions[100]);
    const Outcome outcome = work.run(fmt::format("convert builtin:slanted-wall a.ply --crop {},{},{},0.5", centre.x, centre.y, centre.z));
    INFO(outcome.errors);
    REQUIRE(outcome.exit_code == 0);
    const Scene cut = loadScene((work.path / "a.ply").string());
    CHECK(outcome.output.find(fmt::format("{} of 1681 splats lie within", cut.size())) != std::string::npos);
    std::size_t next = 0;
    for (std::size_t i = 0; i < wall.size(); ++i) {
        if (glm::distance(glm::dvec3(wall.positions[i]), centre) > 0.5) { continue; }
        REQUIRE(next < cut.size());
        CHECK(cut.positions[next] == wall.positions[i]);
        CHECK(std::equal(cut.sh.begin() + 3 * static_cast<std::ptrdiff_t>(next), cut.sh.begin() + 3 * static_cast<std::ptrdiff_t>(next + 1),
                         wall.sh.begin() + 3 * static_cast<std::ptrdiff_t>(i)));
        ++next;
    }
    CHECK(next == cut.size());
    CHECK(next > 1);
    CHECK(next < wall.size());
    for (const char* wrong : {"0,0,0", "0,0,0,0", "0,0,0,-1", "0,0,nan,1", "0,0,0,inf", "0,0,0,1,2", ","}) {
        checkRefused(work, std::string("convert builtin:slanted-wall b.ply --crop=") + wrong, 1, "must be four finite numbers x,y,z,r");
    }
    checkRefused(work, "convert builtin:slanted-wall b.ply --crop 1e6,0,0,1", 1,
                 "builtin:slanted-wall: none of its 1681 splats lies within --crop 1000000,0,0,1");
    CHECK(fileCount(work) == 1);
}

TEST_CASE("a scene may take the place of its own file") {
    const Workplace work;
    REQUIRE(work.run("convert builtin:one-splat a.ply").exit_code == 0);
    REQUIRE(work.run("convert a.ply a.ply").exit_code == 0);
    CHECK(loadScene((work.path / "a.ply").string()).size() == 1);
    CHECK(fileCount(work) == 1);
}

TEST_CASE("what cannot be converted leaves nothing behind") {
    const Workplace work;
    checkRefused(work, "convert builtin:one-splat a.obj", 1, "a.obj: must be a file whose name ends in .ply, .spz or .sog");
    checkRefused(work, "convert builtin:one-splat nowhere/a.ply", 1, "nowhere must be a directory");
    checkRefused(work, "convert absent.ply a.ply", 1, "absent.ply: no such file");
    checkRefused(work, "convert builtin:one-splat", 2, "OUT");
    CHECK(work.isEmpty());
    std::filesystem::create_directory(work.path / "folder.spz");
    checkRefused(work, "convert builtin:one-splat folder.spz", 1, "folder.spz: is a directory");
    CHECK(std::filesystem::is_empty(work.path / "folder.spz"));
}

}  // namespace convert_test
