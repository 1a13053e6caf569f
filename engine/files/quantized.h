// For all compressed formats: turns small integers back into stored attributes (see scene_builder.h).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace binosplat {

// The constant band of spherical harmonics: a displayed colour is 0.5 + kShConstant * f_dc.
inline constexpr float kShConstant = 0.28209479177387814f;

// The logit of an opacity; 0 and 1 become finite numbers whose sigmoid is exactly 0 and 1 in float32.
inline float storedOpacity(float opacity) {
    if (!(opacity > 0.0f)) { return std::isnan(opacity) ? opacity : -100.0f; }
    if (opacity >= 1.0f) { return 100.0f; }
    const double o = opacity;
    return static_cast<float>(std::log(o / (1.0 - o)));
}

// The logarithm of a scale; 0 becomes one whose exponential is exactly 0 in float32.
inline float storedScale(float scale) { return scale == 0.0f ? -200.0f : std::log(scale); }

// The f_dc of a displayed colour of 0 to 1.
inline float storedColour(float colour) { return (colour - 0.5f) / kShConstant; }

// A unit quaternion (w, x, y, z) whose largest component is positive and not stored; the three others keep
// their order.
inline std::array<float, 4> fromSmallestThree(std::size_t largest, const std::array<float, 3>& others) {
    std::array<float, 4> quaternion{};
    float rest = 1.0f;
    for (std::size_t i = 0, next = 0; i < 4; ++i) {
        if (i == largest) { continue; }
        quaternion[i] = others[next++];
        rest -= quaternion[i] * quaternion[i];
    }
    quaternion[largest] = std::sqrt(std::max(rest, 0.0f));
    return quaternion;
}

// A little-endian value at `offset`, which the caller has checked.
template <typename T>
T loadLittle(std::span<const std::byte> bytes, std::size_t offset) {
    std::array<std::byte, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes.data() + offset, sizeof(T));
    if constexpr (std::endian::native == std::endian::big) { std::reverse(raw.begin(), raw.end()); }
    return std::bit_cast<T>(raw);
}

}  // namespace binosplat
