// The keys of meta.json, each checked for its type. Version 2 has codebooks, version 1 ranges.
#include "engine/scene/sog_meta.h"

#include "engine/error.h"
#include "engine/scene/quantized.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace binosplat {

namespace {

using nlohmann::json;

// A value with its place: "meta.json: means.mins".
struct Node {
    const json& value;
    std::string place;

    [[nodiscard]] bool has(const char* key) const { return value.is_object() && value.contains(key); }
    [[nodiscard]] Node at(const char* key) const {
        check(value.is_object(), "{}: is {}, expected an object", place, value.type_name());
        const auto found = value.find(key);
        check(found != value.end(), "{}: has no {}, expected one", place, key);
        return {*found, place + (place.ends_with(".json") ? ": " : ".") + key};
    }
    [[nodiscard]] Node at(std::size_t index) const { return {value[index], fmt::format("{}[{}]", place, index)}; }
    [[nodiscard]] std::size_t arraySize() const {
        check(value.is_array(), "{}: is {}, expected an array", place, value.type_name());
        return value.size();
    }
    void requireArray(std::size_t size) const { check(arraySize() == size, "{}: has {} entries, expected {}", place, value.size(), size); }
    [[nodiscard]] float number() const {
        check(value.is_number(), "{}: is {}, expected a number", place, value.type_name());
        const double wide = value.get<double>();
        check(std::abs(wide) <= static_cast<double>(std::numeric_limits<float>::max()), "{}: is {}, expected a float32 number", place,
              wide);
        return static_cast<float>(wide);
    }
    [[nodiscard]] std::uint64_t count() const {
        check(value.is_number_unsigned(), "{}: is {}, expected a whole number from 0 on", place,
              value.is_number() ? value.dump() : value.type_name());
        return value.get<std::uint64_t>();
    }
    [[nodiscard]] bool flag() const {
        check(value.is_boolean(), "{}: is {}, expected true or false", place, value.type_name());
        return value.get<bool>();
    }
    [[nodiscard]] std::string text() const {
        check(value.is_string(), "{}: is {}, expected a text", place, value.type_name());
        return value.get<std::string>();
    }
    // The only or the `index`-th of `size` file names.
    [[nodiscard]] std::string fileName(std::size_t index, std::size_t size) const {
        const Node files = at("files");
        files.requireArray(size);
        return files.at(index).text();
    }
};

ByteTable readCodebook(const Node& node) {
    const Node book = node.at("codebook");
    const std::size_t size = book.arraySize();
    check(size >= 1 && size <= 256, "{}: has {} entries, expected 1 to 256", book.place, size);
    ByteTable table;
    table.fill(std::numeric_limits<float>::quiet_NaN());
    // Early writers left null in front; it continues the row of the others.
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
std::array<ByteTable, kChannels> readRanges(const Node& node) {
    const Node mins = node.at("mins"), maxs = node.at("maxs");
    mins.requireArray(kChannels);
    maxs.requireArray(kChannels);
    std::array<ByteTable, kChannels> tables;
    for (std::size_t i = 0; i < kChannels; ++i) { tables[i] = lerpTable(mins.at(i).number(), maxs.at(i).number()); }
    return tables;
}

void readVersion1(const Node& root, SogMeta& meta) {
    const Node shape = root.at("means").at("shape");
    check(shape.arraySize() >= 1, "{}: is empty, expected the number of splats", shape.place);
    meta.count = shape.at(std::size_t{0}).count();
    meta.scales = readRanges<3>(root.at("scales"));
    meta.sh0 = readRanges<4>(root.at("sh0"));
    if (meta.palette) { meta.palette->values = lerpTable(root.at("shN").at("mins").number(), root.at("shN").at("maxs").number()); }
}

void readVersion2(const Node& root, SogMeta& meta) {
    meta.count = root.at("count").count();
    meta.scales.fill(readCodebook(root.at("scales")));
    const ByteTable colours = readCodebook(root.at("sh0"));
    meta.sh0 = {colours, colours, colours, {}};
    for (std::size_t i = 0; i < 256; ++i) { meta.sh0[3][i] = storedOpacity(static_cast<float>(i) / 255.0f); }
    if (!meta.palette) { return; }
    const Node palette = root.at("shN");
    const std::uint64_t bands = palette.at("bands").count();
    check(bands >= 1 && bands <= 3, "{}.bands: is {}, expected 1 to 3", palette.place, bands);
    meta.palette->sh_degree = static_cast<int>(bands);
    meta.palette->count = palette.at("count").count();
    meta.palette->values = readCodebook(palette);
}

}  // namespace

SogMeta parseSogMeta(std::span<const std::byte> text, const std::string& place) {
    json document;
    try {
        const char* begin = reinterpret_cast<const char*>(text.data());
        document = json::parse(begin, begin + text.size());
    } catch (const json::exception& error) {
        std::string reason = error.what();
        std::replace_if(
            reason.begin(), reason.end(), [](char letter) { return letter >= 0 && letter < ' '; }, ' ');
        fail("{}: not JSON ({}), expected the description of a SOG scene", place, reason);
    }
    const Node root{document, place};
    const std::uint64_t version = root.has("version") ? root.at("version").count() : 1;
    check(version == 1 || version == 2, "{}: version: is {}, expected 1 or 2", place, version);

    SogMeta meta;
    meta.antialiased = root.has("antialias") && root.at("antialias").flag();
    const Node means = root.at("means"), mins = means.at("mins"), maxs = means.at("maxs");
    mins.requireArray(3);
    maxs.requireArray(3);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        meta.mins[axis] = mins.at(axis).number();
        meta.maxs[axis] = maxs.at(axis).number();
    }
    meta.means_files = {means.fileName(0, 2), means.fileName(1, 2)};
    meta.scales_file = root.at("scales").fileName(0, 1);
    meta.quats_file = root.at("quats").fileName(0, 1);
    meta.sh0_file = root.at("sh0").fileName(0, 1);
    if (root.has("shN") && !root.at("shN").value.is_null()) {
        meta.palette.emplace();
        meta.palette->centroids_file = root.at("shN").fileName(0, 2);
        meta.palette->labels_file = root.at("shN").fileName(1, 2);
    }
    if (version == 1) {
        readVersion1(root, meta);
    } else {
        readVersion2(root, meta);
    }
    return meta;
}

}  // namespace binosplat
