// Facts about what a scene changes while pictures are made from their pasts: where it is seen, and that the tiles there are found.
#include "engine/frame/changes.h"
#include "tests/engine/passes/past_stages.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>

TEST_SUITE_BEGIN("changes");

namespace changes_test {

using namespace binosplat;
using test::Gpu;

namespace {

// Boxes about an eye: before it, around it, beside it and behind it, from a speck to a hall.
std::vector<SceneChange> boxesAbout(const Eye& eye, int count, unsigned seed) {
    std::mt19937 random(seed);
    const auto draw = [&](double low, double high) { return low + (high - low) * static_cast<double>(random() >> 8) / 16777216.0; };
    std::vector<SceneChange> boxes;
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 middle = eye.world_from_camera.position + glm::dvec3(draw(-3, 3), draw(-3, 3), draw(-3, 3));
        const glm::dvec3 half = std::pow(10.0, draw(-3.0, 0.5)) * glm::dvec3(draw(0, 1), draw(0, 1), draw(0, 1));
        boxes.push_back({glm::vec3(middle - half), glm::vec3(middle + half), static_cast<float>(draw(0.01, 1.0))});
    }
    return boxes;
}

}  // namespace

TEST_CASE("what lies in a box is seen in its rectangle, also where the box reaches through the near plane") {
    const Eye eye = test::makeOddEye({200, 150});
    const glm::dmat3 camera_from_world = glm::mat3_cast(glm::conjugate(eye.world_from_camera.orientation));
    std::mt19937 random(11);
    const auto draw = [&] { return static_cast<double>(random() >> 8) / 16777216.0; };
    std::size_t seen = 0, unseen_boxes = 0, through = 0;
    for (const SceneChange& box : boxesAbout(eye, 400, 1)) {
        const std::vector<gpu::ChangedRect> rects = rectsOf({&box, 1}, eye, 0.2);
        if (rects.empty()) { ++unseen_boxes; }
        if (!rects.empty()) { CHECK(rects[0].error == gpu::kChangedError * box.amount); }
        bool is_before = false, is_behind = false;
        for (int i = 0; i < 200; ++i) {
            const glm::dvec3 at = glm::mix(glm::dvec3(box.low), glm::dvec3(box.high), glm::dvec3(draw(), draw(), draw()));
            const glm::dvec3 c = camera_from_world * (at - eye.world_from_camera.position);
            (c.z < 0.2 ? is_behind : is_before) = true;
            if (c.z < 0.2) { continue; }
            const glm::dvec2 place(eye.intrinsics.fx * c.x / c.z + eye.intrinsics.cx, eye.intrinsics.fy * c.y / c.z + eye.intrinsics.cy);
            if (place.x < 0.0 || place.y < 0.0 || place.x >= 200.0 || place.y >= 150.0) { continue; }
            REQUIRE(rects.size() == 1);
            REQUIRE(glm::all(glm::lessThanEqual(glm::dvec2(rects[0].begin_px), place)));
            REQUIRE(glm::all(glm::greaterThanEqual(glm::dvec2(rects[0].end_px), place)));
            ++seen;
        }
        through += is_before && is_behind ? 1 : 0;
    }
    CHECK(seen > 1000);
    CHECK(unseen_boxes > 100);
    CHECK(through > 20);
}

TEST_CASE("a box before the eye has a rectangle of its own size and the low-pass, one beside it or behind it has none") {
    const Eye eye = test::makeEye({101, 101});
    const auto rectOf = [&](const glm::vec3& low, const glm::vec3& high) {
        const SceneChange box{low, high, 1.0f};
        return rectsOf({&box, 1}, eye, 0.2);
    };
    // 100 px of focal length about (50.5, 50.5).
    const auto rects = rectOf({-0.2f, 0.1f, 2.0f}, {0.1f, 0.2f, 2.0f});
    REQUIRE(rects.size() == 1);
    CHECK(rects[0].begin_px == glm::uvec2(37, 52));
    CHECK(rects[0].end_px == glm::uvec2(59, 64));
    CHECK(rectOf({2.0f, 0.0f, 2.0f}, {3.0f, 1.0f, 2.0f}).empty());
    CHECK(rectOf({-1.0f, -1.0f, -3.0f}, {1.0f, 1.0f, 0.1f}).empty());
}

