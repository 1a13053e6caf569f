// Splats as SOG stores them: 16-bit positions, the order along a curve, rotations in bytes.
#pragma once

#include "engine/scene/scene.h"

#include <array>
#include <cstdint>
#include <vector>

namespace binosplat {

// Positions as 16-bit shares of the range of their logarithms, sign(x) ln(1 + |x|).
struct SogPlaces {
    std::array<float, 3> mins{}, maxs{};               // of the logarithms
    std::vector<std::array<std::uint16_t, 3>> levels;  // of each splat
};
SogPlaces findSogPlaces(const Scene& scene);

// The splats along a Morton curve: neighbours in space become neighbours in the pictures, which then compress
// better.
std::vector<std::uint32_t> mortonOrder(const SogPlaces& places);

// Three bytes for the smaller components, between -1/sqrt(2) and 1/sqrt(2), and one from 252 on that says
// which of w, x, y, z is not stored.
std::array<std::uint8_t, 4> packSogRotation(const glm::quat& rotation);

}  // namespace binosplat
