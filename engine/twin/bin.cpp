// Twin of bin: finds the tiles in which a splat reaches a pixel centre.
#include "engine/parallel.h"
#include "engine/twin/reach.h"

namespace binosplat::reference {
namespace {

constexpr std::size_t kBlock = 2048;

// Marks the tiles that a row's run of pixels touches, after trimming the ends that `meet` denies.
void markRun(const RayPlane& plane, int y, Span run, std::vector<std::uint8_t>& marks) {
    const auto meets = [&](int x) {
        Hit hit;
        return meet(plane, {x + 0.5, y + 0.5}, hit);
    };
    while (run.begin < run.end && !meets(run.begin)) { ++run.begin; }
    while (run.begin < run.end && !meets(run.end - 1)) { --run.end; }
    if (run.begin >= run.end) { return; }
    for (int tile = run.begin / kTileSize; tile <= (run.end - 1) / kTileSize; ++tile) { marks[tile] = 1; }
}

// Appends the pairs of one splat, in ascending order of tiles. `marks` has a zero for each column of tiles,
// and is left that way.
void binOne(const ProjectedSplat& splat, std::uint32_t rank, glm::uvec2 size_px, double near,
            std::vector<std::uint8_t>& marks, std::vector<TilePair>& pairs) {
    const glm::ivec4 box = splat.box_px;
    if (box.x >= box.z || box.y >= box.w) { return; }
    const RayPlane plane = rayPlane(splat, size_px, near);
    const std::uint32_t columns = tileGrid(size_px).x;
    for (int tile_y = box.y / kTileSize; tile_y * kTileSize < box.w; ++tile_y) {
        const int last_row = std::min(box.w, (tile_y + 1) * kTileSize);
        for (int y = std::max(box.y, tile_y * kTileSize); y < last_row; ++y) {
            for (const Span& run : runsOfReach(plane, y, box.x, box.z)) { markRun(plane, y, run, marks); }
        }
        for (int tile_x = box.x / kTileSize; tile_x * kTileSize < box.z; ++tile_x) {
            if (std::exchange(marks[tile_x], std::uint8_t{0}) != 0) {
                pairs.push_back(
                    {static_cast<std::uint32_t>(tile_y) * columns + static_cast<std::uint32_t>(tile_x),
                     rank});
            }
        }
    }
}

}  // namespace

std::vector<TilePair> bin(std::span<const ProjectedSplat> splats, glm::uvec2 size_px,
                          const Settings& settings) {
    std::vector<std::vector<TilePair>> parts((splats.size() + kBlock - 1) / kBlock);
    forBlocks(splats.size(), kBlock, settings.threads, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint8_t> marks(tileGrid(size_px).x, 0);
        for (std::size_t i = begin; i < end; ++i) {
            binOne(splats[i], static_cast<std::uint32_t>(i), size_px, settings.near, marks,
                   parts[begin / kBlock]);
        }
    });
    std::size_t count = 0;
    for (const auto& part : parts) { count += part.size(); }
    std::vector<TilePair> pairs;
    pairs.reserve(count);
    for (auto& part : parts) {
        pairs.insert(pairs.end(), part.begin(), part.end());
        part = {};
    }
    return pairs;
}

void hidePairs(std::vector<TilePair>& pairs, std::span<const std::uint8_t> hidden) {
    if (hidden.empty()) { return; }
    std::erase_if(pairs, [&](const TilePair& pair) { return hidden[pair.tile] != 0; });
}

}  // namespace binosplat::reference
