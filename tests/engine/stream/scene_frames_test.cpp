// What differs between two frames of a moving scene, and what lies between them, against the same computed splat by splat.
#include "engine/stream/scene_frames.h"

#include "engine/error.h"
#include "tests/engine/stream/moving_frames.h"

#include <glm/gtc/packing.hpp>

#include <doctest/doctest.h>

#include <numeric>
#include <random>

TEST_SUITE_BEGIN("scene_frames");

namespace scene_frames_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

// As the device would read it.
Scene unpacked(const SceneFrame& frame, const SceneTraits& traits) {
    const ChunkLayout layout(gpu::kPageSplats, traits);
    Scene scene;
    for (const auto& page : frame) {
        const auto read = [&]<typename T>(std::uint64_t array, std::size_t i, T value) {
            std::memcpy(&value, page->bytes.data() + array + i * sizeof(T), sizeof(T));
            return value;
        };
        for (std::size_t i = 0; i < page->splats; ++i) {
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

bool holds(const SceneChange& box, const glm::dvec3& low, const glm::dvec3& high) {
    return glm::all(glm::lessThanEqual(glm::dvec3(box.low), low + 1e-5)) &&
           glm::all(glm::greaterThanEqual(glm::dvec3(box.high), high - 1e-5));
}

}  // namespace

TEST_CASE("what stayed as it was is one page in both frames, and differs nowhere") {
    Scene scene = slidingAtelier(0);
    limitShDegree(scene, 0, *std::make_unique<LoadNotes>());
    const SceneTraits traits = traitsOf(scene);
    const SceneFrame first = makeSceneFrame(scene, traits);
    CHECK(splatsIn(first) == scene.size());
    Scene moved = scene;
    moved.positions[5000].x += 0.25f;
    moved.opacities[5001] = 0.0f;
    const SceneFrame second = makeSceneFrame(moved, traits, first);
    const std::size_t page = 5000 / gpu::kPageSplats;
    for (std::size_t p = 0; p < first.size(); ++p) { CHECK((first[p] == second[p]) == (p != page)); }
    CHECK(bytesIn(second, first) == first[page]->bytes.size());
    CHECK(bytesIn(second) == first.size() * first[page]->bytes.size());
    const FrameDifference difference = differenceOf(first, second, traits);
    CHECK(difference.pages == std::vector<std::uint32_t>{static_cast<std::uint32_t>(page)});
    // Where both were, and where the one is now.
    for (const auto& [from, splat] : {std::pair(&scene, 5000), std::pair(&moved, 5000), std::pair(&scene, 5001)}) {
        const auto i = static_cast<std::size_t>(splat);
        const glm::dvec3 half = halfExtentOf(from->rotations[i], {from->scales[i], 0.0f}, from->opacities[i]), centre(from->positions[i]);
        CHECK(std::ranges::any_of(difference.changes, [&](const SceneChange& box) { return holds(box, centre - half, centre + half); }));
    }
    CHECK(differenceOf(first, makeSceneFrame(scene, traits), traits).pages.empty());  // equal, if not one
    CHECK(differenceOf(first, first, traits).changes.empty());
}

TEST_CASE("all that moved lies in boxes, no more than there may be, and what came or went at the end does, too") {
    const Scene from = slidingAtelier(0), to = slidingAtelier(3);
    const SceneTraits traits = traitsOf(from);
    const FrameDifference difference = differenceOf(makeSceneFrame(from, traits), makeSceneFrame(to, traits), traits);
    CHECK(difference.changes.size() <= kMostBoxes);
    CHECK(difference.changes.size() > 4);
    double in_boxes = 0.0;
    std::size_t moved = 0, in_none = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        for (const Scene* scene : {&from, &to}) {
            if (from.positions[i] == to.positions[i] || scene->opacities[i] < gpu::kMinAlpha) { continue; }
            const glm::dvec3 half = halfExtentOf(scene->rotations[i], {scene->scales[i], 0.0f}, scene->opacities[i]),
                             p(scene->positions[i]);
            ++moved;
            in_none +=
                std::ranges::none_of(difference.changes, [&](const SceneChange& box) { return holds(box, p - half, p + half); }) ? 1u : 0u;
        }
        in_boxes += std::ranges::any_of(
                        difference.changes,
                        [&](const SceneChange& box) { return holds(box, glm::dvec3(from.positions[i]), glm::dvec3(from.positions[i])); })
                        ? 1.0
                        : 0.0;
    }
    CHECK(moved > 500);
    CHECK(in_none == 0);
    CHECK(in_boxes < 0.5 * static_cast<double>(from.size()));  // and most of the room lies in none

    Scene shorter = from;
    keepWithin(shorter, glm::dvec3(from.positions[0]), 2.5);
    REQUIRE(shorter.size() < from.size());
    const SceneFrame whole = makeSceneFrame(from, traits), part = makeSceneFrame(shorter, traits);
    CHECK(differenceOf(whole, part, traits).pages.back() == whole.size() - 1);
    CHECK(differenceOf(part, whole, traits).pages.back() == whole.size() - 1);
}

TEST_CASE("between two frames each value lies on a straight line, and rotations on the shorter way") {
    Scene from = slidingAtelier(0), to = slidingAtelier(8);
    LoadNotes notes;
    limitShDegree(from, 0, notes);
    limitShDegree(to, 0, notes);
    // The same turn with the other sign.
    for (std::size_t i = 0; i < to.size(); i += 3) { to.rotations[i] = -to.rotations[i]; }
    to.opacities[7] = 0.2f;
    to.sh[3 * 7] = 1.5f;
    to.scales[7] *= 3.0f;
    const SceneTraits traits = traitsOf(from);
    const SceneFrame a = makeSceneFrame(from, traits), b = makeSceneFrame(to, traits, a);
    REQUIRE(correspond(a, b, traits));
    for (const float share : {0.25f, 0.5f, 0.9f}) {
        const SceneFrame mixed = between(a, b, share, traits);
        const Scene got = unpacked(mixed, traits);
        REQUIRE(got.size() == from.size());
        double worst = 0.0;
        for (std::size_t i = 0; i < got.size(); ++i) {
            worst =
                std::max(worst, static_cast<double>(glm::distance(got.positions[i], glm::mix(from.positions[i], to.positions[i], share))));
            worst = std::max(worst, static_cast<double>(glm::distance(got.scales[i], glm::mix(from.scales[i], to.scales[i], share))));
            worst = std::max(worst, std::abs(static_cast<double>(got.opacities[i] - glm::mix(from.opacities[i], to.opacities[i], share))));
            for (std::size_t c = 0; c < 3; ++c) {
                worst = std::max(
                    worst, 0.1 * std::abs(static_cast<double>(got.sh[3 * i + c] - glm::mix(from.sh[3 * i + c], to.sh[3 * i + c], share))));
            }
            // A small turn: normalised lerp and slerp are the same within its cube.
            const glm::quat wanted = glm::slerp(glm::normalize(from.rotations[i]), glm::normalize(to.rotations[i]), share);
            worst = std::max(worst, 1.0 - std::abs(static_cast<double>(glm::dot(got.rotations[i], wanted))));
            worst = std::max(worst, std::abs(1.0 - static_cast<double>(glm::length(got.rotations[i]))));
        }
        CHECK(worst < 2e-4);
        // What stays is equal to the bit, beside what moves.
        const Scene first = unpacked(a, traits);
        std::size_t others = 0;
        for (std::size_t i = 0; i < got.size(); ++i) {
            const bool stays = from.positions[i] == to.positions[i] && i % 3 != 0 && i != 7;
            others += stays && (got.positions[i] != from.positions[i] || got.scales[i] != from.scales[i] ||
                                got.opacities[i] != from.opacities[i] || got.rotations[i] != first.rotations[i])
                          ? 1u
                          : 0u;
        }
        CHECK(others == 0);
        // What the device culls by holds all of it.
        for (std::size_t p = 0; p < mixed.size(); ++p) {
            if (mixed[p] == a[p]) { continue; }
            for (std::size_t i = p * gpu::kPageSplats; i < p * gpu::kPageSplats + mixed[p]->splats; ++i) {
                if (got.opacities[i] < gpu::kMinAlpha) { continue; }
                const glm::dvec3 half = halfExtentOf(got.rotations[i], {got.scales[i], 0.0f}, got.opacities[i]), c(got.positions[i]);
                REQUIRE(holds({mixed[p]->bounds.low, mixed[p]->bounds.high, 1.0f}, c - half, c + half));
            }
        }
    }
}

TEST_CASE("splats in another order, or of another number, do not correspond") {
    const Scene from = slidingAtelier(0), to = slidingAtelier(4);
    const SceneTraits traits = traitsOf(from);
    const SceneFrame a = makeSceneFrame(from, traits), b = makeSceneFrame(to, traits);
    CHECK(correspond(a, b, traits));
    CHECK(correspond(a, a, traits));
    std::vector<std::size_t> order(to.size());
    std::iota(order.begin(), order.end(), 0u);
    std::mt19937 random(1);
    std::shuffle(order.begin(), order.end(), random);
    Scene shuffled = to;
    for (std::size_t i = 0; i < order.size(); ++i) { shuffled.positions[i] = to.positions[order[i]]; }
    CHECK_FALSE(correspond(a, makeSceneFrame(shuffled, traits), traits));
    Scene fewer = to;
    keepWithin(fewer, glm::dvec3(0.0), 3.0);
    CHECK_FALSE(correspond(a, makeSceneFrame(fewer, traits), traits));
    CHECK_FALSE(correspond({}, {}, traits));
}

}  // namespace scene_frames_test
