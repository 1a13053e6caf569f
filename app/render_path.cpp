// Frames along a recorded path of the head.
#include "app/render_path.h"

#include "app/load.h"
#include "app/terminal/interrupt.h"
#include "app/terminal/progress.h"
#include "engine/error.h"
#include "engine/frame/staying_axes.h"
#include "engine/picture/image_io.h"
#include "engine/picture/join.h"
#include "engine/picture/roi_picture.h"
#include "engine/picture/turned.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <span>
#include <string>
#include <string_view>

namespace binosplat {

namespace {

constexpr std::array<std::string_view, 4> kEyeNames{"left", "right", "mono", "stereo"};

std::string pictureName(std::size_t number, std::string_view eye) { return fmt::format("frame_{:06}_{}", number, eye); }

std::vector<std::string_view> eyeNames(bool mono, PictureLayout layout) {
    if (layout != PictureLayout::kSeparate) { return {"stereo"}; }
    return mono ? std::vector<std::string_view>{"mono"} : std::vector<std::string_view>{"left", "right"};
}

// True if a path of this many frames overwrites the picture of this name.
bool isReplaced(std::string_view name, std::size_t frames, const std::vector<std::string_view>& eyes) {
    static constexpr std::string_view kBegin = "frame_";
    const std::string_view number = name.substr(std::min(kBegin.size(), name.size()));
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
    if (error != std::errc{} || value >= frames) { return false; }
    return std::ranges::any_of(eyes, [&](std::string_view eye) { return name == pictureName(value, eye); });
}

void requireNoOthers(const std::filesystem::path& folder, std::size_t frames, const std::vector<std::string_view>& eyes) {
    const std::string extension = extensionOf(PictureKind::kDisplay);
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
        const std::string name = entry.path().stem().string();
        const bool numbered = name.starts_with("frame_") &&
                              std::ranges::any_of(kEyeNames, [&](std::string_view eye) { return name.ends_with(fmt::format("_{}", eye)); });
        if (!numbered || entry.path().extension() != extension) { continue; }
        check(isReplaced(name, frames, eyes),
              "{}: is a frame of another path, which this one's {} frames would not replace; must be taken away", entry.path().string(),
              frames);
    }
}

}  // namespace

Image joined(const Image& left, const Image& right, PictureLayout layout) {
    return layout == PictureLayout::kSideBySide ? besideOneAnother(left, right) : aboveOneAnother(left, right);
}

HeadPath readHeadPath(const RenderOptions& options) {
    HeadMotion motion = readHeadMotion(options.path, options.path_axes, options.segment);
    if (!motion.note().empty()) { fmt::print(stderr, "binosplat: {}\n", motion.note()); }
    std::vector<double> times_s = frameTimes(motion, options.segment, options.path);
    requireNoOthers(options.out, times_s.size(), eyeNames(options.run.stereo.mode == Mode::kMono, options.layout));
    return {std::move(motion), std::move(times_s), options.layout};
}

std::vector<PathFrame> renderPath(StereoFrame& frame, LiveScene* live, const FrameSettings& path_settings, const Cameras& start, Axes kind,
                                  double units_per_metre, const HeadPath& path, OutputFiles& files) {
    FrameSettings settings = path_settings;
    settings.units_per_metre = units_per_metre;
    settings.keep_past = true;
    const bool stay = kind == Axes::kStay, mono = settings.mode == Mode::kMono;
    std::vector<PathFrame> frames;
    StayingAxes axes(glm::radians(kAxesMarginDegrees));
    ProgressLine line(fmt::format("rendering {} frames", path.times_s.size()));
    for (const double time_s : path.times_s) {
        const Pose world_from_middle = path.motion.cameraAt(time_s, start.middle.world_from_camera, units_per_metre);
        const Cameras cameras = moveCameras(start, world_from_middle);
        const std::span<const Eye> views = mono ? std::span(&cameras.middle, 1) : std::span<const Eye>(cameras.eyes);
        const std::span<const Eye> eyes = stay ? axes.follow(views) : views;
        if (stay) {
            settings.hidden_tiles = axes.hiddenTiles();
            settings.gazes = turnGazes(path_settings.gazes, views, eyes);
        }
        if (live != nullptr) {
            live->setTime(time_s - path.times_s.front());
            settle(*live, eyes);
        }
        // A device's first frame compiles kernels, which must not count in the report.
        if (frames.empty()) { frame.render(eyes, settings); }
        line.show(static_cast<double>(frames.size()) / static_cast<double>(path.times_s.size()));
        FrameResult result = frame.render(eyes, settings);
        if (live != nullptr) { result.counters.streaming = streamingOf(*live); }
        const auto shown = [&](int of) {
            const auto e = static_cast<std::size_t>(of);
            return showTurned(frame.readPicture(of), eyes[e], views[e]);
        };
        int eye = 0;
        for (const std::string_view name : eyeNames(mono, path.layout)) {
            stopIfInterrupted();
            const Image picture = path.layout == PictureLayout::kSeparate ? shown(eye++) : joined(shown(kLeft), shown(kRight), path.layout);
            writePicture(files.staging() / pictureName(frames.size(), name), PictureKind::kDisplay, picture);
        }
        frames.push_back({time_s, cameras, std::move(result)});
    }
    // How the tiles of the last frame were made, if both eyes have tiles that were not rendered.
    if (!mono && !frame.readTileKinds(kLeft).empty() && !frame.readTileKinds(kRight).empty()) {
        for (const int eye : {kLeft, kRight}) {
            writePicture(files.staging() / (eye == kLeft ? "roi_left" : "roi_right"), PictureKind::kDisplay,
                         makeRoiPicture(frame.readPicture(eye), frame.readTileKinds(eye), {}));
        }
    }
    return frames;
}

}  // namespace binosplat
