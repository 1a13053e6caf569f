// Facts about the tiles that a headset's lens never shows.
#include "xr/hidden_tiles.h"
#include "app/view/headset/lens_mask.h"
#include "tests/suite.h"

#include <mutex>
#include <thread>

SUITE(hidden_tiles) {

using xr::findHiddenTiles;
using xr::HiddenMesh;

// A picture of 48 x 40 pixels, three tiles by three (the last row half), that spans -1.5 to 1.5 by -1 to 1.5
// in the plane.
constexpr glm::uvec2 kSizePx(48, 40);
const Intrinsics kIntrinsics{16.0, 16.0, 24.0, 24.0};

HiddenMesh rectangle(float left, float right, float bottom, float top) {
    return {{{left, bottom}, {right, bottom}, {right, top}, {left, top}}, {0, 1, 2, 0, 2, 3}};
}

using Tiles = std::vector<std::uint8_t>;

// A view of both eyes in which a rectangle of the plane hides what lies to its left, and the mask for the
// left eye.
struct MaskedView {
    std::array<HiddenMesh, 2> meshes;
    std::array<xr::EyeView, 2> views{};

    MaskedView(float hidden_to, float left_rad) {
        for (std::size_t e = 0; e < 2; ++e) {
            meshes[e] = rectangle(-9.0f, hidden_to, -9.0f, 9.0f);
            views[e].fov = {left_rad, 0.7f, 0.7f, -0.7f};
        }
    }
    Tiles now(LensMask& mask, int version, glm::uvec2 size_px = {64, 64},
              std::vector<glm::uvec2> others = {}) const {
        const std::span<const std::uint8_t> tiles = mask.update(meshes, version, views, size_px, others)[0];
        return {tiles.begin(), tiles.end()};
    }
    // Once all is known.
    Tiles hidden(LensMask& mask, int version, glm::uvec2 size_px = {64, 64}) const {
        static_cast<void>(now(mask, version, size_px));
        mask.finish();
        return now(mask, version, size_px);
    }
    // As it will be.
    [[nodiscard]] Tiles hidden(glm::uvec2 size_px = {64, 64}) const {
        return findHidden({meshes, {views[0].fov, views[1].fov}}, size_px)[0];
    }
};

// The last value before the mask changes, to within 1e-5.
template <typename Make>
float lastBeforeChange(float from, const Make& make) {
    constexpr float kStep = 1e-5f;
    const Tiles first = make(from);
    float value = from;
    while (make(value + kStep) == first && value < from + 0.2f) { value += kStep; }
    REQUIRE(value < from + 0.2f);
    return value;
}

TEST_CASE("a tile is hidden if all of it is, and up is up") {
    // Exactly the upper left tile: x from -1.5 to -0.5, y from 0.5 to 1.5.
    CHECK(findHiddenTiles(rectangle(-1.5f, -0.5f, 0.5f, 1.5f), kIntrinsics, kSizePx) ==
          Tiles{1, 0, 0, 0, 0, 0, 0, 0, 0});
    // One pixel less.
    CHECK(findHiddenTiles(rectangle(-1.5f, -0.57f, 0.5f, 1.5f), kIntrinsics, kSizePx) == Tiles(9, 0));
    // The bottom row of half tiles, and more than the picture.
    CHECK(findHiddenTiles(rectangle(-9.0f, 9.0f, -9.0f, -0.5f), kIntrinsics, kSizePx) ==
          Tiles{0, 0, 0, 0, 0, 0, 1, 1, 1});
}

TEST_CASE("a margin about what shows keeps whole tiles, and none beyond it") {
    // Everything but the middle pixel of the middle tile, from four sides; five tiles by five.
    constexpr glm::uvec2 size(80, 80);
    const Intrinsics intrinsics{1.0, 1.0, 0.0, 0.0};
    HiddenMesh mesh;
    for (const HiddenMesh& side :
         {rectangle(0.0f, 80.0f, -40.0f, 0.0f), rectangle(0.0f, 80.0f, -80.0f, -41.0f),
          rectangle(0.0f, 40.0f, -41.0f, -40.0f), rectangle(41.0f, 80.0f, -41.0f, -40.0f)}) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), side.vertices.begin(), side.vertices.end());
        for (const std::uint32_t corner : side.indices) { mesh.indices.push_back(first + corner); }
    }
    // With 7: 33 to 47. With 8: up to 48, in the next tile.
    for (const auto& [margin_px, shown] :
         {std::pair(0u, 1), {7u, 1}, {8u, 4}, {9u, 9}, {24u, 16}, {1000u, 25}}) {
        CHECK(std::ranges::count(findHiddenTiles(mesh, intrinsics, size, margin_px), 0) == shown);
    }
    CHECK(xr::hiddenMarginPx({1000.0, 800.0, 0.0, 0.0}) == 18);
}

