// Lossless WebP pictures as data: eight bits per channel, as they were stored.
#pragma once

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace binosplat {

// Four bytes per pixel, rows top to bottom; alpha is not multiplied into the others.
struct Pixels {
    glm::uvec2 size_px{0, 0};
    std::vector<std::uint8_t> rgba;
};

// True if this build can decode and encode WebP: it needs libwebp.
bool canDecodeWebp();

// The size that the header of a lossless WebP file states, to be checked before anything is decoded. Throws
// Error naming `name` if `file` does not contain a lossless picture.
glm::uvec2 webpSize(std::span<const std::byte> file, const std::string& name);

// Throws Error naming `name`.
Pixels decodeWebp(std::span<const std::byte> file, const std::string& name);

inline constexpr std::uint32_t kMaxWebpSide = 16383;

// A lossless file: the same bytes, even where alpha is 0. The sides are 1 to kMaxWebpSide. Throws Error
// naming `name` if memory is short.
std::vector<std::byte> encodeWebp(const Pixels& pixels, const std::string& name);

}  // namespace binosplat
