// What `info` counts in a scene: shares of splats that cost more than they show, floaters, and what would take less memory.
#include "engine/scene/survey.h"
#include "engine/scene/ply.h"
#include "tests/engine/scene/gltf_files.h"
#include "tests/engine/scene/spz_files.h"
#include "tests/run_program.h"

TEST_SUITE_BEGIN("survey");

namespace survey_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

void addSplat(Scene& scene, const glm::vec3& position, const glm::vec3& scales, float opacity) {
    scene.positions.push_back(position);
    scene.rotations.emplace_back(1.0f, 0.0f, 0.0f, 0.0f);
    scene.scales.emplace_back(scales.x, scales.y);
    scene.thicknesses.push_back(scales.z);
    scene.opacities.push_back(opacity);
    for (int channel = 0; channel < 3; ++channel) { scene.sh.push_back(0.5f); }
}

// A thousand splats in a cube of a side of 9, one unit apart, a centimetre large.
Scene makeCube() {
    Scene scene;
    for (int i = 0; i < 1000; ++i) { addSplat(scene, glm::vec3(i / 100, i / 10 % 10, i % 10), glm::vec3(0.01f), 0.5f); }
    return scene;
}

// A dense patch, so that none of its splats is alone.
Scene makePatch() {
    Scene scene;
    for (int i = 0; i < 40'000; ++i) {
        addSplat(scene, glm::vec3(0.05f * static_cast<float>(i % 200), 0.05f * static_cast<float>(i / 200), 0.0f), glm::vec3(0.01f), 0.5f);
    }
    return scene;
}

}  // namespace

TEST_CASE("opacities, thicknesses and sizes are counted against their bounds") {
    Scene scene = makeCube();
    const SceneSurvey before = surveyScene(scene);
    CHECK(before.size == doctest::Approx(9.0));
    CHECK(before.transparent + before.opaque + before.thin + before.large == 0);
    addSplat(scene, glm::vec3(4), {0.01f, 0.01f, 0.0009f}, 0.9901f);
    addSplat(scene, glm::vec3(4), {0.01f, 0.91f, 0.0011f}, 0.9899f);
    addSplat(scene, glm::vec3(4), {0.01f, 0.89f, 0.01f}, 0.0039f);
    const SceneSurvey survey = surveyScene(scene);
    CHECK(survey.size == doctest::Approx(9.0));
    CHECK(survey.transparent == 1);
    CHECK(survey.opaque == 1);
    CHECK(survey.thin == 1);
    CHECK(survey.large == 1);
    CHECK(surveyScene(scene, 0.1).thin == 2);  // a unit is a decimetre
    scene.thicknesses.clear();
    CHECK(surveyScene(scene).thin == 0);  // of discs the shorter axis counts
}

TEST_CASE("a floater is seen, small and alone") {
    Scene scene = makePatch();
    CHECK(surveyScene(scene).floaters == 0);
    for (int i = 0; i < 4; ++i) { addSplat(scene, {5.0f, 5.0f, 3.0f}, glm::vec3(0.01f), 0.5f); }
    CHECK(surveyScene(scene).floaters == 4);
    addSplat(scene, {5.0f, 5.15f, 3.0f}, glm::vec3(0.01f), 0.5f);  // a fifth one beside them
    CHECK(surveyScene(scene).floaters == 0);
    addSplat(scene, {-40.0f, 5.0f, 3.0f}, glm::vec3(0.01f), 0.003f);  // not seen
    addSplat(scene, {-50.0f, 5.0f, 3.0f}, glm::vec3(5.0f), 0.5f);     // a large one, as in a sky
    CHECK(surveyScene(scene).floaters == 0);
    addSplat(scene, glm::vec3(3e38f, -3e38f, 3e38f), glm::vec3(0.01f), 0.5f);
    CHECK(surveyScene(scene).floaters == 1);
}

TEST_CASE("half of the splats lie within the sphere that is proposed") {
    Scene scene = makePatch();
    const SceneSurvey survey = surveyScene(scene);
    CHECK(glm::distance(survey.middle, glm::dvec3(5.0, 5.0, 0.0)) < 0.2);
    keepWithin(scene, survey.middle, survey.half_radius);
    CHECK(std::abs(static_cast<double>(scene.size()) - 20000.0) < 200.0);
}

TEST_CASE("scenes of no splat and of one place are surveyed") {
    CHECK(surveyScene({}).size == 0.0);
    Scene scene;
    for (int i = 0; i < 3; ++i) { addSplat(scene, glm::vec3(7), glm::vec3(1), 0.5f); }
    const SceneSurvey survey = surveyScene(scene);
    CHECK(survey.size == 0.0);
    CHECK(survey.large == 0);
    CHECK(survey.floaters == 0);
}

TEST_CASE("info says what a scene is made of, and what would take less memory") {
    const Folder folder;
    const Workplace work;
    Scene scene = makePatch();
    scene.positions[0] = {5.0f, 5.0f, 30.0f};
    scene.opacities[1] = 0.001f;
    scene.opacities[2] = 1.0f;
    writePly(scene, folder.file("a.ply"));
    const Outcome info = work.run("info '" + folder.file("a.ply") + "'");
    CHECK(info.exit_code == 0);
    for (const char* row :
         {"axes               the file does not say; taken as a training's: x right, y down, z front; right-handed\n",
          "colour space       the file does not say; taken as a training's: display-encoded (sRGB)\n",
          "  0.00 %  1 splats: opacity under 1/255, never seen\n", "  0.00 %  1 splats: over 99 % opaque\n",
          "  0.00 %  0 splats: thinner than a millimetre (the shortest axis, ", "  0.00 %  0 splats: larger than a tenth of the size\n",
          "  0.00 %  1 splats: floaters: seen, but alone (fewer than 5 splats within", "(2.0 MiB) on the GPU, 52 a splat",
          "if too much      convert --crop="}) {
        CAPTURE(row);
        CHECK(contains(info.output, row));
    }
    // What is proposed can be done.
    const std::size_t at = info.output.find("--crop=");
    const std::string crop = info.output.substr(at, info.output.find(' ', at) - at);
    CHECK(work.run("convert '" + folder.file("a.ply") + "' b.ply " + crop).exit_code == 0);
    CHECK(contains(work.run("info builtin:atelier").output, "--sh-degree 0: "));
    CHECK_FALSE(contains(info.output, "--sh-degree"));
}

TEST_CASE("info says the axes and the colours that a file names") {
    const Folder folder;
    const Workplace work;
    SpzText spz = makeSpz(3);
    const auto infoOf = [&](const std::string& bytes) { return work.run("info '" + folder.write("a.bin", bytes) + "'").output; };
    CHECK(contains(infoOf(gzip(spz.bytes())), "axes               x right, y up, z back; right-handed (SPZ's own: the file names none)\n"));
    spz.version = 4, spz.flags = 2;
    CHECK(contains(infoOf(makeSpzContainer(spz, spzAxesRecord(8))),
                   "axes               x right, y up, z front; left-handed (named by the file)\n"));
    CHECK(contains(infoOf(makeSpzContainer(spz, spzAxesRecord(16))),
                   "axes               x right, y front, z up; right-handed (named by the file)\n"));
    CHECK(contains(work.run("info builtin:one-splat").output, "colour space       display-encoded (sRGB)\n"));
#ifdef BINOSPLAT_GLTF
    const std::string glb = infoOf(makeGltf(0).glb());
    CHECK(contains(glb, "axes               x left, y up, z front; right-handed (glTF's own)\n"));
    CHECK(contains(glb, "colour space       srgb_rec709_display (named by the file)\n"));
#endif
}

}  // namespace survey_test
