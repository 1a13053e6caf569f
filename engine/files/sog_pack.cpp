// Rounding, and spreading sixteen bits over forty-eight.
#include "engine/files/sog_pack.h"

#include <algorithm>
#include <cmath>

namespace binosplat {

namespace {

double compressPosition(float value) {
    return std::copysign(std::log1p(std::abs(static_cast<double>(value))), static_cast<double>(value));
}

}  // namespace

SogPlaces findSogPlaces(const Scene& scene) {
    SogPlaces places;
    places.levels.resize(scene.size());
    for (int axis = 0; axis < 3 && scene.size() > 0; ++axis) {
        const auto of = [&](const glm::vec3& position) { return position[axis]; };
        const auto [least, largest] = std::ranges::minmax(scene.positions, {}, of);
        const auto a = static_cast<std::size_t>(axis);
        places.mins[a] = static_cast<float>(compressPosition(least[axis]));
        places.maxs[a] = static_cast<float>(compressPosition(largest[axis]));
        const auto low = static_cast<double>(places.mins[a]),
                   range = static_cast<double>(places.maxs[a]) - low;
        for (std::size_t i = 0; i < scene.size(); ++i) {
            const double share =
                range > 0.0 ? (compressPosition(scene.positions[i][axis]) - low) / range : 0.0;
            places.levels[i][a] =
                static_cast<std::uint16_t>(std::lround(65535.0 * std::clamp(share, 0.0, 1.0)));
        }
    }
    return places;
}

std::vector<std::uint32_t> mortonOrder(const SogPlaces& places) {
    const auto spread = [](std::uint64_t bits) {
        bits = (bits | bits << 16) & 0x00000000ff0000ffu;
        bits = (bits | bits << 8) & 0xf00f00f00f00f00fu;
        bits = (bits | bits << 4) & 0x30c30c30c30c30c3u;
        return (bits | bits << 2) & 0x9249249249249249u;
    };
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
    keys.reserve(places.levels.size());
    for (const auto& [x, y, z] : places.levels) {
        keys.emplace_back(spread(x) | spread(y) << 1 | spread(z) << 2,
                          static_cast<std::uint32_t>(keys.size()));
    }
    std::ranges::sort(keys);
    std::vector<std::uint32_t> order;
    order.reserve(keys.size());
    for (const auto& [key, splat] : keys) { order.push_back(splat); }
    return order;
}

std::array<std::uint8_t, 4> packSogRotation(const glm::quat& rotation) {
    const std::array<float, 4> wxyz{rotation.w, rotation.x, rotation.y, rotation.z};
    const auto largest = static_cast<std::size_t>(
        std::ranges::max_element(wxyz, {}, [](float part) { return std::abs(part); }) - wxyz.begin());
    std::array<std::uint8_t, 4> packed{};
    for (std::size_t i = 0, next = 0; i < 4; ++i) {
        if (i == largest) { continue; }
        const float part = std::copysign(1.0f, wxyz[largest]) * wxyz[i] * 1.41421356f;
        packed[next++] =
            static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(0.5f + 0.5f * part, 0.0f, 1.0f)));
    }
    packed[3] = static_cast<std::uint8_t>(252 + largest);
    return packed;
}

}  // namespace binosplat
