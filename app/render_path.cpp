// Renders frames along a recorded path of the head.
#include "app/render_path.h"

#include "app/axes/staying_axes.h"
#include "app/load.h"
#include "app/terminal/interrupt.h"
#include "app/terminal/progress.h"
#include "engine/error.h"
#include "engine/picture/image_io.h"
#include "engine/picture/join.h"
#include "engine/picture/panorama_tags.h"
#include "engine/picture/roi_picture.h"
#include "engine/picture/turned.h"
#include "engine/setup/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace binosplat {

namespace {

constexpr std::array<std::string_view, 4> kEyeNames{"left", "right", "mono", "stereo"};

std::string pictureName(std::size_t number, std::string_view eye) {
    return fmt::format("frame_{:06}_{}", number, eye);
}

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

void requireNoOthers(const std::filesystem::path& folder, std::size_t frames,
                     const std::vector<std::string_view>& eyes) {
    const std::string extension = extensionOf(PictureKind::kDisplay);
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
        const std::string name = entry.path().stem().string();
        const bool numbered =
            name.starts_with("frame_") && std::ranges::any_of(kEyeNames, [&](std::string_view eye) {
                return name.ends_with(fmt::format("_{}", eye));
            });
        if (!numbered || entry.path().extension() != extension) { continue; }
        check(isReplaced(name, frames, eyes),
              "{}: is a frame of another path, which this one's {} frames would not replace; must be removed",
              entry.path().string(), frames);
    }
}

// How many of the first frames exist, for all eyes.
std::size_t countFinished(const std::filesystem::path& folder, std::size_t frames,
                          const std::vector<std::string_view>& eyes) {
    const auto isThere = [&](std::size_t number, std::string_view eye) {
        std::error_code ignored;
        return std::filesystem::exists(
            folder / (pictureName(number, eye) + extensionOf(PictureKind::kDisplay)), ignored);
    };
    std::size_t number = 0;
    while (number < frames &&
           std::ranges::all_of(eyes, [&](std::string_view eye) { return isThere(number, eye); })) {
        ++number;
    }
    return number;
}

// For a path that is resumed: its frames are as large as the existing ones.
void requireSameSize(const std::filesystem::path& folder, std::size_t number, std::string_view eye,
                     glm::uvec2 size_px) {
    const std::filesystem::path path =
        folder / (pictureName(number, eye) + extensionOf(PictureKind::kDisplay));
    const glm::uvec2 before_px = readPicture(path).size_px;
    check(before_px == size_px, "{}: has {}x{} pixels, must be {}x{} as the frames that --resume adds",
          path.string(), before_px.x, before_px.y, size_px.x, size_px.y);
}

void tag(const std::filesystem::path& path, const Image& image, const std::optional<Panorama>& panorama) {
    if (!panorama || image.size_px != panorama->size_px) { return; }
    writeText(path, withPanoramaTags(readTextFile(path, "a picture", SIZE_MAX), *panorama));
}

}  // namespace

NamedPictures namedPictures(std::vector<Image> eyes, PictureLayout layout) {
    const bool beside = layout == PictureLayout::kSideBySide;
    if (layout != PictureLayout::kSeparate) {
        eyes = {beside ? besideOneAnother(eyes[0], eyes[1]) : aboveOneAnother(eyes[0], eyes[1])};
    }
    NamedPictures named;
    for (const std::string_view name : eyeNames(eyes.size() == 1, layout)) {
        named.emplace_back(name, std::move(eyes[named.size()]));
    }
    return named;
}

void writeDisplay(const std::filesystem::path& stem, const Image& image,
                  const std::optional<Panorama>& panorama) {
    const std::filesystem::path path = writePicture(stem, PictureKind::kDisplay, image).front();
    if (path.extension() == ".png") { tag(path, image, panorama); }
}

void writeForGalleries(const std::filesystem::path& stem, const Image& image, const Panorama& panorama) {
    if (image.size_px != panorama.size_px) { return; }  // both eyes
    if (const std::filesystem::path path = writeJpeg(stem, image); !path.empty()) {
        tag(path, image, panorama);
    }
}

