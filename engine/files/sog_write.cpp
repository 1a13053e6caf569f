// Packs a scene into a SOG bundle of version 2.
#include "engine/error.h"
#include "engine/files/codebook.h"
#include "engine/files/quantized.h"
#include "engine/files/sh_palette.h"
#include "engine/files/sog.h"
#include "engine/files/sog_files.h"
#include "engine/files/sog_meta.h"
#include "engine/files/sog_pack.h"
#include "engine/parallel.h"
#include "engine/part_file.h"
#include "engine/picture/webp.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <thread>

namespace binosplat {

namespace {

// The logarithm of a scale without extent: nothing else is as small, and its square is still a normal
// float32.
constexpr float kNoExtent = -20.0f;
constexpr double kPaletteShare = 0.6, kPicturesShare = 0.35;  // of the time

Pixels blank(glm::uvec2 size_px) {
    Pixels pixels{size_px, std::vector<std::uint8_t>(std::size_t{4} * size_px.x * size_px.y, 0)};
    for (std::size_t i = 3; i < pixels.rgba.size(); i += 4) { pixels.rgba[i] = 255; }
    return pixels;
}

// As close to a square as possible, with sides that are multiples of four.
glm::uvec2 choosePictureSize(std::size_t splats, const std::string& path) {
    const auto fours = [](double side) {
        return 4 * std::max(1u, static_cast<std::uint32_t>(std::ceil(side / 4.0)));
    };
    check(splats <= std::size_t{kMaxWebpSide - 3} * (kMaxWebpSide - 3),
          "{}: cannot hold {} splats, WebP's sides end at {} pixels", path, splats, kMaxWebpSide);
    const std::uint32_t width = fours(std::sqrt(static_cast<double>(splats)));
    return {width, fours(static_cast<double>(splats) / width)};
}

// The logarithms of s_u, s_v, s_w of each splat; a disc's last one is kNoExtent.
std::vector<float> listScales(const Scene& scene) {
    std::vector<float> logarithms;
    logarithms.reserve(3 * scene.size());
    for (std::size_t i = 0; i < scene.size(); ++i) {
        for (const float scale :
             {scene.scales[i].x, scene.scales[i].y, scene.isGaussian3d() ? scene.thicknesses[i] : 0.0f}) {
            logarithms.push_back(std::max(storedScale(scale), kNoExtent));
        }
    }
    return logarithms;
}

std::vector<float> listColours(const Scene& scene) {
    const auto stride = static_cast<std::size_t>(3 * shCoefficientCount(scene.sh_degree));
    std::vector<float> colours;
    colours.reserve(3 * scene.size());
    for (std::size_t i = 0; i < scene.size(); ++i) {
        colours.insert(colours.end(), &scene.sh[i * stride], &scene.sh[i * stride] + 3);
    }
    return colours;
}

// Scales without extent have the first value to themselves, since the others are far from it.
Codebook makeScaleBook(const std::vector<float>& logarithms) {
    std::vector<float> some;
    std::ranges::copy_if(logarithms, std::back_inserter(some),
                         [](float logarithm) { return logarithm > kNoExtent; });
    return some.size() < logarithms.size() ? Codebook(some, kNoExtent) : Codebook(some);
}

std::array<std::uint8_t, 4> low(const std::array<std::uint16_t, 3>& levels) {
    const auto byte = [&](std::size_t axis) { return static_cast<std::uint8_t>(levels[axis] & 255); };
    return {byte(0), byte(1), byte(2), 255};
}

std::array<std::uint8_t, 4> high(const std::array<std::uint16_t, 3>& levels) {
    const auto byte = [&](std::size_t axis) { return static_cast<std::uint8_t>(levels[axis] >> 8); };
    return {byte(0), byte(1), byte(2), 255};
}

// The bytes of three numbers of one splat.
std::array<std::uint8_t, 4> code(const Codebook& book, const std::vector<float>& numbers, std::uint32_t splat,
                                 std::uint8_t last = 255) {
    const float* number = numbers.data() + std::size_t{3} * splat;
    return {book.nearest(number[0]), book.nearest(number[1]), book.nearest(number[2]), last};
}

Pixels drawPalette(const ShPalette& palette, const Codebook& book) {
    const auto columns = static_cast<std::uint32_t>(kSogPaletteColumns * palette.coefficients),
               rows =
                   static_cast<std::uint32_t>((palette.size() + kSogPaletteColumns - 1) / kSogPaletteColumns);
    Pixels pixels = blank({columns, rows});
    // The entries of a row follow one another in its pixels.
    for (std::size_t i = 0; i < palette.entries.size() / 3; ++i) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            pixels.rgba[4 * i + channel] = book.nearest(palette.entries[3 * i + channel]);
        }
    }
    return pixels;
}

// Two pictures at a time; progress is reported by the calling thread.
std::vector<NamedBytes> encodeAll(std::vector<std::pair<std::string, Pixels>>& pictures,
                                  const std::string& path, const Progress& progress) {
    std::vector<NamedBytes> files(pictures.size());
    const std::thread::id caller = std::this_thread::get_id();
    forBlocks(
        pictures.size(), 1, static_cast<int>(std::thread::hardware_concurrency()),
        [&](std::size_t i, std::size_t) {
            if (progress && std::this_thread::get_id() == caller) {
                progress(kPaletteShare +
                         kPicturesShare * static_cast<double>(i) / static_cast<double>(pictures.size()));
            }
            files[i] = {pictures[i].first, encodeWebp(pictures[i].second, path + ": " + pictures[i].first)};
            pictures[i].second = {};
        });
    if (progress) { progress(kPaletteShare + kPicturesShare); }
    return files;
}

