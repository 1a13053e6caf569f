// Facts about the tiles that a headset's lens never shows.
#include "xr/hidden_tiles.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

using namespace binosplat;
using xr::findHiddenTiles;
using xr::HiddenMesh;

namespace {

// A picture of 48 x 40 pixels, three tiles by three (the last row half), that spans -1.5 to 1.5 by -1 to 1.5 in the plane.
constexpr glm::uvec2 kSizePx(48, 40);
const Intrinsics kIntrinsics{16.0, 16.0, 24.0, 24.0};

HiddenMesh rectangle(float left, float right, float bottom, float top) {
    return {{{left, bottom}, {right, bottom}, {right, top}, {left, top}}, {0, 1, 2, 0, 2, 3}};
}

using Tiles = std::vector<std::uint8_t>;

}  // namespace

TEST_CASE("without a mesh nothing is hidden") { CHECK(findHiddenTiles({}, kIntrinsics, kSizePx) == Tiles(9, 0)); }

TEST_CASE("a tile is hidden if all of it is, and up is up") {
    // The upper left tile exactly: x from -1.5 to -0.5, y from 0.5 to 1.5.
    CHECK(findHiddenTiles(rectangle(-1.5f, -0.5f, 0.5f, 1.5f), kIntrinsics, kSizePx) == Tiles{1, 0, 0, 0, 0, 0, 0, 0, 0});
    // A pixel less.
    CHECK(findHiddenTiles(rectangle(-1.5f, -0.57f, 0.5f, 1.5f), kIntrinsics, kSizePx) == Tiles(9, 0));
    // The lowest row, of half tiles, and more than the picture.
    CHECK(findHiddenTiles(rectangle(-9.0f, 9.0f, -9.0f, -0.5f), kIntrinsics, kSizePx) == Tiles{0, 0, 0, 0, 0, 0, 1, 1, 1});
}

TEST_CASE("a margin about what shows keeps whole tiles, and none beyond it") {
    // All but the middle tile's middle pixel, from four sides; five tiles by five.
    constexpr glm::uvec2 size(80, 80);
    const Intrinsics intrinsics{1.0, 1.0, 0.0, 0.0};
    HiddenMesh mesh;
    const auto add = [&](float left, float right, float top, float bottom) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), {{left, -top}, {right, -top}, {right, -bottom}, {left, -bottom}});
        for (const std::uint32_t corner : {0, 1, 2, 0, 2, 3}) { mesh.indices.push_back(first + corner); }
    };
    add(0.0f, 80.0f, 0.0f, 40.0f);
    add(0.0f, 80.0f, 41.0f, 80.0f);
    add(0.0f, 40.0f, 40.0f, 41.0f);
    add(41.0f, 80.0f, 40.0f, 41.0f);
    const auto shown = [&](std::uint32_t margin_px) {
        const Tiles tiles = findHiddenTiles(mesh, intrinsics, size, margin_px);
        return std::count(tiles.begin(), tiles.end(), 0);
    };
    CHECK(shown(0) == 1);
    CHECK(shown(7) == 1);  // 33 to 47
    CHECK(shown(8) == 4);  // to 48, in the next tile
    CHECK(shown(9) == 9);
    CHECK(shown(24) == 16);
    CHECK(shown(1000) == 25);
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

TEST_CASE("broken meshes hide nothing") {
    HiddenMesh mesh = rectangle(-9.0f, 9.0f, -9.0f, 9.0f);
    mesh.indices = {0, 1, 7, 2};
    CHECK(findHiddenTiles(mesh, kIntrinsics, kSizePx) == Tiles(9, 0));
    mesh = {{{std::numeric_limits<float>::quiet_NaN(), 0.0f}, {9.0f, -9.0f}, {9.0f, 9.0f}}, {0, 1, 2}};
    CHECK(findHiddenTiles(mesh, kIntrinsics, kSizePx) == Tiles(9, 0));
    mesh = {{{-9.0f, -9.0f}, {0.0f, 0.0f}, {9.0f, 9.0f}}, {0, 1, 2}};  // no area
    CHECK(findHiddenTiles(mesh, kIntrinsics, kSizePx) == Tiles(9, 0));
}
