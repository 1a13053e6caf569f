// All methods at one scene, view and size, in turn and repeatedly, so that a device's drift affects all of
// them alike.
#pragma once

#include "app/bench/bench_plan.h"
#include "app/bench/bench_results.h"
#include "app/options/camera_options.h"
#include "app/scores/resize.h"
#include "app/view/governor/governor.h"
#include "engine/frame/stereo_frame.h"
#include "engine/scene/scene.h"
#include "engine/stream/live_scene.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace binosplat {

// Renders methods, each in buffers shared only with methods that have the same needs, so that none pays for
// another's allocations.
class MethodFrames {
public:
    MethodFrames(const Context& context, const GpuScene& scene) : context_(context), scene_(scene) {}

    // The pictures can be read from `frame` until the next call.
    struct Rendered {
        FrameResult result;
        StereoFrame* frame;
        glm::uvec2 size_px;  // for a full picture

        // At the full size.
        [[nodiscard]] Image readPicture(int eye) const { return scaleUp(frame->readPicture(eye), size_px); }
    };
    // `compared`: for pictures that are read and compared, with the origin of each pixel and counters that
    // cost time; otherwise as in the viewer. `keep_history`: see FrameSettings. `views`: what is seen, if the
    // cameras' pictures cover more. `chosen`: in place of the method's resolution and bound.
    Rendered render(const Cameras& full_cameras, const CameraOptions& camera, const BenchMethod& method,
                    bool compared = false, bool keep_history = false, const Cameras* views = nullptr,
                    const std::optional<GovernedSettings>& chosen = {});

    // The program's peak memory, in bytes, while it holds only this method's buffers, as in the viewer. Frees
    // the buffers of all other methods.
    std::uint64_t peakAlone(const Cameras& cameras, const CameraOptions& camera, const BenchMethod& method);

private:
    struct Entry {
        BenchMethod first_asked;
        std::unique_ptr<StereoFrame> frame;
    };
    StereoFrame& frameFor(const BenchMethod& method);

    const Context& context_;
    const GpuScene& scene_;
    std::vector<Entry> frames_;
    std::uint32_t frames_governed_ = 0;
};

struct BenchPoint {
    const GpuScene& gpu_scene;
    const Scene& scene;
    const RunOptions& run;
    const Cameras& cameras;
    std::string series, view, headset;
    LiveScene* live = nullptr;  // if it is streamed or moves; then `scene` is a sample of it
};

// Renders `round` until the device is at full speed: `rounds` times, and for two seconds on a GPU, whose
// clock rate falls while it waits for scenes to load or pictures to be compared (by a factor of four on an
// NVIDIA H100) and takes more than half a second to rise again.
void warmUp(const Context& context, std::uint32_t rounds, const std::function<void()>& round);

std::vector<BenchResult> benchPoint(const Context& context, const BenchPoint& point, const BenchPlan& plan);

}  // namespace binosplat
