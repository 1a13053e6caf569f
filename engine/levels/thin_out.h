// A scene with fewer splats: those that show most stay, and take over what the others showed.
#pragma once

#include "engine/levels/splat_meter.h"
#include "engine/scene/scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace binosplat {

inline constexpr std::size_t kJudgingViews = 48;
inline constexpr gpu::uint kJudgingSidePx = 256;

// Where a person could stand (standingViews): `count` eyes, after the `first` of them.
std::vector<Eye> standingEyes(const Scene& scene, std::size_t count = kJudgingViews, std::size_t first = 0,
                              gpu::uint side_px = kJudgingSidePx);

class ThinOut {
public:
    // Renders `scene`, which outlives this, from all eyes, which `progress` is told of. `near` is in scene units.
    ThinOut(const Context& context, const Scene& scene, std::vector<Eye> eyes, double near, const Progress& progress = {});

    // The indices of `count` splats, more of those whose blending weights over all pixels of all eyes have greater sums; ascending.
    [[nodiscard]] std::vector<std::uint32_t> choose(std::uint64_t count) const;
    // The scene with these splats alone, wider, and fitted so that the eyes see what the whole scene shows them: in colour, opacity and
    // size. The same on every run on one device.
    [[nodiscard]] Scene keep(std::uint64_t count, const Progress& progress = {});
    // How far what the eyes see of another scene is from what they see of this one: the mean square over pixels and channels.
    [[nodiscard]] double errorOf(const Scene& scene);

private:
    void fit(Scene& scene, const Progress& progress);

    const Context& context_;
    const Scene& scene_;
    std::vector<Eye> eyes_;
    double near_;
    SplatMeter meter_;
    std::vector<Picture> wanted_;
    std::vector<std::int64_t> weights_;
};

}  // namespace binosplat
