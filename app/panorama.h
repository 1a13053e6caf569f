// Pictures of all around the head, or of all before it.
#pragma once

#include "app/options/camera_options.h"
#include "engine/picture/panorama.h"
#include "engine/stream/live_scene.h"

#include <optional>
#include <vector>

namespace binosplat {

// What --projection and --size ask for; none if pictures are flat.
std::optional<Panorama> askedPanorama(const RenderOptions& options);

// The same eyes, upright where the scene's up is known: of where the head turns to only the heading counts, so that horizons are level.
// Both eyes look ahead and stay where they are whichever column is looked at, as the lenses of cameras for such pictures do.
Cameras panoramaCameras(const Cameras& cameras, const Panorama& panorama);

struct EyePictures {
    std::vector<Image> pictures;  // of each eye
    FrameResult result;           // of all faces together
};

// Of the middle in Mode::kMono, else of both eyes.
EyePictures renderPanorama(StereoFrame& frame, LiveScene* live, const FrameSettings& settings, const Cameras& cameras,
                           const Panorama& panorama);

}  // namespace binosplat
