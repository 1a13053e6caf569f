// All methods at one scene, view and size, in turn, again and again, so that a device that drifts drifts for all of them alike.
#pragma once

#include "app/bench/bench_plan.h"
#include "app/bench/bench_results.h"
#include "app/options/camera_options.h"
#include "engine/frame/stereo_frame.h"
#include "engine/scene/scene.h"
#include "engine/stream/live_scene.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace binosplat {

// Renders methods, each in buffers that no method with other needs touches: what one allocates, no other pays for.
class MethodFrames {
public:
    MethodFrames(const Context& context, const GpuScene& scene) : context_(context), scene_(scene) {}

    // `frame` is where the pictures can be read until the next call.
    struct Rendered {
        FrameResult result;
        StereoFrame* frame;
    };
    // `compared`: the pictures are read and compared, with what made each pixel and with counters that cost time; otherwise they are as a
    // viewer has them.
    // `keep_past`: see FrameSettings.
    Rendered render(const Cameras& cameras, const CameraOptions& camera, const StereoOptions& stereo, bool compared = false,
                    bool keep_past = false);

    // The most memory, in bytes, that the program holds while nothing but this method's buffers are there, as a viewer has them. Lets go of
    // all others.
    std::uint64_t peakAlone(const Cameras& cameras, const CameraOptions& camera, const StereoOptions& stereo);

private:
    struct Entry {
        StereoOptions first_asked;
        std::unique_ptr<StereoFrame> frame;
    };
    StereoFrame& frameFor(const StereoOptions& stereo);

    const Context& context_;
    const GpuScene& scene_;
    std::vector<Entry> frames_;
};

struct BenchPoint {
    const GpuScene& gpu_scene;
    const Scene& scene;
    const RunOptions& run;
    const Cameras& cameras;
    std::string series, view, headset;
    LiveScene* live = nullptr;  // where it is streamed or moves; `scene` is a sample of it then
};

// Renders `round` until the device is as fast as it gets: `rounds` times, and two seconds long on a GPU, whose clocks fall while it waits
// for scenes to load or pictures to be compared (by a factor of four, NVIDIA H100) and take more than half a second to rise again.
void warmUp(const Context& context, std::uint32_t rounds, const std::function<void()>& round);

std::vector<BenchResult> benchPoint(const Context& context, const BenchPoint& point, const BenchPlan& plan);

}  // namespace binosplat
