// Cutting, thinning, writing.
#include "tests/engine/stream/split_scene.h"

#include "engine/error.h"
#include "engine/scene/sog.h"
#include "engine/scene/sog_pack.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

namespace binosplat::test {

namespace {

struct Box {
    glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};

    void take(const glm::vec3& a, const glm::vec3& b) {
        low = glm::min(low, a);
        high = glm::max(high, b);
    }
    [[nodiscard]] std::string json() const {
        return fmt::format(R"("bound":{{"min":[{},{},{}],"max":[{},{},{}]}})", low.x, low.y, low.z, high.x, high.y, high.z);
    }
};

// Where a leaf's splats of a level are.
struct Entry {
    std::size_t file = 0, offset = 0, count = 0;
};

struct Leaf {
    std::vector<std::uint32_t> splats;  // along a Morton curve
    std::vector<Entry> levels;
};

std::size_t shWidth(const Scene& scene) { return static_cast<std::size_t>(3 * shCoefficientCount(scene.sh_degree)); }

// The splat of a group that stands for all of it, appended to `to`.
void appendGroup(const Scene& scene, std::span<const std::uint32_t> group, Scene& to) {
    const std::uint32_t first = group.front();
    const float grown = std::sqrt(static_cast<float>(group.size()));
    to.positions.push_back(scene.positions[first]);
    to.rotations.push_back(scene.rotations[first]);
    to.scales.push_back(grown * scene.scales[first]);
    if (scene.isGaussian3d()) { to.thicknesses.push_back(scene.thicknesses[first]); }
    to.opacities.push_back(scene.opacities[first]);
    const std::size_t width = shWidth(scene), at = to.sh.size();
    to.sh.resize(at + width, 0.0f);
    for (const std::uint32_t splat : group) {
        for (std::size_t i = 0; i < width; ++i) { to.sh[at + i] += scene.sh[splat * width + i] / static_cast<float>(group.size()); }
    }
}

Scene like(const Scene& scene) {
    Scene empty;
    empty.name = scene.name;
    empty.sh_degree = scene.sh_degree;
    empty.antialiased = scene.antialiased;
    return empty;
}

class Splitter {
public:
    Splitter(const Scene& scene, const std::string& folder, const SplitSettings& settings)
        : scene_(scene), folder_(folder), settings_(settings) {}

    void run() {
        std::vector<std::uint32_t> all(scene_.size());
        std::iota(all.begin(), all.end(), 0u);
        cut(all);
        for (std::uint32_t level = 0; level < settings_.levels; ++level) { writeLevel(level); }
        const std::string tree = nodeJson();
        std::ofstream file(std::filesystem::path(folder_) / "lod-meta.json", std::ios::binary);
        file << R"({"version":1,"asset":{"generator":"binosplat's tests"},"lodLevels":)" << settings_.levels << R"(,"filenames":[)";
        for (std::size_t i = 0; i < files_.size(); ++i) { file << (i == 0 ? "" : ",") << '"' << files_[i] << '"'; }
        file << R"(],"tree":)" << tree << "}";
        check(file.good(), "{}: cannot be written", folder_);
    }

private:
    struct Node {
        Box box;
        bool is_leaf = false;
    };

    // Nodes in the order of a walk, each before its two children.
    void cut(std::span<std::uint32_t> splats) {
        Box box, centres;
        for (const std::uint32_t splat : splats) {
            const glm::vec3& p = scene_.positions[splat];
            const float reach = std::max(scene_.scales[splat].x, scene_.scales[splat].y);
            box.take(p - reach, p + reach);
            centres.take(p, p);
        }
        const bool is_leaf = splats.size() <= settings_.leaf_splats;
        nodes_.push_back({box, is_leaf});
        if (is_leaf) {
            leaves_.push_back({alongCurve(splats), {}});
            return;
        }
        const glm::vec3 sides = centres.high - centres.low;
        const int axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
        const auto middle = splats.begin() + static_cast<std::ptrdiff_t>(splats.size() / 2);
        std::nth_element(splats.begin(), middle, splats.end(), [&](std::uint32_t a, std::uint32_t b) {
            const float pa = scene_.positions[a][axis], pb = scene_.positions[b][axis];
            return pa < pb || (pa == pb && a < b);
        });
        cut(splats.first(splats.size() / 2));
        cut(splats.subspan(splats.size() / 2));
    }

    std::vector<std::uint32_t> alongCurve(std::span<const std::uint32_t> splats) const {
        Scene part;
        for (const std::uint32_t splat : splats) { part.positions.push_back(scene_.positions[splat]); }
        std::vector<std::uint32_t> order = mortonOrder(findSogPlaces(part));
        for (std::uint32_t& splat : order) { splat = splats[splat]; }
        return order;
    }

    void writeLevel(std::uint32_t level) {
        const std::size_t group = std::size_t{1} << level;
        Scene chunk = like(scene_);
        std::size_t part = 0;
        const auto write = [&] {
            if (chunk.size() == 0) { return; }
            files_.push_back(fmt::format("{}_{}.sog", level, part++));
            writeSogInOrder(chunk, (std::filesystem::path(folder_) / files_.back()).string());
            chunk = like(scene_);
        };
        for (Leaf& leaf : leaves_) {
            const std::size_t count = (leaf.splats.size() + group - 1) / group;
            if (chunk.size() + count > settings_.chunk_splats) { write(); }
            leaf.levels.push_back({files_.size(), chunk.size(), count});
            for (std::size_t i = 0; i < leaf.splats.size(); i += group) {
                appendGroup(scene_, std::span(leaf.splats).subspan(i, std::min(group, leaf.splats.size() - i)), chunk);
            }
        }
        write();
    }

    std::string nodeJson() {
        const Node& node = nodes_[next_node_++];
        if (!node.is_leaf) {
            const std::string first = nodeJson();
            return fmt::format(R"({{{},"children":[{},{}]}})", node.box.json(), first, nodeJson());
        }
        std::string lods;
        const Leaf& leaf = leaves_[next_leaf_++];
        for (std::size_t level = 0; level < leaf.levels.size(); ++level) {
            const Entry& entry = leaf.levels[level];
            lods += fmt::format(R"({}"{}":{{"file":{},"offset":{},"count":{}}})", level == 0 ? "" : ",", level, entry.file, entry.offset,
                                entry.count);
        }
        return fmt::format(R"({{{},"lods":{{{}}}}})", node.box.json(), lods);
    }

    const Scene& scene_;
    std::string folder_;
    SplitSettings settings_;
    std::vector<Node> nodes_;
    std::vector<Leaf> leaves_;
    std::vector<std::string> files_;
    std::size_t next_leaf_ = 0, next_node_ = 0;
};

}  // namespace

void splitScene(const Scene& scene, const std::string& folder, const SplitSettings& settings) {
    check(scene.size() > 0, "{}: has no splats to split", scene.name);
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    check(!error, "{}: cannot be made: {}", folder, error.message());
    Splitter(scene, folder, settings).run();
}

}  // namespace binosplat::test
