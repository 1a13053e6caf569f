// SOG scenes made to measure, as a directory or a bundle.
#pragma once

#include "tests/engine/scene/ply_files.h"
#include "tests/engine/scene/webp_bytes.h"

#include <zlib.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace binosplat::test {

// By file name, meta.json among them.
using SogText = std::map<std::string, std::string>;

inline std::string codebook(double first, double step, int entries = 256) {
    std::string text = "[";
    for (int i = 0; i < entries; ++i) { text += fmt::format("{}{}", i == 0 ? "" : ",", first + step * i); }
    return text + "]";
}

// Eight splats in pictures of 3 x 3. Splat i lies at the share i/8 between the bounds on x (bytes 32 i above, 0 below), 0 on y, 1 on z;
// its scales are the codebook's entries 10 i, 10 i + 1, 10 i + 2 and its colour 20 i, 20 i + 1, 20 i + 2; opacity i/8 of 255.
inline SogText makeSog(int version = 2, bool with_palette = true) {
    std::vector<std::uint8_t> low(36, 0), high(36, 0), scales(36, 0), quats(36, 0), sh0(36, 0), labels(36, 0);
    for (std::uint8_t i = 0; i < 8; ++i) {
        std::uint8_t* at = low.data() + 4 * i;
        at[2] = 255;
        at = high.data() + 4 * i;
        at[0] = static_cast<std::uint8_t>(32 * i), at[2] = 255;
        at = scales.data() + 4 * i;
        at[0] = static_cast<std::uint8_t>(10 * i), at[1] = static_cast<std::uint8_t>(10 * i + 1),
        at[2] = static_cast<std::uint8_t>(10 * i + 2);
        at = quats.data() + 4 * i;
        at[0] = at[1] = at[2] = 128, at[3] = static_cast<std::uint8_t>(252 + i % 4);
        at = sh0.data() + 4 * i;
        at[0] = static_cast<std::uint8_t>(20 * i), at[1] = static_cast<std::uint8_t>(20 * i + 1),
        at[2] = static_cast<std::uint8_t>(20 * i + 2);
        at[3] = static_cast<std::uint8_t>(255 * i / 8);
        labels[4u * i] = static_cast<std::uint8_t>(i % 2 == 0 ? 65 : 1);  // in the second row of the palette, or the first
    }
    // Degree 1: 64 entries of three pixels a row; entry e, coefficient k has the bytes (e, k, 100).
    std::vector<std::uint8_t> centroids(192 * 2 * 4, 255);
    for (std::size_t entry = 0; entry < 128; ++entry) {
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint8_t* at = centroids.data() + 4 * (entry / 64 * 192 + entry % 64 * 3 + k);
            at[0] = static_cast<std::uint8_t>(entry), at[1] = static_cast<std::uint8_t>(k), at[2] = 100;
        }
    }
    SogText files{{"l.webp", makeWebp(3, 3, low, false)},
                  {"u.webp", makeWebp(3, 3, high, false)},
                  {"s.webp", makeWebp(3, 3, scales, false)},
                  {"q.webp", makeWebp(3, 3, quats)},
                  {"c.webp", makeWebp(3, 3, sh0)}};
    const std::string means = R"("mins":[-1,-2,0],"maxs":[1,0,0.6931471805599453],"files":["l.webp","u.webp"])";
    std::string meta, palette;
    if (with_palette) {
        files["p.webp"] = makeWebp(192, 2, centroids, false);
        files["n.webp"] = makeWebp(3, 3, labels, false);
        palette = version == 2
                      ? R"(,"shN":{"count":128,"bands":1,"codebook":)" + codebook(-2, 1.0 / 64) + R"(,"files":["p.webp","n.webp"]})"
                      : R"(,"shN":{"shape":[8,9],"mins":-2,"maxs":1.984375,"quantization":8,"files":["p.webp","n.webp"]})";
    }
    if (version == 2) {
        meta = R"({"version":2,"count":8,"means":{)" + means + R"(},"scales":{"codebook":)" + codebook(-8, 1.0 / 32) +
               R"(,"files":["s.webp"]},"quats":{"files":["q.webp"]},"sh0":{"codebook":)" + codebook(-2, 1.0 / 64) +
               R"(,"files":["c.webp"]})" + palette + "}";
    } else {
        meta = R"({"means":{"shape":[8,3],"dtype":"float32",)" + means +
               R"(},"scales":{"shape":[8,3],"mins":[-8,-8,-8],"maxs":[-0.03125,-0.03125,-0.03125],"files":["s.webp"]},)"
               R"("quats":{"shape":[8,4],"encoding":"quaternion_packed","files":["q.webp"]},)"
               R"("sh0":{"shape":[8,1,4],"mins":[-2,-2,-2,-10],"maxs":[1.984375,1.984375,1.984375,10],"files":["c.webp"]})" +
               palette + "}";
    }
    files["meta.json"] = meta;
    return files;
}

inline std::string writeSogFolder(const Folder& folder, const std::string& name, const SogText& files) {
    std::filesystem::remove_all(folder.file(name));
    std::filesystem::create_directories(folder.file(name));
    for (const auto& [file, bytes] : files) { (void)folder.write(name + "/" + file, bytes); }
    return folder.file(name);
}

// A zip archive of stored entries, or deflated ones, in the order of `files`; names get `prefix`.
inline std::string makeZip(const std::vector<std::pair<std::string, std::string>>& files, bool deflated = false,
                           const std::string& prefix = "") {
    std::string archive, directory;
    for (const auto& [plain_name, bytes] : files) {
        const std::string name = prefix + plain_name;
        std::string packed = bytes;
        if (deflated) {
            uLongf size = compressBound(static_cast<uLong>(bytes.size())) + 16;
            packed.resize(size);
            z_stream stream{};
            REQUIRE(deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) == Z_OK);
            stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
            stream.avail_in = static_cast<uInt>(bytes.size());
            stream.next_out = reinterpret_cast<Bytef*>(packed.data());
            stream.avail_out = static_cast<uInt>(size);
            REQUIRE(deflate(&stream, Z_FINISH) == Z_STREAM_END);
            packed.resize(stream.total_out);
            deflateEnd(&stream);
        }
        const auto sum =
            static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
        const std::string common = littleWord(20, 2) + littleWord(0, 2) + littleWord(deflated ? 8 : 0, 2) + littleWord(0) +
                                   littleWord(sum) + littleWord(static_cast<std::uint32_t>(packed.size())) +
                                   littleWord(static_cast<std::uint32_t>(bytes.size())) +
                                   littleWord(static_cast<std::uint32_t>(name.size()), 2) + littleWord(0, 2);
        directory += "PK\x01\x02" + littleWord(20, 2) + common + littleWord(0, 2) + littleWord(0, 2) + littleWord(0, 2) + littleWord(0) +
                     littleWord(static_cast<std::uint32_t>(archive.size())) + name;
        archive += "PK\x03\x04" + common + name + packed;
    }
    const auto count = static_cast<std::uint32_t>(files.size());
    return archive + directory + "PK\x05\x06" + littleWord(0, 2) + littleWord(0, 2) + littleWord(count, 2) + littleWord(count, 2) +
           littleWord(static_cast<std::uint32_t>(directory.size())) + littleWord(static_cast<std::uint32_t>(archive.size())) +
           littleWord(0, 2);
}

inline std::string makeZip(const SogText& files, bool deflated = false, const std::string& prefix = "") {
    return makeZip(std::vector<std::pair<std::string, std::string>>(files.begin(), files.end()), deflated, prefix);
}

}  // namespace binosplat::test
