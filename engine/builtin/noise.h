// Hashes and noise for generated scenes: integer arithmetic and float32 products only, so the same on every
// platform.
#pragma once

#include <glm/glm.hpp>

#include <cmath>
#include <cstdint>

namespace binosplat::builtin {

// A 32-bit mix with full avalanche (the finalizer of MurmurHash3).
constexpr std::uint32_t hash(std::uint32_t value) {
    value ^= value >> 16;
    value *= 0x85ebca6bu;
    value ^= value >> 13;
    value *= 0xc2b2ae35u;
    return value ^ (value >> 16);
}
constexpr std::uint32_t hash(std::uint32_t a, std::uint32_t b) {
    return hash(a * 0x9e3779b9u ^ hash(b + 0x7f4a7c15u));
}

// In [0, 1), 24 bits.
constexpr float unitFloat(std::uint32_t hashed) {
    return static_cast<float>(hashed >> 8) * (1.0f / 16777216.0f);
}

// Smooth value noise in [0, 1], one unit per cell.
inline float noise(const glm::vec2& at, std::uint32_t seed = 0) {
    const glm::vec2 cell = glm::floor(at);
    glm::vec2 f = at - cell;
    f = f * f * (3.0f - 2.0f * f);
    const auto x = static_cast<std::uint32_t>(static_cast<std::int32_t>(cell.x)),
               y = static_cast<std::uint32_t>(static_cast<std::int32_t>(cell.y));
    const auto corner = [&](std::uint32_t dx, std::uint32_t dy) {
        return unitFloat(hash(hash(x + dx, y + dy), seed));
    };
    return glm::mix(glm::mix(corner(0, 0), corner(1, 0), f.x), glm::mix(corner(0, 1), corner(1, 1), f.x),
                    f.y);
}

// Four octaves, in [0, 1].
inline float fractalNoise(glm::vec2 at, std::uint32_t seed = 0) {
    float sum = 0.0f, weight = 0.5f;
    for (std::uint32_t octave = 0; octave < 4; ++octave) {
        sum += weight * noise(at, seed + octave);
        at = at * 2.03f + 17.0f;
        weight *= 0.5f;
    }
    return sum / 0.9375f;
}

}  // namespace binosplat::builtin
