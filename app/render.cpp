// `binosplat render`: one frame, its pictures and its report.
#include "app/commands.h"
#include "app/interrupt.h"
#include "app/load.h"
#include "app/options/camera_options.h"
#include "app/options/device_options.h"
#include "app/options/modes.h"
#include "app/report/report.h"
#include "engine/error.h"
#include "engine/frame.h"
#include "engine/picture/image_io.h"
#include "engine/picture/roi_picture.h"
#include "engine/setup/output_files.h"

namespace binosplat {

namespace {

constexpr double kLongFrameMs = 2000.0;

void writePictures(OutputFiles& files, StereoFrame& frame, const FrameSettings& settings) {
    const auto write = [&](const char* name, const Image& image) {
        stopIfInterrupted();
        writePicture(files.staging() / name, PictureKind::kFloat, image);
        writePicture(files.staging() / name, PictureKind::kDisplay, image);
    };
    if (settings.mode == Mode::kMono) {
        write("mono", frame.readPicture(0));
    } else {
        const std::array<Image, 2> pictures{frame.readPicture(kLeft), frame.readPicture(kRight)};
        write("left", pictures[kLeft]);
        write("right", pictures[kRight]);
        // Tinted by what made each tile; a mode that renders every eye in full has nothing to tint.
        const Image& affiliated = pictures[static_cast<std::size_t>(1 - settings.dominant)];
        writePicture(files.staging() / "roi", PictureKind::kDisplay,
                     makeRoiPicture(affiliated, frame.readTileKinds(), frame.readPixelClasses()));
    }
    writePicture(files.staging() / "dominant_depth", PictureKind::kFloat, frame.readDominantDepth());
}

}  // namespace

void runRender(const RenderOptions& options) {
    const StereoOptions& stereo = options.run.stereo;
    const Mode mode = stereo.mode;
    // Whatever can be known to fail is found out before the scene is loaded.
    OutputFiles files(options.out);
    const CameraFiles camera_files = readCameraFiles(options.run.camera);

    LoadNotes notes;
    Scene scene = loadWithProgress(options.scene, options.run.load, notes, options.run.memory_limit_mib);
    const Cameras cameras = makeCameras(options.run, camera_files, scene);
    const Context context(contextOptions(options.run));
    const GpuScene gpu_scene = [&] {
        ProgressLine line("uploading " + options.scene);
        return GpuScene(context, scene, [&](double share) { line.show(share); });
    }();
    scene = {};

    StereoFrame frame(context, gpu_scene);
    const std::span<const Eye> eyes = mode == Mode::kMono ? std::span(&cameras.middle, 1) : std::span<const Eye>(cameras.eyes);
    FrameSettings settings = frameSettings(options.run.camera, stereo);
    settings.keep_classes = true;
    stopIfInterrupted();
    FrameResult result = frame.render(eyes, settings);
    stopIfInterrupted();
    // The first frame of a device says more about its driver than about the passes; the report is about the second, unless that takes long.
    if (result.gpu_total_ms < kLongFrameMs) { result = frame.render(eyes, settings); }

    const FrameReport report{context.deviceName(), options, cameras, result};
    writePictures(files, frame, settings);
    writeText(files.staging() / "report.json", reportJson(report));
    context.requireNoValidationMessages();
    stopIfInterrupted();
    files.publish();

    fmt::print("{}", reportTable(report));
    for (const std::string& phrase : result.left_out) { fmt::print("  left out: {}\n", phrase); }
    for (const std::string& line : notes.lines) { fmt::print("  note: {}\n", line); }
}

}  // namespace binosplat
