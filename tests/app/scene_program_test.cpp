// What the program says about a scene, and how it chooses one of several levels.
#include "app/scores/metrics.h"
#include "engine/builtin/procedural.h"
#include "engine/files/ply.h"
#include "engine/picture/image_io.h"
#include "tests/run_program.h"
#ifdef BINOSPLAT_SOG
#include "tests/engine/files/streamed_scenes.h"
#endif

SUITE(scene_program) {

TEST_CASE_FIXTURE(AtWork, "info says what a scene is made of, and what would take less memory") {
    PlyText ply = makePly(0, true);
    for (const char* name : {"scale_0", "scale_1", "scale_2"}) { ply[name].values.assign(3, std::log(0.01)); }
    for (Column& column : ply.columns) { column.values.resize(3000, column.values[0]); }
    for (std::size_t i = 0; i < 3000; ++i) {  // a patch; its corners count as alone, too
        ply["x"].values[i] = 0.05 * static_cast<double>(i % 60);
        ply["y"].values[i] = 0.05 * static_cast<double>(i / 60);
    }
    ply["z"].values.assign(3000, 4.0);
    ply["z"].values[0] = 30.0;
    ply["opacity"].values[1] = -9.0;
    ply["opacity"].values[2] = 9.0;
    work.write("a.ply", ply.bytes());
    const std::string info = work.go("info a.ply").output;
    for (const char* row :
         {"axes               the file does not say; taken as a training's: x right, y down, z front; "
          "right-handed\n",
          "colour space       the file does not say; taken as a training's: display-encoded (sRGB)\n",
          "  0.03 %  1 splats: opacity under 1/255, never seen\n", "  0.03 %  1 splats: over 99 % opaque\n",
          "  0.00 %  0 splats: thinner than a millimetre (the shortest axis, ",
          "  0.00 %  0 splats: larger than a tenth of the size\n",
          "  0.17 %  5 splats: floaters: seen, but alone (fewer than 5 splats within",
          "(0.1 MiB) on the GPU, 52 a splat", "if too much      convert --crop="}) {
        CHECK_MESSAGE(contains(info, row), row);
    }
    CHECK_FALSE(contains(info, "--sh-degree"));
    CHECK(contains(info, "\nup                 0,-1,0: by convention, as no floor was found\n"));
    // The advice can be followed, also far from the origin and in a tiny scene.
    for (const auto& [scale, away, type] : {std::tuple(1.0, 0.0, "float"),
                                            {1.0, 40000.0, "float"},
                                            {1.0, 4e6, "double"},
                                            {1e-4, 0.5, "float"}}) {
        CAPTURE(away);
        PlyText moved = ply;
        for (const char* name : {"x", "y", "z"}) {
            moved[name].type = type;
            for (double& value : moved[name].values) { value = scale * value + away; }
        }
        work.write("moved.ply", moved.bytes());
        const std::string text = work.go("info moved.ply").output;
        const std::size_t at = text.find("--crop=");
        (void)work.go("convert moved.ply half.ply " + text.substr(at, text.find(' ', at) - at));
        const auto kept = static_cast<double>(loadScene((work.path / "half.ply").string()).size());
        CHECK(kept >= 1500.0);
        CHECK(kept < 1600.0);
    }
    work.write("sh.ply", makePly(9).bytes());
    CHECK(contains(work.go("info sh.ply").output, "--sh-degree 0: "));
    PlyText far = makePly();
    for (double& x : far["x"].values) { x += 4e5; }
    far["x"].type = "double";
    work.write("far.ply", far.bytes());
    CHECK(contains(work.go("info far.ply").output, "origin             400001,0,0: positions in memory"));
    CHECK(contains(work.go("convert far.ply far.spz").output, "; that its positions count from 400001,0,0"));
    CHECK(contains(work.go("convert far.ply again.ply").output, "loses: nothing"));
    CHECK(contains(work.bytesOf("again.ply"), "property double x"));
    CHECK(contains(work.go("info builtin:one-splat").output, "colour space       display-encoded (sRGB)\n"));
}

TEST_CASE_FIXTURE(AtWork, "a scene moved with its cameras gives the same picture, and reports say where") {
    const auto rendered = [&](const std::string& name, const glm::dvec3& moved, const std::string& words) {
        fs::create_directory(work.path / name);
        Scene scene = makeBuiltin("builtin:fence");
        scene.origin = moved;
        writePly(scene, (work.path / name / "scene.ply").string());
        work.write(
            name + "/cameras.json",
            fmt::format(R"([{{"position": [{}, {}, {}], "rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],)"
                        R"( "width": 64, "height": 48,)"
                        R"("fx": 60, "fy": 60}}])",
                        moved.x, moved.y, moved.z - 1.0));
        (void)work.go(
            fmt::format("render {0}/scene.ply --mode mono --size 64x48 --out {0}/out {1}", name, words));
        const auto report = nlohmann::json::parse(work.bytesOf(name + "/out/report.json"));
        const auto& eye = report["eyes"]["mono"]["position"];
        const glm::dvec3 at(eye[0].get<double>(), eye[1].get<double>(), eye[2].get<double>());
        CHECK(glm::distance(at, moved + glm::dvec3(0.0, 0.0, -1.0)) < 1e-5);
        if (!report["options"]["eye"].is_null()) { CHECK(report["options"]["eye"] == eye); }
        return readPicture(work.path / name / "out" / "mono" BINOSPLAT_FLOAT_EXTENSION);
    };
    const glm::dvec3 away(500'000.0, 0.0, -500'000.0);
    const Image home = rendered("home", glm::dvec3(0.0), "--view 0"), far = rendered("far", away, "--view 0");
    CHECK(std::ranges::max(home.values) > 0.3f);
    CHECK(psnrOf(compare(home, far).mean_square) > 60.0);
    // From its own cameras, and from a given place: the angles differ, but the pictures agree.
    const Image at_home = rendered("home-eye", glm::dvec3(0.0), "--eye 0,0,-1 --look 0,0,5"),
                there = rendered("far-eye", away, "--eye 500000,0,-500001 --look 500000,0,-499995");
    CHECK(psnrOf(compare(at_home, there).mean_square) > 60.0);
}

