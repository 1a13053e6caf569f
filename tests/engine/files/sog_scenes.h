// SOG scenes made to measure, as a directory or a bundle.
#pragma once

#include "engine/picture/webp.h"
#include "tests/engine/files/packed_bytes.h"
#include "tests/engine/files/ply_files.h"

namespace binosplat::test {

// By file name, including meta.json.
using SogText = std::map<std::string, std::string>;

inline std::string codebook(double first, double step, int entries = 256) {
    std::string text = "[";
    for (int i = 0; i < entries; ++i) { text += fmt::format("{}{}", i == 0 ? "" : ",", first + step * i); }
    return text + "]";
}

inline std::string makeWebp(std::uint32_t width, std::uint32_t height,
                            const std::vector<std::uint8_t>& rgba) {
    const std::vector<std::byte> file = encodeWebp({{width, height}, rgba}, "a test's picture");
    return {reinterpret_cast<const char*>(file.data()), file.size()};
}

// A picture of 3 x 3 pixels; `pixel` gives the first eight.
inline std::string makeNine(const std::function<std::array<int, 4>(int)>& pixel) {
    std::vector<std::uint8_t> rgba;
    for (int i = 0; i < 8; ++i) {
        for (const int value : pixel(i)) { rgba.push_back(static_cast<std::uint8_t>(value)); }
    }
    rgba.resize(36);
    return makeWebp(3, 3, rgba);
}

// Eight splats in pictures of 3 x 3. On x, splat i lies at share i/8 between the bounds (bytes 32 i above, 0
// below), on y at 0, on z at 1. Its scales are the codebook's entries 10 i, 10 i + 1, 10 i + 2, its colour 20
// i, 20 i + 1, 20 i + 2, and its opacity i/8 of 255.
inline SogText makeSog(int version = 2, bool with_palette = true) {
    using Rgba = std::array<int, 4>;
    SogText files;
    files["l.webp"] = makeNine([](int) { return Rgba{0, 0, 255, 0}; });
    files["u.webp"] = makeNine([](int i) { return Rgba{32 * i, 0, 255, 0}; });
    files["s.webp"] = makeNine([](int i) { return Rgba{10 * i, 10 * i + 1, 10 * i + 2, 0}; });
    files["q.webp"] = makeNine([](int i) { return Rgba{128, 128, 128, 252 + i % 4}; });
    files["c.webp"] = makeNine([](int i) { return Rgba{20 * i, 20 * i + 1, 20 * i + 2, 255 * i / 8}; });
    const std::string means =
        R"("mins":[-1,-2,0],"maxs":[1,0,0.6931471805599453],"files":["l.webp","u.webp"])";
    std::string meta, palette;
    if (with_palette) {
        // Degree 1: 64 entries of three pixels a row; coefficient k of entry e has the bytes (e, k, 100).
        std::vector<std::uint8_t> centroids;
        for (std::uint8_t entry = 0; entry < 128; ++entry) {
            for (std::uint8_t k = 0; k < 3; ++k) { centroids.insert(centroids.end(), {entry, k, 100, 255}); }
        }
        files["p.webp"] = makeWebp(192, 2, centroids);
        // An entry in the palette's second row, or in the first.
        files["n.webp"] = makeNine([](int i) { return Rgba{i % 2 == 0 ? 65 : 1, 0, 0, 0}; });
        palette =
            version == 2
                ? R"(,"shN":{"count":128,"bands":1,"codebook":)" + codebook(-2, 1.0 / 64) +
                      R"(,"files":["p.webp","n.webp"]})"
                : R"(,"shN":{"shape":[8,9],"mins":-2,"maxs":1.984375,"quantization":8,"files":["p.webp",)"
                  R"("n.webp"]})";
    }
    if (version == 2) {
        meta = R"({"version":2,"count":8,"means":{)" + means + R"(},"scales":{"codebook":)" +
               codebook(-8, 1.0 / 32) +
               R"(,"files":["s.webp"]},"quats":{"files":["q.webp"]},"sh0":{"codebook":)" +
               codebook(-2, 1.0 / 64) + R"(,"files":["c.webp"]})" + palette + "}";
    } else {
        meta = R"({"means":{"shape":[8,3],"dtype":"float32",)" + means +
               R"(},"scales":{"shape":[8,3],"mins":[-8,-8,-8],"maxs":[-0.03125,-0.03125,-0.03125],)"
               R"("files":["s.webp"]},)"
               R"("quats":{"shape":[8,4],"encoding":"quaternion_packed","files":["q.webp"]},)"
               R"("sh0":{"shape":[8,1,4],"mins":[-2,-2,-2,-10],"maxs":[1.984375,1.984375,1.984375,10],)"
               R"("files":["c.webp"]})" +
               palette + "}";
    }
    files["meta.json"] = meta;
    return files;
}

inline std::string writeSogFolder(const Folder& folder, const std::string& name, const SogText& files) {
    fs::remove_all(folder.file(name));
    fs::create_directories(folder.file(name));
    for (const auto& [file, bytes] : files) { (void)folder.write(name + "/" + file, bytes); }
    return folder.file(name);
}

// A zip archive of stored entries, or deflated ones, in the order of `files`; names get `prefix`.
inline std::string makeZip(const std::vector<std::pair<std::string, std::string>>& files,
                           bool are_deflated = false, const std::string& prefix = "") {
    std::string archive, directory;
    for (const auto& [plain_name, bytes] : files) {
        const std::string name = prefix + plain_name;
        const std::string packed = are_deflated ? deflated(bytes, -MAX_WBITS) : bytes;
        const auto sum =
            crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size()));
        const std::string common = littleWord(20, 2) + littleWord(0, 2) +
                                   littleWord(are_deflated ? 8 : 0, 2) + littleWord(0) + littleWord(sum) +
                                   littleWord(packed.size()) + littleWord(bytes.size()) +
                                   littleWord(name.size(), 2) + littleWord(0, 2);
        directory += "PK\x01\x02" + littleWord(20, 2) + common + littleWord(0, 2) + littleWord(0, 2) +
                     littleWord(0, 2) + littleWord(0) + littleWord(archive.size()) + name;
        archive += "PK\x03\x04" + common + name + packed;
    }
    return archive + directory + "PK\x05\x06" + littleWord(0, 4) + littleWord(files.size(), 2) +
           littleWord(files.size(), 2) + littleWord(directory.size()) + littleWord(archive.size()) +
           littleWord(0, 2);
}

inline std::string makeZip(const SogText& files, bool are_deflated = false, const std::string& prefix = "") {
    return makeZip(std::vector<std::pair<std::string, std::string>>(files.begin(), files.end()), are_deflated,
                   prefix);
}

}  // namespace binosplat::test
