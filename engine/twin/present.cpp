// Twin of present: pictures as bytes.
#include "engine/twin/present.h"

#include "engine/srgb.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace binosplat::reference {
namespace {

std::uint32_t byteOf(double value, bool linear) {
    if (!(value > 0.0)) { return 0; }  // NaN, too
    const double shown = std::min(value, 1.0);
    return static_cast<std::uint32_t>(std::floor((linear ? lightOf(shown) : shown) * 255.0 + 0.5));
}

// For a blended, encoded value of a pixel with this alpha: the linear colour itself, multiplied by alpha.
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
            return presentation.see_through ? seenThrough(value, share, presentation.linear)
                                            : byteOf(value, presentation.linear);
        };
        const std::uint32_t red = channel(pixel.r), green = channel(pixel.g), blue = channel(pixel.b);
        const auto alpha = static_cast<std::uint32_t>(std::floor(share * 255.0 + 0.5));
        const std::uint32_t first = presentation.blue_first ? blue : red,
                            third = presentation.blue_first ? red : blue;
        words.push_back(first | green << 8 | third << 16 | alpha << 24);
    }
    return words;
}

std::vector<std::uint32_t> presentOver(std::span<const glm::dvec4> rgba, std::span<const double> depth_sums,
                                       std::span<const std::uint32_t> behind,
                                       std::span<const double> mesh_depths,
                                       const Presentation& presentation) {
    std::vector<glm::dvec4> mixed;
    std::vector<double> shares;
    for (std::size_t i = 0; i < rgba.size(); ++i) {
        const bool hidden =
            !presentation.is_cut && !mesh_depths.empty() &&
            !(presentation.near * rgba[i].a / depth_sums[i] > mesh_depths[i] - presentation.depth_offset);
        const glm::dvec4 pixel = hidden ? glm::dvec4(0.0) : rgba[i];
        const double left = 1.0 - std::clamp(pixel.a, 0.0, 1.0);
        glm::dvec4& result = mixed.emplace_back();
        for (int c = 0; c < 3; ++c) {
            const int place = presentation.blue_first ? 2 - c : c;
            const double there = ((behind[i] >> (8 * place)) & 255) / 255.0;
            result[c] =
                std::clamp(pixel[c], 0.0, 1.0) + left * (presentation.linear ? encodedOf(there) : there);
        }
        shares.push_back(1.0 - left + left * (behind[i] >> 24) / 255.0);
    }
    std::vector<std::uint32_t> words = present(mixed, presentation);
    for (std::size_t i = 0; i < words.size(); ++i) {
        words[i] = (words[i] & 0xffffff) | static_cast<std::uint32_t>(std::floor(shares[i] * 255.0 + 0.5))
                                               << 24;
    }
    return words;
}

void keepBits(std::span<std::uint32_t> words, std::span<const std::uint32_t> before,
              std::uint32_t kept_bits) {
    for (std::size_t i = 0; i < words.size(); ++i) {
        words[i] = (words[i] & ~kept_bits) | (before[i] & kept_bits);
    }
}

std::vector<double> presentDepths(std::span<const glm::dvec4> rgba, std::span<const double> depth_sums,
                                  std::uint32_t width, const Presentation& presentation) {
    const auto inverseAt = [&](std::size_t i) {
        return depth_sums[i] > 0.0 ? rgba[i].a / depth_sums[i] : 0.0;
    };
    const std::ptrdiff_t columns = width, rows = std::ssize(rgba) / columns;
    // 1/z of the pixels from a given one to the end of the picture.
    const auto profile = [&](std::ptrdiff_t x, std::ptrdiff_t y, std::ptrdiff_t dx, std::ptrdiff_t dy) {
        std::vector<double> values;
        for (; x >= 0 && y >= 0 && x < columns && y < rows; x += dx, y += dy) {
            values.push_back(inverseAt(static_cast<std::size_t>(y * columns + x)));
        }
        return values;
    };
    std::vector<double> shares;
    for (std::size_t i = 0; i < rgba.size(); ++i) {
        double own = rgba[i].a >= 0.5 ? inverseAt(i) : 0.0;
        std::vector<double> ends;
        for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
            const std::vector<double> values = profile(static_cast<std::ptrdiff_t>(i) % columns,
                                                       static_cast<std::ptrdiff_t>(i) / columns, dx, dy);
            for (std::size_t k = 0; k < 16 && k + 1 < values.size(); ++k) {
                if (std::abs(values[k + 1] - values[k]) > 0.02 * values[k]) { continue; }
                const double end = values[k == 0 ? 0 : k + 1];  // no step; or the last one, which is smaller
                if (end > 0.0) { ends.push_back(end); }
                break;
            }
        }
        if (own > 0.0 && !ends.empty()) {
            const auto [back, front] = std::ranges::minmax(ends);
            const auto scaled = [&](double inverse) {
                return presentation.by_inverse ? inverse : -1.0 / inverse;
            };
            const double of_front = (scaled(own) - scaled(back)) / (scaled(front) - scaled(back));
            if (front > 1.1 * back) { own = of_front * rgba[i].a >= 0.5 ? front : back; }
        }
        shares.push_back(std::clamp(presentation.near * own + presentation.depth_offset, 0.0, 1.0));
    }
    return shares;
}

std::vector<std::uint32_t> turn(std::span<const std::uint32_t> words, glm::uvec2 picture_px,
                                glm::uvec2 view_px, const glm::dmat3& picture_from_view, bool linear) {
    std::vector<std::uint32_t> shown;
    const glm::dvec2 last(picture_px - 1u);
    for (std::uint32_t i = 0; i < view_px.x * view_px.y; ++i) {
        const glm::dvec3 ray = picture_from_view * glm::dvec3(i % view_px.x + 0.5, i / view_px.x + 0.5, 1.0);
        const glm::dvec2 place = glm::clamp(glm::dvec2(ray) / ray.z - 0.5, glm::dvec2(0.0), last),
                         low = glm::floor(place);
        std::uint32_t word = 0;
        for (int channel = 0; channel < 4; ++channel) {
            const bool encoded = !linear && channel < 3;
            double light = 0.0;
            for (const glm::dvec2 corner :
                 {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(1, 1)}) {
                const glm::dvec2 share = glm::mix(1.0 - (place - low), place - low, corner),
                                 at = glm::min(low + corner, last);
                const double value =
                    (words[static_cast<std::size_t>(at.y) * picture_px.x + static_cast<std::size_t>(at.x)] >>
                         (8 * channel) &
                     255) /
                    255.0;
                light += share.x * share.y * (encoded ? lightOf(value) : value);
            }
            word |= byteOf(encoded ? encodedOf(light) : light, false) << (8 * channel);
        }
        shown.push_back(word);
    }
    return shown;
}

}  // namespace binosplat::reference
