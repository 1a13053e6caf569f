// Pictures of a scene, one eye after the other, and what each splat makes up of them.
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

    // The following are of this scene, which stays as it is and must outlive them. All sums are zero. `fits`: see measure.
    void show(const GpuScene& scene, bool fits);
    // Renders an eye into `picture`, on black, and then adds to the sums what each splat makes up of it. `near` is in scene units.
    // `wanted`: what the picture should be, if the scene is shown to be fitted.
    void measure(const Eye& eye, double near, Picture& picture, const Picture* wanted = nullptr);
    // The same without sums.
    void render(const Eye& eye, double near, Picture& picture);
    // Adds to the sums for the eye that was rendered last, as measure does.
    void add(const Picture& picture, const Picture* wanted);
    // The sums so far, in gpu::kContributionSteps: of each splat its weight alone or kContributionSums.
    [[nodiscard]] std::vector<std::int64_t> sums();
    [[nodiscard]] std::vector<float> pixels(const Picture& picture);
    // A picture of these pixels, four floats each.
    [[nodiscard]] Picture pictureOf(std::span<const float> pixels, glm::uvec2 size_px);

private:
    void record(const Eye& eye, double near, const Picture& picture);
    // False: the lists had no room, now they have.
    bool hadRoom();
    template <typename T>
    std::vector<T> read(const Buffer& buffer);

    const Context& context_;
    PassKernels kernels_;
    const GpuScene* scene_ = nullptr;
    FrameBuffers buffers_;
    Targets targets_;
    Buffer sums_, readback_;
    bool fits_ = false;
    Commands commands_;  // last: it waits before what it uses is freed
};

}  // namespace binosplat
