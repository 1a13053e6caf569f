// The same scene as SOG and as PLY: what each format keeps of it.
#include "engine/picture/webp.h"
#include "engine/reference/reference.h"
#include "engine/scene/scene.h"
#include "engine/scene/scene_targets.h"
#include "engine/scene/sog.h"
#include "engine/scene/sog_files.h"
#include "engine/scene/spz.h"
#include "engine/scene/survey.h"
#include "tests/engine/scene/ply_files.h"
#include "tests/shared_data.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

TEST_SUITE_BEGIN("equivalent_format");

namespace equivalent_format_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

// R diag(s_u^2, s_v^2, 0) R^T: the disc, whichever way its axes are named.
glm::dmat3 covariance(const Scene& scene, std::size_t splat) {
    const glm::dmat3 turn = glm::mat3_cast(glm::dquat(scene.rotations[splat]));
    const glm::dvec2 scale(scene.scales[splat]);
    const glm::dvec3 u = turn[0] * scale.x, v = turn[1] * scale.y;
    return glm::outerProduct(u, u) + glm::outerProduct(v, v);
}

double norm(const glm::dmat3& matrix) {
    return std::sqrt(glm::dot(matrix[0], matrix[0]) + glm::dot(matrix[1], matrix[1]) + glm::dot(matrix[2], matrix[2]));
}

struct Differences {
    double position = 0.0, opacity = 0.0, sh = 0.0, disc = 0.0;  // the largest; discs relative to their size
    std::size_t other_axis_dropped = 0;
};

Scene loadFlat(const std::filesystem::path& path) {
    LoadNotes notes;
    Scene scene = loadScene(path.string(), 0, &notes);
    flatten(scene, notes);
    return scene;
}

// The two shortest axes of such a splat have the same length, so that either may be the one to drop: the scales agree, the discs do not.
bool tiesAllowBoth(const Scene& a, const Scene& b, std::size_t splat) {
    const auto sorted = [](glm::vec2 scale) { return glm::vec2(std::min(scale.x, scale.y), std::max(scale.x, scale.y)); };
    return glm::distance(sorted(a.scales[splat]), sorted(b.scales[splat])) <= 1e-5f * a.scales[splat].x;
}

Differences compare(const Scene& a, const Scene& b) {
    Differences differences;
    for (std::size_t i = 0; i < a.size(); ++i) {
        differences.position = std::max<double>(differences.position, glm::distance(a.positions[i], b.positions[i]));
        differences.opacity = std::max<double>(differences.opacity, std::abs(a.opacities[i] - b.opacities[i]));
        const double disc = norm(covariance(a, i) - covariance(b, i)) / norm(covariance(b, i));
        if (disc > 1e-4 && tiesAllowBoth(a, b, i)) {
            ++differences.other_axis_dropped;
        } else {
            differences.disc = std::max(differences.disc, disc);
        }
    }
    for (std::size_t i = 0; i < a.sh.size(); ++i) { differences.sh = std::max<double>(differences.sh, std::abs(a.sh[i] - b.sh[i])); }
    MESSAGE(
        fmt::format("largest differences: position {:.2g}, opacity {:.2g}, SH {:.2g}, disc {:.2g} of its size; {} of {} splats with two "
                    "equal shortest axes dropped the other one",
                    differences.position, differences.opacity, differences.sh, differences.disc, differences.other_axis_dropped, a.size()));
    return differences;
}

// Of the float64 twin's pictures, against a peak of 1.
double psnrDb(const Scene& a, const Scene& b, const glm::dvec3& eye_at, const glm::dvec3& look) {
    Eye eye;
    eye.size_px = {320, 320};
    eye.intrinsics = intrinsicsFromFovX(glm::radians(60.0), eye.size_px);
    eye.world_from_camera = lookAt(eye_at, look, {0, -1, 0});
    const reference::Picture first = reference::render(a, eye, {}), second = reference::render(b, eye, {});
    double squares = 0.0;
    for (std::size_t i = 0; i < first.rgba.size(); ++i) {
        const glm::dvec3 difference(first.rgba[i] - second.rgba[i]);
        squares += glm::dot(difference, difference);
    }
    return -10.0 * std::log10(squares / (3.0 * static_cast<double>(first.rgba.size())));
}

