// Twin of depth_bounds: counts how often each depth occurs, in every other row of a picture.
#include "engine/twin/stereo.h"

#include <algorithm>
#include <cmath>

namespace binosplat::reference {

std::vector<std::uint32_t> boundDepths(const Picture& dominant, DepthChoice choice) {
    constexpr double kBins = 1024.0, kBinsPerOctave = 32.0;
    std::vector<std::uint32_t> bins(static_cast<std::size_t>(kBins), 0);
    for (std::size_t i = 0; i < dominant.rgba.size(); ++i) {
        if (i / dominant.size_px.x % 2 != 0 || dominant.rgba[i].w <= 0.5) { continue; }
        const auto pixel = movingPixel(dominant, i, {.choice = TileChoice::kPaper, .depth_choice = choice});
        if (!pixel) { continue; }
        const double octave = -std::log2(pixel->inverse_depth);
        ++bins[static_cast<std::size_t>(
            std::clamp(std::floor(kBinsPerOctave * octave + kBins / 2.0), 0.0, kBins - 1.0))];
    }
    return bins;
}

}  // namespace binosplat::reference