TEST_CASE("more changes than a picture takes are joined, and none is lost") {
    const Eye eye = test::makeEye({256, 256});
    std::vector<SceneChange> boxes;
    for (int i = 0; i < 1000; ++i) {
        const float x = -2.0f + 0.004f * static_cast<float>(i);
        boxes.push_back({{x, -0.1f, 2.0f}, {x + 0.001f, 0.1f, 2.0f}, i % 7 == 0 ? 1.0f : 0.5f});
    }
    const auto rects = rectsOf(boxes, eye, 0.2);
    CHECK(rects.size() <= kMostChanges);
    for (const SceneChange& box : boxes) {
        const auto alone = rectsOf({&box, 1}, eye, 0.2);
        if (alone.empty()) { continue; }
        CHECK(std::ranges::any_of(rects, [&](const gpu::ChangedRect& rect) {
            return glm::all(glm::lessThanEqual(rect.begin_px, alone[0].begin_px)) &&
                   glm::all(glm::greaterThanEqual(rect.end_px, alone[0].end_px)) && rect.error >= alone[0].error;
        }));
    }
}

TEST_CASE_FIXTURE(Gpu, "mark_changed gives the twin's errors") {
    for (const glm::uvec2 size_px : {glm::uvec2(16, 16), glm::uvec2(200, 150), glm::uvec2(333, 47)}) {
        Eye eye = test::makeOddEye(size_px);
        std::mt19937 random(2);
        const glm::uvec2 size_tiles = tilesOf(size_px);
        std::vector<gpu::PastTile> tiles(std::size_t{size_tiles.x} * size_tiles.y);
        std::vector<reference::PastTile> twin;
        for (gpu::PastTile& tile : tiles) {
            tile = {.cost = static_cast<gpu::uint>(random() % 100),
                    .age = static_cast<gpu::uint>(random() % 10),
                    .growth = 0.25f,
                    .errors = {},
                    .grown = {}};
            for (int q = 0; q < 4; ++q) { tile.errors[q] = static_cast<float>(random() % 512) / 2048.0f; }
            twin.push_back(test::tileOf(tile));
        }
        const std::vector<gpu::ChangedRect> rects = rectsOf(boxesAbout(eye, 60, 3), eye, 0.2);
        REQUIRE(rects.size() >= 3);
        std::vector<reference::ChangedRect> twin_rects;
        for (const gpu::ChangedRect& rect : rects) { twin_rects.push_back({rect.begin_px, rect.end_px, static_cast<double>(rect.error)}); }
        reference::markChanged(twin, size_px, twin_rects);
        const Buffer tile_buffer = upload("tiles", tiles), rect_buffer = upload("rects", rects);
        const gpu::MarkChangedPass pass{.tiles = tile_buffer.address<gpu::PastTile>(),
                                        .rects = rect_buffer.address<gpu::ChangedRect>(),
                                        .size_tiles = size_tiles,
                                        .count = static_cast<gpu::uint>(rects.size())};
        const Kernel& kernel = this->kernel(MarkChangedKernel{});
        run([&](Commands& commands) { commands.dispatchOver(kernel, pass, tiles.size(), gpu::kWarpGroup); });
        const auto marked = readBack<gpu::PastTile>(tile_buffer, tiles.size());
        std::size_t changed = 0;
        for (std::size_t t = 0; t < tiles.size(); ++t) {
            CHECK(marked[t].cost == tiles[t].cost);
            CHECK(marked[t].age == tiles[t].age);
            for (int q = 0; q < 4; ++q) {
                REQUIRE(std::abs(static_cast<double>(marked[t].errors[q]) - twin[t].errors[static_cast<std::size_t>(q)]) < 1e-5);
                changed += marked[t].errors[q] != tiles[t].errors[q] ? 1 : 0;
            }
        }
        CHECK(changed > 0);
    }
}

}  // namespace changes_test
