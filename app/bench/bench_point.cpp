// All methods at one scene, view and size.
#include "app/bench/bench_point.h"

#include "app/axes/staying_axes.h"
#include "app/load.h"
#include "app/options/modes.h"
#include "app/report/report.h"
#include "app/terminal/interrupt.h"
#include "engine/twin/coarse.h"
#include "engine/twin/reference.h"

#include <algorithm>
#include <array>
#include <chrono>

namespace binosplat {

namespace {

// One method and the costs of its frames.
struct Runner {
    BenchMethod method;
    BenchResult result;                                  // completed by summarize() from the frames
    std::map<std::string, std::vector<double>> pass_ms;  // by the text of its label
    FrameResult last, compared;

    void count(const FrameResult& frame) {
        last = frame;
        result.frame_ms.push_back(frame.gpu_total_ms);
        for (const auto& [label, ms] : addUp(frame.gpu_ms)) { pass_ms[label.text()].push_back(ms); }
    }
};

BenchResult summarize(const Runner& runner, const BenchPoint& point) {
    BenchResult result = runner.result;
    result.series = point.series;
    result.scene = point.scene.name;
    result.view = point.view;
    result.headset = point.headset;
    result.splats = point.live != nullptr ? point.live->counters().splats_read : point.scene.size();
    result.backbone = point.scene.isGaussian3d() ? "3DGS" : "2DGS";
    result.size_px = point.cameras.middle.size_px;
    result.method = runner.method.name;
    result.resolution = runner.method.resolution;
    result.dominant = runner.method.stereo.dominant;
    result.frames = static_cast<std::uint32_t>(result.frame_ms.size());
    for (const auto& [label, ms] : addUp(runner.last.gpu_ms)) {
        result.pass_ms.push_back({label, median(runner.pass_ms.at(label.text()))});
    }
    result.total_ms = median(result.frame_ms);
    result.least_ms = std::ranges::min(result.frame_ms);
    result.most_ms = std::ranges::max(result.frame_ms);
    FrameCounters counters = runner.last.counters;
    if (point.live != nullptr) { counters.streaming = streamingOf(*point.live); }
    result.counters = counters.named();
    result.counters.merge(runner.compared.counters.named());  // including counters that cost time
    result.tiles_rendered = runner.last.tiles_rendered;
    result.work_rendered = runner.last.work_rendered;
    if (!runner.last.stereo_bytes_per_pixel.empty()) {
        result.stereo_bytes_per_pixel = runner.last.stereo_bytes_per_pixel.back().second;
    }
    return result;
}

reference::Settings twinSettings(const BenchPoint& point) {
    reference::Settings settings;
    settings.near = point.cameras.near;
    settings.background = point.run.camera.background;
    return settings;
}

// How many pairs of tile and splat the customary square bound would make of what one eye sees.
std::uint64_t countSquareBoxPairs(const BenchPoint& point) {
    const reference::Settings settings = twinSettings(point);
    const Eye& eye = point.cameras.middle;
    const auto visible =
        reference::compact(point.scene, reference::cull(point.scene, {&eye, 1}, settings), eye, settings);
    std::uint64_t pairs = 0;
    for (const auto& splat : reference::project(point.scene, visible.splats, eye, settings)) {
        pairs += splat.square_box_tiles;
    }
    return pairs;
}

// The float64 twin of `mono` on the CPU, as a frame of its own; wall-clock time.
FrameResult renderTwin(const BenchPoint& point) {
    const std::array<PassLabel, reference::kPassCount> labels{
        {{Role::kNone, FrameStage::kSort, "cull"},
         {Role::kNone, FrameStage::kSort, "compact"},
         {Role::kNone, FrameStage::kSort, "sort_depth"},
         {Role::kNone, FrameStage::kSplat, "project"},
         {Role::kNone, FrameStage::kSplat, "bin"},
         {Role::kNone, FrameStage::kSplat, "sort_tiles"},
         {Role::kNone, FrameStage::kSplat, "rasterize"}}};
    std::array<double, reference::kPassCount> seconds{};
    reference::Settings settings = twinSettings(point);
    settings.seconds = seconds.data();
    const auto start = std::chrono::steady_clock::now();
    const reference::Picture picture = reference::render(point.scene, point.cameras.middle, settings);
    FrameResult result;
    result.gpu_total_ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    for (std::size_t pass = 0; pass < labels.size(); ++pass) {
        result.gpu_ms.push_back({labels[pass], 1000.0 * seconds[pass]});
    }
    return result;
}

// The affiliated eye in full, with splats in the order of `stereo`.
Image renderFull(const StereoOptions& stereo, const BenchPoint& point, MethodFrames& frames) {
    BenchMethod shared = plainMethod(Mode::kShared, point.run);
    shared.stereo.order = stereo.order;
    return frames.render(point.cameras, point.run.camera, shared, true)
        .readPicture(1 - shared.stereo.dominant);
}

// Measures memory and pictures of a method, before its frames are timed.
Runner prepare(const BenchMethod& method, const BenchPoint& point, const BenchPlan& plan,
               MethodFrames& frames, const Image& full) {
    Runner runner;
    runner.method = method;
    BenchResult& result = runner.result;
    result.mode = method.stereo.mode;
    result.peak_gpu_bytes = frames.peakAlone(point.cameras, point.run.camera, method);
    const MethodFrames::Rendered rendered = frames.render(point.cameras, point.run.camera, method, true);
    runner.compared = rendered.result;
    const auto measure = [&](const Image& whole, const Image& picture, const Eye& eye,
                             const std::optional<Gaze>& gaze, std::span<const std::uint32_t> tile_kinds,
                             std::span<const std::uint8_t> pixel_classes) {
        if (gaze) {
            result.seen = measureSeen(whole, picture,
                                      reference::findSharesThere(eye, {gaze->direction, gaze->clear_rad}));
        }
        result.quality =
            measureQuality(whole, picture, tile_kinds, pixel_classes,
                           {plan.ssim, plan.flip, eye.intrinsics.fx, plan.lpips ? &*plan.lpips : nullptr});
    };
    const std::array<std::optional<Gaze>, 2> gazes = gazesOf(point.cameras, method.stereo);
    if (plan.psnr &&
        (reprojects(method.stereo.mode) || (method.stereo.mode != Mode::kMono && method.resolution < 1.0))) {
        const auto affiliated = static_cast<std::size_t>(1 - method.stereo.dominant);
        const bool has_origins = reprojects(method.stereo.mode) && method.resolution == 1.0;
        measure(full, rendered.readPicture(static_cast<int>(affiliated)), point.cameras.eyes[affiliated],
                gazes[affiliated],
                has_origins ? rendered.frame->readTileKinds() : std::vector<std::uint32_t>(),
                has_origins ? rendered.frame->readPixelClasses() : std::vector<std::uint8_t>());
        if (!has_origins || !rendered.result.counters.warped) { result.quality.resize(1); }
    } else if (plan.psnr && method.stereo.mode == Mode::kMono && method.stereo.half_periphery) {
        const Image picture = rendered.readPicture(0);
        BenchMethod sharp = method;
        sharp.stereo.half_periphery = false;
        sharp.resolution = 1.0;
        const Image own_full = frames.render(point.cameras, point.run.camera, sharp, true).readPicture(0);
        measure(own_full, picture, point.cameras.middle, gazes[0], {}, {});
        result.quality.resize(1);  // no pixel comes from another eye
    }
    return runner;
}

// The same eyes in smaller pictures.
Cameras atResolution(const Cameras& cameras, double resolution) {
    const auto smaller = [&](const Eye& eye) {
        return resize(eye,
                      glm::max(glm::uvec2(glm::round(resolution * glm::dvec2(eye.size_px))), glm::uvec2(1)));
    };
    Cameras all = cameras;
    all.middle = smaller(cameras.middle);
    for (Eye& eye : all.eyes) { eye = smaller(eye); }
    return all;
}

// True if both can share buffers. A frame of `predicted` also remembers the settings of the previous one.
bool needSame(const BenchMethod& one, const BenchMethod& other) {
    const StereoOptions &a = one.stereo, &b = other.stereo;
    if (one.resolution != other.resolution) { return false; }
    if (a.mode != b.mode || a.half_periphery != b.half_periphery) { return false; }
    if (a.mode == Mode::kPredicted || hasHistory(a.mode) || hasHistory(b.mode)) {
        return a == b && one.frame_time == other.frame_time;
    }
    return !reprojects(a.mode) ||
           (a.warp.center_rois == b.warp.center_rois &&
            (a.warp.depth_choice == gpu::kDepthInverse) == (b.warp.depth_choice == gpu::kDepthInverse));
}

}  // namespace

StereoFrame& MethodFrames::frameFor(const BenchMethod& method) {
    const auto there = std::ranges::find_if(
        frames_, [&](const Entry& entry) { return needSame(entry.first_asked, method); });
    if (there != frames_.end()) { return *there->frame; }
    return *frames_.emplace_back(Entry{method, std::make_unique<StereoFrame>(context_, scene_)}).frame;
}

MethodFrames::Rendered MethodFrames::render(const Cameras& full_cameras, const CameraOptions& camera,
                                            const BenchMethod& method, bool compared, bool keep_history,
                                            const Cameras* views,
                                            const std::optional<GovernedSettings>& chosen) {
    stopIfInterrupted();
    StereoOptions stereo = method.stereo;
    if (chosen) {
        stereo.warp.budget = chosen->budget;
        stereo.warp.error_bound_db = chosen->error_bound_db;
    }
    const Cameras cameras = atResolution(full_cameras, chosen ? chosen->resolution_scale : method.resolution);
    FrameSettings settings = frameSettings(camera, stereo, scene_.usualOrder());
    settings.near = cameras.near;
    settings.gazes = gazesOf(cameras, stereo);
    settings.keep_classes = compared;
    settings.keep_history = keep_history;
    if (chosen) { settings.measured_part = frames_governed_++ % gpu::kMeasuredParts; }
    settings.half_floats = !compared;  // as in the viewer
    // It is not read here, so a mode only pays for it if it needs it itself.
    settings.keep_depth = false;
    StereoFrame& frame = frameFor(method);
    const std::span<const Eye> eyes =
        settings.mode == Mode::kMono ? std::span(&cameras.middle, 1) : std::span<const Eye>(cameras.eyes);
    std::array<std::vector<std::uint8_t>, 2> hidden;
    for (std::size_t e = 0; views != nullptr && e < eyes.size(); ++e) {
        hidden[e] = hiddenFrom(views->eyes[e], eyes[e]);
        settings.hidden_tiles[e] = hidden[e];
    }
    if (views != nullptr) { settings.gazes = turnGazes(gazesOf(*views, stereo), views->eyes, eyes); }
    return {frame.render(eyes, settings), &frame, full_cameras.eyes[0].size_px};
}

std::uint64_t MethodFrames::peakAlone(const Cameras& cameras, const CameraOptions& camera,
                                      const BenchMethod& method) {
    frames_.clear();
    MemoryUse& use = context_.memoryUse();
    use.peak_bytes = use.current_bytes.load();
    return render(cameras, camera, method).result.peak_gpu_bytes;
}

void warmUp(const Context& context, std::uint32_t rounds, const std::function<void()>& round) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    const auto least =
        context.isSoftware() || rounds == 0 ? std::chrono::seconds(0) : std::chrono::seconds(2);
    for (std::uint32_t i = 0; i < rounds || Clock::now() - begin < least; ++i) { round(); }
}

