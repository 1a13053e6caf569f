// components: connected holes and the tiles of their boxes (paper, section 3.5, step 2), by flood fill.
#include "engine/twin/splat.h"
#include "engine/twin/stereo.h"

#include <algorithm>

namespace binosplat::reference {
namespace {

// Pixels [low, high).
struct Box {
    glm::ivec2 low, high;
};

void markBox(const Box& box, std::vector<TileKind>& kinds, const glm::ivec2& size, int margin_px) {
    const glm::ivec2 low = glm::max(box.low - margin_px, glm::ivec2(0)),
                     high = glm::min(box.high + margin_px, size);
    const int columns = (size.x + kTileSize - 1) / kTileSize;
    for (int y = low.y / kTileSize; y * kTileSize < high.y; ++y) {
        for (int x = low.x / kTileSize; x * kTileSize < high.x; ++x) {
            TileKind& kind = kinds[static_cast<std::size_t>(y * columns + x)];
            if (kind == TileKind::kNone) { kind = TileKind::kCenter; }
        }
    }
}

// Removes from `open` the pixels that can be reached from `first` over touching pixels, including corners.
Box floodFill(std::vector<std::uint8_t>& open, const glm::ivec2& size, const glm::ivec2& first) {
    const auto indexOf = [&](const glm::ivec2& at) { return static_cast<std::size_t>(at.y * size.x + at.x); };
    Box box{first, first + 1};
    std::vector<glm::ivec2> rest{first};
    open[indexOf(first)] = 0;
    while (!rest.empty()) {
        const glm::ivec2 at = rest.back();
        rest.pop_back();
        box = {glm::min(box.low, at), glm::max(box.high, at + 1)};
        for (int n = 0; n < 9; ++n) {
            const glm::ivec2 next = at + glm::ivec2(n % 3 - 1, n / 3 - 1);
            if (next.x < 0 || next.y < 0 || next.x >= size.x || next.y >= size.y ||
                open[indexOf(next)] == 0) {
                continue;
            }
            open[indexOf(next)] = 0;
            rest.push_back(next);
        }
    }
    return box;
}

}  // namespace

std::size_t markComponents(std::span<const Resolved> resolved, std::vector<TileKind>& kinds,
                           glm::uvec2 size_px, int margin_px, std::size_t most_boxes) {
    const glm::ivec2 size(size_px);
    const int columns = (size.x + kTileSize - 1) / kTileSize;
    std::vector<std::uint8_t> open(resolved.size(), 0);
    std::vector<Box> pixels, boxes;
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const auto i = static_cast<std::size_t>(y * size.x + x);
            if (resolved[i].pixel_class != PixelClass::kHole ||
                kinds[static_cast<std::size_t>(y / kTileSize * columns + x / kTileSize)] != TileKind::kNone) {
                continue;
            }
            open[i] = 1;
            pixels.push_back({{x, y}, {x + 1, y + 1}});
        }
    }
    for (const Box& pixel : pixels) {
        if (open[static_cast<std::size_t>(pixel.low.y * size.x + pixel.low.x)] != 0) {
            boxes.push_back(floodFill(open, size, pixel.low));
        }
    }
    for (const Box& box : boxes.size() <= most_boxes ? boxes : pixels) {
        markBox(box, kinds, size, margin_px);
    }
    return boxes.size();
}

}  // namespace binosplat::reference
