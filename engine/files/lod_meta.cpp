// Walks the tree and keeps the leaves' ranges, sorted by chunk.
#include "engine/files/lod_meta.h"

#include "engine/error.h"
#include "engine/files/json_node.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>

namespace binosplat {

namespace {

constexpr std::uint64_t kMaxLevels = 64;
// With leaves of half a million splats, 21 nodes below each other make a scene of 2^40; a tree cut by size
// may need a few more.
constexpr int kMaxTreeDepth = 64;
// No scene has this many; and the counts of all leaves that a file can hold add up within 64 bits.
constexpr std::uint64_t kMaxSplats = std::uint64_t{1} << 40;

// A path to a file within the folder: without a root (Windows takes "/a" for relative), without "..", and
// without anything that another system would take for either.
std::string readChunkPath(const JsonNode& node) {
    const std::string text = node.filePath();
    const std::filesystem::path path(text);
    const bool within = !path.has_root_path() &&
                        text.find_first_of(std::string_view(":\0", 2)) == std::string::npos &&
                        std::find(path.begin(), path.end(), "..") == path.end();
    check(within, "{}: names \"{}\", expected a path within the folder of this file", node.place(), text);
    check(path.filename() == "meta.json" || path.extension() == ".sog",
          "{}: names \"{}\", expected the meta.json or the .sog of a chunk", node.place(), text);
    return path.lexically_normal().generic_string();
}

void readFiles(const JsonNode& root, LodMeta& meta) {
    std::set<std::string> known;
    const auto readOnce = [&](const JsonNode& node) {
        std::string path = readChunkPath(node);
        check(known.insert(path).second, "{}: names {} once more, expected each chunk once", node.place(),
              path);
        return path;
    };
    const JsonNode files = root.at("filenames");
    for (std::size_t i = 0; i < files.arraySize(); ++i) { meta.files.push_back(readOnce(files.at(i))); }
    if (root.has("environment")) { meta.environment = readOnce(root.at("environment")); }
}

// The level that a leaf's key says, as the format writes it: "0", "1", ...
std::optional<std::size_t> readLevel(const std::string& key, std::size_t levels) {
    for (std::size_t level = 0; level < levels; ++level) {
        if (key == std::to_string(level)) { return level; }
    }
    return std::nullopt;
}

std::uint64_t readSplats(const JsonNode& node) {
    const std::uint64_t splats = node.count();
    check(splats <= kMaxSplats, "{}: is {}, expected at most {}", node.place(), splats, kMaxSplats);
    return splats;
}

// By level; values of levels that the leaf lacks mean nothing.
void readErrors(const JsonNode& errors, LodLeaf& leaf) {
    const std::size_t size = errors.arraySize();
    for (const LodRange& range : leaf.levels) {
        check(range.level < size, "{}: has {} values, expected one for each level up to {}", errors.place(),
              size, leaf.levels.back().level);
        const JsonNode error = errors.at(range.level);
        leaf.errors.push_back(error.number());
        check(leaf.errors.back() >= 0.0f, "{}: is {}, expected 0 or more", error.place(), leaf.errors.back());
    }
}

void readLeaf(const JsonNode& node, LodLeaf leaf, LodMeta& meta) {
    const JsonNode lods = node.at("lods");
    lods.requireObject();
    std::vector<bool> present(meta.levels.size(), false);
    for (const auto& [key, value] : lods.value.items()) {
        const JsonNode entry = lods.at(key);
        const std::optional<std::size_t> level = readLevel(key, meta.levels.size());
        check(level.has_value(), "{}: is not a level, expected 0 to {}", entry.place(),
              meta.levels.size() - 1);
        const JsonNode file = entry.at("file");
        check(file.count() < meta.files.size(), "{}: is {}, expected less than the {} of filenames",
              file.place(), file.count(), meta.files.size());
        const SplatRange range{readSplats(entry.at("offset")), readSplats(entry.at("count"))};
        if (range.count == 0) { continue; }
        meta.levels[*level].chunks[file.count()].push_back(range);
        leaf.levels.push_back(
            {static_cast<std::uint32_t>(*level), static_cast<std::uint32_t>(file.count()), range});
        present[*level] = true;
    }
    const bool any = !leaf.levels.empty();
    for (std::size_t level = 0; level < present.size(); ++level) {
        meta.leaves_without[level] += any && !present[level];
    }
    ++meta.leaves;
    if (!any) { return; }  // then its box may be empty, too
    const bool is_box = glm::all(glm::lessThanEqual(leaf.low, leaf.high));
    check(is_box, "{}: lies in no box, expected a bound whose min is at most its max", lods.place());
    std::ranges::sort(leaf.levels, {}, &LodRange::level);
    if (meta.has_errors) { readErrors(node.at("errors"), leaf); }
    // If a leaf lacks this level but has a coarser one, the next coarser one is used.
    for (std::uint32_t level = 0; level < leaf.levels.back().level; ++level) {
        if (present[level]) { continue; }
        const LodRange& coarser = *std::ranges::upper_bound(leaf.levels, level, {}, &LodRange::level);
        meta.levels[level].chunks[coarser.file].push_back(coarser.splats);
        ++meta.leaves_coarser[level];
    }
    meta.tree.push_back(std::move(leaf));
}

LodLeaf readBounds(const JsonNode& bound) {
    const auto readCorner = [&](const char* corner) {
        const JsonNode values = bound.at(corner);
        values.requireArray(3);
        return glm::vec3(values.at(0).number(), values.at(1).number(), values.at(2).number());
    };
    return {readCorner("min"), readCorner("max"), {}};
}

// The parser has limited the depth.
void readTree(const JsonNode& node, LodMeta& meta) {
    const LodLeaf box = readBounds(node.at("bound"));
    const bool is_leaf = node.has("lods");
    check(is_leaf != node.has("children"), "{}: has {}, expected one of them", node.place(),
          is_leaf ? "both children and lods" : "neither children nor lods");
    if (is_leaf) { return readLeaf(node, box, meta); }
    const JsonNode children = node.at("children");
    check(children.arraySize() > 0, "{}: is empty, expected nodes", children.place());
    for (std::size_t i = 0; i < children.arraySize(); ++i) { readTree(children.at(i), meta); }
}

// Ranges of leaves that are adjacent in a chunk are merged.
void joinRanges(const LodMeta& meta, std::size_t file, std::vector<SplatRange>& ranges,
                const std::string& place) {
    std::ranges::sort(ranges, {}, &SplatRange::first);
    std::vector<SplatRange> joined;
    for (const SplatRange range : ranges) {
        const std::uint64_t end = joined.empty() ? 0 : joined.back().first + joined.back().count;
        check(joined.empty() || range.first >= end,
              "{}: tree: two leaves name splat {} of filenames[{}] ({}), expected each splat once", place,
              range.first, file, meta.files[file]);
        if (!joined.empty() && range.first == end) {
            joined.back().count += range.count;
        } else {
            joined.push_back(range);
        }
    }
    ranges = std::move(joined);
}

}  // namespace

LodMeta parseLodMeta(std::span<const std::byte> text, const std::string& place) {
    // A node of the tree is an object within an array; a leaf's entries are two levels deeper.
    const nlohmann::json document =
        parseJson(text, place, "the levels of a streamed SOG scene", 2 * kMaxTreeDepth + 4);
    const JsonNode root{document, place};
    if (root.has("version")) {
        const JsonNode version = root.at("version");  // the first writers left it out
        check(version.count() == 1, "{}: is {}, expected 1", version.place(), version.count());
    }
    const JsonNode levels = root.at("lodLevels");
    check(levels.count() >= 1 && levels.count() <= kMaxLevels, "{}: is {}, expected 1 to {}", levels.place(),
          levels.count(), kMaxLevels);

    LodMeta meta;
    meta.has_errors = root.has("lodErrors") && root.at("lodErrors").flag();
    meta.levels.resize(levels.count());
    meta.leaves_without.resize(levels.count());
    meta.leaves_coarser.resize(levels.count());
    readFiles(root, meta);
    readTree(root.at("tree"), meta);
    for (LodLevel& level : meta.levels) {
        for (auto& [file, ranges] : level.chunks) {
            joinRanges(meta, file, ranges, place);
            for (const SplatRange range : ranges) { level.splats += range.count; }
        }
    }
    return meta;
}

}  // namespace binosplat