std::vector<BenchResult> benchPoint(const Context& context, const BenchPoint& point, const BenchPlan& plan) {
    const CameraOptions& camera = point.run.camera;
    if (point.live != nullptr) { settle(*point.live, point.cameras.eyes); }
    MethodFrames frames(context, point.gpu_scene);
    std::map<std::optional<Order>, Image> full_by_order;
    for (const BenchMethod& method : plan.methods) {
        Image& full = full_by_order[method.stereo.order];
        if (full.values.empty()) { full = renderFull(method.stereo, point, frames); }
    }

    std::vector<Runner> runners;
    for (const BenchMethod& method : plan.methods) {
        runners.push_back(prepare(method, point, plan, frames, full_by_order.at(method.stereo.order)));
    }
    warmUp(context, plan.warm_up, [&] {
        for (Runner& runner : runners) { frames.render(point.cameras, camera, runner.method); }
    });
    Runner twin;
    twin.method.name = "float64 twin, one eye";
    for (std::uint32_t i = 0; i < plan.repeats; ++i) {
        for (Runner& runner : runners) {
            runner.count(frames.render(point.cameras, camera, runner.method).result);
        }
    }
    if (plan.twin && point.live == nullptr) {
        for (std::uint32_t i = 0; i < plan.repeats; ++i) { twin.count(renderTwin(point)); }
        runners.push_back(twin);
    }
    std::vector<BenchResult> results;
    for (const Runner& runner : runners) { results.push_back(summarize(runner, point)); }
    if (!results.back().mode) {
        results.back().counters = {{"square_box_tile_pairs", countSquareBoxPairs(point)}};
    }
    return results;
}

}  // namespace binosplat