HeadPath readHeadPath(const RenderOptions& options) {
    HeadMotion motion = readHeadMotion(options.path, options.path_axes, options.segment);
    if (!motion.note().empty()) { fmt::print(stderr, "binosplat: {}\n", motion.note()); }
    std::vector<double> times_s = frameTimes(motion, options.segment, options.path);
    const std::vector<std::string_view> eyes =
        eyeNames(options.run.stereo.mode == Mode::kMono, options.layout);
    requireNoOthers(options.out, times_s.size(), eyes);
    // If all frames exist, the last one is rendered again, since a film may be missing.
    const std::size_t first =
        options.resume ? std::min(countFinished(options.out, times_s.size(), eyes), times_s.size() - 1) : 0;
    const double length_s = times_s.back() - times_s.front();
    const double mean_rate_hz = length_s > 0.0 ? static_cast<double>(times_s.size() - 1) / length_s : 1.0;
    return {std::move(motion),
            std::move(times_s),
            first,
            options.out,
            options.layout,
            askedPanorama(options),
            options.segment.rate_hz.value_or(mean_rate_hz),
            fmt::format("frame_%06d_{}{}", eyes[0], extensionOf(PictureKind::kDisplay))};
}

std::vector<PathFrame> renderPath(StereoFrame& frame, LiveScene* live, const FrameSettings& path_settings,
                                  const Cameras& start, Axes kind, double units_per_metre,
                                  const HeadPath& path, OutputFiles& files) {
    FrameSettings settings = path_settings;
    settings.units_per_metre = units_per_metre;
    settings.keep_history = true;
    const bool stay = kind == Axes::kStay, mono = settings.mode == Mode::kMono;
    std::vector<PathFrame> frames;
    StayingAxes axes(glm::radians(kAxesMarginDegrees));
    bool is_first = true;
    const auto renderFlat = [&](const Cameras& cameras) {
        const std::span<const Eye> views =
            mono ? std::span(&cameras.middle, 1) : std::span<const Eye>(cameras.eyes);
        const std::span<const Eye> eyes = stay ? axes.follow(views) : views;
        if (stay) {
            settings.hidden_tiles = axes.hiddenTiles();
            settings.gazes = turnGazes(path_settings.gazes, views, eyes);
        }
        if (live != nullptr) { settle(*live, eyes); }
        // A device's first frame compiles kernels, which must not count in the report.
        if (std::exchange(is_first, false)) { frame.render(eyes, settings); }
        EyePictures made{{}, frame.render(eyes, settings)};
        for (std::size_t e = 0; e < eyes.size(); ++e) {
            made.pictures.push_back(showTurned(frame.readPicture(static_cast<int>(e)), eyes[e], views[e]));
        }
        return made;
    };
    const std::size_t all = path.times_s.size();
    // What a frame shows may depend on all before it: those that are there are rendered again.
    const std::size_t begin = !path.panorama && (stay || hasHistory(settings.mode)) ? 0 : path.first;
    ProgressLine line(fmt::format("rendering {} frames", all - begin));
    const auto renderNext = [&](std::size_t number) {
        const double time_s = path.times_s[number];
        const Pose world_from_middle =
            path.motion.cameraAt(time_s, start.middle.world_from_camera, units_per_metre);
        Cameras cameras = moveCameras(start, world_from_middle);
        if (path.panorama) { cameras = panoramaCameras(cameras, *path.panorama); }
        if (live != nullptr) { live->setTime(time_s - path.times_s.front()); }
        line.show(static_cast<double>(number - begin) / static_cast<double>(all - begin));
        EyePictures made = path.panorama ? renderPanorama(frame, live, settings, cameras, *path.panorama)
                                         : renderFlat(cameras);
        stopIfInterrupted();
        if (number < path.first) { return; }
        if (live != nullptr) { made.result.counters.streaming = streamingOf(*live); }
        for (const auto& [name, picture] : namedPictures(std::move(made.pictures), path.layout)) {
            if (frames.empty() && number > 0) {
                requireSameSize(path.folder, number - 1, name, picture.size_px);
            }
            writeDisplay(files.staging() / pictureName(number, name), picture, path.panorama);
        }
        frames.push_back({time_s, cameras, std::move(made.result)});
    };
    try {
        for (std::size_t number = begin; number < all; ++number) { renderNext(number); }
    } catch (const Interrupted&) {
        if (frames.empty()) { throw; }
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
