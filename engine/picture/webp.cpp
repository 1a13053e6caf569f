// WebP headers by hand, WebP pixels through OpenImageIO.
#include "engine/picture/webp.h"

#include "engine/error.h"

#ifdef BINOSPLAT_OPENIMAGEIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#pragma GCC diagnostic pop
#endif

#include <algorithm>
#include <cstring>
#include <string_view>

namespace binosplat {

namespace {

std::uint32_t loadWord(std::span<const std::byte> bytes, std::size_t offset) {
    std::uint32_t word = 0;
    for (std::size_t i = 4; i-- > 0;) { word = word << 8 | std::to_integer<std::uint32_t>(bytes[offset + i]); }
    return word;
}

// The stream of a lossless picture: one byte 0x2f, 14 bits width - 1, 14 bits height - 1, a bit that says whether alpha is used.
constexpr std::size_t kStreamHeaderBytes = 5;
constexpr std::size_t kAlphaByte = 4;
constexpr std::byte kAlphaBit{0x10};

// The chunk VP8L of a file, be it alone or among others.
std::span<const std::byte> findStream(std::span<const std::byte> file, const std::string& name) {
    const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
    check(file.size() >= 12 && text.starts_with("RIFF") && text.substr(8, 4) == "WEBP", "{}: not a WebP file, expected one", name);
    for (std::uint64_t at = 12; file.size() >= 8 && at <= file.size() - 8;) {
        const std::string_view kind = text.substr(at, 4);
        const std::uint64_t bytes = loadWord(file, at + 4);
        at += 8;
        if (kind == "VP8L") {
            check(bytes <= file.size() - at, "{}: ends after {} of {} bytes of its picture", name, file.size() - at, bytes);
            check(bytes > kStreamHeaderBytes && file[at] == std::byte{0x2f}, "{}: a WebP file without a picture, expected one", name);
            return file.subspan(at, bytes);
        }
        check(kind != "VP8 " && kind != "ANIM", "{}: a lossy or moving WebP picture, expected a lossless one", name);
        at += bytes + bytes % 2;
    }
    fail("{}: a WebP file without a lossless picture, expected one", name);
}

glm::uvec2 streamSize(std::span<const std::byte> stream) {
    const std::uint32_t word = loadWord(stream, 1);
    return {(word & 0x3fff) + 1, (word >> 14 & 0x3fff) + 1};
}

#ifdef BINOSPLAT_OPENIMAGEIO

// A file of the stream alone, with or without its alpha.
std::vector<std::byte> wrapStream(std::span<const std::byte> stream, bool with_alpha) {
    const auto bytes = static_cast<std::uint32_t>(stream.size());
    std::vector<std::byte> file(20 + bytes + bytes % 2);
    const auto putWord = [&](std::size_t offset, std::uint32_t word) {
        for (std::size_t i = 0; i < 4; ++i) { file[offset + i] = static_cast<std::byte>(word >> 8 * i & 0xff); }
    };
    std::memcpy(file.data(), "RIFF....WEBPVP8L", 16);
    putWord(4, static_cast<std::uint32_t>(file.size() - 8));
    putWord(16, bytes);
    std::ranges::copy(stream, file.begin() + 20);
    std::byte& flags = file[20 + kAlphaByte];
    flags = with_alpha ? flags | kAlphaBit : flags & ~kAlphaBit;
    return file;
}

// Decodes into `rgba`, four bytes from pixel to pixel.
void decodeChannels(std::span<const std::byte> stream, bool with_alpha, const std::string& name, std::vector<std::uint8_t>& rgba) {
    const auto oneLine = [](std::string text) {
        std::ranges::replace(text, '\n', ' ');
        return text;
    };
    std::vector<std::byte> file = wrapStream(stream, with_alpha);
    OIIO::Filesystem::IOMemReader reader(file.data(), file.size());
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create("webp");
    check(input != nullptr && input->set_ioproxy(&reader), "{}: cannot be decoded, this OpenImageIO reads no WebP from memory", name);
    OIIO::ImageSpec spec;
    check(input->open("memory.webp", spec), "{}: cannot be decoded ({})", name, oneLine(input->geterror()));
    const int channels = with_alpha ? 4 : 3;
    const glm::uvec2 expected_px = streamSize(stream);
    const bool fits = glm::ivec2(spec.width, spec.height) == glm::ivec2(expected_px) && spec.nchannels == channels &&
                      spec.format == OIIO::TypeDesc::UINT8;
    check(fits, "{}: decodes to {} x {} with {} channels, expected {} x {} with {} of 8 bits", name, spec.width, spec.height,
          spec.nchannels, expected_px.x, expected_px.y, channels);
    // Row by row: for several at once OpenImageIO takes room for 64 MiB of them, however small the picture.
    bool read = true;
    for (int y = 0; read && y < spec.height; ++y) {
        read = input->read_scanline(y, 0, OIIO::TypeDesc::UINT8, rgba.data() + 4 * static_cast<std::size_t>(spec.width) * y, 4);
    }
    check(read, "{}: cannot be decoded ({})", name, oneLine(input->geterror()));
}

#endif

}  // namespace

glm::uvec2 webpSize(std::span<const std::byte> file, const std::string& name) { return streamSize(findStream(file, name)); }

#ifdef BINOSPLAT_OPENIMAGEIO

bool canDecodeWebp() { return true; }

Pixels decodeWebp(std::span<const std::byte> file, bool with_alpha, const std::string& name) {
    const std::span<const std::byte> stream = findStream(file, name);
    Pixels pixels{streamSize(stream), {}};
    pixels.rgba.assign(std::size_t{4} * pixels.size_px.x * pixels.size_px.y, 255);
    decodeChannels(stream, false, name, pixels.rgba);
    if (!with_alpha || (stream[kAlphaByte] & kAlphaBit) == std::byte{0}) { return pixels; }
    // OpenImageIO multiplies alpha into the colours of WebP, whatever it is asked for: alpha is taken from a second reading.
    std::vector<std::uint8_t> multiplied(pixels.rgba.size());
    decodeChannels(stream, true, name, multiplied);
    for (std::size_t i = 3; i < multiplied.size(); i += 4) { pixels.rgba[i] = multiplied[i]; }
    return pixels;
}

#else

bool canDecodeWebp() { return false; }

Pixels decodeWebp(std::span<const std::byte>, bool, const std::string& name) {
    fail("{}: cannot be decoded, this build is without OpenImageIO", name);
}

#endif

}  // namespace binosplat