std::vector<std::uint32_t> ownOrder(const SogPlaces& places) {
    std::vector<std::uint32_t> order(places.levels.size());
    std::iota(order.begin(), order.end(), 0u);
    return order;
}

using OrderOf = std::vector<std::uint32_t>(const SogPlaces& places);

void requireWritable(const Scene& scene, const std::string& path) {
    check(canDecodeWebp(),
          "{}: this build cannot write SOG: configure with BINOSPLAT_SOG=ON, or write PLY or SPZ", path);
    check(!scene.is_linear,
          "{}: cannot hold colours of linear light ({}), must be written from a display-encoded scene", path,
          scene.name);
}

// The files of a scene; meta.json comes last.
std::vector<NamedBytes> pack(const Scene& scene, const std::string& path, const Progress& progress,
                             OrderOf* orderOf) {
    const glm::uvec2 size_px = choosePictureSize(scene.size(), path);
    const SogPlaces places = findSogPlaces(scene);
    const std::vector<std::uint32_t> order = orderOf(places);
    std::vector<std::pair<std::string, Pixels>> pictures;
    const auto draw = [&](const char* name, const auto& pixelOf) {
        Pixels pixels = blank(size_px);
        for (std::size_t i = 0; i < order.size(); ++i) {
            std::ranges::copy(pixelOf(order[i]), pixels.rgba.begin() + static_cast<std::ptrdiff_t>(4 * i));
        }
        pictures.emplace_back(name, std::move(pixels));
        return nlohmann::json::array({name});
    };

    nlohmann::json meta{{"version", 2}, {"asset", {{"generator", "binosplat"}}}, {"count", scene.size()}};
    if (scene.antialiased) { meta["antialias"] = true; }
    if (scene.antialiased || !scene.isGaussian3d()) {
        meta["model"] = scene.isGaussian3d() ? "antialiased" : "2dgs";
    }
    nlohmann::json files =
        draw("means_l.webp", [&](std::uint32_t splat) { return low(places.levels[splat]); });
    files += draw("means_u.webp", [&](std::uint32_t splat) { return high(places.levels[splat]); })[0];
    meta["means"] = {{"mins", places.mins}, {"maxs", places.maxs}, {"files", files}};

    const std::vector<float> scales = listScales(scene), colours = listColours(scene);
    const Codebook scale_book = makeScaleBook(scales), colour_book(colours);
    files = draw("scales.webp", [&](std::uint32_t splat) { return code(scale_book, scales, splat); });
    meta["scales"] = {{"codebook", scale_book.values()}, {"files", files}};
    meta["quats"] = {{"files", draw("quats.webp", [&](std::uint32_t splat) {
                          return packSogRotation(scene.rotations[splat]);
                      })}};
    files = draw("sh0.webp", [&](std::uint32_t splat) {
        return code(colour_book, colours, splat,
                    static_cast<std::uint8_t>(std::lround(255.0f * scene.opacities[splat])));
    });
    meta["sh0"] = {{"codebook", colour_book.values()}, {"files", files}};

    if (scene.sh_degree > 0 && scene.size() > 0) {
        const auto first_part = [&](double share) { progress(kPaletteShare * share); };
        const ShPalette palette =
            makeShPalette(scene, sogPaletteSize(scene), progress ? Progress(first_part) : Progress());
        const Codebook book(palette.entries);
        pictures.emplace_back("shN_centroids.webp", drawPalette(palette, book));
        files = draw("shN_labels.webp", [&](std::uint32_t splat) -> std::array<std::uint8_t, 4> {
            return {static_cast<std::uint8_t>(palette.labels[splat] & 255),
                    static_cast<std::uint8_t>(palette.labels[splat] >> 8), 0, 255};
        });
        meta["shN"] = {{"count", palette.size()},
                       {"bands", scene.sh_degree},
                       {"codebook", book.values()},
                       {"files", {"shN_centroids.webp", files[0]}}};
    }
    std::vector<NamedBytes> all = encodeAll(pictures, path, progress);
    const std::string text = meta.dump();
    const auto bytes = std::as_bytes(std::span(text));
    all.push_back({"meta.json", {bytes.begin(), bytes.end()}});
    return all;
}

}  // namespace

// A power of two, so that the rows of the palette's picture are full.
std::size_t sogPaletteSize(const Scene& scene) {
    return std::min(std::bit_floor(scene.size()), kMostPaletteEntries);
}

void writeSog(const Scene& scene, const std::string& path, const Progress& progress) {
    requireWritable(scene, path);
    PartFile file(path);
    const std::vector<std::byte> bundle = packSogBundle(pack(scene, path, progress, mortonOrder), path);
    file.write(bundle.data(), bundle.size());
    file.commit();
    if (progress) { progress(1.0); }
}

void writeSogFolder(const Scene& scene, const std::string& folder, const Progress& progress) {
    requireWritable(scene, folder);
    std::error_code error;
    std::filesystem::create_directory(folder, error);
    check(!error, "{}: cannot be written: {}", folder, error.message());
    for (const NamedBytes& named : pack(scene, folder, progress, ownOrder)) {
        PartFile file((std::filesystem::path(folder) / named.name).string());
        file.write(named.bytes.data(), named.bytes.size());
        file.commit();
    }
    if (progress) { progress(1.0); }
}

}  // namespace binosplat
