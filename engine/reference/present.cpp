// present: pictures in bytes.
#include "engine/reference/present.h"

#include "engine/srgb.h"

#include <algorithm>
#include <cmath>

namespace binosplat::reference {
namespace {

std::uint32_t byteOf(double value, bool linear) {
    if (!(value > 0.0)) { return 0; }  // NaN, too
    const double shown = std::min(value, 1.0);
    return static_cast<std::uint32_t>(std::floor((linear ? lightOf(shown) : shown) * 255.0 + 0.5));
}

// For a blended, encoded value with this share: the light of the colour itself, multiplied by the share.
std::uint32_t seenThrough(double value, double share, bool linear) {
    if (!(value > 0.0) || share == 0.0) { return 0; }
    const double light = share * lightOf(std::min(value / share, 1.0));
    return byteOf(linear ? light : encodedOf(light), false);
}

}  // namespace

std::vector<std::uint32_t> present(std::span<const glm::dvec4> rgba, const Presentation& presentation) {
    std::vector<std::uint32_t> words;
    for (const glm::dvec4& pixel : rgba) {
        const double share = !presentation.see_through ? 1.0 : pixel.a > 0.0 ? std::min(pixel.a, 1.0) : 0.0;
        const auto channel = [&](double value) {
            return presentation.see_through ? seenThrough(value, share, presentation.linear) : byteOf(value, presentation.linear);
        };
        const std::uint32_t red = channel(pixel.r), green = channel(pixel.g), blue = channel(pixel.b);
        const auto alpha = static_cast<std::uint32_t>(std::floor(share * 255.0 + 0.5));
        const std::uint32_t first = presentation.blue_first ? blue : red, third = presentation.blue_first ? red : blue;
        words.push_back(first | green << 8 | third << 16 | alpha << 24);
    }
    return words;
}

std::vector<double> presentDepths(std::span<const glm::dvec4> rgba, std::span<const double> depth_sums, const Presentation& presentation) {
    std::vector<double> shares;
    for (std::size_t i = 0; i < rgba.size(); ++i) {
        const bool anything = rgba[i].a >= 1.0 / 255.0 && depth_sums[i] > 0.0;
        shares.push_back(anything ? std::min(presentation.near * rgba[i].a / depth_sums[i], 1.0) : 0.0);
    }
    return shares;
}

}  // namespace binosplat::reference
