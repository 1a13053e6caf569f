// Chunks and boxes.
#include "engine/picture/panorama_tags.h"

#include "engine/error.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <vector>

namespace binosplat {
namespace {

using namespace std::string_literals;

std::string bigEndian(std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) { bytes += static_cast<char>(value >> shift); }
    return bytes;
}

std::uint32_t readBigEndian(std::string_view bytes, std::size_t at) {
    check(at + 4 <= bytes.size(), "an MP4's box ends too soon");
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i) { value = value << 8 | static_cast<unsigned char>(bytes[i]); }
    return value;
}

// Of PNG's chunks: CRC-32 as in its annex D, bit by bit.
std::uint32_t checksum(std::string_view bytes) {
    std::uint32_t crc = 0xffffffffu;
    for (const char byte : bytes) {
        crc ^= static_cast<unsigned char>(byte);
        for (int bit = 0; bit < 8; ++bit) { crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u); }
    }
    return ~crc;
}

std::string box(const std::string& type, const std::string& content) {
    return bigEndian(static_cast<std::uint32_t>(8 + content.size())) + type + content;
}

std::string filmBoxes(const FilmTags& tags) {
    const std::string plain(4, '\0');  // version and flags
    std::string boxes;
    if (tags.eyes != FilmEyes::kOne) { boxes += box("st3d", plain + static_cast<char>(tags.eyes)); }
    if (tags.width_rad) {
        // The share of a whole turn that is missing on each side, in 2^-32.
        const double cropped = 0.5 - *tags.width_rad / (4.0 * std::numbers::pi);
        const std::string side = bigEndian(static_cast<std::uint32_t>(std::llround(cropped * 4294967296.0)));
        const std::string level(12, '\0'), none(4, '\0');
        boxes += box("sv3d", box("svhd", plain + "binosplat"s + '\0') +
                                 box("proj", box("prhd", plain + level) +
                                                 box("equi", plain + none + none + side + side)));
    }
    return boxes;
}

// Where the box of this type begins among those from `begin` to `end`; `end` if there is none.
std::size_t findBox(std::string_view bytes, std::string_view type, std::size_t begin, std::size_t end) {
    while (begin < end) {
        const std::uint32_t size = readBigEndian(bytes, begin);
        check(size >= 8 && size <= end - begin, "a box of an MP4 has {} bytes, must have 8 to {}", size,
              end - begin);
        if (bytes.substr(begin + 4, 4) == type) { return begin; }
        begin += size;
    }
    return end;
}

}  // namespace

static std::string xmpOf(const Panorama& panorama) {
    const glm::uvec2 size = panorama.size_px;
    const auto whole_width =
        static_cast<std::uint32_t>(std::lround(size.x * 2.0 * std::numbers::pi / panorama.width_rad));
    return fmt::format(
        "<?xpacket begin=\"\xef\xbb\xbf\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?><x:xmpmeta "
        "xmlns:x=\"adobe:ns:meta/\">"
        "<rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\"><rdf:Description rdf:about=\"\" "
        "xmlns:GPano=\"http://ns.google.com/photos/1.0/panorama/\" GPano:ProjectionType=\"equirectangular\" "
        "GPano:UsePanoramaViewer=\"True\" GPano:CroppedAreaImageWidthPixels=\"{}\" "
        "GPano:CroppedAreaImageHeightPixels=\"{}\" "
        "GPano:FullPanoWidthPixels=\"{}\" GPano:FullPanoHeightPixels=\"{}\" "
        "GPano:CroppedAreaLeftPixels=\"{}\" "
        "GPano:CroppedAreaTopPixels=\"0\"/></rdf:RDF></x:xmpmeta><?xpacket end=\"r\"?>",
        size.x, size.y, whole_width, size.y, (whole_width - size.x) / 2);
}

std::string withPanoramaTags(const std::string& file, const Panorama& panorama) {
    const std::string xmp = xmpOf(panorama);
    if (file.starts_with("\xff\xd8")) {
        // A segment APP1, after the one that says that it is a JFIF.
        const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(file.at(at)); };
        const std::size_t place = byte(3) == 0xe0 ? std::size_t{4} + byte(4) * 256 + byte(5) : 2;
        const std::string segment = "http://ns.adobe.com/xap/1.0/"s + '\0' + xmp;
        const std::string length = bigEndian(static_cast<std::uint32_t>(segment.size() + 2)).substr(2);
        return file.substr(0, place) + "\xff\xe1" + length + segment + file.substr(place);
    }
    // Not compressed, without a language.
    const std::string chunk = "iTXt"s + "XML:com.adobe.xmp" + std::string(5, '\0') + xmp;
    constexpr std::size_t kHeader = 8 + 25;  // the signature, and the chunk IHDR
    return file.substr(0, kHeader) + bigEndian(static_cast<std::uint32_t>(chunk.size() - 4)) + chunk +
           bigEndian(checksum(chunk)) + file.substr(kHeader);
}

std::string withFilmTags(const std::string& moov, const FilmTags& tags) {
    const std::string boxes = filmBoxes(tags);
    // The boxes around the descriptions of a track's pictures; and what comes in each before its own boxes.
    constexpr std::size_t kStsd = 8, kPicture = 78;
    std::string tagged = moov;
    std::size_t end = moov.size(), begin = 8;
    check(findBox(moov, "moov", 0, end) == 0, "an MP4's index is missing");
    std::vector<std::size_t> around{0};
    for (const std::string_view type : {"trak", "mdia", "minf", "stbl", "stsd"}) {
        const std::size_t found = findBox(moov, type, begin, end);
        check(found < end, "an MP4 has no box {}", type);
        around.push_back(found);
        begin = found + 8, end = found + readBigEndian(moov, found);
    }
    // The first description, and in it the first box: how to set up the decoder.
    const std::size_t description = begin + kStsd, inner = description + 8 + kPicture;
    around.push_back(description);
    const std::size_t place = inner + readBigEndian(moov, inner);
    check(place <= end, "an MP4's description of its pictures ends too soon");
    tagged.insert(place, boxes);
    for (const std::size_t start : around) {
        tagged.replace(start, 4,
                       bigEndian(readBigEndian(moov, start) + static_cast<std::uint32_t>(boxes.size())));
    }
    return tagged;
}

}  // namespace binosplat