#ifdef BINOSPLAT_SOG
TEST_CASE_FIXTURE(InFolder, "the program loads the level that --lod names and says which levels there are") {
    const Workplace work;
    const std::string source = writeStreamed(folder, "scene", makeLodMeta());
    const Outcome info = work.go("info '" + source + "'");
    CHECK(
        contains(info.output, "levels of detail   0: 16 splats (loaded)\n                   1: 8 splats\n"));
    CHECK(contains(info.output, "environment: 8 splats (loaded)"));
    CHECK(contains(work.go("info --lod 1 '" + source + "'").output, "1: 8 splats (loaded)"));
    (void)work.go("convert --lod 1 '" + source + "' coarse.ply");
    checkSameScene(loadScene((work.path / "coarse.ply").string()),
                   loadScene(source, 0, nullptr, {}, {1, {}}));
    // The report says what the program chose.
    (void)work.go("render '" + source + "' --mode mono --size 16x16 --out seen");
    const std::string report = work.bytesOf("seen/report.json");
    CHECK(contains(report, "\"lod\": 0,"));
    CHECK(contains(report, "\"sh-degree\": 1,"));
    CHECK(contains(report, "\"antialiased\": false"));
    work.checkRefused("info --lod 2 '" + source + "'", 1, "levels of detail, 0 (the finest) to 1\n");
    work.checkRefused("info --lod fine '" + source + "'", 1, "--lod");
    work.checkRefused("scene one-splat --lod 0 --out a.ply", 2, "--lod");
}
#endif

}  // SUITE(scene_program)