// What SPZ makes of a scene.
Scene throughSpz(const Scene& scene) {
    const Folder folder;
    writeSpz(scene, folder.file("scene.spz"));
    return loadFlat(folder.file("scene.spz"));
}

// Likewise SOG, of discs and of 3D Gaussians.
Scene throughSog(const Scene& scene) {
    const Folder folder;
    writeSog(scene, folder.file("scene.sog"));
    return loadScene(folder.file("scene.sog"));
}

struct Place {
    glm::dvec3 eye, look;
};
constexpr Place kPlaybotPlaces[]{{{0, -0.6, -1.6}, {0, -0.4, 0}}, {{0.3, -0.7, -0.8}, {0, -0.6, 0}}, {{1.5, -0.6, 0.3}, {0, -0.4, 0}}};

// Whether every key of `theirs` is one of `ours`, with a value of the same kind, and files have the same names.
void checkSameKeys(const nlohmann::json& theirs, const nlohmann::json& ours, const std::string& place) {
    CAPTURE(place);
    CHECK(theirs.is_number() == ours.is_number());
    CHECK(theirs.is_array() == ours.is_array());
    if (theirs.is_string() && !place.ends_with(".generator")) { CHECK(theirs == ours); }
    if (theirs.is_array()) { CHECK(theirs.size() == ours.size()); }
    if (theirs.is_array() && theirs[0].is_string()) { CHECK(theirs == ours); }
    if (!theirs.is_object()) { return; }
    for (const auto& [key, value] : theirs.items()) {
        REQUIRE(ours.contains(key));
        checkSameKeys(value, ours[key], place + "." + key);
    }
}

}  // namespace

TEST_CASE("playbot LOD 3 is the same scene as SOG and as PLY" * needsSharedData()) {
    const auto data = sharedData();
    if (!data) { return; }
    const Scene sog = loadFlat(*data / "playbot/playbot_lod3_sog");
    const Scene ply = loadScene((*data / "playbot/playbot_lod3_2dgs_sh2.ply").string());
    REQUIRE(sog.size() == ply.size());
    REQUIRE(sog.sh_degree == ply.sh_degree);
    const Differences differences = compare(sog, ply);
    CHECK(differences.position < 1e-6);
    CHECK(differences.opacity < 1e-5);
    CHECK(differences.sh < 1e-6);
    CHECK(differences.disc < 1e-4);
    CHECK(differences.other_axis_dropped < sog.size() / 200);
    const double as_sog = psnrDb(ply, sog, {0, -0.6, -1.6}, {0, -0.4, 0}),
                 as_spz = psnrDb(ply, throughSpz(ply), {0, -0.6, -1.6}, {0, -0.4, 0});
    MESSAGE(fmt::format("rendered, against the PLY: SOG {:.1f} dB, SPZ {:.1f} dB", as_sog, as_spz));
    CHECK(as_sog > 55.0);
    CHECK(as_spz > 42.0);
}

TEST_CASE("angel is the same scene as a SOG bundle and as PLY" * needsSharedData()) {
    const auto data = sharedData();
    if (!data) { return; }
    const Scene sog = loadFlat(*data / "statues/angel.sog");
    const Scene ply = loadScene((*data / "statues/angel_2dgs_sh0.ply").string());
    REQUIRE(sog.size() == ply.size());
    REQUIRE(sog.sh_degree == ply.sh_degree);
    const Differences differences = compare(sog, ply);
    CHECK(differences.position < 1e-6);
    CHECK(differences.opacity < 2e-4);  // the PLY's writer kept opacities off 1
    CHECK(differences.sh < 1e-6);
    CHECK(differences.disc < 1e-4);
    CHECK(differences.other_axis_dropped < sog.size() / 100);
    const double as_sog = psnrDb(ply, sog, {0, -2, -5}, {0, -2, 0}), as_spz = psnrDb(ply, throughSpz(ply), {0, -2, -5}, {0, -2, 0});
    MESSAGE(fmt::format("rendered, against the PLY: SOG {:.1f} dB, SPZ {:.1f} dB, through SOG and back {:.1f} dB", as_sog, as_spz,
                        psnrDb(ply, throughSog(ply), {0, -2, -5}, {0, -2, 0})));
    CHECK(as_sog > 55.0);
    CHECK(as_spz > 42.0);
}

