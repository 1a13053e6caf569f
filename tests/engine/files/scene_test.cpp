// The built-in scenes, folders of scenes, moving ones among them, what `info` says of a scene, and the shared ones.
#include "app/summary/describe.h"
#include "engine/builtin/procedural.h"
#include "engine/files/scene_folder.h"
#include "engine/files/scene_series.h"
#include "tests/engine/files/spz_files.h"
#ifdef BINOSPLAT_SOG
#include "tests/engine/files/sog_scenes.h"
#endif

SUITE(scene) {

void checkSound(const Scene& scene, std::uint64_t splats) {
    REQUIRE(scene.size() == splats);
    REQUIRE(scene.rotations.size() == splats);
    REQUIRE(scene.scales.size() == splats);
    REQUIRE(scene.opacities.size() == splats);
    REQUIRE(scene.sh.size() == splats * 3 * static_cast<std::size_t>(shCoefficientCount(scene.sh_degree)));
    bool finite = true, unit = true, positive = true, opaque = true;
    for (std::size_t i = 0; i < splats; ++i) {
        finite &= std::isfinite(scene.positions[i].x + scene.positions[i].y + scene.positions[i].z);
        unit &= std::abs(glm::length(scene.rotations[i]) - 1.0f) < 1e-5f;
        positive &= scene.scales[i].x > 0.0f && scene.scales[i].y > 0.0f && std::isfinite(scene.scales[i].x + scene.scales[i].y);
        opaque &= scene.opacities[i] > 0.0f && scene.opacities[i] <= 1.0f;
    }
    for (const float value : scene.sh) { finite &= std::isfinite(value); }
    CHECK(finite);
    CHECK(unit);
    CHECK(positive);
    CHECK(opaque);
}

std::string withSplats(int splats) {
    PlyText ply = makePly();
    for (Column& column : ply.columns) { column.values.resize(static_cast<std::size_t>(splats), column.values[0]); }
    return ply.bytes();
}

// A folder of scenes, by their names and numbers of splats; of none splats, what is no scene.
struct Garden : Folder {
    void place(const std::vector<std::pair<std::string, int>>& scenes) const {
        for (const auto& [name, splats] : scenes) {
            std::filesystem::create_directories(std::filesystem::path(file(name)).parent_path());
            (void)write(name, splats == 0 ? "{}" : withSplats(splats));
        }
    }
    [[nodiscard]] std::string path() const { return std::filesystem::path(file("x")).parent_path().string(); }
    [[nodiscard]] std::string error() const {
        return errorOf([&] { (void)SceneSeries(path()); });
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

TEST_CASE("every built-in scene is sound, repeats exactly and has a view") {
    for (const BuiltinInfo& info : listBuiltins()) {
        CAPTURE(info.name);
        LoadNotes notes;
        const std::uint64_t splats = std::min<std::uint64_t>(info.default_splats, 20'000);  // baking light takes its time
        const Scene scene = loadScene("builtin:" + info.name, splats == info.default_splats ? 0 : splats, &notes);
        checkSound(scene, splats);
        CHECK(scene.name == "builtin:" + info.name);
        CHECK(these(notes.splats_in_file, notes.axes, notes.colour_space) ==
              these(splats, "x right, y down, z front; right-handed", "display-encoded (sRGB)"));
        checkSameScene(makeBuiltin(info.name, splats), scene);
        CHECK(builtinView(info.name).has_value());
        CHECK(builtinView("builtin:" + info.name)->fov_x_deg > 0.0);
    }
}

TEST_CASE("the atelier has exactly the splats asked for, its light is baked alike at any number, and only its glazed vase shines") {
    glm::dvec3 colour_before(0.0);
    for (const std::uint64_t splats : {1000u, 1001u, 4999u, 50'000u}) {
        const Scene scene = makeBuiltin("builtin:atelier", splats);
        checkSound(scene, splats);
        CHECK(scene.sh_degree == 3);
        glm::dvec3 colour(0.0);
        for (std::size_t i = 0; i < splats; ++i) {
            colour += glm::dvec3(scene.sh[48 * i], scene.sh[48 * i + 1], scene.sh[48 * i + 2]) / double(splats);
        }
        if (splats > 1001) { CHECK(glm::length(colour - colour_before) < 0.12); }
        colour_before = colour;
        if (splats < 50'000) { continue; }
        const SceneSummary summary = describeScene(scene);
        for (const std::size_t band : {1u, 2u, 3u}) { CHECK(summary.splats_using_band[band] == between(50, 5'000)); }
        CHECK(summary.max_position.y < 50.0f);  // y is down: the feet of the hills lie a little below, the sky far above
        CHECK(summary.min_position.y < -100.0f);
        CHECK(summary.max_position.z > 300.0f);
    }
}

TEST_CASE("the analytic scenes are as documented") {
    const Scene slanted = makeBuiltin("builtin:slanted-wall");
    const glm::vec3 t_w = slanted.rotations[0] * glm::vec3(0.0f, 0.0f, 1.0f);
    CHECK(glm::length(t_w - glm::vec3(-std::sqrt(0.5f), 0.0f, std::sqrt(0.5f))) < 1e-6f);
    for (const glm::vec3& p : slanted.positions) { CHECK(p.z == doctest::Approx(4.0 + p.x).epsilon(1e-6)); }
    const Scene one = makeBuiltin("builtin:one-splat");
    CHECK(0.5 + 0.28209479177387814 * one.sh[0] == doctest::Approx(0.9));
    const Scene step = makeBuiltin("builtin:step-edge");
    CHECK(these(step.positions[29].x, step.positions.back().z) == these(doctest::Approx(-0.05), 4.0f));
    CHECK(makeBuiltin("builtin:fence").positions[80].y == doctest::Approx(1.0));
    CHECK(makeBuiltin("builtin:two-layers").opacities[0] == 0.5f);
}

TEST_CASE("built-in names and counts that do not exist are refused") {
    const std::string message = loadError("builtin:castle");
    CHECK(contains(message, "builtin:castle: no such built-in scene"));
    for (const BuiltinInfo& info : listBuiltins()) { CHECK(contains(message, info.name)); }
    CHECK(contains(loadError("builtin:atelier", 999), "999 splats asked for, expected 1000 to 40000000"));
    CHECK(contains(loadError("builtin:atelier", 40'000'001), "expected 1000 to 40000000"));
    CHECK(contains(loadError("builtin:one-splat", 2), "expected 1"));
    CHECK_FALSE(builtinView("castle").has_value());
}

TEST_CASE_FIXTURE(InFolder, "a summary counts what is there and what is not needed") {
    PlyText ply = makePly(45);
    for (int i = 0; i < 45; ++i) {
        const bool kept = i % 15 < 3;
        for (double& value : ply[fmt::format("f_rest_{}", i)].values) { value = kept ? value : 0.0; }
    }
    ply["opacity"].values[2] = -9.0;
    const auto [notes, scene] = readScene(folder.write("bands.ply", ply.bytes()));
    const SceneSummary summary = describeScene(scene, &notes);
    CHECK(these(summary.splats, summary.min_position, summary.max_position, summary.sh_degree, summary.splats_using_band[1]) ==
          these(3, glm::vec3(-3.0f, 0.125f, 4.0f), glm::vec3(2.0f, 0.5f, 6.0f), 1, 3));
    CHECK(these(summary.splats_using_band[2], summary.invisible_splats, summary.host_bytes, summary.opacity_quantiles[2]) ==
          these(0, 1, 3 * (12 + 16 + 8 + 4 + 48), 0.5f));
    CHECK(these(summary.scale_quantiles[4], summary.scale_quantiles[0]) == these(1.0f, doctest::Approx(std::exp(-1.5))));
    REQUIRE(summary.left_out.size() == 2);
    CHECK(contains(summary.left_out[0], "SH bands 2 to 3"));
}

TEST_CASE("colours are limited to the bands that are asked for") {
    Scene scene;
    scene.positions.resize(2);
    scene.sh_degree = 2;
    for (int i = 0; i < 2 * 27; ++i) { scene.sh.push_back(static_cast<float>(i)); }
    const std::vector<float> all = scene.sh;
    LoadNotes notes;
    limitShDegree(scene, 2, notes);
    CHECK(scene.sh == all);
    CHECK(notes.lines.empty());
    limitShDegree(scene, 1, notes);
    CHECK(scene.sh_degree == 1);
    REQUIRE(scene.sh.size() == 24);
    CHECK(std::equal(all.begin(), all.begin() + 12, scene.sh.begin()));
    CHECK(std::equal(all.begin() + 27, all.begin() + 39, scene.sh.begin() + 12));
    CHECK(notes.sh_limited);
    limitShDegree(scene, 0, notes);
    CHECK(scene.sh == std::vector<float>{0.0f, 1.0f, 2.0f, 27.0f, 28.0f, 29.0f});
}

TEST_CASE("a folder is streamed SOG, SOG, a training's output, a moving scene or has one scene, judged in this order, or none of them") {
    const Garden garden;
    const std::string root = garden.path();
    std::filesystem::create_directories(root + "/point_cloud/iteration_best");
    const std::string four = loadError(root);
    for (const char* kind :
         {"is a directory", "lod-meta.json", "meta.json (SOG)", "point_cloud/iteration_N", "numbered files", "one scene file"}) {
        CHECK(contains(four, kind));
    }
    garden.place({{"frame_9.txt", 0}, {"frame_10.txt", 0}, {".hidden.ply", 1}});
    CHECK(loadError(root) == four);
    garden.place({{"alone_1.ply", 4}});
#ifdef BINOSPLAT_SOG
    for (const char* weights : {"/ckpt_6999_rank0.pt", "/ckpt_29999_rank0.pt"}) {  // of a network: zip archives
        std::ofstream(root + weights, std::ios::binary)
            << makeZip(std::vector<std::pair<std::string, std::string>>{{"archive/data.pkl", "x"}, {"archive/data/0", "y"}});
    }
#endif
    LoadNotes of_one;
    CHECK(loadScene(root, 0, &of_one).size() == 4);
    checkSays(of_one.lines, ": a folder, of which");
    CHECK(contains(of_one.lines[0], "alone_1.ply was loaded, its only scene"));
    garden.place({{"other.ply", 1}});
    CHECK(loadError(root) == four);
    garden.place({{"step_10.ply", 1}, {"step_9.ply", 2}, {"step_100.ply", 1}});
    LoadNotes of_moving;
    CHECK(loadScene(root, 0, &of_moving).size() == 2);
    checkSays(of_moving.lines, ": a moving scene of 3 frames, of which");
    CHECK(contains(of_moving.lines[0], "step_9.ply was loaded"));

    garden.place({{"point_cloud/iteration_7000/point_cloud.ply", 7}});
    CHECK(loadScene(root).size() == 7);
    garden.place({{"point_cloud/iteration_30000/point_cloud.ply", 30},
                  {"point_cloud/iteration_9000/point_cloud.ply", 9},
                  {"point_cloud/iteration_40000/other.ply", 4},  // stopped before it was written
                  {"point_cloud/iteration_best/point_cloud.ply", 5}});
    LoadNotes notes;
    CHECK(loadScene(root + "/", 0, &notes).size() == 30);
    checkSays(notes.lines, "iteration_30000");

    garden.place({{"meta.json", 0}});
#ifdef BINOSPLAT_SOG
    CHECK(contains(loadError(root), "meta.json"));
    CHECK_FALSE(contains(loadError(root), "lod-meta.json"));
    garden.place({{"lod-meta.json", 0}});
    CHECK(contains(loadError(root), "lod-meta.json"));
#else
    const std::string without = "a SOG scene, which this build cannot read: configure with BINOSPLAT_SOG=ON";
    garden.place({{"streamed/lod-meta.json", 0}});
    (void)garden.write("meta.json", R"({"version":2,"count":0,"means":{"mins":[0,0,0],"maxs":[0,0,0],"files":["l.webp","u.webp"]}})");
    (void)garden.write("a.sog", "PK\x03\x04 and so on");
    for (const char* source : {"", "/meta.json", "/streamed", "/streamed/lod-meta.json", "/a.sog"}) {
        CHECK(contains(loadError(root + source), without));
    }
#endif
}

TEST_CASE("checkpoints of a training, as folders or files with round numbers, are no film: the newest is shown, the others are named") {
    const auto check = [](const std::vector<std::pair<std::string, int>>& files, std::size_t splats, const std::string& older) {
        const Garden garden;
        garden.place(files);
        LoadNotes notes;
        CHECK(loadScene(garden.path(), 0, &notes).size() == splats);
        REQUIRE(notes.lines.size() == 1);
        const std::string said = "a training's output, of which " + garden.file(files.back().first) + " was loaded" + older;
        CHECK_MESSAGE(contains(notes.lines[0], said), notes.lines[0]);
        CHECK_FALSE(isMovingScene(garden.path()));
    };
    check({{"iteration_7000/point_cloud.ply", 7}, {"cameras.json", 0}, {"iteration_30000/point_cloud.ply", 30}}, 30,
          "; older ones: iteration_7000/point_cloud.ply");
    check({{"point_cloud_6999.ply", 7}, {"point_cloud_500.ply", 5}, {"point_cloud_29999.ply", 30}}, 30,
          "; older ones: point_cloud_6999.ply, point_cloud_500.ply");
    check({{"export_5000.ply", 5}}, 5, "");
    const Garden film;
    film.place({{"point_cloud_99.ply", 1}, {"point_cloud_100.ply", 2}, {"point_cloud_101.ply", 3}});
    CHECK(film.counts() == std::vector<std::size_t>{1, 2, 3});

    const Garden garden;
    garden.place({{"point_cloud/iteration_100/point_cloud.ply", 1}, {"cameras.json", 0}});
    for (const char* folder : {"", "point_cloud", "point_cloud/"}) {
        const std::optional<TrainingOutput> found = findTrainingOutput(garden.file(folder));
        REQUIRE(found);
        CHECK(std::filesystem::equivalent(found->cameras, garden.file("cameras.json")));
        CHECK(findCameraFile(garden.file(folder)) == garden.file("cameras.json"));
    }
}

TEST_CASE_FIXTURE(InFolder, "files and folders that people take for a scene are named as what they are, with what to open instead") {
    const std::string training = "point_cloud/iteration_N/point_cloud.ply";
    const struct {
        const char *name, *bytes;
        std::string what, instead;
    } files[] = {
        {"garden.ply", "\xef\xbb\xbf\n<!DOCTYPE html>\n<html>", "garden.ply: a web page (HTML)", "download button"},
        {"garden.splat", "<HTML><body>", "a web page (HTML)", "download button"},
        {"tileset.json", R"({"asset":{"version":"1.1"},"geometricError":1,"root":{}})", "a tileset of 3D Tiles", ".glb"},
        {"t.json", R"({"camera_angle_x":1,"frames":[{"transform_matrix":[]}]})", "photographs with their cameras", training},
        {"cameras.json", R"([{"img_name":"a","rotation":[]}])", "the cameras of a 3DGS training", "--cameras"},
        {"list.json", R"({"cameras": []})", "a list of cameras", "--cameras"},
        {"cameras.bin", "\1", "the cameras of a COLMAP project", training},
        {"points3D.bin", "\1", "the point cloud of a COLMAP project", training},
        {"a/sparse/0/cameras.bin", "\1", "a COLMAP project", training},
        {"b/cameras.txt", "#", "cameras of a COLMAP project", training},
        {"c/opensfm/reconstruction.json", "[]", "an OpenDroneMap project", training},
        {"d/transforms.json", "{}", "photographs with their cameras", training},
    };
    for (const auto& [name, bytes, what, instead] : files) {
        const std::string text = name;
        std::filesystem::create_directories(std::filesystem::path(folder.file(text)).parent_path());
        const std::string path = folder.write(text, bytes);
        const std::string message = loadError(text[1] == '/' ? folder.file(text.substr(0, 1)) : path);
        CHECK_MESSAGE(contains(message, what), message);
        CHECK_MESSAGE(contains(message, "not a splat scene"), message);
        CHECK_MESSAGE(contains(message, instead), message);
    }
}

TEST_CASE_FIXTURE(Garden, "numbered files are frames in the order of their numbers, whatever else lies beside them") {
    CHECK_FALSE(isMovingScene(path()));
    place({{"step_9.ply", 1}, {"notes_1.txt", 0}, {"notes_2.txt", 0}, {"notes_3.txt", 0}});
    CHECK_FALSE(isMovingScene(path()));
    CHECK_FALSE(error().empty());
    place({{"step_10.ply", 2}, {"step_11.ply", 3}, {"other.ply", 9}});
    CHECK(isMovingScene(path()));
    CHECK(counts() == std::vector<std::size_t>{1, 2, 3});
    CHECK(SceneSeries(path()).lines().empty());
    CHECK(SceneSeries(path()).growth() > 1.0);
    CHECK_FALSE(isMovingScene(file("step_9.ply")));
    CHECK_FALSE(isMovingScene("builtin:atelier"));
}

TEST_CASE("a number that is missing shows what comes before it for longer, and numbers without any order count as they come") {
    const Garden garden;
    garden.place({{"t010.ply", 1}, {"t020.ply", 2}, {"t050.ply", 5}, {"t060.ply", 6}});
    CHECK(garden.counts() == std::vector<std::size_t>{1, 2, 2, 2, 5, 6});
    const SceneSeries series(garden.path());
    CHECK(series.sceneCount() == 4);
    checkSays(series.lines(), "2 of 6 numbered files are missing, the first after t020.ply");
    garden.place({{"t901.ply", 9}, {"t99999999999999999999999999.ply", 7}});
    CHECK(garden.counts() == std::vector<std::size_t>{1, 2, 5, 6, 9, 7});
}

TEST_CASE_FIXTURE(Garden, "the frames of a moving scene count from one place") {
    PlyText ply = makePly();
    ply["x"].type = "double";
    for (const bool packed : {false, true}) {
        CAPTURE(packed);
        for (const double moved : {0.0, 2.75}) {
            ply["x"].values = {100'000.25 + moved, 100'000.25 + moved, 100'000.25 + moved};
            (void)write(moved == 0.0 ? "f1.ply" : "f2.ply", packed ? gzip(ply.bytes()) : ply.bytes());
        }
        const SceneSeries series(path());
        LoadNotes notes;
        const Scene second = series.load(1, notes), first = series.load(0, notes);
        CHECK(first.origin == glm::dvec3(100'000.0, 0.0, 0.0));
        CHECK(second.origin == first.origin);
        CHECK(first.positions[0].x == 0.25f);
        CHECK(second.positions[0].x == 3.0f);
    }
}

TEST_CASE_FIXTURE(Garden, "two moving scenes in one folder, and formats that differ, are refused") {
    place({{"a1.ply", 1}, {"a2.ply", 1}});
    CHECK(error().empty());
    place({{"b1.ply", 1}, {"b2.ply", 1}});
    CHECK(contains(error(), "expected one moving scene"));
    place({{"b3.ply", 3}});  // now one is the larger
    CHECK(counts() == std::vector<std::size_t>{1, 1, 3});
    // In the middle, where nobody has looked yet.
    (void)write("b2.ply", std::string(320, '\0'));
    const SceneSeries series(path());
    LoadNotes notes;
    CHECK_THROWS_AS((void)series.load(1, notes), Error);
    CHECK(series.load(2, notes).size() == 3);
}

}  // SUITE(scene)
