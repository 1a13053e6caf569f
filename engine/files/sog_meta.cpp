// The keys of meta.json, each checked for its type. Version 2 has codebooks, version 1 ranges.
#include "engine/files/sog_meta.h"

#include "engine/error.h"
#include "engine/files/json_node.h"
#include "engine/files/quantized.h"

namespace binosplat {

namespace {

// The single file name, or the `index`-th of `size`.
std::string fileName(const JsonNode& node, std::size_t index, std::size_t size) {
    const JsonNode files = node.at("files");
    files.requireArray(size);
    return files.at(index).filePath();
}

ByteTable readCodebook(const JsonNode& node) {
    const JsonNode book = node.at("codebook");
    const std::size_t size = book.arraySize();
    check(size >= 1 && size <= 256, "{}: has {} entries, expected 1 to 256", book.place(), size);
    ByteTable table;
    table.fill(std::numeric_limits<float>::quiet_NaN());
    // Early writers put null first; its value continues the series of the others.
    const bool null_in_front = size == 256 && book.value[0].is_null();
    for (std::size_t i = null_in_front ? 1 : 0; i < size; ++i) { table[i] = book.at(i).number(); }
    if (null_in_front) { table[0] = table[1] + (table[1] - table[255]) / 255.0f; }
    return table;
}

ByteTable lerpTable(float low, float high) {
    ByteTable table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
        const float share = static_cast<float>(i) / 255.0f;
        table[i] = low * (1.0f - share) + high * share;
    }
    return table;
}

// One table per channel from arrays mins and maxs.
template <std::size_t kChannels>
std::array<ByteTable, kChannels> readRanges(const JsonNode& node) {
    const JsonNode mins = node.at("mins"), maxs = node.at("maxs");
    mins.requireArray(kChannels);
    maxs.requireArray(kChannels);
    std::array<ByteTable, kChannels> tables;
    for (std::size_t i = 0; i < kChannels; ++i) {
        tables[i] = lerpTable(mins.at(i).number(), maxs.at(i).number());
    }
    return tables;
}

void readVersion1(const JsonNode& root, SogMeta& meta) {
    const JsonNode shape = root.at("means").at("shape");
    check(shape.arraySize() >= 1, "{}: is empty, expected the number of splats", shape.place());
    meta.count = shape.at(std::size_t{0}).count();
    meta.scales = readRanges<3>(root.at("scales"));
    meta.sh0 = readRanges<4>(root.at("sh0"));
    if (meta.palette) {
        meta.palette->values =
            lerpTable(root.at("shN").at("mins").number(), root.at("shN").at("maxs").number());
    }
}

void readVersion2(const JsonNode& root, SogMeta& meta) {
    meta.count = root.at("count").count();
    meta.scales.fill(readCodebook(root.at("scales")));
    const ByteTable colours = readCodebook(root.at("sh0"));
    meta.sh0 = {colours, colours, colours, {}};
    for (std::size_t i = 0; i < 256; ++i) { meta.sh0[3][i] = storedOpacity(static_cast<float>(i) / 255.0f); }
    if (!meta.palette) { return; }
    const JsonNode palette = root.at("shN");
    const std::uint64_t bands = palette.at("bands").count();
    check(bands >= 1 && bands <= 3, "{}.bands: is {}, expected 1 to 3", palette.place(), bands);
    meta.palette->sh_degree = static_cast<int>(bands);
    meta.palette->count = palette.at("count").count();
    meta.palette->values = readCodebook(palette);
}

}  // namespace

SogMeta parseSogMeta(std::span<const std::byte> text, const std::string& place) {
    const nlohmann::json document = parseJson(text, place, "the description of a SOG scene");
    const JsonNode root{document, place};
    const std::uint64_t version = root.has("version") ? root.at("version").count() : 1;
    check(version == 1 || version == 2, "{}: version: is {}, expected 1 or 2", place, version);

    SogMeta meta;
    meta.antialiased = root.has("antialias") && root.at("antialias").flag();
    if (root.has("model")) {  // newer writers
        const std::string model = root.at("model").text();
        meta.antialiased = model == "antialiased";
        meta.discs = model == "2dgs";
    }
    const JsonNode means = root.at("means"), mins = means.at("mins"), maxs = means.at("maxs");
    mins.requireArray(3);
    maxs.requireArray(3);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        meta.mins[axis] = mins.at(axis).number();
        meta.maxs[axis] = maxs.at(axis).number();
    }
    meta.means_files = {fileName(means, 0, 2), fileName(means, 1, 2)};
    meta.scales_file = fileName(root.at("scales"), 0, 1);
    meta.quats_file = fileName(root.at("quats"), 0, 1);
    meta.sh0_file = fileName(root.at("sh0"), 0, 1);
    if (root.has("shN")) {
        meta.palette.emplace();
        meta.palette->centroids_file = fileName(root.at("shN"), 0, 2);
        meta.palette->labels_file = fileName(root.at("shN"), 1, 2);
    }
    if (version == 1) {
        readVersion1(root, meta);
    } else {
        readVersion2(root, meta);
    }
    return meta;
}

}  // namespace binosplat
