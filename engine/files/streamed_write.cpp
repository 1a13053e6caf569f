// A tree of boxes with about equally many splats, and their levels, chunk by chunk.
#include "engine/files/streamed_write.h"

#include "engine/error.h"
#include "engine/files/sog.h"
#include "engine/files/sog_pack.h"
#include "engine/part_file.h"
#include "engine/platform.h"
#include "engine/scene/pick_splats.h"
#include "engine/temporary_folder.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <system_error>

namespace binosplat {

namespace {

namespace fs = std::filesystem;

constexpr int kMostDepth = 48;  // readers limit it, too
constexpr float kReach =
    2.0f;  // in standard deviations: a leaf's box holds the visible part of its finest splats
constexpr float kBeyond = std::numeric_limits<float>::max();
constexpr double kLeastSeen = 1.0;  // in pixels: splats that show less are taken to be like the others

// Along a Morton curve of their own.
void sortAlongCurve(const Scene& scene, std::span<std::uint32_t> splats) {
    Scene part;
    for (const std::uint32_t splat : splats) { part.positions.push_back(scene.positions[splat]); }
    std::vector<std::uint32_t> order = mortonOrder(findSogPlaces(part));
    for (std::uint32_t& splat : order) { splat = splats[splat]; }
    std::ranges::copy(order, splats.begin());
}

void addError(SplatError& sum, const SplatError& error) {
    sum.weight += error.weight, sum.square += error.square;
}

fs::path findFreeName(const fs::path& folder) {
    for (int attempt = 0;; ++attempt) {
        fs::path name = folder;
        name += fmt::format(".part{}-{}", processId(), attempt);
        if (!fs::exists(name)) { return name; }
    }
}

}  // namespace

StreamedWriter::StreamedWriter(const fs::path& path, const StreamedWriteSettings& settings)
    : folder_(path.parent_path()), settings_(settings) {
    check(!folder_.empty(), "{}: must be in a folder of its own, as in scene/lod-meta.json", path.string());
    const fs::path parent = folder_.has_parent_path() ? folder_.parent_path() : ".";
    check(fs::is_directory(parent), "{}: cannot be written, {} must be a directory", path.string(),
          parent.string());
    check(!fs::exists(folder_) || (fs::is_directory(folder_) && fs::is_empty(folder_)),
          "{}: is there already, must be absent or empty", folder_.string());
    part_ = findFreeName(folder_);
    std::error_code error;
    fs::create_directory(part_, error);
    check(!error, "{}: cannot be written: {}", folder_.string(), error.message());
}

StreamedWriter::~StreamedWriter() {
    if (!part_.empty()) { removeFolder(part_); }
}

void StreamedWriter::cutLeaves(std::span<const glm::vec3> centres) {
    check(!centres.empty(), "{}: would have no splats, expected some to stream", folder_.string());
    std::vector<std::uint32_t> splats(centres.size());
    std::iota(splats.begin(), splats.end(), 0u);
    cut(centres, splats, 0);
}

std::uint32_t StreamedWriter::cut(std::span<const glm::vec3> centres, std::span<std::uint32_t> splats,
                                  int depth) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back(
        {.low = glm::vec3(kBeyond), .high = glm::vec3(-kBeyond), .splats = splats.size(), .parts = {}});
    glm::vec3 low(kBeyond), high(-kBeyond);
    for (const std::uint32_t splat : splats) {
        low = glm::min(low, centres[splat]);
        high = glm::max(high, centres[splat]);
    }
    const glm::vec3 sides = high - low;
    const int axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
    if (splats.size() <= settings_.leaf_splats || depth == kMostDepth || !(sides[axis] > 0.0f)) {
        return index;
    }
    const auto along = [&](std::uint32_t splat) { return centres[splat][axis]; };
    const auto half = splats.begin() + static_cast<std::ptrdiff_t>(splats.size() / 2);
    std::ranges::nth_element(splats, half, {}, along);
    // If many centres share the middle one's coordinate, the cut moves up to the next.
    float at = along(*half);
    if (at == low[axis]) {
        at = kBeyond;
        for (const std::uint32_t splat : splats) {
            at = along(splat) > low[axis] ? std::min(at, along(splat)) : at;
        }
    }
    const auto middle =
        std::partition(splats.begin(), splats.end(), [&](std::uint32_t splat) { return along(splat) < at; });
    nodes_[index].axis = axis;
    nodes_[index].cut = at;
    const std::uint32_t first = cut(centres, {splats.begin(), middle}, depth + 1),
                        second = cut(centres, {middle, splats.end()}, depth + 1);
    nodes_[index].first = first;
    nodes_[index].second = second;
    return index;
}

