// resample: colours of the target, read from the source's picture where each pixel came from.
#include "engine/twin/eye_change.h"
#include "engine/twin/splat.h"

#include <algorithm>

namespace binosplat::reference {
namespace {

// Catmull and Rom's kernel: the cubic through samples at whole distances, whose slope there is that of the
// neighbours' chord.
double kernel(double distance) {
    const double d = std::abs(distance);
    if (d < 1.0) { return 1.0 + d * d * (1.5 * d - 2.5); }
    return d < 2.0 ? 2.0 + d * (-4.0 + d * (2.5 - 0.5 * d)) : 0.0;
}

glm::dvec4 sample(const Picture& picture, const glm::dvec2& place_px) {
    const glm::ivec2 size(picture.size_px);
    // Samples lie at pixel centres; the border repeats outwards.
    const glm::dvec2 at = glm::clamp(place_px, glm::dvec2(0.5), glm::dvec2(size) - 0.5) - 0.5;
    const glm::ivec2 base(glm::floor(at));
    glm::dvec4 sum(0.0);
    for (int y = base.y - 1; y <= base.y + 2; ++y) {
        for (int x = base.x - 1; x <= base.x + 2; ++x) {
            const int index = std::clamp(y, 0, size.y - 1) * size.x + std::clamp(x, 0, size.x - 1);
            sum += kernel(at.x - x) * kernel(at.y - y) * picture.rgba[static_cast<std::size_t>(index)];
        }
    }
    return glm::max(sum, glm::dvec4(0.0));
}

}  // namespace

std::vector<glm::dvec4> resample(const Picture& dominant, std::span<const Resolved> resolved,
                                 std::span<const TileKind> kinds, const EyePair& eyes,
                                 const glm::dvec3& background) {
    const EyeChange source_from_target(eyes.source, eyes.target);
    const std::size_t width = dominant.size_px.x, columns = tileGrid(dominant.size_px).x;
    std::vector<glm::dvec4> colours(resolved.size(), glm::dvec4(0.0));
    for (std::size_t i = 0; i < resolved.size(); ++i) {
        const std::size_t x = i % width, y = i / width;
        const TileKind kind = kinds[y / kTileSize * columns + x / kTileSize];
        if (kind == TileKind::kHidden) { colours[i] = glm::dvec4(background, 0.0); }
        if (kind != TileKind::kNone) { continue; }
        const glm::dvec2 pixel_px(resolved[i].column + 0.5,
                                  static_cast<double>(y - resolved[i].rows_up) + 0.5);
        colours[i] = sample(dominant, source_from_target.move(pixel_px, resolved[i].inverse_depth).place_px);
    }
    return colours;
}

std::vector<glm::dvec4> copyColours(const Picture& dominant, std::span<const Arrival> arrivals,
                                    std::span<const TileKind> kinds, const EyePair& eyes,
                                    const glm::dvec3& background) {
    const EyeChange source_from_target(eyes.source, eyes.target);
    const std::size_t width = dominant.size_px.x, columns = tileGrid(dominant.size_px).x;
    const auto arrived = [&](std::size_t i) { return arrivals[i].way != Arrival::kNone; };
    std::vector<glm::dvec4> colours(arrivals.size(), glm::dvec4(0.0));
    for (std::size_t i = 0; i < arrivals.size(); ++i) {
        const std::size_t x = i % width, y = i / width, begin = y * width, end = begin + width;
        const TileKind kind = kinds[y / kTileSize * columns + x / kTileSize];
        if (kind == TileKind::kHidden) { colours[i] = glm::dvec4(background, 0.0); }
        if (kind != TileKind::kNone) { continue; }
        // One beyond the nearest at or before the pixel, and the nearest at or after it.
        std::size_t history_left = i + 1, right = i;
        while (history_left > begin && !arrived(history_left - 1)) { --history_left; }
        while (right < end && !arrived(right)) { ++right; }
        if (history_left == begin && right == end) {
            const glm::dvec2 place = source_from_target.move(glm::dvec2(x, y) + 0.5, 0.0).place_px;
            const glm::dvec2 inside = glm::clamp(place, glm::dvec2(0.5), glm::dvec2(dominant.size_px) - 0.5);
            colours[i] =
                dominant
                    .rgba[static_cast<std::size_t>(inside.y) * width + static_cast<std::size_t>(inside.x)];
            continue;
        }
        const std::size_t first = history_left > begin ? history_left - 1 : right,
                          last = right < end ? right : first;
        const double share =
            first == last ? 0.0 : static_cast<double>(i - first) / static_cast<double>(last - first);
        colours[i] = (1.0 - share) * dominant.rgba[arrivals[first].source] +
                     share * dominant.rgba[arrivals[last].source];
    }
    return colours;
}

std::vector<double> resampleDepths(std::span<const glm::dvec4> colours, std::span<const Resolved> resolved,
                                   std::span<const TileKind> kinds, glm::uvec2 size_px) {
    const std::size_t width = size_px.x, columns = tileGrid(size_px).x;
    std::vector<double> depths(resolved.size(), 0.0);
    for (std::size_t i = 0; i < resolved.size(); ++i) {
        const bool made = kinds[i / width / kTileSize * columns + i % width / kTileSize] == TileKind::kNone;
        if (made && resolved[i].inverse_depth > 0.0) { depths[i] = colours[i].a / resolved[i].inverse_depth; }
    }
    return depths;
}

void averageRows(std::vector<glm::dvec4>& colours, std::vector<double>& depths,
                 std::vector<Resolved>& resolved, std::span<const TileKind> kinds,
                 std::span<const double> seen_shares, glm::uvec2 size_px) {
    const std::size_t width = size_px.x, columns = tileGrid(size_px).x;
    for (std::size_t y = 1; y + 1 < size_px.y; y += 2) {
        if ((y + 1) % kTileSize == 0) { continue; }
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t tile = y / kTileSize * columns + x / kTileSize, i = y * width + x;
            if (kinds[tile] != TileKind::kNone || seen_shares[tile] > 0.25) { continue; }
            colours[i] = 0.5 * (colours[i - width] + colours[i + width]);
            depths[i] = 0.5 * (depths[i - width] + depths[i + width]);
            resolved[i].pixel_class = resolved[i - width].pixel_class;
        }
    }
}

}  // namespace binosplat::reference
