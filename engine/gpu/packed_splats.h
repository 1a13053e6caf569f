// Splats as stored on the device: 48 bytes per disc, 52 per 3D Gaussian, and 20, 48 or 92 more for SH bands 1
// to 3 if the scene has them.
#pragma once

#include "engine/gpu/buffer.h"
#include "engine/mode.h"
#include "engine/scene/scene.h"
#include "shaders/shared/types.h"

#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace binosplat {

// Traits that a scene's splats share.
struct SceneTraits {
    int sh_degree = 0;
    std::uint32_t splat_kind = gpu::kDiscs;  // or kGaussians
    // The Gaussians were trained with an opacity that the low-pass dims.
    bool is_dimmed = false;
    Order usual_order = Order::kDepth;  // the one that the scene asks for
    bool is_light = false;              // its colours are linear, to be encoded once they are blended

    [[nodiscard]] bool isGaussian3d() const { return splat_kind != gpu::kDiscs; }
    bool operator==(const SceneTraits&) const = default;
};
SceneTraits traitsOf(const Scene& scene);

// Device bytes of one splat.
std::uint64_t deviceBytesPerSplat(int sh_degree, bool gaussian_3d);

// Where the arrays of `capacity` splats begin within their chunk, in bytes; each begins, and the last ends,
// at a multiple of 16.
struct ChunkLayout {
    ChunkLayout(std::uint64_t capacity, const SceneTraits& traits);
    // For such splats that begin this far into a buffer.
    [[nodiscard]] gpu::SceneChunk chunkAt(const Buffer& buffer, std::uint64_t offset_bytes, float fade) const;

    std::uint64_t positions = 0, rotations = 0, scales = 0, thicknesses = 0, opacities = 0, base_colours = 0,
                  sh = 0, bytes = 0;
    std::uint64_t sh_bytes_per_splat = 0;
    std::uint32_t sh_degree = 0;
};

// Half the size of the axis-aligned box, in the world, around every part of a splat that is not fainter than
// kMinAlpha, with a small margin for the device's rounding. `scales` are along the axes of `rotation`, which
// has unit length (a disc's third is 0). A splat with an opacity below kMinAlpha is not visible at all.
glm::dvec3 halfExtentOf(const glm::quat& rotation, const glm::vec3& scales, float opacity);

// What the device must know about a page: the box around its visible splats, and how many there are.
class PageBounds {
public:
    void add(const glm::vec3& centre, const glm::quat& rotation, const glm::vec3& scales, float opacity);
    [[nodiscard]] gpu::ScenePage page() const;

private:
    glm::dvec3 low_{std::numeric_limits<double>::infinity()}, high_{-std::numeric_limits<double>::infinity()};
    double reach_ = 0.0;
    std::uint32_t shown_ = 0;
};

// Writes splats [first, first + count) of `scene`, which is of the same kind, to `to`, laid out as `layout`
// (for at least `count` splats). Bands of harmonics that the scene lacks become zeros; those beyond the
// traits' degree are dropped. `bounds` grows to include the visible splats.
void packSplats(const Scene& scene, std::uint64_t first, std::uint64_t count, const SceneTraits& traits,
                const ChunkLayout& layout, std::uint8_t* to, PageBounds* bounds = nullptr);

// Splats in pages of kPageSplats, each with its own layout and bounds; the last page is padded with splats
// that are never visible. Can be made on any thread.
class PackedPages {
public:
    // Splats [first, first + count) of `scene`. Throws Error if they are discs and the traits are for 3D
    // Gaussians, or the other way round.
    PackedPages(const Scene& scene, std::size_t first, std::size_t count, const SceneTraits& traits);
    PackedPages(const Scene& scene, const SceneTraits& traits)
        : PackedPages(scene, 0, scene.size(), traits) {}
    // One page in its packed form.
    PackedPages(std::uint32_t splats, const gpu::ScenePage& page, std::vector<std::uint8_t> bytes)
        : splat_count_(splats), pages_{page}, bytes_(std::move(bytes)) {}
    PackedPages() = default;

    [[nodiscard]] std::uint32_t splatCount() const { return splat_count_; }
    [[nodiscard]] std::uint32_t pageCount() const { return static_cast<std::uint32_t>(pages_.size()); }
    [[nodiscard]] const std::vector<gpu::ScenePage>& pages() const { return pages_; }
    // As many bytes per page as a ChunkLayout of kPageSplats has.
    [[nodiscard]] std::span<const std::uint8_t> bytes() const { return bytes_; }

private:
    std::uint32_t splat_count_ = 0;
    std::vector<gpu::ScenePage> pages_;
    std::vector<std::uint8_t> bytes_;
};

}  // namespace binosplat
