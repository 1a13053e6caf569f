// Weights for LPIPS that come from no training.
#pragma once

#include "tests/suite.h"

namespace binosplat::test {

inline constexpr std::size_t kNetworkWeights = 722'496, kHeadWeights = 2'240;

// Of either sign in the network, and large enough that features keep their size from layer to layer; the
// heads' weights lie between 0 and 1.
inline std::vector<float> makeLpipsWeights(unsigned seed) {
    std::mt19937 random(seed);
    const auto next = [&] { return static_cast<float>(drawUnit(random)); };
    std::vector<float> values;
    const auto add = [&](std::size_t inputs, std::size_t outputs, std::size_t taps) {
        const float reach = std::sqrt(6.0f / static_cast<float>(inputs * taps));
        for (std::size_t i = 0; i < inputs * taps * outputs; ++i) {
            values.push_back(reach * (2.0f * next() - 1.0f));
        }
        for (std::size_t i = 0; i < outputs; ++i) { values.push_back(0.2f * (next() - 0.5f)); }
    };
    add(3, 64, 9);
    const std::size_t fires[][3] = {{64, 16, 64},   {128, 16, 64},  {128, 32, 128}, {256, 32, 128},
                                    {256, 48, 192}, {384, 48, 192}, {384, 64, 256}, {512, 64, 256}};
    for (const auto& [inputs, squeezed, expanded] : fires) {
        add(inputs, squeezed, 1);
        add(squeezed, expanded, 1);
        add(squeezed, expanded, 9);
    }
    for (std::size_t i = 0; i < kHeadWeights; ++i) { values.push_back(next()); }
    return values;
}

inline void writeFloats(const fs::path& file, const std::vector<float>& values) {
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size() * sizeof(float)));
}

}  // namespace binosplat::test
