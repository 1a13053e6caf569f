// A header of 4096 bytes, one of 1024 for each section, then the sections: lengths of the buckets that are
// not full, then buckets, then splats.
#include "engine/files/ksplat.h"

#include "engine/error.h"
#include "engine/files/quantized.h"
#include "engine/files/scene_builder.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace binosplat {

namespace {

constexpr std::size_t kHeaderBytes = 4096, kSectionHeaderBytes = 1024, kBucketBytes = 12;
constexpr std::uint32_t kMostSections = 65536;
constexpr int kMostDegree = 2;

// By level: bytes of a coordinate, of a scale, of a component of the rotation, and of a coefficient of the
// harmonics.
struct Level {
    std::size_t position, scale, rotation, harmonic;

    [[nodiscard]] std::size_t harmonicsAt() const { return 3 * position + 3 * scale + 4 * rotation + 4; }
};
constexpr std::array<Level, 3> kLevels{{{4, 4, 4, 4}, {2, 2, 2, 2}, {2, 2, 2, 1}}};

struct Header {
    std::uint32_t sections = 0;
    std::size_t level = 0;
    float least_harmonic = 0.0f, most_harmonic = 0.0f;  // of level 2
};

// The bytes of one section, all of which are in the file.
struct Section {
    std::string place;
    std::uint64_t splats = 0, splats_at = 0, splat_bytes = 0;
    int sh_degree = 0;
    // A coordinate is bucket centre + (value - middle) * step.
    float step = 0.0f, middle = 0.0f;
    std::uint64_t full_buckets = 0, bucket_size = 0;  // the first ones
    std::vector<std::uint32_t> other_sizes;           // of the buckets that follow
    std::vector<glm::vec3> centres;
};

Header parseHeader(const InputFile& file, std::span<const std::byte> bytes) {
    check(bytes.size() == kHeaderBytes, "{}: header: ends after {} bytes, expected {}", file.name(),
          bytes.size(), kHeaderBytes);
    Header header;
    header.sections = loadLittle<std::uint32_t>(bytes, 4);
    header.level = loadLittle<std::uint16_t>(bytes, 20);
    check(header.level < kLevels.size(), "{}: header: compression level {}, expected 0, 1 or 2", file.name(),
          header.level);
    const auto orElse = [](float value, float standard) { return value == 0.0f ? standard : value; };
    header.least_harmonic = orElse(loadLittle<float>(bytes, 36), -1.5f);
    header.most_harmonic = orElse(loadLittle<float>(bytes, 40), 1.5f);
    check(header.sections <= file.bytesLeft() / kSectionHeaderBytes,
          "{}: header: {} sections, but only {} bytes are left for their headers", file.name(),
          header.sections, file.bytesLeft());
    return header;
}

// `at` is where the section's bytes begin; it is moved to their end.
Section openSection(const InputFile& file, const Header& header, std::uint32_t index,
                    std::span<const std::byte> bytes, std::uint64_t& at) {
    Section section;
    section.place = fmt::format("{}: section {}", file.name(), index);
    check(bytes.size() == kSectionHeaderBytes, "{}: header: ends after {} bytes, expected {}", section.place,
          bytes.size(), kSectionHeaderBytes);
    const auto word = [&](std::size_t offset) {
        return std::uint64_t{loadLittle<std::uint32_t>(bytes, offset)};
    };
    const Level& level = kLevels[header.level];
    const std::uint64_t room = word(4), buckets = word(12), range = word(24) == 0 ? 32767 : word(24),
                        others = word(36);
    const std::uint64_t bucket_bytes = loadLittle<std::uint16_t>(bytes, 20);
    section.splats = word(0);
    section.bucket_size = word(8);
    section.full_buckets = word(32);
    section.sh_degree = loadLittle<std::uint16_t>(bytes, 40);
    check(section.splats <= room, "{}: header: {} splats with room for {}", section.place, section.splats,
          room);
    check(section.sh_degree <= kMostDegree, "{}: header: SH degree {}, expected 0 to {}", section.place,
          section.sh_degree, kMostDegree);
    section.splat_bytes =
        level.harmonicsAt() +
        3 * (static_cast<std::uint64_t>(shCoefficientCount(section.sh_degree)) - 1) * level.harmonic;
    // Each of these easily fits into 64 bits.
    const std::uint64_t bytes_needed = 4 * others + bucket_bytes * buckets + section.splat_bytes * room,
                        left = file.sizeBytes() - at;
    check(bytes_needed <= left, "{}: data: {} bytes are left of {} for {} splats and {} buckets",
          section.place, left, bytes_needed, room, buckets);

    std::uint64_t held = section.full_buckets * section.bucket_size;
    if (header.level > 0) {
        check(bucket_bytes == kBucketBytes || buckets == 0, "{}: header: {} bytes a bucket, expected {}",
              section.place, bucket_bytes, kBucketBytes);
        check(section.full_buckets <= buckets && others == buckets - section.full_buckets,
              "{}: header: {} full and {} other buckets, expected {} in all", section.place,
              section.full_buckets, others, buckets);
        section.middle = static_cast<float>(range);
        section.step = loadLittle<float>(bytes, 16) / 2.0f / section.middle;
        std::vector<std::byte> stored(4 * others + kBucketBytes * buckets);
        check(file.readAt(at, stored) == stored.size(), "{}: data: ends within the buckets", section.place);
        for (std::size_t i = 0; i < others; ++i) {
            section.other_sizes.push_back(loadLittle<std::uint32_t>(stored, 4 * i));
            held += section.other_sizes.back();
        }
        for (std::size_t i = 0; i < buckets; ++i) {
            const auto coordinate = [&](std::size_t axis) {
                return loadLittle<float>(stored, 4 * others + kBucketBytes * i + 4 * axis);
            };
            section.centres.emplace_back(coordinate(0), coordinate(1), coordinate(2));
        }
        check(held >= section.splats, "{}: data: {} buckets hold {} splats, expected {}", section.place,
              buckets, held, section.splats);
    }
    section.splats_at = at + 4 * others + bucket_bytes * buckets;
    at += bytes_needed;
    return section;
}

// The bucket of a splat; splats are asked for in order.
class Buckets {
public:
    explicit Buckets(const Section& section) : section_(section) { rest_ = sizeOf(0); }

