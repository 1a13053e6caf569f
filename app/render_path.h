// Frames along a recorded way of the head: numbered pictures of what each eye sees, and what each frame took.
#pragma once

#include "app/options/camera_options.h"
#include "app/options/options.h"
#include "app/report/report.h"
#include "engine/setup/head_motion.h"
#include "engine/setup/output_files.h"
#include "engine/stream/live_scene.h"

#include <vector>

namespace binosplat {

struct HeadPath {
    HeadMotion motion;
    std::vector<double> times_s;  // of the frames, since the motion's first pose
};

// --path, at each of its poses or --rate times a second. Throws Error where the file cannot be used, or where the output folder holds
// numbered pictures that the new ones would not replace: nobody could tell them apart.
HeadPath readHeadPath(const RenderOptions& options);

// Every frame's pictures, staged in `files`; cameras start as `start` and move with the head. Each frame waits until all is there that it
// asks for of a `live` scene, which is null where the scene is whole; one that moves begins with the first frame.
std::vector<PathFrame> renderPath(StereoFrame& frame, LiveScene* live, const FrameSettings& settings, const Cameras& start,
                                  double units_per_metre, const HeadPath& path, OutputFiles& files);

}  // namespace binosplat