// `within` the block that was begun last.
void StreamedWriter::collectBlocks(std::uint32_t node, std::uint64_t most, bool within,
                                   Blocks& blocks) const {
    const Node& at = nodes_[node];
    if (!within && (at.splats <= most || at.axis < 0)) {
        ++blocks.count;
        within = true;
    }
    if (at.axis < 0) {
        blocks.of_node[node] = blocks.count - 1;
        return;
    }
    collectBlocks(at.first, most, within, blocks);
    collectBlocks(at.second, most, within, blocks);
}

StreamedWriter::Blocks StreamedWriter::cutBlocks(std::uint64_t most) const {
    Blocks blocks{std::vector<std::uint32_t>(nodes_.size(), 0u)};
    collectBlocks(0, most, false, blocks);
    return blocks;
}

std::vector<std::vector<std::uint32_t>> StreamedWriter::sortInto(const Blocks& blocks,
                                                                 std::span<const glm::vec3> centres) const {
    std::vector<std::vector<std::uint32_t>> sorted(blocks.count);
    for (std::uint32_t splat = 0; splat < centres.size(); ++splat) {
        sorted[blocks.of_node[leafOf(centres[splat])]].push_back(splat);
    }
    return sorted;
}

std::uint32_t StreamedWriter::leafOf(const glm::vec3& position) const {
    std::uint32_t node = 0;
    while (nodes_[node].axis >= 0) {
        node = position[nodes_[node].axis] < nodes_[node].cut ? nodes_[node].first : nodes_[node].second;
    }
    return node;
}

// Of coarser levels only the centres count: few large splats reach far, and a leaf would seem to be as large.
void StreamedWriter::bound(std::uint32_t leaf, const Scene& scene, std::uint32_t splat, bool is_finest) {
    const float thickness = scene.isGaussian3d() ? scene.thicknesses[splat] : 0.0f;
    const float reach =
        is_finest ? kReach * std::max({scene.scales[splat].x, scene.scales[splat].y, thickness}) : 0.0f;
    nodes_[leaf].low = glm::min(nodes_[leaf].low, scene.positions[splat] - reach);
    nodes_[leaf].high = glm::max(nodes_[leaf].high, scene.positions[splat] + reach);
}

void StreamedWriter::add(std::size_t level, const Scene& scene, std::span<const SplatError> errors,
                         std::size_t against, const Progress& progress) {
    const std::size_t levels = std::max(counts_.size(), level + 1);
    counts_.resize(levels), chunks_.resize(levels), all_errors_.resize(levels);
    has_errors_ = has_errors_ && (level == 0 || !errors.empty());
    std::vector<std::vector<std::uint32_t>> leaves(nodes_.size());
    for (std::uint32_t splat = 0; splat < scene.size(); ++splat) {
        const std::uint32_t leaf = leafOf(scene.positions[splat]);
        leaves[leaf].push_back(splat);
        bound(leaf, scene, splat, level == 0);
    }
    std::vector<std::uint32_t> chunk;
    std::size_t written = 0;
    const auto write = [&] {
        if (chunk.empty()) { return; }
        const std::string name = fmt::format("{}_{}", level, chunks_[level]++);
        const auto part = [&](double share) {
            progress((static_cast<double>(written) + share * static_cast<double>(chunk.size())) /
                     static_cast<double>(scene.size()));
        };
        writeSogFolder(pickSplats(scene, chunk), (part_ / name).string(),
                       progress ? Progress(part) : Progress());
        files_.push_back(fmt::format(R"("{}/meta.json")", name));
        written += chunk.size();
        chunk.clear();
    };
    for (std::size_t leaf = 0; leaf < leaves.size(); ++leaf) {
        std::vector<std::uint32_t>& own = leaves[leaf];
        if (own.empty()) { continue; }
        if (!chunk.empty() && chunk.size() + own.size() > settings_.chunk_splats) { write(); }
        sortAlongCurve(scene, own);
        Part part{level, files_.size(), chunk.size(), own.size(), against, {}};
        for (const std::uint32_t splat : own) {
            addError(part.error, errors.empty() ? SplatError{} : errors[splat]);
        }
        addError(all_errors_[level], part.error);
        nodes_[leaf].parts.push_back(part);
        chunk.insert(chunk.end(), own.begin(), own.end());
        own = {};
    }
    write();
    counts_[level] += scene.size();
}

