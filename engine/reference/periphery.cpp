// periphery and fill_periphery.
#include "engine/reference/periphery.h"

#include "engine/reference/splat.h"

#include <algorithm>
#include <cmath>

namespace binosplat::reference {
namespace {

constexpr int kTile = static_cast<int>(kTileSize), kTileSamples = kTile / 2;
// The cubic reads two samples on either side, second differences one.
constexpr int kReach = 2;

glm::ivec2 gridOf(const Eye& eye) { return glm::ivec2(tileGrid(eye.size_px)); }

double angleTo(const Eye& eye, const Gaze& gaze, const glm::dvec2& place_px) {
    const Intrinsics& lens = eye.intrinsics;
    const glm::dvec3 ray((place_px.x - lens.cx) / lens.fx, (place_px.y - lens.cy) / lens.fy, 1.0);
    return std::acos(std::clamp(glm::dot(glm::normalize(ray), glm::normalize(gaze.direction)), -1.0, 1.0));
}

bool isHidden(std::span<const std::uint8_t> hidden, std::size_t tile) { return !hidden.empty() && hidden[tile] != 0; }

// Catmull and Rom's kernel, by the distance from a sample.
double cubic(double distance) {
    const double d = std::abs(distance);
    if (d >= 2.0) { return 0.0; }
    return d < 1.0 ? 1.0 + d * d * (1.5 * d - 2.5) : 2.0 + d * (-4.0 + d * (2.5 - 0.5 * d));
}
double linear(double distance) { return std::max(0.0, 1.0 - std::abs(distance)); }

// The sum of kernel-weighted samples around a place, in samples; at the borders the outermost ones go on.
template <typename Value, typename Kernel>
Value sampleAt(std::span<const Value> samples, glm::ivec2 size, const glm::dvec2& place, const Kernel& kernel) {
    Value sum(0.0);
    const glm::ivec2 first = glm::ivec2(glm::floor(place - 0.5)) - 1;
    for (int y = first.y; y < first.y + 4; ++y) {
        for (int x = first.x; x < first.x + 4; ++x) {
            const int column = std::clamp(x, 0, size.x - 1), row = std::clamp(y, 0, size.y - 1);
            const double weight = kernel(place.x - (x + 0.5)) * kernel(place.y - (y + 0.5));
            sum += weight * samples[static_cast<std::size_t>(row * size.x + column)];
        }
    }
    return sum;
}

}  // namespace

Eye halfOf(const Eye& eye) {
    Eye half = eye;
    half.size_px = {eye.size_px.x / 2 + eye.size_px.x % 2, eye.size_px.y / 2 + eye.size_px.y % 2};
    half.own_pixel_px = eye.own_pixel_px / 2;
    half.intrinsics = {eye.intrinsics.fx / 2, eye.intrinsics.fy / 2, eye.intrinsics.cx / 2, eye.intrinsics.cy / 2};
    return half;
}

double seenShare(double pixel_sr, double angle_rad, double clear_rad) {
    const double finest_rad = glm::radians(1.0 / 48.0) + 0.022 * std::max(angle_rad - clear_rad, 0.0);
    return std::min(1.0, 2.0 * 2.0 * pixel_sr / (finest_rad * finest_rad));
}

std::vector<double> findSharesThere(const Eye& eye, const Gaze& gaze) {
    const glm::ivec2 tiles = gridOf(eye);
    const Intrinsics& lens = eye.intrinsics;
    std::vector<double> shares;
    for (int y = 0; y < tiles.y; ++y) {
        for (int x = 0; x < tiles.x; ++x) {
            const glm::dvec2 place_px = static_cast<double>(kTile) * (glm::dvec2(x, y) + 0.5);
            const double tan_x = (place_px.x - lens.cx) / lens.fx, tan_y = (place_px.y - lens.cy) / lens.fy;
            const double cosine = 1.0 / std::sqrt(1.0 + tan_x * tan_x + tan_y * tan_y);
            const double pixel_sr = cosine * cosine * cosine / (lens.fx * lens.fy);
            shares.push_back(seenShare(pixel_sr, angleTo(eye, gaze, place_px), gaze.clear_rad));
        }
    }
    return shares;
}

std::vector<std::uint8_t> findBeyond(const Eye& eye, const Gaze& gaze) {
    std::vector<std::uint8_t> beyond;
    for (const double share : findSharesThere(eye, gaze)) { beyond.push_back(share <= 0.25 ? 1 : 0); }
    return beyond;
}

std::vector<std::uint8_t> findHalfTiles(const Eye& eye, const Gaze& gaze, std::span<const std::uint8_t> hidden) {
    const std::vector<std::uint8_t> beyond = findBeyond(eye, gaze);
    const glm::ivec2 tiles = gridOf(eye), half_tiles = gridOf(halfOf(eye)), last(glm::ivec2(halfOf(eye).size_px) - 1);
    std::vector<std::uint8_t> needed(static_cast<std::size_t>(half_tiles.x) * static_cast<std::size_t>(half_tiles.y), 0);
    for (int tile = 0; tile < tiles.x * tiles.y; ++tile) {
        if (beyond[static_cast<std::size_t>(tile)] == 0 || isHidden(hidden, static_cast<std::size_t>(tile))) { continue; }
        const glm::ivec2 first = kTileSamples * glm::ivec2(tile % tiles.x, tile / tiles.x);
        const glm::ivec2 low = glm::max(first - kReach, glm::ivec2(0)) / kTile;
        const glm::ivec2 high = glm::min(first + kTileSamples - 1 + kReach, last) / kTile;
        for (int y = low.y; y <= high.y; ++y) {
            for (int x = low.x; x <= high.x; ++x) { needed[static_cast<std::size_t>(y * half_tiles.x + x)] = 1; }
        }
    }
    return needed;
}

std::vector<double> expectLosses(std::span<const glm::dvec4> half, const Eye& eye) {
    constexpr double kLoss = 0.3, kMost = 4.0;
    std::vector<double> losses;
    const glm::ivec2 tiles = gridOf(eye), size(halfOf(eye).size_px);
    const auto at = [&](int x, int y) {
        return glm::dvec3(half[static_cast<std::size_t>(std::clamp(y, 0, size.y - 1) * size.x + std::clamp(x, 0, size.x - 1))]);
    };
    for (int tile = 0; tile < tiles.x * tiles.y; ++tile) {
        double squares = 0.0;
        const glm::ivec2 first = kTileSamples * glm::ivec2(tile % tiles.x, tile / tiles.x);
        for (int y = first.y; y < std::min(first.y + kTileSamples, size.y); ++y) {
            for (int x = first.x; x < std::min(first.x + kTileSamples, size.x); ++x) {
                const glm::dvec3 across = at(x - 1, y) - 2.0 * at(x, y) + at(x + 1, y), down = at(x, y - 1) - 2.0 * at(x, y) + at(x, y + 1);
                squares += std::min(glm::dot(across, across) + glm::dot(down, down), kMost);
            }
        }
        losses.push_back(kLoss * squares);
    }
    return losses;
}

std::vector<double> expectSeenLosses(std::span<const glm::dvec4> half, const Eye& eye, const Gaze& gaze) {
    std::vector<double> losses = expectLosses(half, eye);
    const std::vector<double> shares = findSharesThere(eye, gaze);
    for (std::size_t t = 0; t < losses.size(); ++t) { losses[t] *= shares[t]; }
    return losses;
}

std::vector<std::uint8_t> findOwnTiles(std::span<const glm::dvec4> half, const Eye& eye, const Gaze& gaze,
                                       std::span<const std::uint8_t> hidden) {
    constexpr double kLeastSeen = 0.01 * 0.01 * kTile * kTile;
    const std::vector<std::uint8_t> beyond = findBeyond(eye, gaze);
    const std::vector<double> losses = expectSeenLosses(half, eye, gaze);
    std::vector<std::uint8_t> own;
    for (std::size_t t = 0; t < losses.size(); ++t) {
        own.push_back(!isHidden(hidden, t) && (beyond[t] == 0 || losses[t] >= kLeastSeen) ? 1 : 0);
    }
    return own;
}

void fillPeriphery(Picture& picture, const Picture& half, std::span<const std::uint8_t> own_tiles, std::span<const std::uint8_t> hidden,
                   const glm::dvec3& background) {
    const glm::ivec2 size(picture.size_px), half_size(half.size_px);
    const auto columns = static_cast<std::size_t>(tileGrid(picture.size_px).x);
    const std::span<const glm::dvec4> samples(half.rgba);
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const std::size_t i = static_cast<std::size_t>(y * size.x + x);
            const std::size_t tile = static_cast<std::size_t>(y / kTile) * columns + static_cast<std::size_t>(x / kTile);
            if (own_tiles[tile] != 0) { continue; }
            if (isHidden(hidden, tile)) {
                picture.rgba[i] = glm::dvec4(background, 0.0);
                picture.depth[i] = 0.0;
                continue;
            }
            const glm::dvec2 place = 0.5 * (glm::dvec2(x, y) + 0.5);
            glm::dvec4& pixel = picture.rgba[i];
            pixel = glm::max(sampleAt(samples, half_size, place, cubic), glm::dvec4(0.0));
            pixel.a = std::min(pixel.a, 1.0);
            const double alpha = sampleAt(samples, half_size, place, linear).a;
            const double depth = sampleAt(std::span<const double>(half.depth), half_size, place, linear);
            picture.depth[i] = alpha > 0.0 ? pixel.a * depth / alpha : 0.0;
        }
    }
}

