// Reads WebP headers itself, WebP pixels through libwebp.
#include "engine/picture/webp.h"

#include "engine/error.h"

#ifdef BINOSPLAT_SOG
#include <webp/decode.h>
#include <webp/encode.h>
#endif

#include <cassert>
#include <string_view>

namespace binosplat {

namespace {

std::uint32_t loadWord(std::span<const std::byte> bytes, std::size_t offset) {
    std::uint32_t word = 0;
    for (std::size_t i = 4; i-- > 0;) {
        word = word << 8 | std::to_integer<std::uint32_t>(bytes[offset + i]);
    }
    return word;
}

// The stream of a lossless picture: one byte 0x2f, 14 bits width - 1, 14 bits height - 1, and a bit that says
// whether alpha is used.
constexpr std::size_t kStreamHeaderBytes = 5;

// A file's VP8L chunk, alone or among others.
std::span<const std::byte> findStream(std::span<const std::byte> file, const std::string& name) {
    const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
    check(file.size() >= 12 && text.starts_with("RIFF") && text.substr(8, 4) == "WEBP",
          "{}: not a WebP file, expected one", name);
    for (std::uint64_t at = 12; file.size() >= 8 && at <= file.size() - 8;) {
        const std::string_view kind = text.substr(at, 4);
        const std::uint64_t bytes = loadWord(file, at + 4);
        at += 8;
        if (kind == "VP8L") {
            check(bytes <= file.size() - at, "{}: ends after {} of {} bytes of its picture", name,
                  file.size() - at, bytes);
            check(bytes > kStreamHeaderBytes && file[at] == std::byte{0x2f},
                  "{}: a WebP file without a picture, expected one", name);
            return file.subspan(at, bytes);
        }
        check(kind != "VP8 " && kind != "ANIM", "{}: a lossy or moving WebP picture, expected a lossless one",
              name);
        at += bytes + bytes % 2;
    }
    fail("{}: a WebP file without a lossless picture, expected one", name);
}

glm::uvec2 streamSize(std::span<const std::byte> stream) {
    const std::uint32_t word = loadWord(stream, 1);
    return {(word & 0x3fff) + 1, (word >> 14 & 0x3fff) + 1};
}

}  // namespace

glm::uvec2 webpSize(std::span<const std::byte> file, const std::string& name) {
    return streamSize(findStream(file, name));
}

#ifdef BINOSPLAT_SOG

bool canDecodeWebp() { return true; }

Pixels decodeWebp(std::span<const std::byte> file, const std::string& name) {
    const std::span<const std::byte> stream = findStream(file, name);
    const glm::uvec2 size_px = streamSize(stream);
    const std::size_t stride = std::size_t{4} * size_px.x;
    Pixels pixels{size_px, std::vector<std::uint8_t>(stride * size_px.y)};
    // A bare stream counts as a file for libwebp, too.
    const auto* begin = reinterpret_cast<const std::uint8_t*>(stream.data());
    check(WebPDecodeRGBAInto(begin, stream.size(), pixels.rgba.data(), pixels.rgba.size(),
                             static_cast<int>(stride)) != nullptr,
          "{}: cannot be decoded, its picture is damaged", name);
    return pixels;
}

namespace {

// From 0 to 9. The data are mostly noise: 7 takes twice as long, and saves one per cent.
constexpr int kEffort = 3;

struct WebpMemory {
    WebPMemoryWriter writer{};
    WebPPicture picture{};
    ~WebpMemory() {
        WebPPictureFree(&picture);
        WebPMemoryWriterClear(&writer);
    }
};

}  // namespace

std::vector<std::byte> encodeWebp(const Pixels& pixels, const std::string& name) {
    assert(pixels.size_px.x >= 1 && pixels.size_px.x <= kMaxWebpSide && pixels.size_px.y >= 1 &&
           pixels.size_px.y <= kMaxWebpSide);
    WebPConfig config;
    WebpMemory memory;
    const bool fits = WebPConfigInit(&config) != 0 && WebPConfigLosslessPreset(&config, kEffort) != 0 &&
                      WebPPictureInit(&memory.picture) != 0;
    check(fits, "{}: libwebp has another version than it was built for", name);
    config.exact = 1;  // colours under alpha 0 are data, too
    WebPMemoryWriterInit(&memory.writer);
    memory.picture.use_argb = 1;
    memory.picture.width = static_cast<int>(pixels.size_px.x);
    memory.picture.height = static_cast<int>(pixels.size_px.y);
    memory.picture.writer = WebPMemoryWrite;
    memory.picture.custom_ptr = &memory.writer;
    const bool encoded =
        WebPPictureImportRGBA(&memory.picture, pixels.rgba.data(), 4 * memory.picture.width) != 0 &&
        WebPEncode(&config, &memory.picture) != 0;
    check(encoded, "{}: cannot be encoded (libwebp's error {})", name,
          static_cast<int>(memory.picture.error_code));
    const auto* begin = reinterpret_cast<const std::byte*>(memory.writer.mem);
    return {begin, begin + memory.writer.size};
}

#else

bool canDecodeWebp() { return false; }

Pixels decodeWebp(std::span<const std::byte>, const std::string& name) {
    fail("{}: cannot be decoded, this build is without libwebp", name);
}

std::vector<std::byte> encodeWebp(const Pixels&, const std::string& name) {
    fail("{}: cannot be encoded, this build is without libwebp", name);
}

#endif

}  // namespace binosplat
