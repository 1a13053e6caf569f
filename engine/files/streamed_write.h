// Streamed SOG scenes, version 1, as PlayCanvas specifies them ("The Streamed SOG Format"): a folder of
// chunks, each a SOG scene in a folder of its own, and a lod-meta.json that says which of their splats show
// which part of the scene at which level.
#pragma once

#include "engine/scene/scene.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace binosplat {

struct StreamedWriteSettings {
    std::uint64_t chunk_splats = 512 * 1024;  // at most, unless a single leaf has more
    std::uint64_t leaf_splats = 16 * 1024;    // of the finest level, at most
};

// The error of a level's pictures where one of its splats is visible: sums over pixels of the splat's
// blending weight, and of that weight times the mean squared error over channels.
struct SplatError {
    double weight = 0.0, square = 0.0;
};

class StreamedWriter {
public:
    // `path` ends in /lod-meta.json. Its folder appears complete, with finish(), or not at all; until then
    // everything is in a folder next to it. Throws Error if the folder exists and is not empty.
    StreamedWriter(const std::filesystem::path& path, const StreamedWriteSettings& settings);
    StreamedWriter(const StreamedWriter&) = delete;
    StreamedWriter& operator=(const StreamedWriter&) = delete;
    ~StreamedWriter();

    // Call this first. Makes the leaves, with about the same number of splats of the finest level in each;
    // `centres` are those of all its splats. Throws Error if there are none.
    void cutLeaves(std::span<const glm::vec3> centres);
    // Groups whole leaves into blocks of at most `most` of these splats, unless a single leaf has more: the
    // block of each leaf, by its node.
    struct Blocks {
        std::vector<std::uint32_t> of_node;
        std::uint32_t count = 0;
    };
    [[nodiscard]] Blocks cutBlocks(std::uint64_t most) const;
    // The indices of these centres by block, ascending.
    [[nodiscard]] std::vector<std::vector<std::uint32_t>> sortInto(const Blocks& blocks,
                                                                   std::span<const glm::vec3> centres) const;
    // Adds splats of a level: all, or those of some leaves to which none have been added yet. They go to the
    // leaves in which their centres lie, in Morton order. `errors`: for each splat, against the earlier level
    // `against`; empty at level 0, and otherwise if unknown.
    void add(std::size_t level, const Scene& scene, std::span<const SplatError> errors = {},
             std::size_t against = 0, const Progress& progress = {});
    // Splats that every level shows, whatever is chosen: at most once.
    void addEnvironment(const Scene& scene, const Progress& progress = {});
    // How many splats each level has so far.
    [[nodiscard]] const std::vector<std::uint64_t>& counts() const { return counts_; }
    // A path for scratch files, removed with the writer: a folder that does not exist yet.
    [[nodiscard]] std::filesystem::path scratchFolder() const { return part_ / "scratch"; }
    // Scratch folders must be gone by then.
    void finish();

private:
    // Where a leaf's splats of a level are, and how large their error is.
    struct Part {
        std::size_t level = 0, file = 0, offset = 0, count = 0, against = 0;
        SplatError error;
    };
    struct Node {
        glm::vec3 low{0.0f}, high{0.0f};  // of what its finest splats reach
        // -1 for a leaf; otherwise splats at or beyond `cut` go to the second child
        int axis = -1;
        float cut = 0.0f;
        std::uint32_t first = 0, second = 0;  // children
        std::uint64_t splats = 0;             // of the finest level
        std::vector<Part> parts;              // of a leaf
    };

    std::uint32_t cut(std::span<const glm::vec3> centres, std::span<std::uint32_t> splats, int depth);
    std::uint32_t leafOf(const glm::vec3& position) const;
    void bound(std::uint32_t leaf, const Scene& scene, std::uint32_t splat, bool is_finest);
    glm::mat2x3 boundParents(std::uint32_t node);
    void collectBlocks(std::uint32_t node, std::uint64_t most, bool within, Blocks& blocks) const;
    [[nodiscard]] std::vector<double> errorsOf(const Node& leaf) const;
    [[nodiscard]] std::string jsonOf(std::uint32_t node) const;

    std::filesystem::path folder_, part_;
    StreamedWriteSettings settings_;
    std::vector<Node> nodes_;         // the root first
    std::vector<std::string> files_;  // JSON strings
    std::vector<std::uint64_t> counts_;
    std::vector<std::size_t> chunks_;     // of each level
    std::vector<SplatError> all_errors_;  // of each level, of all leaves
    bool has_errors_ = true, has_environment_ = false;
};

}  // namespace binosplat
