// The built-in scenes, folders of scenes, moving scenes, what `info` says about a scene, and the shared ones.
#include "app/summary/describe.h"
#include "engine/builtin/procedural.h"
#include "engine/files/scene_folder.h"
#include "engine/files/scene_series.h"
#include "tests/engine/files/sog_scenes.h"
#include "tests/engine/files/spz_files.h"
#include "tests/engine/scene/scene_measures.h"

#include <fmt/ranges.h>

SUITE(scene) {

void checkSound(const Scene& scene, std::uint64_t splats) {
    CHECK(scene.size() == splats);
    CHECK(isSound(scene));
    CHECK(std::ranges::all_of(scene.scales,
                              [](const glm::vec2& scale) { return std::min(scale.x, scale.y) > 0.0f; }));
    CHECK(std::ranges::all_of(scene.opacities, [](float opacity) { return opacity > 0.0f; }));
}

// A folder of scenes, by name and number of splats; zero splats stand for something that is not a scene.
struct Garden : Folder {
    void place(const std::vector<std::pair<std::string, int>>& scenes) const {
        for (const auto& [name, splats] : scenes) {
            fs::create_directories(fs::path(file(name)).parent_path());
            PlyText ply = makePly();
            ply.resize(splats);
            (void)write(name, splats == 0 ? "{}" : ply.bytes());
        }
    }
    [[nodiscard]] std::string path() const { return fs::path(file("x")).parent_path().string(); }
    [[nodiscard]] std::string error() const {
        return errorOf([&] { (void)SceneSeries(path()); });
    }
    // The number of splats in each frame's scene.
    [[nodiscard]] std::vector<std::size_t> counts() const {
        const SceneSeries series(path());
        std::vector<std::size_t> counts;
        LoadNotes notes;
        for (std::size_t frame = 0; frame < series.size(); ++frame) {
            counts.push_back(series.load(series.sceneOf(frame), notes).size());
        }
        return counts;
    }
};

TEST_CASE("every built-in scene is sound, repeats exactly and has a view") {
    for (const BuiltinInfo& info : listBuiltins()) {
        CAPTURE(info.name);
        LoadNotes notes;
        // Baking light takes a while.
        const std::uint64_t splats = std::min<std::uint64_t>(info.default_splats, 20'000);
        const Scene scene =
            loadScene("builtin:" + info.name, splats == info.default_splats ? 0 : splats, &notes);
        checkSound(scene, splats);
        CHECK(scene.name == "builtin:" + info.name);
        CHECK(these(notes.splats_in_file, notes.axes, notes.colour_space) ==
              these(splats, "x right, y down, z front; right-handed", "display-encoded (sRGB)"));
        checkSameScene(makeBuiltin(info.name, splats), scene);
        CHECK(builtinView(info.name).has_value());
        CHECK(builtinView("builtin:" + info.name)->fov_x_deg > 0.0);
    }
}

TEST_CASE("the atelier has the splats asked for, lit alike at any number; only its vase shines") {
    glm::dvec3 colour_before(0.0);
    for (const std::uint64_t splats : {1000u, 1001u, 4999u, 50'000u}) {
        const Scene scene = makeBuiltin("builtin:atelier", splats);
        checkSound(scene, splats);
        CHECK(scene.sh_degree == 3);
        glm::dvec3 colour(0.0);
        for (std::size_t i = 0; i < splats; ++i) {
            colour +=
                glm::dvec3(scene.sh[48 * i], scene.sh[48 * i + 1], scene.sh[48 * i + 2]) / double(splats);
        }
        if (splats > 1001) { CHECK(glm::length(colour - colour_before) < 0.12); }
        colour_before = colour;
        if (splats < 50'000) { continue; }
        const SceneSummary summary = describeScene(scene);
        for (const std::size_t band : {1u, 2u, 3u}) {
            CHECK(summary.splats_using_band[band] == between(50, 5'000));
        }
        // y points down: the feet of the hills lie slightly below, the sky far above
        CHECK(summary.max_position.y < 50.0f);
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
    checkError("999 splats asked for, expected 1000 to 40000000", "builtin:atelier", 999);
    checkError("expected 1000 to 40000000", "builtin:atelier", 40'000'001);
    checkError("expected 1", "builtin:one-splat", 2);
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
    CHECK(these(summary.splats, summary.min_position, summary.max_position, summary.sh_degree,
                summary.splats_using_band[1]) ==
          these(3, glm::vec3(-3.0f, 0.125f, 4.0f), glm::vec3(2.0f, 0.5f, 6.0f), 1, 3));
    CHECK(these(summary.splats_using_band[2], summary.invisible_splats, summary.host_bytes,
                summary.opacity_quantiles[2]) == these(0, 1, 3 * (12 + 16 + 8 + 4 + 48), 0.5f));
    CHECK(these(summary.scale_quantiles[4], summary.scale_quantiles[0]) ==
          these(1.0f, doctest::Approx(std::exp(-1.5))));
    REQUIRE(summary.left_out.size() == 2);
    CHECK(contains(summary.left_out[0], "SH bands 2 to 3"));
}

TEST_CASE("colours are limited to the bands that are asked for") {
    Scene scene;
    scene.positions.resize(2);
    scene.sh_degree = 2;
    scene.sh.resize(2 * 27);
    std::iota(scene.sh.begin(), scene.sh.end(), 0.0f);
    const std::vector<float> all = scene.sh;
    LoadNotes notes;
    limitShDegree(scene, 2, notes);
    CHECK(these(scene.sh, notes.lines.empty()) == these(all, true));
    limitShDegree(scene, 1, notes);
    std::vector<float> expected(all.begin(), all.begin() + 12);
    expected.insert(expected.end(), all.begin() + 27, all.begin() + 39);
    CHECK(these(scene.sh_degree, scene.sh, notes.sh_limited) == these(1, expected, true));
    limitShDegree(scene, 0, notes);
    CHECK(scene.sh == std::vector<float>{0.0f, 1.0f, 2.0f, 27.0f, 28.0f, 29.0f});
}

SCRIPT(scene, "engine/files/scene") {
    const Garden garden;
    const auto load = [&](const std::string& name) {
        const auto [notes, scene] = readScene(garden.file(name));
        std::string said = fmt::format("{} splats, {} notes\n", scene.size(), notes.lines.size());
        for (const std::string& line : notes.lines) { said += withSlashes(line) + "\n"; }
        return said;
    };
    ScriptHost host{[&](const std::string& name, const std::string&) {
                        Outcome outcome = tried([&] { return load(name); });
                        outcome.errors = withSlashes(outcome.errors);
                        return outcome;
                    },
                    garden.path()};
    host.names = {{"ROOT", withSlashes(garden.path())}};
    host.verbs["folder"] = [&](const std::string& name) { fs::create_directories(garden.file(name)); };
    host.verbs["still"] = [&](const std::string& name) {
        CHECK_FALSE(isMovingScene(name.starts_with("builtin:") ? name : garden.file(name)));
    };
    host.verbs["place"] = [&](const std::string& line) {
        const std::vector<std::string> words = wordsIn(line);
        for (std::size_t i = 0; i < words.size(); i += 2) {
            garden.place({{words[i], std::stoi(words.at(i + 1))}});
        }
    };
    // A moving scene's frames, with its only note after a colon; `!` and the message if it is refused.
    host.verbs["frames"] = [&](const std::string& expected) {
        if (expected.starts_with('!')) {
            CHECK_FALSE(garden.error().empty());
            CHECK(contains(garden.error(), expected.substr(std::min<std::size_t>(2, expected.size()))));
            return;
        }
        CHECK(isMovingScene(garden.path()));
        const std::vector<std::string> notes = SceneSeries(garden.path()).lines();
        const std::size_t colon = std::min(expected.find(": "), expected.size());
        CHECK(fmt::format("{}", fmt::join(garden.counts(), " ")) == expected.substr(0, colon));
        CHECK(notes.empty() == (colon == expected.size()));
        if (colon < expected.size()) { checkSays(notes, expected.substr(colon + 2)); }
    };
#ifdef BINOSPLAT_SOG
    host.features = {"sog"};
    // A network's checkpoints: zip archives.
    host.verbs["checkpoints"] = [&](const std::string&) {
        using Entries = std::vector<std::pair<std::string, std::string>>;
        for (const char* weights : {"ckpt_6999_rank0.pt", "ckpt_29999_rank0.pt"}) {
            (void)garden.write(weights, makeZip(Entries{{"archive/data.pkl", "x"}, {"archive/data/0", "y"}}));
        }
    };
#endif
    runScript(host);
}

TEST_CASE_FIXTURE(Garden, "a training's cameras are found from its folders, and frames that grow are told") {
    place({{"point_cloud/iteration_100/point_cloud.ply", 1},
           {"cameras.json", 0},
           {"film/a1.ply", 1},
           {"film/a2.ply", 2}});
    for (const char* folder : {"", "point_cloud", "point_cloud/"}) {
        const std::optional<TrainingOutput> found = findTrainingOutput(file(folder));
        REQUIRE(found);
        CHECK(fs::equivalent(found->cameras, file("cameras.json")));
        CHECK(findCameraFile(file(folder)) == file("cameras.json"));
    }
    CHECK(these(SceneSeries(file("film")).growth() > 1.0, SceneSeries(file("film")).sceneCount()) ==
          these(true, 2));
}

TEST_CASE_FIXTURE(Garden, "the frames of a moving scene count from one place") {
    PlyText ply = makePly();
    ply["x"].type = "double";
    for (const bool packed : {false, true}) {
        CAPTURE(packed);
        for (const double moved : {0.0, 2.75}) {
            ply["x"].values.assign(3, 100'000.25 + moved);
            (void)write(moved == 0.0 ? "f1.ply" : "f2.ply", packed ? gzip(ply.bytes()) : ply.bytes());
        }
        const SceneSeries series(path());
        LoadNotes notes;
        const Scene second = series.load(1, notes), first = series.load(0, notes);
        const glm::dvec3 origin(100'000.0, 0.0, 0.0);
        CHECK(these(first.origin, second.origin, first.positions[0].x, second.positions[0].x) ==
              these(origin, origin, 0.25f, 3.0f));
    }
}

TEST_CASE_FIXTURE(Garden, "a frame of another format is refused, and the next one is shown") {
    place({{"b1.ply", 1}, {"b3.ply", 3}});
    (void)write("b2.ply", std::string(320, '\0'));
    const SceneSeries series(path());
    LoadNotes notes;
    CHECK_THROWS_AS((void)series.load(1, notes), Error);
    CHECK(series.load(2, notes).size() == 3);
}

}  // SUITE(scene)
