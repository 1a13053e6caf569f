// The same scene as SOG and as PLY: what each format preserves of it.
#include "app/scores/metrics.h"
#include "app/summary/survey.h"
#include "engine/files/scene_targets.h"
#include "engine/files/sog.h"
#include "engine/files/sog_files.h"
#include "engine/picture/webp.h"
#include "tests/engine/frame/gpu_scenes.h"
#include "tests/engine/scene/scene_measures.h"
#include "tests/shared_data.h"

namespace binosplat::test::equivalent_format_suite {

Scene loadFlat(const std::filesystem::path& path) {
    auto [notes, scene] = readScene(path.string());
    flatten(scene, notes);
    return scene;
}

// Of the float64 twin's pictures.
double psnrDb(const Scene& a, const Scene& b, const glm::dvec3& place, const glm::dvec3& look) {
    const Eye eye = eyeOf({place, look, {0, -1, 0}, 60.0}, {320, 320});
    return compare(toImage(reference::render(a, eye, {})), toImage(reference::render(b, eye, {}))).psnrDb();
}

TEST_CASE("playbot and angel are the same scenes as SOG and as PLY" * needsSharedData()) {
    const auto data = sharedData();
    if (!data) { return; }
    const Scene playbot = loadFlat(*data / "playbot/playbot_lod3_2dgs_sh2.ply"),
                angel = loadFlat(*data / "statues/angel_2dgs_sh0.ply");
    const Scene playbot_sog = loadFlat(*data / "playbot/playbot_lod3_sog"),
                angel_sog = loadFlat(*data / "statues/angel.sog");
    CHECK(these(playbot_sog.size(), angel_sog.size()) == these(playbot.size(), angel.size()));
    CHECK(psnrDb(playbot, playbot_sog, {0, -0.6, -1.6}, {0, -0.4, 0}) > 55.0);
    CHECK(psnrDb(angel, angel_sog, {0, -2, -5}, {0, -2, 0}) > 55.0);
}

TEST_CASE("a bundle has the files and keys that other writers' have" * needsSharedData()) {
    const auto data = sharedData();
    if (!data) { return; }
    const Folder folder;
    writeSog(loadScene((*data / "playbot/playbot_lod3_sog").string()), folder.file("a.sog"));
    const InputFile bundle(folder.file("a.sog"));
    const auto metaOf = [](SogFiles& files) {
        const std::vector<std::byte> text = files.read("meta.json", 1 << 22);
        return nlohmann::json::parse(reinterpret_cast<const char*>(text.data()),
                                     reinterpret_cast<const char*>(text.data() + text.size()));
    };
    const std::unique_ptr<SogFiles> theirs = openSogFolder((*data / "playbot/playbot_lod3_sog").string()),
                                    ours = openSogBundle(bundle);
    const nlohmann::json our_meta = metaOf(*ours).flatten(), their_meta = metaOf(*theirs).flatten();
    for (const auto& [key, value] : their_meta.items()) {
        CAPTURE(key);
        REQUIRE(our_meta.contains(key));
        CHECK(our_meta[key].is_number() == value.is_number());
        if (value.is_string() && !key.ends_with("generator")) { CHECK(our_meta[key] == value); }
    }
    for (const char* picture :
         {"means_l", "means_u", "scales", "quats", "sh0", "shN_centroids", "shN_labels"}) {
        const auto sizeIn = [&](SogFiles& files) {
            const std::string name = std::string(picture) + ".webp";
            return webpSize(files.read(name, 1 << 24), name);
        };
        CAPTURE(picture);
        CHECK(sizeIn(*theirs) == sizeIn(*ours));
    }
}

void checkFormats(const std::vector<std::string>& sources, const std::vector<glm::dvec3>& directions) {
    const auto data = sharedData();
    if (!data) { return; }
    for (const std::string& source : sources) {
        const Scene scene =
            loadScene((*data / source).string(), 0, nullptr, {},
                      {source.ends_with("streamed") ? std::optional<std::uint32_t>(4) : std::nullopt, {}});
        const SceneSurvey survey = surveyScene(scene);
        const double away = 1.5 * std::max(survey.size, 0.5);
        for (const auto& [name, least_db] :
             {std::pair("a.ply", 100.0), std::pair("a.spz", scene.isGaussian3d() ? 40.0 : 42.0),
              std::pair("a.sog", 45.0)}) {
            INFO("source ", source, ", name ", name);
            const Folder folder;
            findSceneTarget(name).write(scene, folder.file(name), {});
            auto [notes, back] = readScene(folder.file(name));
            if (name == std::string("a.spz") && !scene.isGaussian3d()) { flatten(back, notes); }
            REQUIRE(back.size() == scene.size());
            CHECK(back.isGaussian3d() == scene.isGaussian3d());
            for (const glm::dvec3& direction : directions) {
                CHECK(psnrDb(scene, back, survey.middle + away * glm::normalize(direction), survey.middle) >
                      least_db);
            }
        }
    }
}

TEST_CASE("scenes of every format that is read are the same pictures in every format that is written" *
          needsSharedData()) {
    checkFormats({"formats/minimal.ksplat", "formats/minimal.splat", "playbot/playbot_streamed",
                  "formats/khr_extensible_fallback.gltf"},
                 {{0.8, -0.5, 0.5}});
}

TEST_CASE("larger scenes are the same pictures from three sides in every format that is written" *
          needsSharedData() * nightly()) {
    checkFormats({"guitar/guitar.compressed.ply", "statues/angel.sog", "statues/angel_2dgs_sh0.ply",
                  "playbot/playbot_streamed", "playbot/playbot_lod2_2dgs_sh2.ply",
                  "playbot/playbot_lod3_2dgs_sh2.ply", "playbot/playbot_lod3_sog"},
                 {{0, -0.3, -1}, {0.8, -0.5, 0.5}, {-1, 0.2, 0.3}});
}

}  // namespace binosplat::test::equivalent_format_suite