TEST_CASE("playbot is the same picture through SOG and back, as discs and as 3D Gaussians, from three places" * needsSharedData()) {
    const auto data = sharedData();
    if (!data) { return; }
    for (const char* file : {"playbot/playbot_lod3_2dgs_sh2.ply", "playbot/playbot_lod3_sog"}) {
        const Scene scene = loadScene((*data / file).string()), back = throughSog(scene);
        CHECK(back.isGaussian3d() == scene.isGaussian3d());
        for (const Place& place : kPlaybotPlaces) {
            const double db = psnrDb(scene, back, place.eye, place.look);
            MESSAGE(fmt::format("{} through SOG and back: {:.1f} dB", file, db));
            CHECK(db > 45.0);
        }
    }
}

TEST_CASE("a bundle has the files and keys that other writers' have" * needsSharedData()) {
    const auto data = sharedData();
    if (!data) { return; }
    const Folder folder;
    writeSog(loadScene((*data / "playbot/playbot_lod3_sog").string()), folder.file("a.sog"));
    const InputFile bundle(folder.file("a.sog"));
    const auto metaOf = [](SogFiles& files) {
        const std::vector<std::byte> text = files.read("meta.json", 1 << 22);
        return nlohmann::json::parse(reinterpret_cast<const char*>(text.data()), reinterpret_cast<const char*>(text.data() + text.size()));
    };
    const std::unique_ptr<SogFiles> theirs = openSogFolder((*data / "playbot/playbot_lod3_sog").string()), ours = openSogBundle(bundle);
    checkSameKeys(metaOf(*theirs), metaOf(*ours), "meta.json");
    for (const char* picture : {"means_l", "means_u", "scales", "quats", "sh0", "shN_centroids", "shN_labels"}) {
        const auto sizeIn = [&](SogFiles& files) {
            const std::string name = std::string(picture) + ".webp";
            return webpSize(files.read(name, 1 << 24), name);
        };
        CAPTURE(picture);
        CHECK(sizeIn(*theirs) == sizeIn(*ours));
    }
}

TEST_CASE("scenes of every format that is read go through every format that is written, as the same pictures" * needsSharedData()) {
    const auto data = sharedData();
    if (!data) { return; }
    const Folder folder;
    std::vector<std::string> sources{"guitar/guitar.compressed.ply", "formats/minimal.ksplat", "formats/minimal.splat", "statues/angel.sog",
                                     "playbot/playbot_streamed"};
#ifdef BINOSPLAT_GLTF
    sources.emplace_back("formats/khr_extensible_fallback.gltf");
#endif
    for (const std::string& source : sources) {
        CAPTURE(source);
        const Scene scene = loadScene((*data / source).string(), 0, nullptr, {},
                                      {source.ends_with("streamed") ? std::optional<std::uint32_t>(4) : std::nullopt, {}});
        const SceneSurvey survey = surveyScene(scene);
        const double away = 1.5 * std::max(survey.size, 0.5);
        std::string told;
        for (const auto& [name, least_db] : {std::pair("a.ply", 100.0), std::pair("a.spz", 40.0), std::pair("a.sog", 45.0)}) {
            findSceneTarget(name).write(scene, folder.file(name), {});
            const Scene back = loadScene(folder.file(name));
            REQUIRE(back.size() == scene.size());
            for (const glm::dvec3& direction : {glm::dvec3(0, -0.3, -1), glm::dvec3(0.8, -0.5, 0.5), glm::dvec3(-1, 0.2, 0.3)}) {
                const double db = psnrDb(scene, back, survey.middle + away * glm::normalize(direction), survey.middle);
                told += fmt::format(" {} {:.1f} dB", name + 2, db);
                CHECK(db > least_db);
            }
        }
        MESSAGE(fmt::format("{}:{}", source, told));
    }
}

}  // namespace equivalent_format_test
