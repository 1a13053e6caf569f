// `binosplat bench --motion`: every method at every pose of a recorded head.
#include "app/bench/bench.h"
#include "app/bench/bench_scene.h"
#include "app/bench/motion_point.h"
#include "app/options/device_options.h"
#include "app/terminal/interrupt.h"
#include "app/terminal/progress.h"
#include "engine/setup/head_motion.h"
#include "engine/setup/output_files.h"

#include <fmt/format.h>

#include <filesystem>
#include <string>

namespace binosplat {

namespace {

// One view of a scene at every pose.
void playView(const Context& context, const BenchOptions& options, const BenchPlan& plan,
              const HeadMotion& motion, const std::string& source, const BenchScene& loaded,
              const BenchView& view, MotionRun& run) {
    const GpuScene& gpu_scene = loaded.gpuScene();
    LiveScene* const live = loaded.live();
    RunOptions view_run = view.run;
    const glm::uvec2 size_px = plan.series.front().sizes_px.front();
    if (size_px.x > 0) { view_run.camera.size_px = size_px; }
    const Cameras start = makeCameras(view_run, readCameraFiles(view_run.camera), loaded.scene());
    std::string name = nameIn(plan, source) + (view.name.empty() ? "" : ", " + view.name);
    const std::vector<double> times_s = frameTimes(motion, options.segment, options.motion_file);
    const auto poseAt = [&](double time_s) {
        return moveCameras(
            start, motion.cameraAt(time_s, start.middle.world_from_camera, 1.0 / view_run.metres_per_unit));
    };
    const auto camerasAt = [&](double time_s) {
        const Cameras cameras = poseAt(time_s);
        if (live != nullptr) {
            live->setTime(time_s - times_s.front());
            settle(*live, cameras.eyes);
        }
        return cameras;
    };
    if (live != nullptr) { settle(*live, start.eyes); }
    // A GPU runs at full speed only while it is kept busy, so its times come from a run without pictures.
    std::vector<std::vector<FrameResult>> timed;
    std::optional<MotionPoint> timed_point;
    if (!context.isSoftware()) {
        timed_point.emplace(context, gpu_scene, view_run, plan, name, options.frame_time);
        MotionPoint& point = *timed_point;
        warmUp(context, plan.warm_up, [&] { point.warm(start); });
        for (const double time_s : times_s) { timed.push_back(point.time(camerasAt(time_s))); }
    }
    MotionPoint point(context, gpu_scene, view_run, plan, name, options.frame_time);
    if (timed_point) { point.chooseAs(*timed_point); }
    for (std::uint32_t i = 0; timed.empty() && i < plan.warm_up; ++i) { point.warm(start); }
    ProgressLine progress(name);
    for (std::size_t i = 0; i < times_s.size(); ++i) {
        if (i % options.every != 0) {
            point.pass(camerasAt(times_s[i]));
            continue;
        }
        const std::size_t first = run.frames.size();
        if (loaded.moves() && i > 0) { point.rememberStill(poseAt(times_s[i])); }
        point.play(camerasAt(times_s[i]), i, times_s[i], run.frames);
        for (std::size_t f = first; live != nullptr && f < run.frames.size(); ++f) {
            run.frames[f].streaming = streamingOf(*live);
            run.frames[f].splats_read = live->counters().splats_read;
        }
        for (std::size_t m = 0; !timed.empty() && m < timed[i].size(); ++m) {
            setTimes(run.frames[first + m], timed[i][m]);
        }
        progress.show(static_cast<double>(i) / static_cast<double>(times_s.size()));
    }
}

}  // namespace

void benchMotion(const BenchOptions& options, const BenchPlan& plan) {
    requireScenes(plan);
    const HeadMotion motion = readHeadMotion(options.motion_file, options.motion_axes, options.segment);
    if (!motion.note().empty()) { fmt::print(stderr, "binosplat: {}\n", motion.note()); }
    OutputFiles files(options.out);
    const Context context(contextOptions(options.run));
    MotionRun run{context.deviceName(),
                  options.run.config,
                  std::filesystem::path(options.motion_file).filename().string(),
                  {}};
    for (const std::string& source : plan.scenes) {
        for (const DrawnViews& drawn : viewsOf(plan, source, options.run)) {
            const BenchScene scene(context, drawn.run, source);
            for (const BenchView& view : drawn.views) {
                playView(context, options, plan, motion, source, scene, view, run);
            }
        }
    }
    writeText(files.staging() / "motion.csv", motionCsv(run));
    writeText(files.staging() / "motion.json", motionJson(run));
    writeText(files.staging() / "motion.svg", motionPlot(run));
    context.requireNoValidationMessages();
    stopIfInterrupted();
    files.publish();
    fmt::print("{}", motionTable(run, terminalColumns()));
}

}  // namespace binosplat
