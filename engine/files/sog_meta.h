// meta.json of a SOG scene, version 1 or 2, as lookup tables: the value of each byte of each picture.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>

namespace binosplat {

// A float for each of the 256 values of a byte; NaN where the file has none, so that a splat with that byte
// is skipped.
using ByteTable = std::array<float, 256>;

inline constexpr std::size_t kSogPaletteColumns = 64;  // entries per row of the picture of centroids

// SH beyond the constant band: each splat has a label, each label a row of coefficients.
struct SogPalette {
    // 0: version 1 does not say; the picture's width does
    int sh_degree = 0;
    std::uint64_t count = std::numeric_limits<std::uint64_t>::max();  // the same
    ByteTable values{};
    std::string centroids_file, labels_file;
};

// Some of a file's splats: `count` of them from `first` on.
struct SplatRange {
    std::uint64_t first = 0, count = 0;
};

struct SogMeta {
    std::uint64_t count = 0;
    bool antialiased = false;
    // Trained as 2DGS: the shortest of the three scales is meaningless.
    bool discs = false;
    std::array<float, 3> mins{}, maxs{};     // of the positions after x -> sign(x) ln(1 + |x|)
    std::array<std::string, 2> means_files;  // low bytes, high bytes
    std::array<ByteTable, 3> scales{};
    std::string scales_file, quats_file;
    std::array<ByteTable, 4> sh0{};  // f_dc of red, green, blue; logit of the opacity
    std::string sh0_file;
    std::optional<SogPalette> palette;
};

// `place` is the file's name for messages. Throws Error naming the key and what was expected.
SogMeta parseSogMeta(std::span<const std::byte> text, const std::string& place);

}  // namespace binosplat
