// What differs between two frames of a moving scene, and what lies between them, splat by splat.
#include "engine/stream/scene_frames.h"

#include "tests/engine/stream/moving_frames.h"

#include <glm/gtc/packing.hpp>

SUITE(scene_frames) {

// As the device would read it.
Scene unpacked(const SceneFrame& frame, const SceneTraits& traits) {
    const ChunkLayout layout(gpu::kPageSplats, traits);
    Scene scene;
    for (const PackedPages& page : frame) {
        const auto read = [&]<typename T>(std::uint64_t array, std::size_t i, T value) {
            std::memcpy(&value, page.bytes().data() + array + i * sizeof(T), sizeof(T));
            return value;
        };
        for (std::size_t i = 0; i < page.splatCount(); ++i) {
            scene.positions.push_back(read(layout.positions, i, glm::vec3()));
            const glm::vec4 q = read(layout.rotations, i, glm::vec4());
            scene.rotations.emplace_back(q.w, q.x, q.y, q.z);
            scene.scales.push_back(read(layout.scales, i, glm::vec2()));
            scene.opacities.push_back(read(layout.opacities, i, 0.0f));
            const glm::uvec2 colour = read(layout.base_colours, i, glm::uvec2());
            const glm::vec2 rg = glm::unpackHalf2x16(colour.x), b = glm::unpackHalf2x16(colour.y);
            scene.sh.insert(scene.sh.end(), {rg.x, rg.y, b.x});
        }
    }
    return scene;
}

// Whether the box contains everything that can be seen of the splat.
bool holds(const glm::vec3& low, const glm::vec3& high, const Scene& scene, std::size_t splat) {
    const glm::dvec3 half = halfExtentOf(scene.rotations[splat], {scene.scales[splat], 0.0f},
                                         scene.opacities[splat]),
                     centre(scene.positions[splat]);
    return glm::all(glm::lessThanEqual(glm::dvec3(low), centre - half + 1e-5)) &&
           glm::all(glm::greaterThanEqual(glm::dvec3(high), centre + half - 1e-5));
}

bool oneHolds(const std::vector<SceneChange>& boxes, const Scene& scene, std::size_t splat) {
    return std::ranges::any_of(
        boxes, [&](const SceneChange& box) { return holds(box.low, box.high, scene, splat); });
}

Scene withoutSh(Scene scene) {
    LoadNotes notes;
    limitShDegree(scene, 0, notes);
    return scene;
}

TEST_CASE("what stayed as it was differs nowhere, and a step has the pages that do") {
    const Scene scene = withoutSh(slidingAtelier(0));
    const SceneTraits traits = traitsOf(scene);
    const SceneFrame first = makeSceneFrame(scene, traits);
    Scene moved = scene;
    moved.positions[5000].x += 0.25f;
    moved.opacities[5001] = 0.0f;
    const SceneFrame second = makeSceneFrame(moved, traits);
    const std::size_t page = 5000 / gpu::kPageSplats;
    for (std::size_t p = 0; p < first.size(); ++p) {
        CHECK(std::ranges::equal(first[p].bytes(), second[p].bytes()) == (p != page));
    }
    CHECK(bytesIn(second) == first.size() * first[page].bytes().size());
    const FrameStep step = stepBetween(first, second, traits);
    CHECK(these(step.splats, step.pages) ==
          these(scene.size(), std::vector<std::uint32_t>{static_cast<std::uint32_t>(page)}));
    CHECK(std::ranges::equal(step.now.at(0).bytes(), second[page].bytes()));
    // Where both were, and where the first one is now.
    CHECK(oneHolds(step.changes, scene, 5000));
    CHECK(oneHolds(step.changes, moved, 5000));
    CHECK(oneHolds(step.changes, scene, 5001));
    CHECK(stepBetween(first, makeSceneFrame(scene, traits), traits).pages.empty());
    CHECK(stepBetween(first, first, traits).changes.empty());
}

TEST_CASE("all that moved lies in few boxes, and so does what came or went at the end") {
    const Scene from = slidingAtelier(0), to = slidingAtelier(3);
    const SceneTraits traits = traitsOf(from);
    const SceneFrame whole = makeSceneFrame(from, traits);
    const std::vector<SceneChange> changes = stepBetween(whole, makeSceneFrame(to, traits), traits).changes;
    CHECK(changes.size() == within(5, kMostBoxes));
    std::size_t moved = 0, in_none = 0, in_boxes = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        for (const Scene* scene : {&from, &to}) {
            if (from.positions[i] == to.positions[i] || scene->opacities[i] < gpu::kMinAlpha) { continue; }
            ++moved;
            in_none += !oneHolds(changes, *scene, i);
        }
        in_boxes += std::ranges::any_of(changes, [&p = from.positions[i]](const SceneChange& box) {
            return glm::all(glm::lessThanEqual(box.low, p)) && glm::all(glm::greaterThanEqual(box.high, p));
        });
    }
    CHECK(moved > 500);
    CHECK(in_none == 0);
    CHECK(2 * in_boxes < from.size());  // and most of the room is in none
    Scene shorter = from;
    keepWithin(shorter, glm::dvec3(from.positions[0]), 2.5);
    REQUIRE(shorter.size() < from.size());
    const SceneFrame part = makeSceneFrame(shorter, traits);
    CHECK(stepBetween(whole, part, traits).pages.back() == whole.size() - 1);
    CHECK(stepBetween(part, whole, traits).pages.back() == whole.size() - 1);
}

