// Unpacks SPZ.
#include "engine/error.h"
#include "engine/files/gzip.h"
#include "engine/files/quantized.h"
#include "engine/files/scene_builder.h"
#include "engine/files/spz.h"
#include "engine/files/spz_axes.h"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

namespace binosplat {

namespace {

// A file with so many bytes of scene per byte of its own is not a scene: positions alone do not compress so
// well.
constexpr std::uint64_t kMaxExpansion = 256;
// How much is unpacked at a time, so that loading can be stopped; and the share of loading that unpacking
// takes.
constexpr std::size_t kPieceBytes = std::size_t{4} << 20;
constexpr double kUnpackingShare = 0.5;
// How much of the extensions' records is searched.
constexpr std::size_t kMostRecords = std::size_t{1} << 16;

struct Header {
    std::uint32_t version = 0;
    std::uint64_t splats = 0;
    int sh_degree = 0;  // after limiting it; sh_bytes says what the file has
    int fractional_bits = 0;
    bool antialiased = false;
    bool has_extensions = false;
    std::size_t rotation_bytes = 0, sh_bytes = 0;  // per splat

    [[nodiscard]] std::uint64_t bytesPerSplat() const { return 16 + rotation_bytes + sh_bytes; }
};

Header parseHeader(const std::string& file, std::span<const std::byte> bytes, bool gzipped) {
    check(bytes.size() == spz::kHeaderBytes, "{}: header: ends after {} bytes, expected {}", file,
          bytes.size(), spz::kHeaderBytes);
    Header header;
    header.version = loadLittle<std::uint32_t>(bytes, 4);
    const bool known = header.version >= 2 && header.version <= (gzipped ? 3u : 4u);
    check(known, "{}: header: SPZ version {} {}, expected 2 or 3, or 4 without gzip", file, header.version,
          gzipped ? "within gzip" : "without gzip");
    header.splats = loadLittle<std::uint32_t>(bytes, 8);
    const int degree = std::to_integer<int>(bytes[12]);
    check(degree <= 4, "{}: header: SH degree {}, expected 0 to 4", file, degree);
    header.sh_degree = std::min(degree, kMaxShDegree);
    header.sh_bytes = 3 * (static_cast<std::size_t>(shCoefficientCount(degree)) - 1);
    header.rotation_bytes = header.version == 2 ? 3 : 4;
    header.fractional_bits = std::to_integer<int>(bytes[13]);
    header.antialiased = (std::to_integer<int>(bytes[14]) & spz::kAntialiased) != 0;
    header.has_extensions = (std::to_integer<int>(bytes[14]) & spz::kHasExtensions) != 0;
    check(header.fractional_bits <= 23, "{}: header: {} fractional bits of 24, expected 0 to 23", file,
          header.fractional_bits);
    return header;
}

// All attributes, one after another, and the beginning of the extensions' records.
struct Attributes {
    std::vector<std::byte> bytes, records;
    const std::byte *positions, *alphas, *colours, *scales, *rotations, *sh;
};

// Memory for all attributes, if the file can hold that many.
Attributes reserveAttributes(const InputFile& file, const Header& header) {
    const std::uint64_t total = header.splats * header.bytesPerSplat();
    check(total <= kMaxExpansion * file.sizeBytes() + 65536,
          "{}: header: {} splats of {} bytes in a file of {}, expected fewer than {} per byte", file.name(),
          header.splats, header.bytesPerSplat(), file.sizeBytes(), kMaxExpansion);
    Attributes attributes{};
    attributes.bytes.resize(total);
    attributes.positions = attributes.bytes.data();
    attributes.alphas = attributes.positions + 9 * header.splats;
    attributes.colours = attributes.alphas + header.splats;
    attributes.scales = attributes.colours + 3 * header.splats;
    attributes.rotations = attributes.scales + 3 * header.splats;
    attributes.sh = attributes.rotations + header.rotation_bytes * header.splats;
    return attributes;
}

// Fills its target as far as there is something to read, and returns how far.
using ReadSome = std::function<std::size_t(std::span<std::byte> target)>;

// Versions 2 and 3: one stream, within gzip or bare.
Attributes readStream(InputFile& file, const ReadSome& read, const Header& header, const Progress& progress) {
    Attributes attributes = reserveAttributes(file, header);
    const std::size_t total = attributes.bytes.size();
    std::size_t got = 0;
    for (std::size_t more = 1; got < total && more > 0; got += more) {
        if (progress) { progress(kUnpackingShare * static_cast<double>(got) / static_cast<double>(total)); }
        more = read(std::span(attributes.bytes).subspan(got, std::min(total - got, kPieceBytes)));
    }
    check(got == total, "{}: data: ends after {} bytes, expected {} for {} splats", file.name(), got, total,
          header.splats);
    // The checksum is compared at the end of a gzip stream; records of extensions may come before that.
    std::array<std::byte, 4096> behind;
    std::uint64_t extra = 0;
    for (std::size_t more = 0; (more = read(behind)) > 0;) {
        if (attributes.records.size() < kMostRecords) {
            attributes.records.insert(attributes.records.end(), behind.begin(),
                                      behind.begin() + static_cast<std::ptrdiff_t>(more));
        }
        extra += more;
        check(extra <= kMaxExpansion * file.sizeBytes() + 65536,
              "{}: data: {} bytes and more behind the last splat", file.name(), extra);
    }
    return attributes;
}

// Version 4: the header is followed by the number of streams, the place of their table (two 64-bit sizes for
// each: packed, plain), and a stream per attribute, each compressed by itself. Records of extensions are
// between the header and the table.
Attributes readContainer(InputFile& file, const Header& header, std::size_t streams, std::uint64_t table_at,
                         const Progress& progress) {
    const std::array<std::uint64_t, 6> per_splat{9, 1, 3, 3, header.rotation_bytes, header.sh_bytes};
    const std::size_t least = header.sh_bytes == 0 ? 5 : 6;  // empty streams may be omitted
    check(streams >= least && streams <= 6, "{}: header: {} streams, expected {}", file.name(), streams,
          least);
    check(table_at >= file.positionBytes() && table_at <= file.sizeBytes(),
          "{}: header: the table of streams is at byte {}, expected it from {} to {}", file.name(), table_at,
          file.positionBytes(), file.sizeBytes());
    const std::span<const std::byte> start =
        file.readBlock(std::min<std::uint64_t>(table_at - file.positionBytes(), kMostRecords));
    std::vector<std::byte> records(start.begin(), start.end());
    file.skip(table_at - file.positionBytes());
    const std::span<const std::byte> table_bytes = file.readBlock(16 * streams);
    check(table_bytes.size() == 16 * streams, "{}: ends within the table of streams, at byte {}", file.name(),
          file.positionBytes());
    const std::vector<std::byte> table(table_bytes.begin(), table_bytes.end());

    Attributes attributes = reserveAttributes(file, header);
    attributes.records = std::move(records);
    std::byte* target = attributes.bytes.data();
    for (std::size_t i = 0; i < streams; ++i) {
        const auto packed = loadLittle<std::uint64_t>(table, 16 * i),
                   plain = loadLittle<std::uint64_t>(table, 16 * i + 8);
        const std::uint64_t expected = per_splat[i] * header.splats;
        check(plain == expected, "{}: stream {}: {} bytes, expected {} for {} splats", file.name(), i, plain,
              expected, header.splats);
        check(packed <= file.bytesLeft(), "{}: stream {}: {} bytes are left of {}", file.name(), i,
              file.bytesLeft(), packed);
        std::vector<std::byte> bytes(packed);
        const auto before = static_cast<double>(target - attributes.bytes.data());
        for (std::size_t done = 0, more = 0; done < packed; done += more) {
            const double read =
                static_cast<double>(plain) * static_cast<double>(done) / static_cast<double>(packed);
            if (progress) {
                progress(kUnpackingShare * (before + read) /
                         std::max(static_cast<double>(attributes.bytes.size()), 1.0));
            }
            more =
                file.read(std::span(bytes).subspan(done, std::min<std::size_t>(packed - done, kPieceBytes)));
            check(more > 0, "{}: stream {}: ends after {} of {} bytes", file.name(), i, done, packed);
        }
        const std::size_t got = ZSTD_decompress(target, plain, bytes.data(), bytes.size());
        check(ZSTD_isError(got) == 0, "{}: stream {}: broken ({})", file.name(), i, ZSTD_getErrorName(got));
        check(got == plain, "{}: stream {}: ends after {} bytes, expected {}", file.name(), i, got, plain);
        target += plain;
    }
    return attributes;
}

float loadByte(const std::byte* at) { return static_cast<float>(std::to_integer<int>(*at)); }

// 24 bits, two's complement.
float loadFixed(const std::byte* at, int fractional_bits) {
    int value = 0;
    for (int i = 0; i < 3; ++i) { value |= std::to_integer<int>(at[i]) << 8 * i; }
    if (value >= 1 << 23) { value -= 1 << 24; }
    return std::ldexp(static_cast<float>(value), -fractional_bits);
}

// w, x, y, z as stored, before the axes change. Version 2: x, y, z in bytes; w is not negative.
std::array<float, 4> loadRotation2(const std::byte* at) {
    const auto component = [&](std::size_t i) { return loadByte(at + i) / 127.5f - 1.0f; };
    return fromSmallestThree(0, {component(0), component(1), component(2)});
}

// Version 3: two bits say which of x, y, z, w is the largest; each of the others, first to last from the top,
// has a sign bit and nine bits up to 1/sqrt(2).
std::array<float, 4> loadRotation3(const std::byte* at) {
    const auto word = loadLittle<std::uint32_t>(std::span(at, 4), 0);
    const auto component = [&](int shift) {
        const float size = static_cast<float>(word >> shift & 511u) / 511.0f * 0.70710678f;
        return (word >> (shift + 9) & 1u) != 0 ? -size : size;
    };
    const std::array<float, 4> xyzw =
        fromSmallestThree(word >> 30, {component(20), component(10), component(0)});
    return {xyzw[3], xyzw[0], xyzw[1], xyzw[2]};
}

void unpackSplat(const Header& header, const SpzAxes& axes, const Attributes& attributes, std::size_t splat,
                 StoredBlock& block, std::size_t row) {
    const auto put = [&](int attribute, float value) { block.put(attribute, row, value); };
    glm::vec3 position;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const int offset = static_cast<int>(axis);
        position[offset] = loadFixed(attributes.positions + 9 * splat + 3 * axis, header.fractional_bits);
        put(kStoredScale0 + offset, loadByte(attributes.scales + 3 * splat + axis) / 16.0f - 10.0f);
        put(kStoredDc0 + offset,
            (loadByte(attributes.colours + 3 * splat + axis) / 255.0f - 0.5f) / spz::kColourScale);
    }
    position = axes.turn(position);
    for (int axis = 0; axis < 3; ++axis) { put(kStoredX + axis, position[axis] + 0.0f); }  // no -0
    put(kStoredOpacity, storedOpacity(loadByte(attributes.alphas + splat) / 255.0f));
    const std::byte* packed = attributes.rotations + header.rotation_bytes * splat;
    const std::array<float, 4> wxyz = header.version == 2 ? loadRotation2(packed) : loadRotation3(packed);
    const glm::quat rotation = axes.turn(glm::quat(wxyz[0], wxyz[1], wxyz[2], wxyz[3]));
    const std::array<float, 4> turned{rotation.w, rotation.x, rotation.y, rotation.z};
    for (int i = 0; i < 4; ++i) { put(kStoredRot0 + i, turned[static_cast<std::size_t>(i)]); }
    const int coefficients = shCoefficientCount(header.sh_degree) - 1;
    for (int channel = 0; channel < 3; ++channel) {
        float* rest = block.rest(row) + channel * coefficients;
        for (int k = 0; k < coefficients; ++k) {
            rest[k] = (loadByte(attributes.sh + header.sh_bytes * splat + 3 * k + channel) - 128.0f) / 128.0f;
        }
        axes.turnSh(rest, header.sh_degree);
    }
}

// The file's axes, or the format's own if the file names none.
SpzAxes chooseAxes(const std::string& file, const Header& header, const Attributes& attributes,
                   LoadNotes& notes, bool& known) {
    const std::optional<std::uint32_t> said =
        header.has_extensions ? findSpzAxes(attributes.records) : std::nullopt;
    if (said && *said > SpzAxes::kLast) {
        notes.lines.push_back(fmt::format("{}: names axes {}, which are not known; taken as {}", file, *said,
                                          SpzAxes().describe()));
    }
    known = said && *said > 0 && *said <= SpzAxes::kLast;
    const SpzAxes axes(known ? *said : SpzAxes::kUsual);
    notes.axes = axes.describe() + (known ? " (named by the file)" : " (SPZ's own: the file names none)");
    return axes;
}

}  // namespace

