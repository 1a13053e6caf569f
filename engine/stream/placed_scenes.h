// Several placed scenes as one on the device: their splats stay where they are in memory, and the pages of
// all scenes are listed together.
#pragma once

#include "engine/gpu/gpu_scene.h"
#include "engine/similarity.h"

#include <span>
#include <vector>

namespace binosplat {

struct PlacedScene {
    const GpuScene* scene = nullptr;  // with a table; it may be in several places
    glm::dvec3 origin{0.0};           // of its positions
    Similarity world_from_scene = {};
    bool is_shown = true;
};

class PlacedScenes {
public:
    // The scenes must outlive this; place() may change where they are. Throws Error unless all are discs, or
    // all are Gaussians of one kind, and the colours of all are encoded in the same way.
    PlacedScenes(const Context& context, std::span<const PlacedScene> scenes);
    PlacedScenes(const PlacedScenes&) = delete;
    PlacedScenes& operator=(const PlacedScenes&) = delete;

    // The scene that frames render. Changes of the scenes themselves must be recorded before its own.
    [[nodiscard]] const GpuScene& scene() const { return scene_; }
    // The origin of its positions, in the world.
    [[nodiscard]] const glm::dvec3& origin() const { return origin_; }
    // True if it consists of these scenes, in this order.
    [[nodiscard]] bool isOf(std::span<const PlacedScene> scenes) const;
    // From the next recordChanges on.
    void place(std::span<const PlacedScene> scenes);

private:
    // A scene's pages in the table.
    struct Part {
        std::size_t first_page = 0;
        std::uint64_t changes_known = 0;
        gpu::ScenePage bounds;  // of the whole page, as frames see it; with count 0: nowhere
        bool is_dirty = true;
    };

    [[nodiscard]] gpu::Placement placementOf(const PlacedScene& placed) const;
    [[nodiscard]] gpu::DeviceAddress<gpu::Placement> placementAt(std::size_t part) const;
    void makePages(std::size_t part);
    // What changed in the scene itself.
    void noteChanges(std::size_t part);
    void recordChanges(Commands& commands);

    glm::dvec3 origin_{0.0};
    std::vector<PlacedScene> placed_;
    std::vector<Part> parts_;
    GpuScene scene_;
    Buffer page_table_, placements_;
};

}  // namespace binosplat
