// rasterize: what the source's picture tells about a pixel that will be reprojected: its depth, and how
// certain that is.
#include "engine/twin/stereo.h"

#include <algorithm>
#include <cmath>

namespace binosplat::reference {
namespace {

constexpr double kCodesPerOctave = 2.0, kLeastSpreadLog2 = -13.0, kLastCode = 31.0;
constexpr double kNearest = 1e30;  // nothing has such an inverse depth

// Standard deviation of the inverse depths that a pixel blends.
double deviation(const Picture& dominant, std::size_t pixel) {
    const double weight = dominant.rgba[pixel].w, mean = dominant.inverse_depth[pixel] / weight;
    return std::sqrt(std::max(dominant.inverse_depth_squared[pixel] / weight - mean * mean, 0.0));
}

}  // namespace

double chooseInverseDepth(const Picture& dominant, std::size_t pixel, DepthChoice choice) {
    const double weight = dominant.rgba[pixel].w;
    if (weight <= 0.0) { return 0.0; }
    switch (choice) {
        case DepthChoice::kSum:
            return 1.0 / dominant.depth[pixel];
        case DepthChoice::kMean:
            return 1.0 / (dominant.depth[pixel] / weight);
        case DepthChoice::kInverse:
            return dominant.inverse_depth[pixel] / weight;
    }
    return 0.0;
}

std::uint32_t spreadCode(double spread) {
    if (!(spread > 0.0)) { return 0; }
    const double code = std::round(kCodesPerOctave * (std::log2(spread) - kLeastSpreadLog2)) + 1.0;
    return static_cast<std::uint32_t>(std::clamp(code, 0.0, kLastCode));
}

double spreadOf(std::uint32_t code) {
    return code == 0 ? 0.0 : std::exp2((code - 1.0) / kCodesPerOctave + kLeastSpreadLog2);
}

std::optional<MovingPixel> movingPixel(const Picture& dominant, std::size_t pixel,
                                       const StereoSettings& settings) {
    const double inverse_depth = chooseInverseDepth(dominant, pixel, settings.depth_choice);
    if (!(inverse_depth >= 0.0 && inverse_depth < kNearest)) { return std::nullopt; }
    return MovingPixel{inverse_depth,
                       inverse_depth > 0.0 ? spreadCode(deviation(dominant, pixel) / inverse_depth) : 0};
}

double roundedDepth(double inverse_depth) {
    int octave = 0;
    const double within = std::frexp(inverse_depth, &octave);
    return std::ldexp(std::floor(within * 0x1p19 + 0.5), octave - 19);
}

}  // namespace binosplat::reference
