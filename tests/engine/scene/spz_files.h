// SPZ files made to measure.
#pragma once

#include "tests/engine/scene/ply_files.h"

#include <zlib.h>
#include <zstd.h>

namespace binosplat::test {

inline std::string gzip(const std::string& bytes) {
    std::string packed(compressBound(static_cast<uLong>(bytes.size())) + 64, '\0');
    z_stream stream{};
    REQUIRE(deflateInit2(&stream, 9, Z_DEFLATED, MAX_WBITS + 16, 8, Z_DEFAULT_STRATEGY) == Z_OK);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    REQUIRE(deflate(&stream, Z_FINISH) == Z_STREAM_END);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

inline std::string textOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

inline std::string gunzip(const std::string& bytes) {
    std::string plain(std::size_t{1} << 22, '\0');
    z_stream stream{};
    REQUIRE(inflateInit2(&stream, MAX_WBITS + 16) == Z_OK);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(plain.data());
    stream.avail_out = static_cast<uInt>(plain.size());
    REQUIRE(inflate(&stream, Z_FINISH) == Z_STREAM_END);
    plain.resize(stream.total_out);
    inflateEnd(&stream);
    return plain;
}

// The stream of an SPZ file before compression, a column per attribute.
struct SpzText {
    std::uint32_t version = 3, splats = 0;
    int sh_degree = 0, fractional_bits = 12, flags = 0;
    std::vector<int> positions, alphas, colours, scales, rotations, sh;

    [[nodiscard]] std::string bytes() const {
        std::string text = "NGSP";
        const auto word = [&](std::uint32_t value, int count) {
            for (int i = 0; i < count; ++i) { text.push_back(static_cast<char>(value >> 8 * i & 0xff)); }
        };
        word(version, 4);
        word(splats, 4);
        for (const int value : {sh_degree, fractional_bits, flags, 0}) { text.push_back(static_cast<char>(value)); }
        for (const int value : positions) { word(static_cast<std::uint32_t>(value), 3); }
        for (const auto& column : {alphas, colours, scales, rotations, sh}) {
            for (const int value : column) { text.push_back(static_cast<char>(value)); }
        }
        return text;
    }
};

// Two splats of SH degree 1.
inline SpzText makeSpz(std::uint32_t version) {
    SpzText spz{version, 2, 1, 8, 0, {256, -512, 128, 0, 1, -1}, {255, 51}, {0, 255, 128, 10, 20, 30}, {160, 176, 32, 0, 255, 160}, {}, {}};
    if (version == 2) {
        spz.rotations = {128, 128, 128, 255, 128, 128};  // nearly none; half a turn about x
    } else {
        // w largest, the others +0; z largest, x = -256/511/sqrt(2), the others +0.
        spz.rotations = {0, 0, 0, 0xc0, 0, 0, 0, 0x80 | 0x20 | 0x10};
    }
    for (int i = 0; i < 18; ++i) { spz.sh.push_back(128 + 4 * i); }
    return spz;
}

// The same as a container of version 4, with `extension` between header and table.
inline std::string makeSpzContainer(const SpzText& spz, const std::string& extension = "") {
    const std::string plain = spz.bytes();
    std::string file = plain.substr(0, 15), table, data;
    const std::size_t sizes[] = {9u * spz.splats, spz.splats, 3u * spz.splats, 3u * spz.splats, 4u * spz.splats, spz.sh.size()};
    char streams = 0;
    const auto put = [](std::string& text, std::uint64_t value, int bytes) {
        for (int i = 0; i < bytes; ++i) { text.push_back(static_cast<char>(value >> 8 * i & 0xff)); }
    };
    std::size_t at = 16;
    for (const std::size_t size : sizes) {
        if (size == 0) { continue; }
        std::string packed(ZSTD_compressBound(size), '\0');
        packed.resize(ZSTD_compress(packed.data(), packed.size(), plain.data() + at, size, 3));
        put(table, packed.size(), 8);
        put(table, size, 8);
        data += packed;
        at += size;
        ++streams;
    }
    file.push_back(streams);
    put(file, 32 + extension.size(), 4);
    return file + std::string(12, '\0') + extension + table + data;
}

// A record of an extension.
inline std::string spzRecord(std::uint32_t type, const std::string& content) {
    std::string bytes;
    for (const auto value : {type, static_cast<std::uint32_t>(content.size())}) {
        for (int i = 0; i < 4; ++i) { bytes.push_back(static_cast<char>(value >> 8 * i & 0xff)); }
    }
    return bytes + content;
}

// Of the one that names axes.
inline std::string spzAxesRecord(int system) { return spzRecord(0xadbe0003u, std::string{static_cast<char>(system), '\0', '\0', '\0'}); }

}  // namespace binosplat::test
