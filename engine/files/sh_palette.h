// A palette for the harmonics of colours: rows of coefficients that stand for those of many splats.
#pragma once

#include "engine/scene/scene.h"

#include <cstdint>
#include <vector>

namespace binosplat {

struct ShPalette {
    std::size_t coefficients = 0;       // for each channel, without the constant band
    std::vector<float> entries;         // entries[(entry * coefficients + k) * 3 + channel]
    std::vector<std::uint16_t> labels;  // the entry of each splat

    [[nodiscard]] std::size_t size() const {
        return coefficients == 0 ? 0 : entries.size() / (3 * coefficients);
    }
};

inline constexpr std::size_t kMostPaletteEntries = 65536;

// k-means over the bands from 1 on, with at most `most_entries`, 1 to kMostPaletteEntries. Rows of zeros keep
// an entry of zeros. The scene must have bands above the constant one. The result does not depend on the
// number of threads.
ShPalette makeShPalette(const Scene& scene, std::size_t most_entries, const Progress& progress);

}  // namespace binosplat
