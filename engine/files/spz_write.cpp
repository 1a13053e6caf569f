// Packs SPZ version 3.
#include "engine/error.h"
#include "engine/files/gzip.h"
#include "engine/files/spz.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace binosplat {

namespace {

constexpr int kMaxFractionalBits = 16;
constexpr float kMaxFixed = 8388607.0f;  // 2^23 - 1

std::byte nearestByte(float value) {
    return static_cast<std::byte>(std::lround(std::clamp(value, 0.0f, 255.0f)));
}

float furthestCoordinate(const Scene& scene) {
    float furthest = 0.0f;
    for (const glm::vec3& position : scene.positions) {
        furthest = std::max({furthest, std::abs(position.x), std::abs(position.y), std::abs(position.z)});
    }
    return furthest;
}

std::byte* putWord(std::byte* at, std::uint32_t word, int bytes) {
    for (int i = 0; i < bytes; ++i) { *at++ = static_cast<std::byte>(word >> 8 * i & 0xff); }
    return at;
}

std::byte* putPosition(const glm::vec3& position, int fractional_bits, std::byte* at) {
    for (const float coordinate : {position.x, -position.y, -position.z}) {
        at = putWord(at, static_cast<std::uint32_t>(std::lround(std::ldexp(coordinate, fractional_bits))), 3);
    }
    return at;
}

std::byte* putColour(const float* f_dc, std::byte* at) {
    for (int channel = 0; channel < 3; ++channel) {
        *at++ = nearestByte(255.0f * (0.5f + spz::kColourScale * f_dc[channel]));
    }
    return at;
}

// The third scale is the smallest, so that programs that draw discs drop that one; for discs it is the
// smallest possible.
std::byte* putScale(const Scene& scene, std::size_t splat, std::byte* at) {
    const glm::vec2& scale = scene.scales[splat];
    for (const float axis : {scale.x, scale.y, scene.isGaussian3d() ? scene.thicknesses[splat] : 0.0f}) {
        *at++ = axis > 0.0f ? nearestByte((std::log(axis) + 10.0f) * 16.0f) : std::byte{0};
    }
    return at;
}

std::byte* putRotation(const glm::quat& rotation, std::byte* at) {
    const std::array<float, 4> xyzw{rotation.x, -rotation.y, -rotation.z, rotation.w};
    std::uint32_t largest = 0;
    for (std::uint32_t i = 1; i < 4; ++i) {
        if (std::abs(xyzw[i]) > std::abs(xyzw[largest])) { largest = i; }
    }
    const bool negate = std::signbit(xyzw[largest]);
    std::uint32_t word = largest;
    for (std::uint32_t i = 0; i < 4; ++i) {
        if (i == largest) { continue; }
        const auto size =
            static_cast<std::uint32_t>(std::min(511l, std::lround(std::abs(xyzw[i]) * 1.41421356f * 511.0f)));
        word = word << 10 | static_cast<std::uint32_t>(std::signbit(xyzw[i]) != negate) << 9 | size;
    }
    return putWord(at, word, 4);
}

std::byte* putSh(const float* sh, int coefficients, std::byte* at) {
    for (int k = 1; k < coefficients; ++k) {
        for (int channel = 0; channel < 3; ++channel) {
            const float value = sh[3 * k + channel];
            *at++ = nearestByte(128.0f + 128.0f * (spz::kShChangesSign[k] ? -value : value));
        }
    }
    return at;
}

}  // namespace

int spzFractionalBits(const Scene& scene) {
    const float furthest = furthestCoordinate(scene);
    int bits = kMaxFractionalBits;
    while (bits > 0 && std::ldexp(furthest, bits) > kMaxFixed) { --bits; }
    return bits;
}

void writeSpz(const Scene& scene, const std::string& path, const Progress& progress) {
    check(!scene.is_linear,
          "{}: cannot hold colours of linear light ({}), must be written from a display-encoded scene", path,
          scene.name);
    check(scene.size() <= 0xffffffffu, "{}: cannot hold {} splats, SPZ counts in 32 bits", path,
          scene.size());
    const float furthest = furthestCoordinate(scene);
    check(furthest <= kMaxFixed, "{}: cannot hold positions up to {} units, SPZ ends at {}", path, furthest,
          kMaxFixed);
    const int fractional_bits = spzFractionalBits(scene);
    PartFile file(path);
    GzipWriter stream(file);
    std::array<std::byte, spz::kHeaderBytes> header{};
    std::byte* at = putWord(header.data(), spz::kMagic, 4);
    at = putWord(at, 3, 4);
    at = putWord(at, static_cast<std::uint32_t>(scene.size()), 4);
    at = putWord(at, static_cast<std::uint32_t>(scene.sh_degree), 1);
    at = putWord(at, static_cast<std::uint32_t>(fractional_bits), 1);
    putWord(at, scene.antialiased ? spz::kAntialiased : 0, 1);
    stream.write(header);

    const int coefficients = shCoefficientCount(scene.sh_degree);
    const auto shOf = [&](std::size_t splat) {
        return scene.sh.data() + splat * 3 * static_cast<std::size_t>(coefficients);
    };
    using Put = std::function<std::byte*(std::size_t splat, std::byte * at)>;
    const std::array<Put, 6> attributes{
        [&](std::size_t splat, std::byte* to) {
            return putPosition(scene.positions[splat], fractional_bits, to);
        },
        [&](std::size_t splat, std::byte* to) {
            return *to = nearestByte(255.0f * scene.opacities[splat]), to + 1;
        },
        [&](std::size_t splat, std::byte* to) { return putColour(shOf(splat), to); },
        [&](std::size_t splat, std::byte* to) { return putScale(scene, splat, to); },
        [&](std::size_t splat, std::byte* to) { return putRotation(scene.rotations[splat], to); },
        [&](std::size_t splat, std::byte* to) { return putSh(shOf(splat), coefficients, to); },
    };
    constexpr std::size_t kBlockSplats = 4096;
    std::vector<std::byte> block(kBlockSplats * 45);
    for (std::size_t i = 0; i < attributes.size(); ++i) {
        for (std::size_t done = 0; done < scene.size();) {
            if (progress) {
                const double within = static_cast<double>(done) / static_cast<double>(scene.size());
                progress((static_cast<double>(i) + within) / static_cast<double>(attributes.size()));
            }
            std::byte* end = block.data();
            for (const std::size_t stop = std::min(scene.size(), done + kBlockSplats); done < stop; ++done) {
                end = attributes[i](done, end);
            }
            stream.write(std::span(block.data(), end));
        }
    }
    stream.finish();
    file.commit();
    if (progress) { progress(1.0); }
}

}  // namespace binosplat
