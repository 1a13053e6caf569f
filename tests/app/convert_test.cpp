// `binosplat convert`, run as a program.
#include "engine/files/load_scene.h"
#include "tests/run_program.h"

SUITE(convert) {

using Files = std::set<std::string>;

struct Converted : Workplace {
    // The line of what was written, and what it loses.
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

TEST_CASE("a scene goes through every format within what the line says that it loses, and may take the place of its own file") {
    const Converted work;
    CHECK(work.convert("builtin:slanted-wall a.ply").loses == "nothing");
    const Converted::Said spz = work.convert("a.ply b.spz");
    CHECK(spz.written.starts_with("b.spz: 1681 splats (discs), SH degree 0"));
    CHECK(spz.loses ==
          "positions in steps of 1.53e-05 units, scales of 6 %; colours and opacities of 8 bits; rotations of 10 bits a component; "
          "that its splats are discs (render it with --flatten)");
    CHECK(work.convert("b.spz b.spz").loses.find("discs") == std::string::npos);
    static_cast<void>(work.convert("b.spz c.ply"));
    static_cast<void>(work.convert("a.ply a.ply"));
    CHECK(work.files() == Files{"a.ply", "b.spz", "c.ply"});
    const Scene made = loadScene("builtin:slanted-wall"), ply = work.load("a.ply"), back = work.load("c.ply");
    REQUIRE(back.size() == made.size());
    CHECK(these(ply.positions, ply.sh) == these(made.positions, made.sh));
    for (std::size_t i = 0; i < made.size(); ++i) {
        CHECK(glm::distance(back.positions[i], made.positions[i]) < 2e-5f);
        CHECK(std::abs(back.opacities[i] - made.opacities[i]) < 0.002f);
    }
#ifdef BINOSPLAT_SOG
    const Converted::Said sog = work.convert("a.ply a.sog");
    CHECK(sog.written.starts_with("a.sog: 1681 splats (discs), SH degree 0"));
    CHECK(sog.loses ==
          "the order of the splats; positions of 16 bits over the logarithm of the scene's extent; scales and colours of 256 values "
          "each; rotations and opacities of 8 bits");
    static_cast<void>(work.convert("a.sog d.ply"));
    static_cast<void>(work.convert("d.ply d.sog"));
    CHECK(these(work.load("d.sog").size(), work.load("d.sog").isGaussian3d()) == these(made.size(), false));
#else
    work.checkRefused("convert builtin:one-splat a.sog", 1, "a.sog: this build cannot write SOG");
#endif
}

TEST_CASE_FIXTURE(Converted, "a sphere can be cut out of a scene, and keeps all that its splats have") {
    const Scene wall = loadScene("builtin:slanted-wall");
    const glm::dvec3 centre(wall.positions[100]);
    const Outcome outcome = go(fmt::format("convert builtin:slanted-wall a.ply --crop {},{},{},0.5", centre.x, centre.y, centre.z));
    const Scene cut = load("a.ply");
    CHECK(outcome.output.find(fmt::format("{} of 1681 splats lie within", cut.size())) != std::string::npos);
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

TEST_CASE_FIXTURE(Converted, "a share, a number or a size of the splats can be kept, the same bytes on every run") {
    write("cameras.json", R"([{"position":[0,0,0],"rotation":[[1,0,0],[0,1,0],[0,0,1]],"width":64,"height":64,"fx":40,"fy":40}])");
    const std::string wall = "convert builtin:slanted-wall ", cameras = " --cameras cameras.json";
    const Outcome outcome = go(wall + "a.ply --keep 0.25" + cameras);
    CHECK(outcome.output.find("420 of 1681 splats are kept, those that show most") != std::string::npos);
    static_cast<void>(go(wall + "b.ply --keep 420" + cameras));
    CHECK(bytesOf("a.ply") == bytesOf("b.ply"));
    static_cast<void>(go(wall + "b.ply --keep 20KB" + cameras));
    CHECK(std::filesystem::file_size(path / "b.ply") <= 20000);
    CHECK(std::filesystem::file_size(path / "b.ply") > 18000);
    const std::string expected = ", must be a share of the splats up to 1, a number of them, or a size such as 50MB";
    for (const char* wrong : {"0", "1.5", "-3", "half", "MB"}) {
        checkRefused(fmt::format("{}c.ply --keep={}", wall, wrong), 1, fmt::format("--keep is {}{}", wrong, expected));
    }
    checkRefused(wall + "c.ply" + cameras, 2, "--cameras is given without --keep");
    checkRefused(wall + "c.ply --levels 2", 2, "--levels is given, but OUT is not a lod-meta.json");
#ifdef BINOSPLAT_SOG
    static_cast<void>(go(wall + "scene/lod-meta.json --levels 3" + cameras));
    for (const auto& [level, splats] : {std::pair("0", 1681), std::pair("1", 840), std::pair("2", 420)}) {
        CHECK(go(fmt::format("info scene --lod {}", level)).output.find(fmt::format("{} ", splats)) != std::string::npos);
    }
    checkRefused(wall + "scene/lod-meta.json", 1, "scene: is there already, must be absent or empty");
    std::filesystem::remove_all(path / "scene");
#endif
    CHECK(files() == Files{"a.ply", "b.ply", "cameras.json"});
}

TEST_CASE_FIXTURE(Converted, "what cannot be converted leaves nothing behind") {
    std::filesystem::create_directory(path / "folder.spz");
    write("file", "");
    checkRefused("convert builtin:one-splat a.obj", 1, "a.obj: must be a file whose name ends in .ply, .spz or .sog");
    checkRefused("convert builtin:one-splat nowhere/a.ply", 1, "nowhere must be a directory");
    checkRefused("convert absent.ply a.ply", 1, "absent.ply: no such file");
    checkRefused("convert builtin:one-splat folder.spz", 1, "folder.spz: is a directory");
#ifdef BINOSPLAT_SOG
    std::filesystem::create_directory(path / "folder.sog");
    checkRefused("convert builtin:one-splat file/c.sog", 1, "file must be a directory");
    checkRefused("convert builtin:one-splat folder.sog", 1, "folder.sog: is a directory");
    std::filesystem::remove(path / "folder.sog");
#endif
    CHECK(files() == Files{"file", "folder.spz"});
}

}  // SUITE(convert)