TEST_CASE("triangles may turn either way and meet within a tile") {
    HiddenMesh mesh = rectangle(-0.5f, 0.5f, -0.5f, 0.5f);
    CHECK(findHiddenTiles(mesh, kIntrinsics, kSizePx) == Tiles{0, 0, 0, 0, 1, 0, 0, 0, 0});
    mesh.indices = {0, 2, 1, 0, 3, 2};
    CHECK(findHiddenTiles(mesh, kIntrinsics, kSizePx) == Tiles{0, 0, 0, 0, 1, 0, 0, 0, 0});
    mesh.indices = {0, 1, 2};  // half of it
    CHECK(findHiddenTiles(mesh, kIntrinsics, kSizePx) == Tiles(9, 0));
}

TEST_CASE("no mesh, and broken ones, hide nothing") {
    HiddenMesh out_of_range = rectangle(-9.0f, 9.0f, -9.0f, 9.0f);
    out_of_range.indices = {0, 1, 7, 2};
    const HiddenMesh not_a_number{
        {{std::numeric_limits<float>::quiet_NaN(), 0.0f}, {9.0f, -9.0f}, {9.0f, 9.0f}}, {0, 1, 2}};
    const HiddenMesh flat{{{-9.0f, -9.0f}, {0.0f, 0.0f}, {9.0f, 9.0f}}, {0, 1, 2}};
    for (const HiddenMesh& mesh : {HiddenMesh{}, out_of_range, not_a_number, flat}) {
        CHECK(findHiddenTiles(mesh, kIntrinsics, kSizePx) == Tiles(9, 0));
    }
}

TEST_CASE("angles and meshes that shiver make no mask anew, others do") {
    // Where a tremor would show: with the slightest change, another column of tiles is hidden or shown.
    const auto check = [](float from, bool is_announced, const auto& viewOf) {
        const auto tilesAt = [&](float value) { return viewOf(value).hidden(); };
        const float edge = lastBeforeChange(from, tilesAt);
        CHECK(tilesAt(edge + 5e-5f) != tilesAt(edge));
        LensMask mask;
        const Tiles first = viewOf(edge).hidden(mask, 1);
        CHECK(viewOf(edge + 5e-5f).hidden(mask, is_announced ? 2 : 1) == first);
        CHECK(viewOf(edge + 5e-4f).hidden(mask, is_announced ? 3 : 1) == tilesAt(edge + 5e-4f));
    };
    check(-0.6f, true, [](float edge) { return MaskedView(edge, -0.7f); });
    check(-0.8f, false, [](float left_rad) { return MaskedView(-0.4f, left_rad); });
}

TEST_CASE("masks are found on a thread, each once, and until then hide no more than they will") {
    const std::thread::id here = std::this_thread::get_id();
    std::mutex mutex;
    std::string found;
    LensMask mask([&](const LensShape& lens, glm::uvec2 size_px) {
        const std::lock_guard lock(mutex);
        found += fmt::format("{}{} ", size_px.x, std::this_thread::get_id() == here ? " here" : "");
        return findHidden(lens, size_px);
    });
    const MaskedView view(-0.2f, -0.7f);
    const glm::uvec2 large(256, 256), small(112, 112);
    // Nothing is known, and nothing hidden; but there is a mask, whose coming frames would wait for.
    CHECK(view.now(mask, 1, large, {large, small}) == Tiles(256, 0));
    CHECK_FALSE(mask.knows(large));
    mask.finish();
    for (int steps = 0; steps < 3; ++steps) {
        CHECK(view.now(mask, 1, small, {large, small}) == view.hidden(small));
        CHECK(view.now(mask, 1, large, {large, small}) == view.hidden(large));
    }
    CHECK(mask.knows(large));
    const glm::uvec2 next(176, 176);
    const Tiles meanwhile = view.now(mask, 1, next), exact = view.hidden(next);
    CHECK(std::ranges::count(meanwhile, 1) > 0);
    REQUIRE(meanwhile.size() == exact.size());
    CHECK(std::ranges::equal(meanwhile, exact, std::less_equal<>()));
    mask.finish();
    CHECK(view.now(mask, 1, next) == exact);
    // Other angles: what comes of the old ones is dropped.
    CHECK(MaskedView(-0.2f, -0.75f).now(mask, 1, {320, 320}) == Tiles(400, 0));
    const MaskedView turned(-0.2f, -0.8f);
    CHECK(turned.now(mask, 1, next) == Tiles(121, 0));
    mask.finish();
    CHECK(turned.now(mask, 1, next) == Tiles(121, 0));
    CHECK(turned.hidden(mask, 1, next) == turned.hidden(next));
    CHECK(found == "256 112 176 320 176 ");
    for (unsigned px = 200; px < 260; ++px) {  // a slider that is dragged
        CHECK(turned.hidden(mask, 1, {px, px}) == turned.hidden({px, px}));
    }
}

}  // SUITE(hidden_tiles)