    const glm::vec3& next() {
        while (rest_ == 0) { rest_ = sizeOf(++index_); }
        --rest_;
        return section_.centres[index_];
    }

private:
    [[nodiscard]] std::uint64_t sizeOf(std::size_t index) const {
        return index < section_.full_buckets  ? section_.bucket_size
               : section_.other_sizes.empty() ? 0
                                              : section_.other_sizes[index - section_.full_buckets];
    }

    const Section& section_;
    std::size_t index_ = 0;
    std::uint64_t rest_ = 0;
};

float loadFloat(std::span<const std::byte> bytes, std::size_t offset, std::size_t size) {
    return size == 4 ? loadLittle<float>(bytes, offset)
                     : glm::unpackHalf1x16(loadLittle<std::uint16_t>(bytes, offset));
}

// `sh_degree` is the builder's, at least the section's; the block's old content is overwritten.
void unpackSplat(const Header& header, const Section& section, std::span<const std::byte> bytes,
                 Buckets& buckets, int sh_degree, StoredBlock& block, std::size_t row) {
    const Level& level = kLevels[header.level];
    const auto put = [&](int attribute, float value) { block.put(attribute, row, value); };
    const std::size_t scales_at = 3 * level.position, rotation_at = scales_at + 3 * level.scale,
                      colour_at = rotation_at + 4 * level.rotation;
    const glm::vec3 centre = header.level == 0 ? glm::vec3(0.0f) : buckets.next();
    for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        put(kStoredX + axis,
            header.level == 0 ? loadLittle<float>(bytes, 4 * i)
                              : centre[axis] + (static_cast<float>(loadLittle<std::uint16_t>(bytes, 2 * i)) -
                                                section.middle) *
                                                   section.step);
        put(kStoredScale0 + axis, storedScale(loadFloat(bytes, scales_at + level.scale * i, level.scale)));
        put(kStoredDc0 + axis,
            storedColour(static_cast<float>(std::to_integer<int>(bytes[colour_at + i])) / 255.0f));
    }
    put(kStoredOpacity,
        storedOpacity(static_cast<float>(std::to_integer<int>(bytes[colour_at + 3])) / 255.0f));
    for (std::size_t i = 0; i < 4; ++i) {
        put(kStoredRot0 + static_cast<int>(i),
            loadFloat(bytes, rotation_at + level.rotation * i, level.rotation));
    }

