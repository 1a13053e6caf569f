// Facts about merging splats.
#include "engine/levels/merge.h"

#include "engine/builtin/procedural.h"
#include "tests/engine/gpu/gpu_fixture.h"

SUITE(merge) {

constexpr float kBand = 0.28209479177387814f;

// Discs of radius 0.1 that face z, of these grey colours.
Scene makeRow(const std::vector<glm::vec3>& positions, const std::vector<float>& greys) {
    Scene scene;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        scene.positions.push_back(positions[i]);
        scene.rotations.emplace_back(1.0f, 0.0f, 0.0f, 0.0f);
        scene.scales.emplace_back(0.1f);
        scene.opacities.push_back(0.9f);
        scene.sh.insert(scene.sh.end(), 3, greys[i] / kBand);
    }
    return scene;
}

double areaOf(const Scene& scene) {
    double area = 0.0;
    for (std::size_t i = 0; i < scene.size(); ++i) {
        area += static_cast<double>(scene.scales[i].x * scene.scales[i].y * scene.opacities[i]);
    }
    return area;
}

TEST_CASE("of three discs in a row the two that look alike become one that covers what they covered") {
    const Scene row =
        makeRow({{0.0f, 0.0f, 0.0f}, {0.2f, 0.0f, 0.0f}, {0.4f, 0.0f, 0.0f}}, {0.1f, 0.5f, 0.6f});
    SplatMerger merger(row, std::vector<std::int64_t>{100, 100, 300});
    merger.reduceTo(2);
    const Scene& scene = merger.scene();
    REQUIRE(scene.size() == 2);
    CHECK(these(scene.positions[0], scene.sh[0]) == these(row.positions[0], row.sh[0]));
    // Weights decide about the mean.
    CHECK(scene.positions[1].x == doctest::Approx(0.35));
    CHECK(scene.sh[3] * kBand == doctest::Approx(0.575));
    CHECK(areaOf(scene) == doctest::Approx(areaOf(row)));
    // Still facing z, and longer along the row.
    const glm::mat3 axes = glm::mat3_cast(scene.rotations[1]);
    CHECK(std::abs(axes[2].z) == doctest::Approx(1.0));
    CHECK(std::abs(axes[0].x) == doctest::Approx(1.0));
    CHECK(scene.scales[1].x * scene.scales[1].x / (scene.scales[1].y * scene.scales[1].y) ==
          doctest::Approx((0.01 + 0.25 * 0.75 * 0.04) / 0.01));
}

TEST_CASE("what shows little is merged first, and what lies at the same place becomes denser, not larger") {
    Scene scene = makeRow({{0.0f, 0.0f, 0.0f}, {0.1f, 0.0f, 0.0f}, {5.0f, 0.0f, 0.0f}, {5.1f, 0.0f, 0.0f}},
                          {0.5f, 0.5f, 0.5f, 0.5f});
    SplatMerger merger(scene, std::vector<std::int64_t>{1000, 1000, 1, 1});
    merger.reduceTo(3);
    CHECK(merger.scene().positions[2].x == doctest::Approx(5.05));
    scene.positions.assign(4, glm::vec3(1.0f));
    scene.opacities.assign(4, 0.5f);
    SplatMerger same_place(scene, std::vector<std::int64_t>(4, 1));
    same_place.reduceTo(1);
    REQUIRE(same_place.scene().size() == 1);
    CHECK(same_place.scene().scales[0].x == doctest::Approx(0.1));
    CHECK(same_place.scene().opacities[0] >= 0.5f);
    scene.opacities.assign(4, 0.001f);
    SplatMerger faint(scene, std::vector<std::int64_t>(4, 1));
    faint.reduceTo(1);
    CHECK(faint.scene().opacities[0] == kFaintest);
}

TEST_CASE("Gaussians keep the spread of their centres along all axes") {
    Scene scene = makeRow({{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.3f}}, {0.5f, 0.5f});
    scene.thicknesses.assign(2, 0.1f);
    SplatMerger merger(scene, std::vector<std::int64_t>{10, 10});
    merger.reduceTo(1);
    const glm::vec3 along = glm::mat3_cast(merger.scene().rotations[0])[0];
    CHECK(std::abs(along.z) == doctest::Approx(1.0));
    const double longest = merger.scene().scales[0].x, shortest = merger.scene().thicknesses[0];
    CHECK(longest / shortest == doctest::Approx(std::sqrt(0.01 + 0.0225) / 0.1));
}

TEST_CASE("a room merged step by step has the counts asked for, and the same splats every time") {
    const Scene room = makeBuiltin("builtin:atelier", 3000);
    const std::vector<std::int64_t> weights(room.size(), 7);
    SplatMerger once(room, weights), again(room, weights);
    double area = areaOf(room);
    for (const std::uint64_t count : {room.size() / 2, room.size() / 8, std::size_t{1}}) {
        once.reduceTo(count);
        again.reduceTo(count);
        CHECK(once.scene().size() == count);
        CHECK(
            these(once.scene().positions, once.scene().rotations, once.scene().scales, once.scene().sh) ==
            these(again.scene().positions, again.scene().rotations, again.scene().scales, again.scene().sh));
        // Nothing is covered twice as much as before, and most still is.
        if (count > 1) { CHECK(areaOf(once.scene()) > 0.6 * area); }
        CHECK(areaOf(once.scene()) < 1.01 * area);
        area = areaOf(once.scene());
    }
}

}  // SUITE(merge)
