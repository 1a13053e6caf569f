// SPZ files made to measure.
#pragma once

#include "tests/engine/files/packed_bytes.h"
#include "tests/engine/files/ply_files.h"

#include <zstd.h>

namespace binosplat::test {

inline std::string gzip(const std::string& bytes) { return deflated(bytes, MAX_WBITS + 16); }

// The stream of an SPZ file before compression, with a column for each attribute.
struct SpzText {
    std::uint32_t version = 3, splats = 0;
    int sh_degree = 0, fractional_bits = 12, flags = 0;
    std::vector<int> positions{}, alphas{}, colours{}, scales{}, rotations{}, sh{};

    [[nodiscard]] std::string bytes() const {
        std::string text = "NGSP" + littleWord(version) + littleWord(splats);
        for (const int value : {sh_degree, fractional_bits, flags, 0}) {
            text.push_back(static_cast<char>(value));
        }
        for (const int value : positions) { text += littleWord(value, 3); }
        for (const auto& column : {alphas, colours, scales, rotations, sh}) {
            for (const int value : column) { text.push_back(static_cast<char>(value)); }
        }
        return text;
    }
};

// Two splats of SH degree 1.
inline SpzText makeSpz(std::uint32_t version) {
    SpzText spz{.version = version,
                .splats = 2,
                .sh_degree = 1,
                .fractional_bits = 8,
                .positions = {256, -512, 128, 0, 1, -1},
                .alphas = {255, 51},
                .colours = {0, 255, 128, 10, 20, 30},
                .scales = {160, 176, 32, 0, 255, 160}};
    // Version 2: almost no turn; half a turn about x. Version 3: w largest, the others +0; z largest, x =
    // -256/511/sqrt(2), the others +0.
    spz.rotations = version == 2 ? std::vector{128, 128, 128, 255, 128, 128}
                                 : std::vector{0, 0, 0, 0xc0, 0, 0, 0, 0x80 | 0x20 | 0x10};
    for (int i = 0; i < 18; ++i) { spz.sh.push_back(128 + 4 * i); }
    return spz;
}

// The same in a container of version 4, with `extension` between header and table.
inline std::string makeSpzContainer(const SpzText& spz, const std::string& extension = "") {
    const std::string plain = spz.bytes();
    std::string table, data;
    const std::size_t sizes[] = {9u * spz.splats, spz.splats,      3u * spz.splats,
                                 3u * spz.splats, 4u * spz.splats, spz.sh.size()};
    char streams = 0;
    for (std::size_t at = 16; const std::size_t size : sizes) {
        if (size == 0) { continue; }
        std::string packed(ZSTD_compressBound(size), '\0');
        packed.resize(ZSTD_compress(packed.data(), packed.size(), plain.data() + at, size, 3));
        table += littleWord(packed.size(), 8) + littleWord(size, 8);
        data += packed;
        at += size;
        ++streams;
    }
    return plain.substr(0, 15) + streams + littleWord(32 + extension.size()) + std::string(12, '\0') +
           extension + table + data;
}

inline std::string spzRecord(std::uint32_t type, const std::string& content) {
    return littleWord(type) + littleWord(content.size()) + content;
}

inline std::string spzAxesRecord(int system) {
    return spzRecord(0xadbe0003u, std::string{static_cast<char>(system), '\0', '\0', '\0'});
}

}  // namespace binosplat::test
