// Streamed SOG scenes, version 1, as PlayCanvas specifies them ("The Streamed SOG Format"): a folder of chunks, each a SOG scene of its own
// folder, and a lod-meta.json that says which of their splats show which part of the scene at which level.
#pragma once

#include "engine/scene/scene.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace binosplat {

struct StreamedWriteSettings {
    std::uint64_t chunk_splats = 512 * 1024;  // at most, unless a leaf has more
    std::uint64_t leaf_splats = 16 * 1024;    // of the finest level, at most
};

class StreamedWriter {
public:
    // `path` ends in /lod-meta.json. Its folder appears whole, with finish(), or not at all: until then all lies in one beside it. Throws
    // Error if the folder is there already and holds anything.
    StreamedWriter(const std::filesystem::path& path, const StreamedWriteSettings& settings);
    StreamedWriter(const StreamedWriter&) = delete;
    StreamedWriter& operator=(const StreamedWriter&) = delete;
    ~StreamedWriter();

    // The next level; the first is the finest, and is cut into leaves. The splats of each level go to the leaves in which their centres
    // lie, in Morton order.
    void addLevel(const Scene& scene, const Progress& progress = {});
    void finish();

private:
    struct Node {
        glm::vec3 low{0.0f}, high{0.0f};  // of what its splats reach, at all levels
        int axis = -1;                    // of a leaf -1; else splats at `cut` or beyond it go to the second child
        float cut = 0.0f;
        std::uint32_t first = 0, second = 0;  // children
        std::vector<std::string> levels;      // JSON: where its splats are, of a leaf
    };

    std::uint32_t cut(const Scene& scene, std::span<std::uint32_t> splats, int depth);
    std::uint32_t leafOf(const glm::vec3& position) const;
    void bound(std::uint32_t leaf, const Scene& scene, std::uint32_t splat);
    glm::mat2x3 boundParents(std::uint32_t node);
    [[nodiscard]] std::string jsonOf(std::uint32_t node) const;

    std::filesystem::path folder_, part_;
    StreamedWriteSettings settings_;
    std::vector<Node> nodes_;         // the root first
    std::vector<std::string> files_;  // JSON strings
    std::vector<std::uint64_t> counts_;
};

}  // namespace binosplat
