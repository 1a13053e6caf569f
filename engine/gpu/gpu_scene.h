// A scene in device memory; packed_splats.h says how much a splat takes.
#pragma once

#include "engine/gpu/packed_splats.h"

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace binosplat {

class Commands;

// A part of a scene that appeared, disappeared or faded: where in the world, and by how much its opacity
// changed, up to 1.
struct SceneChange {
    glm::vec3 low, high;
    float amount;
};

// The pages of a scene, as the device has them.
struct PageTable {
    std::vector<gpu::SceneChunk> chunks;
    std::vector<gpu::ScenePage> bounds;
};

// Positions, rotations, scales and opacities stay float32, with rotations normalised; colours become half
// floats (off by at most 2^-11, and at most 65504). A splat with an attribute that is not finite, or a
// rotation of length zero, is never visible.
class GpuScene {
public:
    // A whole scene that stays as it is. Splits it into chunks of a power of two splats if one allocation
    // cannot hold it. `keeps_table`: it may be placed among others.
    GpuScene(const Context& context, const Scene& scene, const Progress& progress = {},
             bool keeps_table = false);

    // What frames read of it, for those of a thread of its own: counts as they are now, and memory that stays
    // this one's, which must outlive it. Brings no changes.
    [[nodiscard]] GpuScene asItIs() const;

    // Capacity in splats; in a scene of pages some places may be free.
    [[nodiscard]] std::uint32_t splatCount() const { return splat_count_; }
    // Splats that are there.
    [[nodiscard]] std::uint32_t splatsHeld() const { return splats_held_; }
    // Loaded pages, if the scene is in pages.
    [[nodiscard]] std::uint32_t pagesHeld() const { return pages_held_; }
    // Splats there will be once all pending changes are recorded.
    [[nodiscard]] std::uint32_t splatsComing() const { return splats_coming_; }
    [[nodiscard]] const SceneTraits& traits() const { return traits_; }
    [[nodiscard]] int shDegree() const { return traits_.sh_degree; }
    [[nodiscard]] std::uint32_t splatKind() const { return traits_.splat_kind; }
    // As the scene asks for it.
    [[nodiscard]] Order usualOrder() const { return traits_.usual_order; }
    // True if its colours are light, to be encoded after blending.
    [[nodiscard]] bool isLight() const { return traits_.is_light; }
    // Splat i lies in chunk i >> chunkBits().
    [[nodiscard]] std::uint32_t chunkBits() const { return chunk_bits_; }
    [[nodiscard]] std::size_t chunkCount() const { return chunk_count_; }
    [[nodiscard]] gpu::DeviceAddress<gpu::SceneChunk> chunks() const { return chunks_; }
    // True if chunks come and go: then each is a page, and pages() are their bounds.
    [[nodiscard]] bool isInPages() const { return pages_.value != 0; }
    [[nodiscard]] gpu::DeviceAddress<gpu::ScenePage> pages() const { return pages_; }
    // What the next frame reads; empty if it was not kept. Scenes in pages always keep it.
    [[nodiscard]] const PageTable& table() const { return table_; }
    // True if its chunks are those of several scenes, each with a placement.
    [[nodiscard]] bool isPlaced() const { return is_placed_; }
    [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
    // Records changes from one frame to the next, before any pass of the next; does nothing for a scene that
    // stays as it is.
    void recordChanges(Commands& commands) const {
        if (record_changes_) { record_changes_(commands); }
    }
    // Where something changed: notes it for the next recordChanges(); counts all changes ever recorded; and
    // returns those after the first `known` of them, until the next recordChanges(), or nothing if changes
    // that old are forgotten.
    [[nodiscard]] std::span<const SceneChange> changesNoted() const { return changes_noted_; }
    [[nodiscard]] std::uint64_t changesRecorded() const { return changes_forgotten_ + changes_.size(); }
    [[nodiscard]] std::optional<std::span<const SceneChange>> changesSince(std::uint64_t known) const {
        if (known < changes_forgotten_) { return std::nullopt; }
        return std::span(changes_).subspan(static_cast<std::size_t>(known - changes_forgotten_));
    }

private:
    friend class ResidentScene;
    friend class PlacedScenes;
    GpuScene() = default;
    void keepTable(const Scene& scene, const std::vector<gpu::SceneChunk>& chunks);

    SceneTraits traits_;
    std::uint32_t splat_count_ = 0, splats_held_ = 0, splats_coming_ = 0, pages_held_ = 0;
    std::uint32_t chunk_bits_ = 0;
    std::size_t chunk_count_ = 0;
    gpu::DeviceAddress<gpu::SceneChunk> chunks_;
    gpu::DeviceAddress<gpu::ScenePage> pages_;
    std::uint64_t bytes_ = 0;
    std::vector<Buffer> buffers_;
    Buffer chunk_table_;
    PageTable table_;
    bool is_placed_ = false;
    std::function<void(Commands&)> record_changes_;
    std::vector<SceneChange> changes_noted_, changes_;  // of the recorded ones, only the latest
    std::uint64_t changes_forgotten_ = 0;
};

}  // namespace binosplat
