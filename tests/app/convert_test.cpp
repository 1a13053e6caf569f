// `binosplat convert`, run as a program.
#include "engine/files/load_scene.h"
#include "tests/app/program_script.h"

SUITE(convert) {

using Files = std::set<std::string>;

struct Converted : Workplace {
    // The line that says what was written, and the one that says what was lost.
    struct Said {
        std::string written, loses;
    };
    [[nodiscard]] Said convert(const std::string& arguments) const {
        const std::string output = go("convert " + arguments).output;
        const std::string sign = "\n  loses: ";
        const std::size_t at = output.find(sign), begin = at + sign.size();
        REQUIRE(at != std::string::npos);
        return {output.substr(0, at), output.substr(begin, output.find('\n', begin) - begin)};
    }
    [[nodiscard]] Scene load(const std::string& name) const { return loadScene((path / name).string()); }
};

TEST_CASE_FIXTURE(Converted, "a scene goes through every format within what the line says that it loses") {
    CHECK(convert("builtin:slanted-wall a.ply").loses == "nothing");
    const Converted::Said spz = convert("a.ply b.spz");
    CHECK(spz.written.starts_with("b.spz: 1681 splats (discs), SH degree 0"));
    CHECK(spz.loses ==
          "positions in steps of 1.53e-05 units, scales of 6 %; colours and opacities of 8 bits; rotations "
          "of 10 bits a component; "
          "that its splats are discs (render it with --flatten)");
    CHECK_FALSE(contains(convert("b.spz b.spz").loses, "discs"));
    static_cast<void>(convert("b.spz c.ply"));
    static_cast<void>(convert("a.ply a.ply"));
    CHECK(files() == Files{"a.ply", "b.spz", "c.ply"});
    const Scene made = loadScene("builtin:slanted-wall"), ply = load("a.ply"), back = load("c.ply");
    REQUIRE(back.size() == made.size());
    CHECK(these(ply.positions, ply.sh) == these(made.positions, made.sh));
    for (std::size_t i = 0; i < made.size(); ++i) {
        CHECK(glm::distance(back.positions[i], made.positions[i]) < 2e-5f);
        CHECK(std::abs(back.opacities[i] - made.opacities[i]) < 0.002f);
    }
#ifdef BINOSPLAT_SOG
    const Converted::Said sog = convert("a.ply a.sog");
    CHECK(sog.written.starts_with("a.sog: 1681 splats (discs), SH degree 0"));
    CHECK(sog.loses ==
          "the order of the splats; positions of 16 bits over the logarithm of the scene's extent; scales "
          "and colours of 256 values "
          "each; rotations and opacities of 8 bits");
    static_cast<void>(convert("a.sog d.ply"));
    static_cast<void>(convert("d.ply d.sog"));
    CHECK(these(load("d.sog").size(), load("d.sog").isGaussian3d()) == these(made.size(), false));
#endif
}

TEST_CASE_FIXTURE(Converted, "a sphere can be cut out of a scene, and keeps all that its splats have") {
    const Scene wall = loadScene("builtin:slanted-wall");
    const glm::dvec3 centre(wall.positions[100]);
    const Outcome outcome = go(
        fmt::format("convert builtin:slanted-wall a.ply --crop {},{},{},0.5", centre.x, centre.y, centre.z));
    const Scene cut = load("a.ply");
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
    checkRefused("convert builtin:slanted-wall b.ply --crop 1e6,0,0,1", 1,
                 "builtin:slanted-wall: none of its 1681 splats lies within --crop 1000000,0,0,1");
    CHECK(files() == Files{"a.ply"});
}

SCRIPT(convert, "app/convert") { runProgramScript(); }

}  // SUITE(convert)
