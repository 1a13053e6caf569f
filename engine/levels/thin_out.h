// A scene with fewer splats: those that show most stay, and take over what the others showed.
#pragma once

#include "engine/files/streamed_write.h"
#include "engine/levels/splat_meter.h"
#include "engine/scene/scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace binosplat {

inline constexpr std::size_t kJudgingViews = 48;
inline constexpr gpu::uint kJudgingSidePx = 256;
inline constexpr int kFitSteps = 16;

// Where a person could stand (standingViews): `count` eyes, leaving out the first `first`.
std::vector<Eye> standingEyes(const Scene& scene, std::size_t count = kJudgingViews, std::size_t first = 0,
                              gpu::uint side_px = kJudgingSidePx);

// A part of a scene as seen from `count` of the places of these eyes (viewsOnto).
std::vector<Eye> eyesOnto(const Scene& part, std::span<const Eye> from, std::size_t count, gpu::uint side_px);

class ThinOut {
public:
    // Renders `scene`, which must outlive this, from all eyes, and reports to `progress`. `near` is in scene
    // units. `steps`: of a fit, each from every fourth eye. On a software device, pictures of which a tile
    // has too many splats are larger than their eyes say.
    ThinOut(const Context& context, const Scene& scene, std::vector<Eye> eyes, double near,
            const Progress& progress = {}, int steps = kFitSteps);

    // The indices of `count` splats, favouring those with the greater sums of blending weights over all
    // pixels of all eyes; ascending.
    [[nodiscard]] std::vector<std::uint32_t> choose(std::uint64_t count) const;
    // The scene with only these splats, wider, and fitted so that the eyes see what the whole scene shows
    // them: in colour, opacity and size. The same on every run on one device.
    [[nodiscard]] Scene keep(std::uint64_t count, const Progress& progress = {});
    // How far another scene's pictures for these eyes are from this one's: the mean square over pixels and
    // channels.
    [[nodiscard]] double errorOf(const Scene& scene);
    // The same for each splat of the other scene, which must have some, where it shows; from one of `every`
    // of the eyes.
    [[nodiscard]] std::vector<SplatError> splatErrorsOf(const Scene& scene, const Progress& progress = {},
                                                        std::size_t every = 1);

private:
    void weigh(const Progress& progress);
    void fit(Scene& scene, const Progress& progress);

    const Context& context_;
    const Scene& scene_;
    std::vector<Eye> eyes_;
    double near_;
    int steps_;
    SplatMeter meter_;
    std::vector<Picture> wanted_;
    std::vector<std::int64_t> weights_;
};

}  // namespace binosplat
