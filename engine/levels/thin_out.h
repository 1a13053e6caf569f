// A scene with fewer splats: those that show most stay, or are merged, and take over what the others showed.
#pragma once

#include "engine/files/streamed_write.h"
#include "engine/levels/merge.h"
#include "engine/levels/splat_meter.h"
#include "engine/scene/scene.h"

#include <cstdint>
#include <memory>
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
    // units. `steps`: of a fit, each from every fourth eye. `side_of_few_px`: where few of many splats stay,
    // they are fitted in pictures of at most this side; 0: of any. On a software device, pictures of which a
    // tile has too many splats are larger than their eyes say.
    ThinOut(const Context& context, const Scene& scene, std::vector<Eye> eyes, double near,
            const Progress& progress = {}, int steps = kFitSteps, gpu::uint side_of_few_px = 0);

    // The indices of `count` splats, favouring those with the greater sums of blending weights over all
    // pixels of all eyes; ascending.
    [[nodiscard]] std::vector<std::uint32_t> choose(std::uint64_t count) const;
    // A scene of `count` splats, fitted so that the eyes see what the whole scene shows them: in colour,
    // opacity and size. These are the chosen splats, made wider, or, where few of many stay, each is merged
    // from several. The same calls give the same splats on every run on one device.
    [[nodiscard]] Scene keep(std::uint64_t count, const Progress& progress = {});
    // How far another scene's pictures for these eyes are from this one's: the mean square over pixels and
    // channels.
    [[nodiscard]] double errorOf(const Scene& scene);
    // The same for each splat of the other scene, which must have some, where it shows; from one of `every`
    // of the eyes.
    [[nodiscard]] std::vector<SplatError> splatErrorsOf(const Scene& scene, const Progress& progress = {},
                                                        std::size_t every = 1);

private:
    // The whole scene's pictures, for eyes that may become larger.
    struct Wanted {
        std::vector<Eye> eyes;
        std::vector<Picture> pictures;
    };
    // Adds each splat's weights to `weights`, if given.
    void look(Wanted& wanted, std::vector<std::int64_t>* weights, const Progress& progress);
    void fit(Scene& scene, const Wanted& wanted, const Progress& progress);
    [[nodiscard]] Scene chosen(std::uint64_t count) const;
    Scene merged(std::uint64_t count);
    const Wanted& wantedOfFew();

    const Context& context_;
    const Scene& scene_;
    Wanted wanted_, wanted_of_few_;
    double near_;
    int steps_;
    gpu::uint side_of_few_px_;
    SplatMeter meter_;
    std::vector<std::int64_t> weights_;
    std::unique_ptr<SplatMerger> merger_;
};

}  // namespace binosplat
