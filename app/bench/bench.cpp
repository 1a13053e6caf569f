// `binosplat bench`: error against run time, over scenes, splat counts, sizes, headsets and views.
#include "app/bench/bench.h"

#include "app/bench/bench_point.h"
#include "app/bench/bench_scene.h"
#include "app/options/device_options.h"
#include "app/terminal/interrupt.h"
#include "app/terminal/progress.h"
#include "engine/address.h"
#include "engine/builtin/procedural.h"
#include "engine/error.h"
#include "engine/setup/output_files.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iterator>

namespace binosplat {

namespace {

std::vector<std::uint64_t> countsOf(const std::string& source, const BenchSeries& series) {
    // A file's splat count is fixed, so it is measured only once for all counts of a series.
    return isBuiltin(source) ? series.splats : std::vector<std::uint64_t>{0};
}

std::size_t pointCount(const BenchPlan& plan, const RunOptions& run) {
    std::size_t points = 0;
    for (const std::string& source : plan.scenes) {
        for (const BenchSeries& series : plan.series) {
            for (const DrawnViews& drawn : viewsOf(plan, source, run)) {
                points += countsOf(source, series).size() * series.sizes_px.size() * drawn.views.size() *
                          plan.headsets.size();
            }
        }
    }
    return points;
}

// One scene with one splat count, drawn in one way: with every size, headset and view.
void benchScene(const Context& context, const BenchPlan& plan, const BenchSeries& series,
                const std::vector<BenchView>& views, const BenchScene& loaded,
                std::vector<BenchResult>& results, const std::function<void()>& next) {
    const Scene& scene = loaded.scene();
    for (const glm::uvec2 size_px : series.sizes_px) {
        for (const std::string& headset : plan.headsets) {
            for (const BenchView& view : views) {
                RunOptions run = view.run;
                if (size_px.x > 0) { run.camera.size_px = size_px; }
                if (!headset.empty()) { run.camera.headset = headset; }
                const Cameras cameras = makeCameras(run, readCameraFiles(run.camera), scene);
                const BenchPoint point{loaded.gpuScene(),  scene,        run, cameras, series.name, view.name,
                                       run.camera.headset, loaded.live()};
                std::ranges::move(benchPoint(context, point, plan), std::back_inserter(results));
                next();
            }
        }
    }
}

// Reports errors in scenes, headsets and cameras before anything is measured.
void requireFiles(const BenchPlan& plan, const RunOptions& run) {
    requireScenes(plan);
    for (const std::string& headset : plan.headsets) {
        CameraOptions camera = run.camera;
        if (!headset.empty()) { camera.headset = headset; }
        readCameraFiles(camera);
    }
}

void benchSpeed(const BenchOptions& options, const BenchPlan& plan) {
    requireFiles(plan, options.run);
    OutputFiles files(options.out);
    const Context context(contextOptions(options.run));
    BenchRun run{context.deviceName(), options.run.config, {}};
    {
        // All points are assumed to take equally long.
        const auto points = static_cast<double>(pointCount(plan, options.run));
        double done = 0.0;
        ProgressLine progress("bench");
        for (const std::string& source : plan.scenes) {
            for (const BenchSeries& series : plan.series) {
                for (const std::uint64_t splats : countsOf(source, series)) {
                    for (const DrawnViews& drawn : viewsOf(plan, source, options.run)) {
                        const BenchScene scene(context, drawn.run, source, splats);
                        benchScene(context, plan, series, drawn.views, scene, run.results,
                                   [&] { progress.show(++done / points); });
                    }
                }
            }
        }
    }
    compareModes(run.results);
    markFront(run.results);
    writeText(files.staging() / "bench.json", benchJson(run));
    writeText(files.staging() / "bench.csv", benchCsv(run));
    writeText(files.staging() / "bench.svg", benchPlot(run));
    context.requireNoValidationMessages();
    stopIfInterrupted();
    files.publish();
    fmt::print("{}", benchTable(run, terminalColumns()));
}

}  // namespace

void requireScenes(const BenchPlan& plan) {
    for (const std::string& source : plan.scenes) {
        requireNoUser(source);
        const bool there = isAddress(source) || (isBuiltin(source) ? builtinView(source).has_value()
                                                                   : std::filesystem::exists(source));
        check(there, "{}: no such scene", source);
    }
}

void runBench(const BenchOptions& options) {
    const BenchPlan plan = planBench(options);
    if (!options.motion_file.empty()) { return benchMotion(options, plan); }
    if (!options.photos_folder.empty() || options.orders) {
        check(options.run.load.splat_budget == 0,
              "splat-budget is {}, expected none with --photos and --orders, which compare whole scenes",
              options.run.load.splat_budget);
    }
    if (!options.photos_folder.empty()) { return benchPhotos(options, plan); }
    if (options.orders) { return benchOrders(options, plan); }
    benchSpeed(options, plan);
}

}  // namespace binosplat
