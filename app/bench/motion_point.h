// `bench --motion`: one scene, view and size at every pose of a recorded head, with all methods at each pose.
#pragma once

#include "app/axes/staying_axes.h"
#include "app/bench/bench_point.h"
#include "app/bench/motion_results.h"
#include "app/bench/seen_through_lens.h"

#include <array>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace binosplat {

class MotionPoint {
public:
    // `frame_time`: of `temporal`; if limited, a governor chooses its resolution and bound.
    MotionPoint(const Context& context, const GpuScene& scene, const RunOptions& run, const BenchPlan& plan,
                std::string name, const FrameTime& frame_time = {});
    // Repeats the choices of `timed` for the same poses, however long frames take now.
    void chooseAs(const MotionPoint& timed);

    // Renders a frame of each method, so that none is timed in its first frame.
    void warm(const Cameras& cameras);
    // Renders a frame of each method, only to measure it.
    std::vector<FrameResult> time(const Cameras& cameras);
    // Renders a pose that is not scored, but is the history of one that is.
    void pass(const Cameras& cameras);
    // For a moving scene, before it moves on: renders the next pose without that motion.
    void rememberStill(const Cameras& cameras);
    // Adds a frame of each method to `result`.
    void play(const Cameras& cameras, std::size_t number, double time_s, std::vector<MotionFrame>& result);

private:
    // What is kept for one method between frames.
    struct MethodHistory {
        BenchMethod method;
        std::array<Image, 2> error;  // pictures - full renders, of the previous frame
        FrameTime frame_time = {};   // of a governed frame
        std::optional<Governor> governor = {};
        // The governor's choice for each pose so far, or that of another run.
        std::vector<GovernedSettings> chosen = {};
        std::size_t next = 0;  // of these
    };

    // Both eyes in full, and their pairs of tile and splat.
    struct FullRender {
        std::array<Image, 2> eyes, seen;  // `seen`: through the lenses of a named headset
        double pairs = 0.0;
    };

    // The cameras of a pose, and what is seen of their pictures: the same unless their axes stay.
    struct Posed {
        const Cameras& views;
        Cameras pictures;
    };
    Posed posed(const Cameras& cameras);
    // A frame of a method, with what its governor chooses.
    MethodFrames::Rendered render(const Posed& pose, MethodHistory& sequence);
    // If a limit is a share of two-pass's time.
    void timeTwoPass(const Posed& pose);
    // The time of a governed frame and its limit, in ms.
    [[nodiscard]] std::pair<double, double> timeAndLimit(const FrameTime& limit, double ms) const;
    MethodFrames::Rendered render(const Posed& pose, const BenchMethod& method, bool keep_history,
                                  const std::optional<GovernedSettings>& chosen = {});
    // As a wearer sees it.
    [[nodiscard]] Image show(const Posed& pose, const MethodFrames::Rendered& rendered, int eye) const;
    // Renders the eyes in full, in the order of shared_.
    FullRender renderFull(const Posed& pose);

    CameraOptions camera_;
    BenchMethod shared_, two_pass_;
    MethodFrames frames_;
    std::optional<StayingAxes> axes_;
    std::string name_;
    std::vector<MethodHistory> sequences_;
    std::deque<double> two_pass_ms_;  // at the last poses; empty unless a limit is a share of it
    double first_two_pass_ms_ = 0.0;
    // Set from the first frame on, if there is a headset: its eyes move as one.
    std::optional<SeenThroughLens> lens_;
    std::map<std::optional<Order>, FullRender> full_before_;
    std::map<std::optional<Order>, std::array<Image, 2>> still_;
};

// Sets the frame's times from another run of it.
void setTimes(MotionFrame& frame, const FrameResult& result);

}  // namespace binosplat
