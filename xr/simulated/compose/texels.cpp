// Texel formats and the sRGB curve.
#include "xr/simulated/compose/texels.h"

#include <glm/common.hpp>
#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace simulated {

namespace {

// Decoding 256 bytes by table, and encoding by a first guess, corrected with the exact thresholds between
// bytes: `pow` per pixel would take most of the time of composing.
struct SrgbTables {
    static constexpr std::size_t kGuesses = 4096;
    std::array<double, 256> linear_of_byte{};
    std::array<double, 257> least_of_byte{};
    std::array<std::uint8_t, kGuesses> guess{};

    SrgbTables() {
        for (std::size_t i = 0; i < 256; ++i) {
            linear_of_byte[i] = decodeSrgb(static_cast<double>(i) / 255.0);
            least_of_byte[i] = i == 0 ? 0.0 : decodeSrgb((static_cast<double>(i) - 0.5) / 255.0);
        }
        least_of_byte[256] = 2.0;
        for (std::size_t i = 0, byte = 0; i < kGuesses; ++i) {
            while (least_of_byte[byte + 1] <= static_cast<double>(i) / kGuesses) { ++byte; }
            guess[i] = static_cast<std::uint8_t>(byte);
        }
    }
};

const SrgbTables& tables() {
    static const SrgbTables kTables;
    return kTables;
}

double readHalf(const std::byte* bytes) {
    std::uint16_t half = 0;
    std::memcpy(&half, bytes, sizeof half);
    const auto value = static_cast<double>(glm::unpackHalf1x16(half));
    // No display shows infinity, and one bad texel must not spread over its neighbours.
    return std::isnan(value) ? 0.0 : std::clamp(value, -65504.0, 65504.0);
}

}  // namespace

double decodeSrgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double encodeSrgb(double linear) {
    return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

std::uint8_t srgbByte(double linear) {
    if (!(linear > 0.0)) { return 0; }
    if (linear >= 1.0) { return 255; }
    const SrgbTables& known = tables();
    std::size_t byte = known.guess[static_cast<std::size_t>(linear * SrgbTables::kGuesses)];
    while (known.least_of_byte[byte + 1] <= linear) { ++byte; }
    return static_cast<std::uint8_t>(byte);
}

std::size_t bytesPerTexel(Texels texels) { return texels == Texels::kRgba16f ? 8 : 4; }

Sampler::Sampler(const Picture& picture, const Rect& rect) : picture_(picture), rect_(rect) {
    const auto inside = [](std::uint64_t offset, std::uint64_t extent, std::uint64_t size) {
        return extent > 0 && offset + extent <= size;
    };
    if (!inside(rect.offset.x, rect.extent.x, picture.size_px.x) ||
        !inside(rect.offset.y, rect.extent.y, picture.size_px.y)) {
        throw std::invalid_argument("a layer's rectangle is not inside its picture");
    }
    if (picture.bytes.size() !=
        std::size_t{picture.size_px.x} * picture.size_px.y * bytesPerTexel(picture.texels)) {
        throw std::invalid_argument("a layer's picture does not have the bytes of its size and format");
    }
}

glm::dvec4 Sampler::texel(std::uint32_t x, std::uint32_t y) const {
    const std::size_t index = std::size_t{rect_.offset.y + y} * picture_.size_px.x + rect_.offset.x + x;
    const std::byte* bytes = picture_.bytes.data() + index * bytesPerTexel(picture_.texels);
    if (picture_.texels == Texels::kRgba16f) {
        const glm::dvec4 values(readHalf(bytes), readHalf(bytes + 2), readHalf(bytes + 4),
                                readHalf(bytes + 6));
        if (picture_.transfer == Transfer::kLinear) { return values; }
        return {decodeSrgb(values.r), decodeSrgb(values.g), decodeSrgb(values.b), values.a};
    }
    const auto light = [&](std::size_t channel) {
        const auto byte = static_cast<std::uint8_t>(bytes[channel]);
        return picture_.transfer == Transfer::kSrgb ? tables().linear_of_byte[byte] : byte / 255.0;
    };
    const bool is_bgr = picture_.texels == Texels::kBgra8;
    return {light(is_bgr ? 2 : 0), light(1), light(is_bgr ? 0 : 2),
            static_cast<std::uint8_t>(bytes[3]) / 255.0};
}

glm::dvec4 Sampler::sample(double u, double v) const {
    const glm::dvec2 last(rect_.extent.x - 1, rect_.extent.y - 1);
    const glm::dvec2 place =
        glm::clamp(glm::dvec2(u, v) * glm::dvec2(rect_.extent) - 0.5, glm::dvec2(0.0), last);
    const auto x0 = static_cast<std::uint32_t>(place.x), y0 = static_cast<std::uint32_t>(place.y);
    const std::uint32_t x1 = std::min(x0 + 1, rect_.extent.x - 1), y1 = std::min(y0 + 1, rect_.extent.y - 1);
    const double across = place.x - x0, down = place.y - y0;
    return glm::mix(glm::mix(texel(x0, y0), texel(x1, y0), across),
                    glm::mix(texel(x0, y1), texel(x1, y1), across), down);
}

std::optional<glm::dvec4> Sampler::sampleInside(double u, double v) const {
    if (!(u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0)) { return std::nullopt; }
    return sample(u, v);
}

}  // namespace simulated
