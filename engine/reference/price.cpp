// 8h: what a tile's error is worth, for what the tile costs.
#include "engine/reference/stereo.h"

#include <algorithm>
#include <cmath>

namespace binosplat::reference {

std::vector<std::optional<std::uint32_t>> price(std::span<const TileKind> kinds, std::span<const double> errors,
                                                std::span<const std::uint64_t> costs) {
    constexpr double kMostSteps = 0x1p31 - 1.0, kBinsPerOctave = 16.0, kFirstOctave = -23.0, kBins = 1024.0;
    std::vector<std::optional<std::uint32_t>> prices(kinds.size());
    for (std::size_t t = 0; t < kinds.size(); ++t) {
        const double steps = std::min(std::floor(errors[t] * 0x1p20), kMostSteps);
        if (kinds[t] != TileKind::kNone || !(steps > 0.0)) { continue; }
        // Bins of an octave are equally wide.
        int octave = 0;
        const double within = 2.0 * std::frexp(steps / static_cast<double>(costs[t]), &octave) - 1.0;
        const double bin = kBinsPerOctave * (octave - 1 - kFirstOctave) + std::floor(kBinsPerOctave * within);
        prices[t] = static_cast<std::uint32_t>(std::clamp(bin, 0.0, kBins - 1.0));
    }
    return prices;
}

}  // namespace binosplat::reference
