// Pictures of a scene, one eye after the other, and how much each splat contributes to them.
#pragma once

#include "engine/geometry.h"
#include "engine/levels/contribute.h"

#include <cstdint>
#include <span>
#include <vector>

namespace binosplat {

class SplatMeter {
public:
    explicit SplatMeter(const Context& context);
    SplatMeter(const SplatMeter&) = delete;
    SplatMeter& operator=(const SplatMeter&) = delete;

    // What follows is about this scene, which stays as it is and must outlive it. All sums are zero:
    // of each splat its weight and what pictures are off by, or all kContributionSums if it is to be fitted.
    void show(const GpuScene& scene, bool fits);
    // Renders an eye into `picture`, on black. `near` is in scene units.
    void render(const Eye& eye, double near, Picture& picture);
    // Adds to the sums how much each splat contributes to the picture rendered last. `wanted`: what it should
    // be, if not what it is.
    void addSums(const Picture& picture, const Picture* wanted = nullptr);
    // The pairs of the fullest tile of the picture rendered last.
    [[nodiscard]] gpu::uint fullestTile();
    // The sums so far, in gpu::kContributionSteps.
    [[nodiscard]] std::vector<std::int64_t> sums();
    [[nodiscard]] std::vector<float> pixels(const Picture& picture);

private:
    void record(const Eye& eye, double near, const Picture& picture);
    // False: the lists were too short, and have been made longer.
    bool hadCapacity();
    template <typename T>
    std::vector<T> read(const Buffer& buffer);

    const Context& context_;
    PassKernels kernels_;
    const GpuScene* scene_ = nullptr;
    FrameBuffers buffers_;
    Targets targets_;
    Buffer sums_, readback_;
    bool fits_ = false;
    Commands commands_;  // last: it waits before anything that it uses is freed
};

}  // namespace binosplat
