// Unpacks words of 11, 10 and 8 bits between the bounds of their chunk.
#include "engine/files/compressed_ply.h"

#include "engine/error.h"
#include "engine/files/ply.h"
#include "engine/files/ply_header.h"
#include "engine/files/quantized.h"
#include "engine/files/scene_builder.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace binosplat {

namespace {

constexpr std::uint64_t kChunkSplats = 256;
static_assert(kChunkSplats == StoredBlock::kRows);  // a block is a chunk

constexpr std::array<const char*, 18> kBoundNames{
    "min_x",       "min_y",       "min_z",       "max_x",       "max_y",       "max_z",
    "min_scale_x", "min_scale_y", "min_scale_z", "max_scale_x", "max_scale_y", "max_scale_z",
    "min_r",       "min_g",       "min_b",       "max_r",       "max_g",       "max_b"};
constexpr std::size_t kBoundsWithoutColour = 12;
constexpr std::array<const char*, 4> kWordNames{"packed_position", "packed_rotation", "packed_scale",
                                                "packed_color"};

using Bounds = std::array<float, kBoundNames.size()>;

// Where the wanted properties of one element are within a row.
struct Fields {
    std::vector<std::size_t> offsets;
    std::size_t row_bytes = 0;
};

// Each of `names` must be present exactly once, with the format's type.
Fields findFields(const InputFile& file, const ply::Element& element, ply::Type type, const char* type_name,
                  std::span<const std::string> names) {
    Fields fields;
    fields.offsets.assign(names.size(), SIZE_MAX);
    for (const ply::Property& property : element.properties) {
        check(!property.is_list, "{}: header: property {} of element {} is a list, expected scalars only",
              file.name(), property.name, element.name);
        const auto name = std::find(names.begin(), names.end(), property.name);
        if (name != names.end()) {
            std::size_t& offset = fields.offsets[static_cast<std::size_t>(name - names.begin())];
            check(offset == SIZE_MAX, "{}: header: property {} of element {} twice", file.name(),
                  property.name, element.name);
            check(property.type == type,
                  "{}: header: property {} of element {} has another type, expected {}", file.name(),
                  property.name, element.name, type_name);
            offset = fields.row_bytes;
        }
        fields.row_bytes += ply::typeBytes(property.type);
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
        check(fields.offsets[i] != SIZE_MAX,
              "{}: header: element {} has no property {}, expected the ones of a compressed PLY", file.name(),
              element.name, names[i]);
    }
    return fields;
}

// Its elements, checked against each other and against the rest of the file.
struct ChunkLayout {
    std::uint64_t splats = 0, chunks = 0;
    Fields bounds, words, rest;
    int sh_degree = 0;
};

bool hasProperty(const ply::Element& element, std::string_view name) {
    return std::any_of(element.properties.begin(), element.properties.end(),
                       [&](const ply::Property& p) { return p.name == name; });
}

ChunkLayout planElements(const InputFile& file, const ply::Header& header) {
    check(header.encoding == ply::Encoding::kLittleEndian,
          "{}: header: a compressed PLY in another encoding, expected binary_little_endian", file.name());
    const std::vector<ply::Element>& elements = header.elements;
    const bool known = (elements.size() == 2 || (elements.size() == 3 && elements[2].name == "sh")) &&
                       elements[0].name == "chunk" && elements[1].name == "vertex";
    check(known,
          "{}: header: other elements than those of a compressed PLY, expected chunk, vertex and perhaps sh, "
          "in this order",
          file.name());

    ChunkLayout layout;
    layout.chunks = elements[0].count;
    layout.splats = elements[1].count;
    const std::size_t bound_count =
        hasProperty(elements[0], "min_r") ? kBoundNames.size() : kBoundsWithoutColour;
    const std::vector<std::string> bound_names(
        kBoundNames.begin(), kBoundNames.begin() + static_cast<std::ptrdiff_t>(bound_count));
    const std::vector<std::string> word_names(kWordNames.begin(), kWordNames.end());
    layout.bounds = findFields(file, elements[0], ply::Type::kFloat32, "float", bound_names);
    layout.words = findFields(file, elements[1], ply::Type::kUint32, "uint", word_names);
    check(layout.chunks == layout.splats / kChunkSplats + (layout.splats % kChunkSplats != 0),
          "{}: header: {} chunks for {} splats, expected one for each {} splats", file.name(), layout.chunks,
          layout.splats, kChunkSplats);
    if (elements.size() == 3) {
        const std::size_t rest_count = elements[2].properties.size();
        check(rest_count == 9 || rest_count == 24 || rest_count == 45,
              "{}: header: element sh has {} properties, expected 9, 24 or 45", file.name(), rest_count);
        check(elements[2].count == layout.splats,
              "{}: header: {} rows of element sh for {} splats, expected one each", file.name(),
              elements[2].count, layout.splats);
        std::vector<std::string> rest_names;
        for (std::size_t i = 0; i < rest_count; ++i) { rest_names.push_back(fmt::format("f_rest_{}", i)); }
        layout.rest = findFields(file, elements[2], ply::Type::kUint8, "uchar", rest_names);
        layout.sh_degree = rest_count == 9 ? 1 : rest_count == 24 ? 2 : 3;
    }
    // Row sizes are under 1 MiB (the header's limit), so only the counts can be absurd.
    const std::uint64_t left = file.bytesLeft();
    const std::uint64_t per_splat = layout.words.row_bytes + layout.rest.row_bytes;
    check(layout.splats <= left / per_splat &&
              layout.chunks <= (left - layout.splats * per_splat) / layout.bounds.row_bytes,
          "{}: data: {} bytes are left for {} chunks of {} bytes and {} splats of {} bytes each", file.name(),
          left, layout.chunks, layout.bounds.row_bytes, layout.splats, per_splat);
    return layout;
}

std::span<const std::byte> readRow(InputFile& file, const Fields& fields, const char* element,
                                   std::uint64_t row) {
    const std::span<const std::byte> bytes = file.readBlock(fields.row_bytes);
    check(bytes.size() == fields.row_bytes, "{}: data: ends in row {} of element {}", file.name(), row,
          element);
    return bytes;
}

std::vector<Bounds> readBounds(InputFile& file, const ChunkLayout& layout) {
    std::vector<Bounds> all(layout.chunks);
    for (std::uint64_t chunk = 0; chunk < layout.chunks; ++chunk) {
        const std::span<const std::byte> row = readRow(file, layout.bounds, "chunk", chunk);
        Bounds& bounds = all[chunk];
        for (std::size_t i = 0; i < 3; ++i) {
            bounds[kBoundsWithoutColour + i] = 0.0f, bounds[kBoundsWithoutColour + 3 + i] = 1.0f;
        }
        for (std::size_t i = 0; i < layout.bounds.offsets.size(); ++i) {
            bounds[i] = loadLittle<float>(row, layout.bounds.offsets[i]);
        }
    }
    return all;
}

// The `bits` bits of a word from `shift` on as 0 to 1.
float unpack(std::uint32_t word, int shift, int bits) {
    const std::uint32_t mask = (1u << bits) - 1u;
    return static_cast<float>(word >> shift & mask) / static_cast<float>(mask);
}

// Bits from the top: x 11, y 10, z 11.
std::array<float, 3> unpackVector(std::uint32_t word) {
    return {unpack(word, 21, 11), unpack(word, 11, 10), unpack(word, 0, 11)};
}

using Words = std::array<std::uint32_t, kWordNames.size()>;

void unpackSplat(const Words& words, const Bounds& bounds, StoredBlock& block, std::size_t row) {
    const auto put = [&](int attribute, float value) { block.put(attribute, row, value); };
    const auto between = [&](std::size_t low, std::size_t axis, float share) {
        return bounds[low + axis] * (1.0f - share) + bounds[low + 3 + axis] * share;
    };
    const std::array<float, 3> position = unpackVector(words[0]), scale = unpackVector(words[2]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const int offset = static_cast<int>(axis);
        put(kStoredX + offset, between(0, axis, position[axis]));
        put(kStoredScale0 + offset, between(6, axis, scale[axis]));
        put(kStoredDc0 + offset,
            storedColour(between(kBoundsWithoutColour, axis, unpack(words[3], 24 - 8 * offset, 8))));
    }
    put(kStoredOpacity, storedOpacity(unpack(words[3], 0, 8)));
    // Two bits for the largest component (w, x, y, z), then ten for each of the others, from -1/sqrt(2) to
    // 1/sqrt(2).
    const auto component = [&](int shift) { return (unpack(words[1], shift, 10) - 0.5f) * 1.41421356f; };
    const std::array<float, 4> rotation =
        fromSmallestThree(words[1] >> 30, {component(20), component(10), component(0)});
    for (std::size_t i = 0; i < 4; ++i) { put(kStoredRot0 + static_cast<int>(i), rotation[i]); }
}

// Bytes stand for the middle of their interval within -4 to 4; the first and the last stand for its ends.
float unpackRest(std::byte value) {
    const int level = std::to_integer<int>(value);
    const float share = level == 0 ? 0.0f : level == 255 ? 1.0f : (static_cast<float>(level) + 0.5f) / 256.0f;
    return (share - 0.5f) * 8.0f;
}

}  // namespace

