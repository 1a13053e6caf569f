// Cutting, thinning, writing.
#include "tests/engine/stream/split_scene.h"

#include "engine/error.h"
#include "engine/files/sog.h"
#include "engine/files/sog_pack.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>
#include <span>

namespace binosplat::test {

namespace {

struct Box {
    glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};

    void take(const glm::vec3& a, const glm::vec3& b) {
        low = glm::min(low, a);
        high = glm::max(high, b);
    }
    [[nodiscard]] std::string json() const {
        return fmt::format(R"("bound":{{"min":[{},{},{}],"max":[{},{},{}]}})", low.x, low.y, low.z, high.x,
                           high.y, high.z);
    }
};

struct Leaf {
    std::vector<std::uint32_t> splats;  // along a Morton curve
    std::vector<std::string> levels;    // JSON: where its splats are
};

std::size_t shWidth(const Scene& scene) {
    return static_cast<std::size_t>(3 * shCoefficientCount(scene.sh_degree));
}

// Appends to `to` the splat that stands for a whole group.
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
        for (std::size_t i = 0; i < width; ++i) {
            to.sh[at + i] += scene.sh[splat * width + i] / static_cast<float>(group.size());
        }
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
        std::string tree = cut(all);
        for (std::uint32_t level = 0; level < settings_.levels; ++level) { writeLevel(level); }
        std::ofstream file(std::filesystem::path(folder_) / "lod-meta.json", std::ios::binary);
        file << fmt::format(R"({{"version":1,"asset":{{"generator":"binosplat's tests"}},"lodLevels":{},)"
                            R"("filenames":["{}"],"tree":{}}})",
                            settings_.levels, fmt::join(files_, R"(",")"), withLevels(std::move(tree)));
        check(file.good(), "{}: cannot be written", folder_);
    }

private:
    // The JSON of a node for these splats, either a leaf or with two children; the levels of a leaf are still
    // '#'.
    std::string cut(std::span<std::uint32_t> splats) {
        Box box, centres;
        for (const std::uint32_t splat : splats) {
            const glm::vec3& p = scene_.positions[splat];
            const float reach = std::max(scene_.scales[splat].x, scene_.scales[splat].y);
            box.take(p - reach, p + reach);
            centres.take(p, p);
        }
        if (splats.size() <= settings_.leaf_splats) {
            leaves_.push_back({alongCurve(splats), {}});
            return fmt::format(R"({{{},"lods":{{#}}}})", box.json());
        }
        const glm::vec3 sides = centres.high - centres.low;
        const int axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
        const std::size_t half = splats.size() / 2;
        std::ranges::nth_element(
            splats, splats.begin() + static_cast<std::ptrdiff_t>(half), {},
            [&](std::uint32_t splat) { return std::pair(scene_.positions[splat][axis], splat); });
        const std::string first = cut(splats.first(half));
        return fmt::format(R"({{{},"children":[{},{}]}})", box.json(), first, cut(splats.subspan(half)));
    }

    // The same with the levels that were written for each leaf.
    [[nodiscard]] std::string withLevels(std::string tree) const {
        std::size_t at = 0;
        for (const Leaf& leaf : leaves_) {
            at = tree.find('#', at);
            tree.replace(at, 1, fmt::format("{}", fmt::join(leaf.levels, ",")));
        }
        return tree;
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
            leaf.levels.push_back(fmt::format(R"("{}":{{"file":{},"offset":{},"count":{}}})", level,
                                              files_.size(), chunk.size(), count));
            for (std::size_t i = 0; i < leaf.splats.size(); i += group) {
                appendGroup(scene_,
                            std::span(leaf.splats).subspan(i, std::min(group, leaf.splats.size() - i)),
                            chunk);
            }
        }
        write();
    }

    const Scene& scene_;
    std::string folder_;
    SplitSettings settings_;
    std::vector<Leaf> leaves_;
    std::vector<std::string> files_;
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
