// `binosplat bench --motion`: every method at every pose of a recorded head.
#include "app/bench/bench.h"
#include "app/bench/bench_point.h"
#include "app/bench/motion_results.h"
#include "app/load.h"
#include "app/options/device_options.h"
#include "app/options/modes.h"
#include "app/terminal/interrupt.h"
#include "app/terminal/progress.h"
#include "engine/picture/metrics.h"
#include "engine/picture/pair_metrics.h"
#include "engine/setup/head_motion.h"
#include "engine/setup/output_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <string>
#include <utility>

namespace binosplat {

namespace {

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

double pairsOf(const FrameResult& frame) {
    double pairs = 0.0;
    for (const TargetCounters& target : frame.counters.targets) { pairs += static_cast<double>(target.tile_pairs); }
    return pairs;
}

// In tiles that are shown and were not rendered: of the affiliated eye, or of both where these are made from their pasts.
std::uint64_t pixelsWarped(const FrameResult& frame, Mode mode, int affiliated) {
    std::uint64_t pixels = 0, tiles = 0, rendered = frame.counters.warped ? frame.counters.warped->tiles_patched : 0;
    for (std::size_t t = 0; t < frame.counters.targets.size(); ++t) {
        const TargetCounters& target = frame.counters.targets[t];
        if (mode != Mode::kTemporal && t != static_cast<std::size_t>(affiliated)) { continue; }
        pixels += target.pixels;
        tiles += target.tiles;
        rendered += target.tiles_hidden;
    }
    return std::min(pixels, 256 * (tiles - std::min(tiles, rendered)));
}

// R, G and B of a less those of b.
Image subtract(const Image& a, const Image& b) {
    Image difference{a.size_px, 3, {}};
    difference.values.reserve(3 * a.pixelCount());
    for (std::size_t pixel = 0; pixel < a.pixelCount(); ++pixel) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            difference.values.push_back(a.values[pixel * static_cast<std::size_t>(a.channels) + channel] -
                                        b.values[pixel * static_cast<std::size_t>(b.channels) + channel]);
        }
    }
    return difference;
}

// Mean |a - b|; 0 if there is nothing to compare with.
double meanChange(const Image& a, const Image& b) {
    if (a.size_px != b.size_px || a.pixelCount() == 0) { return 0.0; }
    const Image difference = subtract(a, b);
    double sum = 0.0;
    for (const float value : difference.values) { sum += std::abs(static_cast<double>(value)); }
    return sum / static_cast<double>(difference.values.size());
}

void setTimes(MotionFrame& frame, const FrameResult& result) {
    frame.total_ms = result.gpu_total_ms;
    frame.stage_ms = stagesOf(frame.mode, result.gpu_ms);
    frame.pass_ms = byLabel(result.gpu_ms);
}

// One scene, view and size: all poses, and at each all methods.
class MotionPoint {
public:
    MotionPoint(const Context& context, const GpuScene& scene, const RunOptions& run, const BenchPlan& plan, std::string name)
        : camera_(run.camera), shared_(plainMethod(Mode::kShared, run)), frames_(context, scene), name_(std::move(name)) {
        for (const BenchMethod& method : plan.methods) {
            if (method.stereo.mode != Mode::kMono) { sequences_.push_back({method, {}}); }
        }
    }

    // What each method's frame took.
    std::vector<FrameResult> time(const Cameras& cameras) {
        std::vector<FrameResult> results;
        for (const MethodHistory& sequence : sequences_) {
            results.push_back(frames_.render(cameras, camera_, sequence.method.stereo, false, true).result);
        }
        return results;
    }

    // A pose that is not scored, and still is the past of one that is.
    void pass(const Cameras& cameras) {
        for (const MethodHistory& sequence : sequences_) {
            if (hasPast(sequence.method.stereo.mode)) { frames_.render(cameras, camera_, sequence.method.stereo, false, true); }
        }
    }

