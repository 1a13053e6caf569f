// `binosplat render`: one frame, or frames along a path, with pictures and a report.
#include "app/blind_camera.h"
#include "app/commands.h"
#include "app/film.h"
#include "app/load.h"
#include "app/options/camera_options.h"
#include "app/options/device_options.h"
#include "app/options/modes.h"
#include "app/panorama.h"
#include "app/render_path.h"
#include "app/report/report.h"
#include "app/terminal/interrupt.h"
#include "app/terminal/progress.h"
#include "engine/error.h"
#include "engine/frame/stereo_frame.h"
#include "engine/picture/image_io.h"
#include "engine/picture/roi_picture.h"
#include "engine/setup/output_files.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

namespace binosplat {

namespace {

constexpr double kLongFrameMs = 2000.0;

void writeEyes(OutputFiles& files, const NamedPictures& pictures, const std::optional<Panorama>& panorama) {
    for (const auto& [name, image] : pictures) {
        stopIfInterrupted();
        writePicture(files.staging() / name, PictureKind::kFloat, image);
        writeDisplay(files.staging() / name, image, panorama);
        if (panorama) { writeForGalleries(files.staging() / name, image, *panorama); }
    }
}

void writePictures(OutputFiles& files, StereoFrame& frame, const FrameSettings& settings,
                   PictureLayout layout) {
    std::vector<Image> pictures{frame.readPicture(0)};
    if (settings.mode != Mode::kMono) {
        pictures.push_back(frame.readPicture(kRight));
        // Tinted by how each tile was made; a mode that renders every eye in full has nothing to tint.
        const Image& affiliated = pictures[static_cast<std::size_t>(1 - settings.dominant)];
        writePicture(files.staging() / "roi", PictureKind::kDisplay,
                     makeRoiPicture(affiliated, frame.readTileKinds(), frame.readPixelClasses()));
    }
    writeEyes(files, namedPictures(std::move(pictures), layout), {});
    writePicture(files.staging() / "dominant_depth", PictureKind::kFloat, frame.readDominantDepth());
}

// A device's first frame tells more about its driver than about the passes; the report is about the second,
// unless that takes long.
FrameResult renderTimed(StereoFrame& frame, std::span<const Eye> eyes, const FrameSettings& settings) {
    const FrameResult first = frame.render(eyes, settings);
    stopIfInterrupted();
    return first.gpu_total_ms < kLongFrameMs ? frame.render(eyes, settings) : first;
}

// The options, completed with the choices that they left to the file and the memory.
RenderOptions asUsed(RenderOptions options, const Scene& scene, const LoadNotes& notes,
                     const LiveScene* live) {
    LoadOptions& load = options.run.load;
    if (live != nullptr) {
        load.sh_degree = static_cast<std::uint32_t>(live->traits().sh_degree);
        load.antialiased = live->traits().is_dimmed;
    } else {
        if (!notes.level_splats.empty()) { load.lod = notes.level; }
        load.sh_degree = static_cast<std::uint32_t>(scene.sh_degree);
        load.antialiased = scene.antialiased;
    }
    options.run.stereo.order =
        orderOf(options.run.stereo, scene.by_distance ? Order::kDistance : Order::kDepth);
    return options;
}

void warn(const std::string& line) { fmt::print(stderr, "binosplat: {}\n", line); }

void warnOfBlindFrames(const PathReport& report, std::span<const glm::vec3> positions) {
    const auto is_blind = [](const PathFrame& frame) { return frame.frame.sees_nothing; };
    const auto first = std::ranges::find_if(report.frames, is_blind);
    if (first == report.frames.end()) { return; }
    warn(fmt::format("{}: frame {}, the first of {} of {}: {}", report.options.scene,
                     first - report.frames.begin(), std::ranges::count_if(report.frames, is_blind),
                     report.frames.size(),
                     describeNearest(first->cameras.middle.world_from_camera, positions, first->cameras.near,
                                     first->cameras.origin)));
}

// Once its frames are published: a film of all, or a message if a signal has come.
void finishPath(const RenderOptions& options, const HeadPath& path, std::size_t rendered,
                OutputFiles& files) {
    const std::size_t done = path.first + rendered, all = path.times_s.size();
    try {
        stopIfInterrupted();
    } catch (const Interrupted& stop) {
        throw Interrupted{stop.signal, fmt::format("{} of {} frames are in {}, --resume continues", done, all,
                                                   options.out.string())};
    }
    if (!options.video) { return; }
    writeFilm(options.out, path.film_pattern, files.staging() / "video.mp4", path.rate_hz, filmTags(options));
    files.publish();
    fmt::print("film: {}\n", (options.out / "video.mp4").string());
}

}  // namespace

void runRender(const RenderOptions& options) {
    const StereoOptions& stereo = options.run.stereo;
    // Errors that can be detected early are reported before the scene is loaded.
    requirePeriphery(stereo);
    if (options.video) { requireFfmpeg(); }
    OutputFiles files(options.out);
    const CameraFiles camera_files = readCameraFiles(options.run.camera);
    const std::optional<Panorama> panorama = askedPanorama(options);
    const std::optional<HeadPath> path =
        options.path.empty() ? std::nullopt : std::optional(readHeadPath(options));

    LoadNotes notes;
    Scene scene;
    std::optional<const Context> opened;
    std::optional<OpenedScene> opened_scene;
    if (mayLive(options.scene, options.run.load)) {
        opened.emplace(contextOptions(options.run));
        opened_scene = openLive(*opened, options.scene, options.run, StreamFor::kPictures);
    }
    LiveScene* const live = opened_scene ? opened_scene->live.get() : nullptr;
    if (opened_scene) {
        scene = std::move(opened_scene->sample);
        notes = std::move(opened_scene->notes);
    } else {
        scene = loadWithProgress(options.scene, options.run.load, notes, options.run.memory_limit_mib);
    }
    const Cameras cameras = makeCameras(options.run, camera_files, scene);
    if (!opened) { opened.emplace(contextOptions(options.run)); }
    const Context& context = *opened;
    std::optional<const GpuScene> whole;
    if (live == nullptr) {
        whole.emplace(context, scene, ProgressLine("uploading " + options.scene).progress());
    }
    const GpuScene& gpu_scene = whole ? *whole : live->scene();
    const RenderOptions used = asUsed(options, scene, notes, live);
    // For the warning if a camera sees none of them.
    const std::vector<glm::vec3> positions = std::move(scene.positions);
    scene = {};

    StereoFrame frame(context, gpu_scene);
    FrameSettings settings = frameSettings(options.run.camera, stereo, gpu_scene.usualOrder());
    settings.near = cameras.near;
    settings.gazes = gazesOf(cameras, stereo);
    const auto report = [&](const auto& said) {
        writeText(files.staging() / "report.json", reportJson(said));
        context.requireNoValidationMessages();
        files.publish();
        fmt::print("{}", reportTable(said));
    };
    stopIfInterrupted();
    if (path) {
        const double units_per_metre = 1.0 / options.run.metres_per_unit;
        const PathReport said{
            context.deviceName(), used, cameras,
            renderPath(frame, live, settings, cameras, stereo.axes, units_per_metre, *path, files)};
        report(said);
        finishPath(options, *path, said.frames.size(), files);
        warnOfBlindFrames(said, positions);
    } else if (panorama) {
        const Cameras upright = panoramaCameras(cameras, *panorama);
        EyePictures made = renderPanorama(frame, live, settings, upright, *panorama);
        writeEyes(files, namedPictures(std::move(made.pictures), options.layout), panorama);
        stopIfInterrupted();
        report(FrameReport{context.deviceName(), used, upright, made.result});
        if (made.result.sees_nothing) { warn(fmt::format("{}: no splat is seen from there", options.scene)); }
    } else {
        settings.keep_classes = true;
        const std::span<const Eye> eyes =
            stereo.mode == Mode::kMono ? std::span(&cameras.middle, 1) : std::span<const Eye>(cameras.eyes);
        if (live != nullptr) {
            settle(*live, eyes, ProgressLine("loading the visible part of " + live->name()).progress());
        }
        FrameResult result = renderTimed(frame, eyes, settings);
        if (live != nullptr) { result.counters.streaming = streamingOf(*live); }
        writePictures(files, frame, settings, options.layout);
        stopIfInterrupted();
        report(FrameReport{context.deviceName(), used, cameras, result});
        for (const std::string& phrase : result.left_out) { fmt::print("  left out: {}\n", phrase); }
        if (result.sees_nothing) {
            warn(fmt::format(
                "{}: {}", options.scene,
                describeNearest(cameras.middle.world_from_camera, positions, cameras.near, cameras.origin)));
        } else if (const std::string cut = describeCut(cameras.middle, positions, cameras.near);
                   !cut.empty()) {
            warn(fmt::format("{}: {}", options.scene, cut));
        }
    }
    for (const std::string& line : notes.lines) { fmt::print("  note: {}\n", line); }
}

}  // namespace binosplat
