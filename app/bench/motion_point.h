// `bench --motion`: one scene, view and size at every pose of a recorded head, and at each all methods.
#pragma once

#include "app/bench/bench_point.h"
#include "app/bench/motion_results.h"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace binosplat {

class MotionPoint {
public:
    MotionPoint(const Context& context, const GpuScene& scene, const RunOptions& run, const BenchPlan& plan, std::string name);

    // What each method's frame took.
    std::vector<FrameResult> time(const Cameras& cameras);
    // A pose that is not scored, and still is the past of one that is.
    void pass(const Cameras& cameras);
    // Of a scene that moves, before it is shown as at the next pose: what that would show otherwise.
    void rememberStill(const Cameras& cameras);
    // Adds a frame of each method to `result`.
    void play(const Cameras& cameras, std::size_t number, double time_s, std::vector<MotionFrame>& result);

private:
    // What is recorded for one method between frames.
    struct MethodHistory {
        BenchMethod method;
        std::array<Image, 2> error;  // pictures less full renders, of the frame before
    };

    // Both eyes in full, and how many pairs of tile and splat they took.
    struct FullRender {
        std::array<Image, 2> eyes;
        double pairs = 0.0;
    };

    CameraOptions camera_;
    BenchMethod shared_;
    MethodFrames frames_;
    std::string name_;
    std::vector<MethodHistory> sequences_;
    std::map<std::optional<Order>, FullRender> full_before_;
    std::map<std::optional<Order>, std::array<Image, 2>> still_;
};

// The frame took what another run of it took.
void setTimes(MotionFrame& frame, const FrameResult& result);

}  // namespace binosplat
