// Pictures of everything around the head, or of everything ahead of it.
#pragma once

#include "app/options/camera_options.h"
#include "engine/picture/panorama.h"
#include "engine/stream/live_scene.h"

#include <optional>
#include <vector>

namespace binosplat {

// What --projection and --size ask for; empty if pictures are flat.
std::optional<Panorama> askedPanorama(const RenderOptions& options);

// The same eyes, upright if the scene's up is known: only the heading of the head counts, so that horizons
// are level. Both eyes look ahead and stay at their places whichever column is rendered, like the lenses of
// cameras for such pictures.
Cameras panoramaCameras(const Cameras& cameras, const Panorama& panorama);

struct EyePictures {
    std::vector<Image> pictures;  // of each eye
    FrameResult result;           // of all faces together
};

// For the midpoint in Mode::kMono, otherwise for both eyes.
EyePictures renderPanorama(StereoFrame& frame, LiveScene* live, const FrameSettings& settings,
                           const Cameras& cameras, const Panorama& panorama);

}  // namespace binosplat
