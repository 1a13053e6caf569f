// Drawing in vain.
#include "app/view/scenes/frame_maker.h"

namespace binosplat {

glm::uvec3 shapeOfFrames(std::span<const Eye> eyes, const FrameSettings& settings) {
    return {glm::max(settings.most_px, eyes.front().size_px), settings.hidden_tiles[0].empty() ? 0 : 1};
}

SceneFrames makeFrames(const Context& context, PassKernels& kernels, const GpuScene& scene,
                       const FramesWanted& wanted) {
    const auto make = [&](std::span<const Eye> eyes, const FrameSettings& settings) {
        auto frame = std::make_unique<StereoFrame>(context, scene, kernels);
        frame->reserve(eyes, settings);
        // Each has memory of its own.
        for (int turn = 0; turn < 2; ++turn) { (void)frame->renderAhead(eyes, settings); }
        (void)frame->finish();
        frame->forgetHistory();
        frame->reserveForChanges(wanted.bytes_for_changes);
        return frame;
    };
    FrameSettings settings = wanted.settings;
    settings.hidden_tiles = {wanted.hidden_tiles[0], wanted.hidden_tiles[1]};
    SceneFrames frames{make(wanted.eyes, settings), {}, shapeOfFrames(wanted.eyes, settings)};
    if (!wanted.inset_eyes.empty()) { frames.insets = make(wanted.inset_eyes, wanted.inset_settings); }
    return frames;
}

}  // namespace binosplat