void StreamedWriter::addEnvironment(const Scene& scene, const Progress& progress) {
    writeSogFolder(scene, (part_ / "env").string(), progress);
    has_environment_ = true;
}

// By level: the mean square where its splats show, or the whole level's if none showed. Errors add up if a
// level is compared with one that has errors itself, and no coarser level counts as better than a finer one.
std::vector<double> StreamedWriter::errorsOf(const Node& leaf) const {
    std::vector<double> errors(counts_.size());
    for (std::size_t level = 1; level < errors.size(); ++level) {
        errors[level] = errors[level - 1];
        const auto part = std::ranges::find(leaf.parts, level, &Part::level);
        if (part == leaf.parts.end()) { continue; }
        const SplatError& error = part->error.weight >= kLeastSeen ? part->error : all_errors_[level];
        const double mean = error.weight > 0.0 ? error.square / error.weight : 0.0;
        errors[level] = std::max(errors[level], mean + errors[part->against]);
    }
    return errors;
}

// Boxes of everything below; returns the node's corners.
glm::mat2x3 StreamedWriter::boundParents(std::uint32_t node) {
    if (nodes_[node].axis >= 0) {
        const glm::mat2x3 first = boundParents(nodes_[node].first),
                          second = boundParents(nodes_[node].second);
        nodes_[node].low = glm::min(first[0], second[0]);
        nodes_[node].high = glm::max(first[1], second[1]);
    }
    return {nodes_[node].low, nodes_[node].high};
}

std::string StreamedWriter::jsonOf(std::uint32_t index) const {
    const Node& node = nodes_[index];
    const std::string bound = fmt::format(R"("bound":{{"min":[{},{},{}],"max":[{},{},{}]}})", node.low.x,
                                          node.low.y, node.low.z, node.high.x, node.high.y, node.high.z);
    if (node.axis < 0) {
        std::vector<std::string> lods;
        for (const Part& part : node.parts) {
            lods.push_back(fmt::format(R"("{}":{{"file":{},"offset":{},"count":{}}})", part.level, part.file,
                                       part.offset, part.count));
        }
        const std::string errors =
            has_errors_ ? fmt::format(R"(,"errors":[{:.7g}])", fmt::join(errorsOf(node), ",")) : "";
        return fmt::format(R"({{{},"lods":{{{}}}{}}})", bound, fmt::join(lods, ","), errors);
    }
    return fmt::format(R"({{{},"children":[{},{}]}})", bound, jsonOf(node.first), jsonOf(node.second));
}

void StreamedWriter::finish() {
    boundParents(0);
    const std::string text = fmt::format(
        R"({{"version":1,"asset":{{"generator":"binosplat"}},"count":{},"counts":[{}],"lodLevels":{},)"
        R"("lodErrors":{},{}"filenames":[{}],"tree":{}}})",
        std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0}), fmt::join(counts_, ","),
        counts_.size(), has_errors_, has_environment_ ? R"("environment":"env/meta.json",)" : "",
        fmt::join(files_, ","), jsonOf(0));
    PartFile file((part_ / "lod-meta.json").string());
    file.write(text.data(), text.size());
    file.commit();
    std::error_code error;
    fs::remove(folder_, error);  // an empty one
    fs::rename(part_, folder_, error);
    check(!error, "{}: cannot be moved into place: {}", folder_.string(), error.message());
    part_.clear();
}

}  // namespace binosplat
