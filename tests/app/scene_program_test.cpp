// What the program says about a scene, and how it chooses one of several levels.
#include "engine/builtin/procedural.h"
#include "engine/files/ply.h"
#include "tests/app/camera_file.h"
#include "tests/app/program_script.h"
#include "tests/engine/files/ply_files.h"
#ifdef BINOSPLAT_SOG
#include "tests/engine/files/streamed_scenes.h"
#endif

SUITE(scene_program) {

// A patch of 3000 splats, here and moved; scenes with SH bands, far from 0, and with levels of detail.
struct Scenes : Workplace {
    Scenes() {
        PlyText ply = makePly(0, true);
        for (const char* name : {"scale_0", "scale_1", "scale_2"}) {
            ply[name].values.assign(3, std::log(0.01));
        }
        for (Column& column : ply.columns) { column.values.resize(3000, column.values[0]); }
        for (std::size_t i = 0; i < 3000; ++i) {  // its corners count as alone, too
            ply["x"].values[i] = 0.05 * static_cast<double>(i % 60);
            ply["y"].values[i] = 0.05 * static_cast<double>(i / 60);
        }
        ply["z"].values.assign(3000, 4.0);
        ply["z"].values[0] = 30.0;
        ply["opacity"].values[1] = -9.0;
        ply["opacity"].values[2] = 9.0;
        write("a.ply", ply.bytes());
        for (const auto& [scale, away, type] :
             {std::tuple(1.0, 40000.0, "float"), {1.0, 4e6, "double"}, {1e-4, 0.5, "float"}}) {
            PlyText moved = ply;
            for (const char* name : {"x", "y", "z"}) {
                moved[name].type = type;
                for (double& value : moved[name].values) { value = scale * value + away; }
            }
            write(fmt::format("moved{}.ply", away), moved.bytes());
        }
        write("sh.ply", makePly(9).bytes());
        PlyText far = makePly();
        for (double& x : far["x"].values) { x += 4e5; }
        far["x"].type = "double";
        write("far.ply", far.bytes());
    }
};

SCRIPT(scene_program, "app/scene_program") {
    const Scenes scenes;
    ScriptHost host = programIn(scenes);
#ifdef BINOSPLAT_SOG
    const Folder folder;
    host.names["STREAMED"] = writeStreamed(folder, "scene", makeLodMeta());
#endif
    runScript(host);
}

TEST_CASE_FIXTURE(AtWork, "a scene moved with its cameras gives the same picture, and reports say where") {
    const auto rendered = [&](const std::string& name, const glm::dvec3& moved, const std::string& words) {
        fs::create_directory(work.path / name);
        Scene scene = makeBuiltin("builtin:fence");
        scene.origin = moved;
        writePly(scene, (work.path / name / "scene.ply").string());
        work.write(name + "/cameras.json",
                   "[" + cameraJson("a", moved - glm::dvec3(0, 0, 1), kNotTurned, {64, 48}, 60.0) + "]");
        work.go(fmt::format("render {0}/scene.ply --mode mono --size 64x48 --out {0}/out {1}", name, words));
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

}  // SUITE(scene_program)