    void play(const Cameras& cameras, std::size_t number, double time_s, std::vector<MotionFrame>& result) {
        std::map<std::optional<Order>, FullRender> full_by_order;
        for (MethodHistory& sequence : sequences_) {
            shared_.stereo.order = sequence.method.stereo.order;
            FullRender& full = full_by_order[shared_.stereo.order];
            if (full.pairs == 0.0) {
                const auto [rendered, frame] = frames_.render(cameras, camera_, shared_.stereo);
                full = {{frame->readPicture(kLeft), frame->readPicture(kRight)}, std::max(pairsOf(rendered), 1.0)};
            }
            const FullRender& before = full_before_[shared_.stereo.order];
            const Mode mode = sequence.method.stereo.mode;
            const auto [rendered, frame] = frames_.render(cameras, camera_, sequence.method.stereo, false, true);
            MotionFrame row;
            row.point = name_;
            row.method = sequence.method.name;
            row.mode = mode;
            row.number = number;
            row.time_s = time_s;
            setTimes(row, rendered);
            row.work_rendered = pairsOf(rendered) / full.pairs;
            std::array<Image, 2> pictures;
            for (const int eye : {kLeft, kRight}) {
                const auto e = static_cast<std::size_t>(eye);
                row.full_change += 0.5 * meanChange(full.eyes[e], before.eyes[e]);
                if (rendersBothInFull(mode)) { continue; }
                pictures[e] = frame->readPicture(eye);
                Image error = subtract(pictures[e], full.eyes[e]);
                row.mean_square[e] = compare(pictures[e], full.eyes[e]).mean_square;
                row.flicker[e] = meanChange(error, sequence.error[e]);
                row.tile_steps = std::max(row.tile_steps, tileSteps(error));
                sequence.error[e] = std::move(error);
            }
            if (!rendersBothInFull(mode)) {
                row.pixels_warped = pixelsWarped(rendered, mode, 1 - sequence.method.stereo.dominant);
                row.sharpness_gap = sharpnessGap(pictures, full.eyes);
            }
            result.push_back(std::move(row));
        }
        full_before_ = std::move(full_by_order);
    }

private:
    CameraOptions camera_;
    BenchMethod shared_;
    MethodFrames frames_;
    std::string name_;
    std::vector<MethodHistory> sequences_;
    std::map<std::optional<Order>, FullRender> full_before_;
};

// One view of a scene at every pose.
void playView(const Context& context, const BenchOptions& options, const BenchPlan& plan, const HeadMotion& motion,
              const std::string& source, const Scene& scene, const GpuScene& gpu_scene, const BenchView& view, MotionRun& run) {
    RunOptions view_run = view.run;
    const glm::uvec2 size_px = plan.series.front().sizes_px.front();
    if (size_px.x > 0) { view_run.camera.size_px = size_px; }
    const Cameras start = makeCameras(view_run, readCameraFiles(view_run.camera), scene);
    std::string name = nameIn(plan, source) + (view.name.empty() ? "" : ", " + view.name);
    const std::vector<double> times_s = frameTimes(motion, options.segment, options.motion_file);
    const auto camerasAt = [&](double time_s) {
        return moveCameras(start, motion.cameraAt(time_s, start.middle.world_from_camera, 1.0 / view_run.metres_per_unit));
    };
    // A GPU shows how fast it is only while nobody keeps it waiting: its times are those of a run without pictures.
    std::vector<std::vector<FrameResult>> timed;
    if (!context.isSoftware()) {
        MotionPoint point(context, gpu_scene, view_run, plan, name);
        warmUp(context, plan.warm_up, [&] { point.time(start); });
        for (const double time_s : times_s) { timed.push_back(point.time(camerasAt(time_s))); }
    }
    MotionPoint point(context, gpu_scene, view_run, plan, name);
    for (std::uint32_t i = 0; timed.empty() && i < plan.warm_up; ++i) { point.time(start); }
    ProgressLine progress(name);
    for (std::size_t i = 0; i < times_s.size(); ++i) {
        if (i % options.every != 0) {
            point.pass(camerasAt(times_s[i]));
            continue;
        }
        const std::size_t first = run.frames.size();
        point.play(camerasAt(times_s[i]), i, times_s[i], run.frames);
        for (std::size_t m = 0; !timed.empty() && m < timed[i].size(); ++m) { setTimes(run.frames[first + m], timed[i][m]); }
        progress.show(static_cast<double>(i) / static_cast<double>(times_s.size()));
    }
}

}  // namespace

void benchMotion(const BenchOptions& options, const BenchPlan& plan) {
    requireScenes(plan);
    const HeadMotion motion =
        readHeadMotion(options.motion_file, options.motion_axes == "unity" ? MotionAxes::kUnity : MotionAxes::kOpenXr, options.segment);
    OutputFiles files(options.out);
    const Context context(contextOptions(options.run));
    MotionRun run{context.deviceName(), options.run.config, std::filesystem::path(options.motion_file).filename().string(), {}};
    for (const std::string& source : plan.scenes) {
        for (const DrawnViews& drawn : viewsOf(plan, source, options.run)) {
            const Scene scene = loadAs(drawn.run, source);
            const GpuScene gpu_scene(context, scene);
            for (const BenchView& view : drawn.views) { playView(context, options, plan, motion, source, scene, gpu_scene, view, run); }
        }
    }
    writeText(files.staging() / "motion.csv", motionCsv(run));
    writeText(files.staging() / "motion.json", motionJson(run));
    writeText(files.staging() / "motion.svg", motionPlot(run));
    context.requireNoValidationMessages();
    stopIfInterrupted();
    files.publish();
    fmt::print("{}", motionTable(run));
}

}  // namespace binosplat
