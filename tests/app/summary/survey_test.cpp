// Facts about counts in a scene: floaters, splats that cost more than they show, and what to cut.
#include "app/summary/survey.h"
#include "tests/suite.h"

SUITE(survey) {

void addSplat(Scene& scene, const glm::vec3& position, const glm::vec3& scales, float opacity) {
    scene.positions.push_back(position);
    scene.rotations.emplace_back(1.0f, 0.0f, 0.0f, 0.0f);
    scene.scales.emplace_back(scales.x, scales.y);
    scene.thicknesses.push_back(scales.z);
    scene.opacities.push_back(opacity);
    scene.sh.insert(scene.sh.end(), 3, 0.5f);
}

// Dense, so none of its splats is alone.
Scene makePatch() {
    Scene scene;
    for (int i = 0; i < 40'000; ++i) {
        addSplat(scene, 0.05f * glm::vec3(i % 200, i / 200, 0), glm::vec3(0.01f), 0.5f);
    }
    return scene;
}

TEST_CASE("opacities, thicknesses and sizes are counted against their bounds") {
    Scene scene;  // a thousand splats of a centimetre, one unit apart, in a cube with a side of 9
    for (int i = 0; i < 1000; ++i) {
        addSplat(scene, glm::vec3(i / 100, i / 10 % 10, i % 10), glm::vec3(0.01f), 0.5f);
    }
    const SceneSurvey before = surveyScene(scene);
    CHECK(these(before.size, before.transparent + before.opaque + before.thin + before.large) ==
          these(doctest::Approx(9.0), 0));
    addSplat(scene, glm::vec3(4), {0.01f, 0.01f, 0.0009f}, 0.9901f);
    addSplat(scene, glm::vec3(4), {0.01f, 0.91f, 0.0011f}, 0.9899f);
    addSplat(scene, glm::vec3(4), {0.01f, 0.89f, 0.01f}, 0.0039f);
    const SceneSurvey survey = surveyScene(scene);
    CHECK(these(survey.size, survey.transparent, survey.opaque, survey.thin, survey.large) ==
          these(doctest::Approx(9.0), 1, 1, 1, 1));
    CHECK(surveyScene(scene, 0.1).thin == 2);  // a unit is a decimetre
    scene.thicknesses.clear();
    CHECK(surveyScene(scene).thin == 0);  // of a disc, the shorter axis counts
}

TEST_CASE("a floater is seen, small and alone; half of the splats lie within the sphere that is proposed") {
    Scene scene = makePatch();
    const SceneSurvey survey = surveyScene(scene);
    CHECK(survey.floaters == 0);
    for (int i = 0; i < 4; ++i) { addSplat(scene, {5.0f, 5.0f, 3.0f}, glm::vec3(0.01f), 0.5f); }
    CHECK(surveyScene(scene).floaters == 4);
    addSplat(scene, {5.0f, 5.15f, 3.0f}, glm::vec3(0.01f), 0.5f);     // a fifth splat beside them
    addSplat(scene, {-40.0f, 5.0f, 3.0f}, glm::vec3(0.01f), 0.003f);  // invisible
    addSplat(scene, {-50.0f, 5.0f, 3.0f}, glm::vec3(5.0f), 0.5f);     // a large one, as in a sky
    CHECK(surveyScene(scene).floaters == 0);
    addSplat(scene, glm::vec3(3e38f, -3e38f, 3e38f), glm::vec3(0.01f), 0.5f);
    CHECK(surveyScene(scene).floaters == 1);

    scene = makePatch();
    CHECK(glm::distance(survey.middle, glm::dvec3(5.0, 5.0, 0.0)) < 0.2);
    keepWithin(scene, survey.middle, survey.half_radius);
    CHECK(std::abs(static_cast<double>(scene.size()) - 20000.0) < 200.0);
}

TEST_CASE("scenes of no splat and of one place are surveyed") {
    CHECK(surveyScene({}).size == 0.0);
    Scene scene;
    for (int i = 0; i < 3; ++i) { addSplat(scene, glm::vec3(7), glm::vec3(1), 0.5f); }
    const SceneSurvey survey = surveyScene(scene);
    CHECK(these(survey.size, survey.large, survey.floaters) == these(0.0, 0, 0));
}

}  // SUITE(survey)