bool isSpz(InputFile& file) {
    const std::string_view mark("NGSP");
    if (file.peek(4) == mark) { return true; }
    const std::vector<std::byte> start = peekGzip(file, 4);
    return start.size() == 4 && loadLittle<std::uint32_t>(start, 0) == spz::kMagic;
}

Scene readSpz(InputFile& file, LoadNotes& notes, const Progress& progress) {
    if (progress) { progress(0.0); }
    Header header;
    Attributes attributes{};
    std::optional<GzipReader> stream;
    if (file.peek(4) != "NGSP") { stream.emplace(file); }
    const ReadSome read = [&](std::span<std::byte> target) {
        return stream ? stream->read(target) : file.read(target);
    };
    std::array<std::byte, spz::kHeaderBytes> bytes{}, more{};
    header = parseHeader(file.name(), std::span(bytes).first(read(bytes)), stream.has_value());
    if (header.version == 4) {
        const std::size_t size = read(more);
        check(size == more.size(), "{}: header: ends after {} bytes, expected {}", file.name(),
              bytes.size() + size, bytes.size() + more.size());
        attributes = readContainer(file, header, std::to_integer<std::size_t>(bytes[15]),
                                   loadLittle<std::uint32_t>(more, 0), progress);
    } else {
        attributes = readStream(file, read, header, progress);
    }
    LoadNotes of_axes;
    bool axes_known = false;
    const SpzAxes axes = chooseAxes(file.name(), header, attributes, of_axes, axes_known);

    SceneBuilder builder(file.name(), header.splats, header.sh_degree, true);
    StoredBlock block;
    for (std::uint64_t done = 0, blocks = 0; done < header.splats; done += block.rows, ++blocks) {
        if (progress && blocks % 128 == 0) {
            progress(kUnpackingShare + (1.0 - kUnpackingShare) * static_cast<double>(done) /
                                           static_cast<double>(header.splats));
        }
        block.rows =
            static_cast<std::size_t>(std::min<std::uint64_t>(StoredBlock::kRows, header.splats - done));
        for (std::size_t row = 0; row < block.rows; ++row) {
            unpackSplat(header, axes, attributes, done + row, block, row);
        }
        builder.append(block);
    }
    if (progress) { progress(1.0); }
    Scene scene = builder.finish(notes);
    notes.axes = of_axes.axes;
    notes.lines.insert(notes.lines.end(), of_axes.lines.begin(), of_axes.lines.end());
    scene.antialiased = header.antialiased;
    if (axes_known) { scene.vertical_axis = 1; }
    if (header.sh_bytes > 45) {
        notes.lines.push_back(fmt::format("{}: SH of degree 4 were left out, degree 3 is kept", file.name()));
    }
    return scene;
}

}  // namespace binosplat