TEST_CASE("between two frames each value lies on a straight line, and rotations on the shorter way") {
    const Scene from = withoutSh(slidingAtelier(0));
    Scene to = withoutSh(slidingAtelier(8));
    // The same turn with the other sign.
    for (std::size_t i = 0; i < to.size(); i += 3) { to.rotations[i] = -to.rotations[i]; }
    to.opacities[7] = 0.2f;
    to.sh[3 * 7] = 1.5f;
    to.scales[7] *= 3.0f;
    const SceneTraits traits = traitsOf(from);
    const SceneFrame a = makeSceneFrame(from, traits), b = makeSceneFrame(to, traits);
    const Scene first = unpacked(a, traits);
    REQUIRE(correspond(a, b, traits));
    for (const float share : {0.25f, 0.5f, 0.9f}) {
        const FrameStep step = stepBetween(a, a, traits, &b, share);
        SceneFrame mixed = a;
        for (std::size_t i = 0; i < step.now.size(); ++i) { mixed[step.pages[i]] = step.now[i]; }
        const Scene got = unpacked(mixed, traits);
        REQUIRE(got.size() == from.size());
        float worst = 0.0f;
        std::size_t changed = 0, not_held = 0;
        for (std::size_t i = 0; i < got.size(); ++i) {
            // For a small turn, normalised lerp and slerp agree up to its cube.
            const glm::quat turn =
                glm::slerp(glm::normalize(from.rotations[i]), glm::normalize(to.rotations[i]), share);
            worst = std::max(
                {worst, glm::distance(got.positions[i], glm::mix(from.positions[i], to.positions[i], share)),
                 glm::distance(got.scales[i], glm::mix(from.scales[i], to.scales[i], share)),
                 std::abs(got.opacities[i] - glm::mix(from.opacities[i], to.opacities[i], share)),
                 1.0f - std::abs(glm::dot(got.rotations[i], turn)),
                 std::abs(1.0f - glm::length(got.rotations[i]))});
            for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
                worst = std::max(worst, 0.1f * std::abs(got.sh[c] - glm::mix(from.sh[c], to.sh[c], share)));
            }
            // What does not move is equal to the bit, also next to what moves.
            if (from.positions[i] == to.positions[i] && i % 3 != 0 && i != 7) {
                changed += got.positions[i] != from.positions[i] || got.scales[i] != from.scales[i] ||
                           got.opacities[i] != from.opacities[i] || got.rotations[i] != first.rotations[i];
            }
            // The bounds by which the device culls contain all of it.
            const auto& page = mixed[i / gpu::kPageSplats].pages()[0];
            not_held += got.opacities[i] >= gpu::kMinAlpha && !holds(page.low, page.high, got, i);
        }
        CHECK(worst < 2e-4f);
        CHECK(changed == 0);
        CHECK(not_held == 0);
    }
}

TEST_CASE("splats in another order, or of another number, do not correspond") {
    const Scene from = slidingAtelier(0), to = slidingAtelier(4);
    const SceneTraits traits = traitsOf(from);
    const SceneFrame a = makeSceneFrame(from, traits);
    const auto fits = [&](const Scene& scene) {
        return correspond(a, makeSceneFrame(scene, traits), traits);
    };
    CHECK(fits(from));
    CHECK(fits(to));
    Scene shuffled = to, fewer = to;
    std::ranges::shuffle(shuffled.positions, std::mt19937(1));
    keepWithin(fewer, glm::dvec3(0.0), 3.0);
    CHECK_FALSE(fits(shuffled));
    CHECK_FALSE(fits(fewer));
    CHECK_FALSE(correspond({}, {}, traits));
}

}  // SUITE(scene_frames)