    const std::size_t in_block = static_cast<std::size_t>(shCoefficientCount(sh_degree)) - 1;
    std::fill_n(block.rest(row), 3 * in_block, 0.0f);
    // Band by band, the channels of each one after the other.
    std::size_t at = level.harmonicsAt();
    for (std::size_t band = 1; band <= static_cast<std::size_t>(section.sh_degree); ++band) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            for (std::size_t k = band * band - 1; k < (band + 1) * (band + 1) - 1;
                 ++k, at += level.harmonic) {
                const float share = static_cast<float>(std::to_integer<int>(bytes[at])) / 255.0f;
                block.rest(row)[channel * in_block + k] =
                    level.harmonic > 1
                        ? loadFloat(bytes, at, level.harmonic)
                        : header.least_harmonic * (1.0f - share) + header.most_harmonic * share;
            }
        }
    }
}

}  // namespace

bool isKsplat(InputFile& file) {
    const std::string_view start = file.peek(24);
    const std::span<const std::byte> bytes = std::as_bytes(std::span(start.data(), start.size()));
    if (bytes.size() < 24 || loadLittle<std::uint32_t>(bytes, 0) != 0x100) { return false; }  // version 0.1
    const auto word = [&](std::size_t offset) { return loadLittle<std::uint32_t>(bytes, offset); };
    return word(4) >= 1 && word(4) <= kMostSections && word(8) <= word(4) &&
           loadLittle<std::uint16_t>(bytes, 20) < 256;
}

Scene readKsplat(InputFile& file, LoadNotes& notes, const Progress& progress) {
    const Header header = parseHeader(file, file.readBlock(kHeaderBytes));
    std::uint64_t at = kHeaderBytes + std::uint64_t{kSectionHeaderBytes} * header.sections, total = 0;
    int sh_degree = 0;
    std::vector<Section> sections;
    for (std::uint32_t i = 0; i < header.sections; ++i) {
        sections.push_back(openSection(file, header, i, file.readBlock(kSectionHeaderBytes), at));
        total += sections.back().splats;
        if (sections.back().splats > 0) { sh_degree = std::max(sh_degree, sections.back().sh_degree); }
    }
    SceneBuilder builder(file.name(), total, sh_degree, true);
    StoredBlock block;
    std::vector<std::byte> rows;
    std::uint64_t done = 0, blocks = 0;
    for (const Section& section : sections) {
        Buckets buckets(section);
        for (std::uint64_t first = 0; first < section.splats; first += block.rows) {
            if (progress && blocks++ % 128 == 0) {
                progress(static_cast<double>(done) / static_cast<double>(total));
            }
            block.rows =
                static_cast<std::size_t>(std::min<std::uint64_t>(StoredBlock::kRows, section.splats - first));
            rows.resize(block.rows * section.splat_bytes);
            check(file.readAt(section.splats_at + first * section.splat_bytes, rows) == rows.size(),
                  "{}: data: ends before splat {} of {}", section.place, first + block.rows, section.splats);
            for (std::size_t row = 0; row < block.rows; ++row) {
                unpackSplat(header, section,
                            std::span(rows).subspan(row * section.splat_bytes, section.splat_bytes), buckets,
                            sh_degree, block, row);
            }
            builder.append(block);
            done += block.rows;
        }
    }
    if (progress) { progress(1.0); }
    return builder.finish(notes);
}

}  // namespace binosplat
