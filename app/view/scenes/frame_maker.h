// Frames of a scene before it is shown, so that the first one that is shown finds its lists and pictures
// made.
#pragma once

#include "engine/frame/stereo_frame.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace binosplat {

// What such frames will be like.
struct FramesWanted {
    std::vector<Eye> eyes;
    FrameSettings settings;  // with tiles that are hidden as below
    std::array<std::vector<std::uint8_t>, 2> hidden_tiles;
    std::vector<Eye> inset_eyes;  // empty: without insets
    FrameSettings inset_settings;
    std::uint64_t bytes_for_changes = 0;  // of the scene, see StereoFrame
};

// The size that their pictures have memory for, and whether it is known which tiles show.
glm::uvec3 shapeOfFrames(std::span<const Eye> eyes, const FrameSettings& settings);

struct SceneFrames {
    std::unique_ptr<StereoFrame> frame, insets;  // null: none
    glm::uvec3 shape{0};
};

// The same of a scene that is shown, to replace its frames of another method.
struct RemadeFrames {
    std::unique_ptr<GpuScene> scene;  // as it was, until the frames go on with the shown one
    SceneFrames frames;
};

// Draws two of them that nobody sees; on any thread. `kernels` and `scene` outlive the frames; nobody else
// uses the scene meanwhile. Throws Error if the device lacks the memory.
SceneFrames makeFrames(const Context& context, PassKernels& kernels, const GpuScene& scene,
                       const FramesWanted& wanted);

}  // namespace binosplat