bool isCompressedPly(InputFile& file) {
    if (!isPly(file)) { return false; }
    constexpr std::size_t kHeaderReach = std::size_t{1} << 16;
    const std::string_view start = file.peek(kHeaderReach);
    const std::string_view header = start.substr(0, start.find("end_header"));
    return header.find(" packed_position\n") != std::string_view::npos ||
           header.find(" packed_position\r\n") != std::string_view::npos;
}

Scene readCompressedPly(InputFile& file, LoadNotes& notes, const Progress& progress) {
    const ply::Header header = ply::readHeader(file);
    const ChunkLayout layout = planElements(file, header);
    const std::vector<Bounds> bounds = readBounds(file, layout);
    // SH come after all words, so the words wait in memory.
    std::vector<Words> all_words(layout.splats);
    for (std::uint64_t splat = 0; splat < layout.splats; ++splat) {
        const std::span<const std::byte> row = readRow(file, layout.words, "vertex", splat);
        for (std::size_t i = 0; i < kWordNames.size(); ++i) {
            all_words[splat][i] = loadLittle<std::uint32_t>(row, layout.words.offsets[i]);
        }
    }
    SceneBuilder builder(file.name(), layout.splats, layout.sh_degree, true);
    StoredBlock block;
    for (std::uint64_t chunk = 0; chunk < layout.chunks; ++chunk) {
        if (progress && chunk % 128 == 0) {
            progress(static_cast<double>(chunk) / static_cast<double>(layout.chunks));
        }
        const std::uint64_t first = chunk * kChunkSplats;
        block.rows = static_cast<std::size_t>(std::min(kChunkSplats, layout.splats - first));
        for (std::size_t row = 0; row < block.rows; ++row) {
            unpackSplat(all_words[first + row], bounds[chunk], block, row);
            if (layout.sh_degree == 0) { continue; }
            const std::span<const std::byte> rest = readRow(file, layout.rest, "sh", first + row);
            for (std::size_t i = 0; i < layout.rest.offsets.size(); ++i) {
                block.rest(row)[i] = unpackRest(rest[layout.rest.offsets[i]]);
            }
        }
        builder.append(block);
    }
    if (progress) { progress(1.0); }
    Scene scene = builder.finish(notes);
    scene.antialiased = header.antialiased;
    scene.vertical_axis = header.vertical_axis;
    if (header.vertical_axis >= 0) {
        notes.axes = fmt::format("{} is vertical (named by the file)", "xyz"[header.vertical_axis]);
    }
    return scene;
}

}  // namespace binosplat
