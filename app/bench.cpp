// `binosplat bench`: modes in turn, again and again, so that a device that drifts drifts for all of them alike.
#include "app/bench_plan.h"
#include "app/bench_results.h"
#include "app/camera_options.h"
#include "app/commands.h"
#include "app/load.h"
#include "app/modes.h"
#include "engine/error.h"
#include "engine/frame.h"
#include "engine/setup/output_files.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>

namespace binosplat {

namespace {

// One mode with buffers of its own, and what its frames took.
struct Runner {
    std::string mode;
    std::unique_ptr<StereoFrame> frame;
    std::vector<double> total_ms;
    std::map<std::string, std::vector<double>> pass_ms;
    FrameResult last;
    std::uint64_t peak_gpu_bytes = 0;
};

class PointBench {
public:
    PointBench(const Context& context, const GpuScene& scene, const RunOptions& options, const Cameras& cameras)
        : context_(context), scene_(scene), options_(options), cameras_(cameras) {}

    // The most memory that the program holds while nothing but this mode runs.
    std::uint64_t measurePeak(const std::string& mode) {
        StereoFrame alone(context_, scene_);
        MemoryUse& use = context_.memoryUse();
        use.peak_bytes = use.current_bytes;
        return render(alone, mode).peak_gpu_bytes;
    }

    FrameResult render(StereoFrame& frame, const std::string& name) {
        StereoOptions stereo = options_.stereo;
        stereo.mode = name;
        FrameSettings settings = frameSettings(options_.camera, stereo);
        settings.keep_depth = false;  // nobody reads it here, so no mode pays for it unless it needs it itself
        const std::span<const Eye> eyes =
            settings.mode == Mode::kMono ? std::span(&cameras_.middle, 1) : std::span<const Eye>(cameras_.eyes);
        return frame.render(eyes, settings);
    }

    void count(Runner& runner) {
        runner.last = render(*runner.frame, runner.mode);
        runner.total_ms.push_back(runner.last.gpu_total_ms);
        for (const auto& [name, ms] : runner.last.gpu_ms) { runner.pass_ms[name].push_back(ms); }
    }

private:
    const Context& context_;
    const GpuScene& scene_;
    const RunOptions& options_;
    const Cameras& cameras_;
};

BenchResult summarize(const Runner& runner) {
    BenchResult result;
    result.mode = runner.mode;
    result.frames = static_cast<std::uint32_t>(runner.total_ms.size());
    for (const auto& [name, ms] : runner.last.gpu_ms) { result.pass_ms.emplace_back(name, median(runner.pass_ms.at(name))); }
    result.total_ms = median(runner.total_ms);
    result.least_ms = std::ranges::min(runner.total_ms);
    result.most_ms = std::ranges::max(runner.total_ms);
    result.counters = runner.last.counters;
    result.peak_gpu_bytes = runner.peak_gpu_bytes;
    return result;
}

// All modes at one scene, splat count and size.
std::vector<BenchResult> benchPoint(PointBench& bench, const Context& context, const GpuScene& scene, const BenchPlan& plan) {
    std::vector<Runner> runners;
    for (const std::string& mode : plan.modes) {
        Runner runner;
        runner.mode = mode;
        runner.peak_gpu_bytes = bench.measurePeak(mode);
        runners.push_back(std::move(runner));
    }
    for (Runner& runner : runners) { runner.frame = std::make_unique<StereoFrame>(context, scene); }
    for (std::uint32_t i = 0; i < plan.warm_up; ++i) {
        for (Runner& runner : runners) { bench.render(*runner.frame, runner.mode); }
    }
    for (std::uint32_t i = 0; i < plan.repeats; ++i) {
        for (Runner& runner : runners) { bench.count(runner); }
    }
    std::vector<BenchResult> results;
    for (const Runner& runner : runners) { results.push_back(summarize(runner)); }
    return results;
}

// A scene that is not there is found out before the others are measured.
void requireScenes(const BenchPlan& plan) {
    for (const std::string& source : plan.scenes) {
        const bool there = isBuiltin(source) ? builtinView(source).has_value() : std::filesystem::exists(source);
        check(there, "{}: no such scene", source);
    }
}

std::size_t pointCount(const BenchPlan& plan) {
    std::size_t points = 0;
    for (const BenchSeries& series : plan.series) { points += series.splats.size() * series.sizes_px.size(); }
    return points * plan.scenes.size();
}

// One scene with one splat count, at every size of a series.
template <typename PointDone>
std::vector<BenchResult> benchSizes(const Context& context, const RunOptions& run, const CameraFiles& files, const Scene& scene,
                                    const BenchPlan& plan, const BenchSeries& series, PointDone&& point_done) {
    std::vector<BenchResult> results;
    const GpuScene gpu_scene(context, scene);
    for (const glm::uvec2 size_px : series.sizes_px) {
        RunOptions resized = run;
        resized.camera.size_px = size_px;
        const Cameras cameras = makeCameras(resized, files, scene);
        PointBench bench(context, gpu_scene, resized, cameras);
        for (BenchResult& result : benchPoint(bench, context, gpu_scene, plan)) {
            result.series = series.name;
            result.scene = scene.name;
            result.splats = scene.size();
            result.size_px = size_px;
            results.push_back(std::move(result));
        }
        point_done();
    }
    return results;
}

}  // namespace

void runBench(const BenchOptions& options) {
    const BenchPlan plan = planBench(options);
    requireScenes(plan);
    OutputFiles files(options.out);
    const CameraFiles camera_files = readCameraFiles(options.run.camera);
    const Context context({.device = options.run.device});
    BenchRun run{context.deviceName(), options.run.config, {}};

    ProgressLine progress("bench");
    std::size_t points_done = 0;
    const auto point_done = [&] { progress.show(static_cast<double>(++points_done) / static_cast<double>(pointCount(plan))); };
    for (const std::string& source : plan.scenes) {
        for (const BenchSeries& series : plan.series) {
            // A file has the splats it has: it is measured once for all counts of a series.
            const std::vector<std::uint64_t> counts = isBuiltin(source) ? series.splats : std::vector<std::uint64_t>{0};
            for (const std::uint64_t splats : counts) {
                const Scene scene = loadScene(source, splats);
                std::ranges::move(benchSizes(context, options.run, camera_files, scene, plan, series, point_done),
                                  std::back_inserter(run.results));
            }
        }
    }
    compareModes(run.results);
    writeText(files.staging() / "bench.json", benchJson(run));
    writeText(files.staging() / "bench.csv", benchCsv(run));
    writeText(files.staging() / "bench.svg", benchPlot(run));
    files.publish();
    fmt::print("{}", benchTable(run));
}

}  // namespace binosplat
