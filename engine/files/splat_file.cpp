// Rows of .splat files, and the guess whether a file is one.
#include "engine/files/splat_file.h"

#include "engine/error.h"
#include "engine/files/quantized.h"
#include "engine/files/scene_builder.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace binosplat {

namespace {

constexpr std::size_t kSplatBytes = 32;

float loadByte(std::span<const std::byte> row, std::size_t offset) {
    return static_cast<float>(std::to_integer<int>(row[offset]));
}
float loadRotation(std::span<const std::byte> row, std::size_t i) {
    return (loadByte(row, 28 + i) - 128.0f) / 128.0f;
}

bool isRotation(std::span<const std::byte> row, const std::array<int, 4>& bytes) {
    return std::ranges::equal(row.subspan(28, 4), bytes, {},
                              [](std::byte byte) { return std::to_integer<int>(byte); });
}
// A quaternion of length zero, from writers without rotations.
bool isNoRotation(std::span<const std::byte> row) { return isRotation(row, {128, 128, 128, 128}); }
// One of length 2, which some writers leave in every row; it is normalised like any other.
bool isLongRotation(std::span<const std::byte> row) { return isRotation(row, {255, 0, 0, 0}); }

bool isPlausible(std::span<const std::byte> row) {
    float length2 = 0.0f;
    for (std::size_t i = 0; i < 4; ++i) { length2 += loadRotation(row, i) * loadRotation(row, i); }
    bool plausible = (length2 > 0.9f && length2 < 1.1f) || isNoRotation(row) || isLongRotation(row);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float position = loadLittle<float>(row, 4 * axis),
                    scale = loadLittle<float>(row, 12 + 4 * axis);
        plausible = plausible && std::abs(position) < 1e9f && scale >= 0.0f && scale < 1e9f;
    }
    return plausible;
}

}  // namespace

bool isSplatFile(InputFile& file) {
    constexpr std::size_t kSamples = 1024;
    const std::string_view start = file.peek(kSamples * kSplatBytes);
    const std::span<const std::byte> bytes = std::as_bytes(std::span(start.data(), start.size()));
    std::size_t plausible = 0;
    const std::size_t samples = bytes.size() / kSplatBytes;
    for (std::size_t i = 0; i < samples; ++i) {
        plausible += isPlausible(bytes.subspan(i * kSplatBytes, kSplatBytes));
    }
    // A few may be broken; they are counted when they are read.
    return samples > 0 && 10 * plausible >= 9 * samples;
}

Scene readSplatFile(InputFile& file, LoadNotes& notes, const Progress& progress) {
    const std::uint64_t splats = file.bytesLeft() / kSplatBytes;
    check(file.bytesLeft() % kSplatBytes == 0, "{}: data: ends in splat {}: {} bytes, expected {} per splat",
          file.name(), splats, file.bytesLeft(), kSplatBytes);
    SceneBuilder builder(file.name(), splats, 0, true);
    StoredBlock block;
    for (std::uint64_t done = 0, blocks = 0; done < splats; done += block.rows, ++blocks) {
        if (progress && blocks % 128 == 0) {
            progress(static_cast<double>(done) / static_cast<double>(splats));
        }
        block.rows = static_cast<std::size_t>(std::min<std::uint64_t>(StoredBlock::kRows, splats - done));
        const std::span<const std::byte> bytes = file.readBlock(block.rows * kSplatBytes);
        check(bytes.size() == block.rows * kSplatBytes, "{}: data: ends in splat {} of {}", file.name(),
              done + bytes.size() / kSplatBytes, splats);
        for (std::size_t row = 0; row < block.rows; ++row) {
            const std::span<const std::byte> splat = bytes.subspan(row * kSplatBytes, kSplatBytes);
            const auto put = [&](int attribute, float value) { block.column(attribute)[row] = value; };
            for (int axis = 0; axis < 3; ++axis) {
                const auto i = static_cast<std::size_t>(axis);
                put(kStoredX + axis, loadLittle<float>(splat, 4 * i));
                put(kStoredScale0 + axis, storedScale(loadLittle<float>(splat, 12 + 4 * i)));
                put(kStoredDc0 + axis, storedColour(loadByte(splat, 24 + i) / 255.0f));
            }
            put(kStoredOpacity, storedOpacity(loadByte(splat, 27) / 255.0f));
            for (int i = 0; i < 4; ++i) {
                put(kStoredRot0 + i, loadRotation(splat, static_cast<std::size_t>(i)));
            }
            if (isNoRotation(splat)) { put(kStoredRot0, 1.0f); }
        }
        builder.append(block);
    }
    if (progress) { progress(1.0); }
    return builder.finish(notes);
}

}  // namespace binosplat
