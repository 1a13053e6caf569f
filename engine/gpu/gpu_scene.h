// A scene in device memory: 48 bytes a disc, 52 a 3D Gaussian, and 20, 48 or 92 for SH bands 1 to 3 where the scene has them.
#pragma once

#include "engine/gpu/buffer.h"
#include "engine/mode.h"
#include "engine/scene/scene.h"
#include "shaders/shared/types.h"

#include <vector>

namespace binosplat {

// Positions, rotations, scales and opacities stay float32, rotations are normalised; colours are half floats (off by at most 2^-11 of
// themselves, and not beyond 65504). A splat with an attribute that is not finite, or a rotation of length zero, is never seen.
class GpuScene {
public:
    // Splits the scene into chunks of a power of two splats where one allocation cannot hold it.
    GpuScene(const Context& context, const Scene& scene, const Progress& progress = {});

    [[nodiscard]] std::uint32_t splatCount() const { return splat_count_; }
    [[nodiscard]] int shDegree() const { return sh_degree_; }
    // kDiscs, kGaussians or kAntialiasedGaussians.
    [[nodiscard]] std::uint32_t splatKind() const { return splat_kind_; }
    // Likewise for passes that dimming does not matter to: kDiscs or kGaussians.
    [[nodiscard]] std::uint32_t splatShape() const { return splat_kind_ == gpu::kDiscs ? gpu::kDiscs : gpu::kGaussians; }
    // As the scene asks for it.
    [[nodiscard]] Order usualOrder() const { return usual_order_; }
    // Whether its colours are light, to be encoded once they are blended.
    [[nodiscard]] bool isLight() const { return is_light_; }
    // Splat i lies in chunk i >> chunkBits().
    [[nodiscard]] std::uint32_t chunkBits() const { return chunk_bits_; }
    [[nodiscard]] std::size_t chunkCount() const { return buffers_.size(); }
    [[nodiscard]] gpu::DeviceAddress<gpu::SceneChunk> chunks() const { return chunk_table_.address<gpu::SceneChunk>(); }
    [[nodiscard]] std::uint64_t bytes() const;

private:
    std::uint32_t splat_count_ = 0;
    int sh_degree_ = 0;
    std::uint32_t splat_kind_ = gpu::kDiscs;
    Order usual_order_ = Order::kDepth;
    bool is_light_ = false;
    std::uint32_t chunk_bits_ = 0;
    std::vector<Buffer> buffers_;
    Buffer chunk_table_;
};

// Device bytes of one splat.
std::uint64_t deviceBytesPerSplat(int sh_degree, bool gaussian_3d);

}  // namespace binosplat