void fillPast(Past& picture, const Past& half, std::span<const double> losses, std::span<const std::uint8_t> own_tiles,
              std::span<const std::uint8_t> hidden) {
    constexpr double kOwnCost = 0.6;
    const glm::ivec2 tiles = gridOf(picture.eye), half_tiles = gridOf(half.eye), size(picture.eye.size_px);
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const auto tile = static_cast<std::size_t>(y / kTile * tiles.x + x / kTile);
            if (own_tiles[tile] != 0) { continue; }
            const auto sample = static_cast<std::size_t>(y / 2 * static_cast<int>(half.eye.size_px.x) + x / 2);
            picture.pixels[static_cast<std::size_t>(y * size.x + x)] = isHidden(hidden, tile) ? std::nullopt : half.pixels[sample];
        }
    }
    for (int tile = 0; tile < tiles.x * tiles.y; ++tile) {
        const auto t = static_cast<std::size_t>(tile);
        if (own_tiles[t] != 0) { continue; }
        picture.tiles[t] = {};
        if (isHidden(hidden, t)) { continue; }
        const int x = tile % tiles.x, y = tile / tiles.x;
        const PastTile& from = half.tiles[static_cast<std::size_t>(y / 2 * half_tiles.x + x / 2)];
        picture.tiles[t].cost = static_cast<std::uint64_t>(kOwnCost * static_cast<double>(from.cost));
        picture.tiles[t].errors.fill(std::sqrt(losses[t] / (3.0 * kTile * kTile)) +
                                     from.errors[static_cast<std::size_t>(2 * (y % 2) + x % 2)]);
    }
}

PeripheryPictures renderPeriphery(const Scene& scene, const Eye& eye, const Gaze& gaze, const Settings& settings,
                                  std::span<const std::uint8_t> hidden) {
    PeripheryPictures made{render(scene, eye, settings), render(scene, halfOf(eye), settings), {}};
    made.own_tiles = findOwnTiles(made.half.rgba, eye, gaze, hidden);
    fillPeriphery(made.picture, made.half, made.own_tiles, hidden, settings.background);
    return made;
}

}  // namespace binosplat::reference
