// The built-in scenes, what `info` says of a scene, and the shared ones.
#include "engine/scene/describe.h"
#include "engine/scene/procedural.h"
#include "tests/engine/scene/ply_files.h"
#include "tests/shared_data.h"

#include <algorithm>

TEST_SUITE_BEGIN("scene");

namespace scene_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

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

}  // namespace

TEST_CASE("every built-in scene is sound, repeats exactly and has a view") {
    for (const BuiltinInfo& info : listBuiltins()) {
        CAPTURE(info.name);
        LoadNotes notes;
        const Scene scene = loadScene("builtin:" + info.name, 0, &notes);
        checkSound(scene, info.default_splats);
        CHECK(scene.name == "builtin:" + info.name);
        CHECK(notes.splats_in_file == info.default_splats);
        const std::uint64_t few = std::min<std::uint64_t>(info.default_splats, 20'000);  // baking light takes its time
        checkSameScene(makeBuiltin(info.name, few), makeBuiltin(info.name, few));
        CHECK(builtinView(info.name).has_value());
        CHECK(builtinView("builtin:" + info.name)->fov_x_deg > 0.0);
    }
}

TEST_CASE("the atelier has exactly the splats asked for, and its light is baked alike at any number") {
    glm::dvec3 colour_before(0.0);
    for (const std::uint64_t splats : {1000u, 1001u, 4999u, 20'000u, 60'000u}) {
        const Scene scene = makeBuiltin("builtin:atelier", splats);
        checkSound(scene, splats);
        CHECK(scene.sh_degree == 3);
        glm::dvec3 colour(0.0);
        for (std::size_t i = 0; i < splats; ++i) {
            colour += glm::dvec3(scene.sh[48 * i], scene.sh[48 * i + 1], scene.sh[48 * i + 2]) / double(splats);
        }
        if (splats > 1001) { CHECK(glm::length(colour - colour_before) < 0.12); }
        colour_before = colour;
    }
}

TEST_CASE("only the atelier's glazed vase shines") {
    const SceneSummary summary = describeScene(makeBuiltin("builtin:atelier", 50'000));
    for (const std::size_t band : {1u, 2u, 3u}) {
        CHECK(summary.splats_using_band[band] > 50);
        CHECK(summary.splats_using_band[band] < 5'000);
    }
    CHECK(summary.max_position.y < 50.0f);  // y is down: the feet of the hills lie a little below, the sky far above
    CHECK(summary.min_position.y < -100.0f);
    CHECK(summary.max_position.z > 300.0f);
}

TEST_CASE("the analytic scenes are as documented") {
    const Scene slanted = makeBuiltin("builtin:slanted-wall");
    const glm::vec3 t_w = slanted.rotations[0] * glm::vec3(0.0f, 0.0f, 1.0f);
    CHECK(glm::length(t_w - glm::vec3(-std::sqrt(0.5f), 0.0f, std::sqrt(0.5f))) < 1e-6f);
    for (const glm::vec3& p : slanted.positions) { CHECK(p.z == doctest::Approx(4.0 + p.x).epsilon(1e-6)); }
    const Scene one = makeBuiltin("builtin:one-splat");
    CHECK(0.5 + 0.28209479177387814 * one.sh[0] == doctest::Approx(0.9));
    const Scene step = makeBuiltin("builtin:step-edge");
    CHECK(step.positions[29].x == doctest::Approx(-0.05));
    CHECK(step.positions.back().z == 4.0f);
    CHECK(makeBuiltin("builtin:fence").positions[80].y == doctest::Approx(1.0));
    CHECK(makeBuiltin("builtin:two-layers").opacities[0] == 0.5f);
}

TEST_CASE("built-in names and counts that do not exist are refused") {
    const std::string message = loadError("builtin:castle");
    CHECK(contains(message, "builtin:castle: no such built-in scene"));
    for (const BuiltinInfo& info : listBuiltins()) { CHECK(contains(message, info.name)); }
    CHECK(contains(loadError("builtin:atelier", 999), "999 splats asked for, expected 1000 to 10000000"));
    CHECK(contains(loadError("builtin:atelier", 10'000'001), "expected 1000 to 10000000"));
    CHECK(contains(loadError("builtin:one-splat", 2), "expected 1"));
    CHECK_FALSE(builtinView("castle").has_value());
}

TEST_CASE("a summary counts what is there and what is not needed") {
    const Folder folder;
    PlyText ply = makePly(45);
    for (int i = 0; i < 45; ++i) {
        const bool kept = i % 15 < 3;
        for (double& value : ply[fmt::format("f_rest_{}", i)].values) { value = kept ? value : 0.0; }
    }
    ply["opacity"].values[2] = -9.0;
    LoadNotes notes;
    const Scene scene = loadScene(folder.write("bands.ply", ply.bytes()), 0, &notes);
    const SceneSummary summary = describeScene(scene, &notes);
    CHECK(summary.splats == 3);
    CHECK(summary.min_position == glm::vec3(-3.0f, 0.125f, 4.0f));
    CHECK(summary.max_position == glm::vec3(2.0f, 0.5f, 6.0f));
    CHECK(summary.sh_degree == 1);
    CHECK(summary.splats_using_band[1] == 3);
    CHECK(summary.splats_using_band[2] == 0);
    CHECK(summary.invisible_splats == 1);
    CHECK(summary.host_bytes == 3 * (12 + 16 + 8 + 4 + 48));
    CHECK(summary.opacity_quantiles[2] == 0.5f);
    CHECK(summary.scale_quantiles[4] == 1.0f);
    CHECK(summary.scale_quantiles[0] == doctest::Approx(std::exp(-1.5)));
    REQUIRE(summary.left_out.size() == 2);
    CHECK(contains(summary.left_out[0], "SH bands 2 to 3"));
}

TEST_CASE("colours are limited to the bands that are asked for") {
    Scene scene;
    scene.name = "two";
    scene.positions.resize(2);
    scene.sh_degree = 2;
    for (int i = 0; i < 2 * 27; ++i) { scene.sh.push_back(static_cast<float>(i)); }
    LoadNotes notes;
    limitShDegree(scene, 2, notes);
    CHECK(scene.sh.size() == 54);
    CHECK(notes.lines.empty());
    limitShDegree(scene, 1, notes);
    CHECK(scene.sh_degree == 1);
    REQUIRE(scene.sh.size() == 24);
    CHECK(scene.sh[11] == 11.0f);
    CHECK(scene.sh[12] == 27.0f);
    CHECK(scene.sh[23] == 38.0f);
    CHECK(notes.sh_limited);
    limitShDegree(scene, 0, notes);
    CHECK(scene.sh == std::vector<float>{0.0f, 1.0f, 2.0f, 27.0f, 28.0f, 29.0f});
}

TEST_CASE("a folder is streamed SOG, SOG, a training's output or a moving scene, judged in this order, or none of them") {
    namespace fs = std::filesystem;
    const Folder folder;
    const fs::path root = folder.file("garden");
    const auto place = [&](const std::string& name, const std::string& bytes) {
        fs::create_directories((root / name).parent_path());
        return folder.write("garden/" + name, bytes);
    };
    const auto withSplats = [](int splats) {
        PlyText ply = makePly();
        for (Column& column : ply.columns) { column.values.resize(static_cast<std::size_t>(splats), column.values[0]); }
        return ply.bytes();
    };
    fs::create_directories(root / "point_cloud/iteration_best");
    const std::string four = loadError(root.string());
    for (const char* kind : {"is a directory", "lod-meta.json", "meta.json (SOG)", "point_cloud/iteration_N", "numbered files"}) {
        CHECK(contains(four, kind));
    }
    place("frame_9.txt", "no scene"), place("frame_10.txt", "no scene"), place("alone_1.ply", withSplats(1));
    CHECK(loadError(root.string()) == four);
    place("step_10.ply", withSplats(1)), place("step_9.ply", withSplats(2)), place("step_100.ply", withSplats(1));
    LoadNotes of_moving;
    CHECK(loadScene(root.string(), 0, &of_moving).size() == 2);
    REQUIRE(of_moving.lines.size() == 1);
    CHECK(contains(of_moving.lines[0], "garden: a moving scene of 3 frames, of which"));
    CHECK(contains(of_moving.lines[0], "step_9.ply was loaded"));

    place("point_cloud/iteration_7000/point_cloud.ply", withSplats(7));
    CHECK(loadScene(root.string()).size() == 7);
    place("point_cloud/iteration_30000/point_cloud.ply", withSplats(30));
    place("point_cloud/iteration_9000/point_cloud.ply", withSplats(9));
    place("point_cloud/iteration_40000/other.ply", withSplats(4));  // stopped before it was written
    place("point_cloud/iteration_best/point_cloud.ply", withSplats(5));
    LoadNotes notes;
    CHECK(loadScene(root.string() + "/", 0, &notes).size() == 30);
    REQUIRE(notes.lines.size() == 1);
    CHECK(contains(notes.lines[0], "iteration_30000"));
    CHECK(contains(loadError(root.string() + "/point_cloud"), "is a directory"));

    place("meta.json", "{}");
#ifdef BINOSPLAT_SOG
    CHECK(contains(loadError(root.string()), "meta.json"));
    CHECK_FALSE(contains(loadError(root.string()), "lod-meta.json"));
    place("lod-meta.json", "{}");
    CHECK(contains(loadError(root.string()), "lod-meta.json"));
#else
    CHECK(contains(loadError(root.string()), "a SOG scene, which this build cannot read"));
#endif
}

TEST_CASE("the shared scenes load whole" * needsSharedData()) {
    const auto data = test::sharedData();
    if (!data) { return; }
    const auto load = [&](const char* file, std::size_t splats, int degree) {
        LoadNotes notes;
        const Scene scene = loadScene((*data / file).string(), 0, &notes);
        CHECK(scene.size() == splats);
        CHECK(scene.sh_degree == degree);
        CHECK(notes.skipped_not_finite + notes.skipped_zero_rotation == 0);
        CHECK_FALSE(notes.three_scales);
    };
    load("playbot/playbot_lod2_2dgs_sh2.ply", 125'000, 2);
    load("playbot/playbot_lod3_2dgs_sh2.ply", 31'000, 2);
    load("statues/angel_2dgs_sh0.ply", 71'359, 0);
}

}  // namespace scene_test
