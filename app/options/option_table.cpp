// Every option, once.
#include "app/options/option_table.h"

#include "app/scores/flip.h"
#include "engine/scene/scene.h"

#include <algorithm>

namespace binosplat {

namespace {

constexpr std::uint64_t kAny32 = std::numeric_limits<std::uint32_t>::max();
// A gap is filled pixel by pixel from its two ends; a longer run is not a crack in a surface but uncovered
// background.
constexpr std::uint64_t kMaxGapPx = 64;
constexpr std::uint64_t kMaxMoveCost = 1'000'000;
// Colours are between 0 and a few, and a pixel of a reprojected tile counts for a squared error of at most 4
// (kMaxPixelError).
constexpr double kMaxExpectedError = 8.0;
constexpr std::uint64_t kMaxMemoryMib = std::uint64_t{1} << 30;
constexpr std::uint64_t kMaxFrames = 1'000'000'000;
constexpr std::uint64_t kMaxStep = 1'000'000;
constexpr double kMaxSeconds = 1e6, kMaxRateHz = 10'000.0;

constexpr unsigned kPictures = kRender | kBench;          // commands that make pictures without a headset
constexpr unsigned kWearer = kPictures | kView;           // commands that show a scene to two eyes
constexpr unsigned kScenes = kWearer | kInfo | kConvert;  // commands that load a scene
constexpr unsigned kDevices = kPictures | kStability | kKernels;
constexpr unsigned kTried = kWearer | kMethods;  // options that a bench varies

constexpr auto kCamera = &RunOptions::camera;
constexpr auto kStereo = &RunOptions::stereo;
constexpr auto kWarp = &StereoOptions::warp;
// Names below are in this order.
static_assert(gpu::kDepthSum == 0 && gpu::kDepthMean == 1 && gpu::kDepthInverse == 2);
constexpr auto kPathSegment = &RenderOptions::segment;
constexpr auto kMotionSegment = &BenchOptions::segment;
constexpr auto kLoad = &RunOptions::load;

// A count whose 0 means none.
template <typename Owner>
OptionField<Owner> noneIfZero(OptionField<Owner> field) {
    field.value = [value = std::move(field.value)](const Owner& owner) {
        const OptionValue given = value(owner);
        return given == OptionValue{std::uint64_t{0}} ? OptionValue{} : given;
    };
    return field;
}

// A number whose slider ends before its range does.
template <typename Owner>
OptionField<Owner> slidesTo(double most, OptionField<Owner> field) {
    field.slider_most = most;
    return field;
}

}  // namespace

std::span<const OptionRow<RunOptions>> runRows() {
    static const std::vector<OptionRow<RunOptions>> rows{
        // Camera.
        {{"eye", "camera", kWearer, "x,y,z", "the point midway between the eyes",
          "where `binosplat info` says"},
         field::make<kCamera, &CameraOptions::eye>("", readVector)},
        {{"look", "camera", kWearer, "x,y,z", "the point to look at"},
         field::make<kCamera, &CameraOptions::look>("", readVector)},
        {{"up", "camera", kWearer, "x,y,z", "the direction that points up in the picture",
          "that of the cameras, the floor or the built-in scene, or 0,-1,0"},
         field::make<kCamera, &CameraOptions::up>("", readVector)},
        {{"fov-x", "camera", kPictures, "DEG", "horizontal field of view",
          "60, or the built-in scene's view"},
         field::number<kCamera, &CameraOptions::fov_x_deg>(0.1, 179.0)},
        {{"size", "camera", kPictures, "WxH", "pixels per eye; a single number sets both width and height",
          "1024x1024, or that of --cameras or --headset"},
         field::make<kCamera, &CameraOptions::size_px>(fmt::format("1 to {} each", kMaxSide), readSize)},
        {{"cameras", "camera", kWearer | kConvert, "FILE", "cameras.json from 3DGS or 2DGS training",
          "with --view, the one next to SCENE or in its folder"},
         field::file<kCamera, &CameraOptions::cameras_file>()},
        {{"view", "camera", kWearer, "N", "which camera of --cameras, counting from 0"},
         field::count<kCamera, &CameraOptions::view>(0, kAny32)},
        {{"headset", "camera", kPictures, "NAME",
          "angles, size and eye distance from configs/headsets/NAME.toml"},
         field::text<kCamera, &CameraOptions::headset>()},
        {{"near", "camera", kWearer, "Z",
          "nearest depth that is drawn, in scene units (in view: in the wearer's metres)",
          "0.2, or a fifth of the scene's size if that is less than a unit"},
         field::number<kCamera, &CameraOptions::near>(1e-6, 1e6)},
        {{"background", "camera", kWearer, "r,g,b", "colour behind the scene"},
         field::make<kCamera, &CameraOptions::background>("0 to 1 each", readColour)},

        // Stereo.
        {{"mode", "stereo", kTried, "MODE", "how both eyes' pictures are made",
          "predicted; with view and --path: temporal", /*required*/ false,
          /*by_command*/ true},
         field::named<kStereo, &StereoOptions::mode>({kModeNames.begin(), kModeNames.end()})},
        {{"dominant", "stereo", kWearer, "SIDE", "eye that is rendered in full"},
         field::named<kStereo, &StereoOptions::dominant>({"left", "right"})},
        {{"ipd", "stereo", kPictures, "METRES", "distance between the eyes", "0.063, or the headset's"},
         field::number<kStereo, &StereoOptions::ipd_m>(0.0, 10.0)},
        {{"center-roi", "stereo", kTried, "",
          "paper mode: also render the holes that remain inside the picture"},
         field::flag<kStereo, kWarp, &StereoSettings::center_rois>()},
        {{"margin", "stereo", kTried, "PX",
          "paper mode: pixels added around each part that is rendered after reprojection"},
         slidesTo(128, field::count<kStereo, kWarp, &StereoSettings::margin_px>(0, kMaxSide))},
        {{"budget", "stereo", kTried, "FRACTION",
          "how much may be rendered each frame, as a share of the work of rendering one eye (predicted) or "
          "both (temporal) in full"},
         field::share<kStereo, kWarp, &StereoSettings::budget>()},
        {{"error-bound", "stereo", kTried, "DB",
          "temporal mode: tiles that are expected to have less than this PSNR (up to 4.4 dB more where "
          "contrast is low) are rendered first, within --budget; 0: off"},
         field::number<kStereo, kWarp, &StereoSettings::error_bound_db>(0.0, 60.0)},
        {{"move-cost", "stereo", kTried, "PAIRS",
          "predicted mode: tiles that at most this many splats touch are rendered, not reprojected; temporal "
          "mode: so are frames in which reprojecting saves fewer pairs per tile"},
         field::count<kStereo, kWarp, &StereoSettings::move_cost>(0, kMaxMoveCost)},
        {{"depth", "stereo", kTried, "KIND", "the depth by which a pixel is reprojected: D, D/A or A/I"},
         field::named<kStereo, kWarp, &StereoSettings::depth_choice>({"sum", "mean", "inverse"})},
        {{"order", "stereo", kTried, "KIND",
          "blending order: by depth, or by distance from the point midway between the eyes",
          "the scene's, or depth; with view or --axes stay: distance", /*required*/ false,
          /*by_command*/ true},
         field::named<kStereo, &StereoOptions::order>({"depth", "distance"})},
        {{"resampling", "stereo", kTried, "KIND",
          "reproject and paper modes: reprojected pixels are sampled with a cubic kernel, or copied forward "
          "with gaps interpolated, as in "
          "the "
          "paper"},
         field::named<kStereo, kWarp, &StereoSettings::forward>({"cubic", "forward"})},
        {{"per-eye", "stereo", kTried, "",
          "paper mode: cull, sort and project for each eye by itself, as two-pass does"},
         field::flag<kStereo, &StereoOptions::per_eye>()},
        {{"gap-px", "stereo", kTried, "PX",
          "longest run of uncovered pixels that is interpolated; longer runs are holes"},
         field::count<kStereo, kWarp, &StereoSettings::gap_px>(0, kMaxGapPx)},
        {{"edge-samples", "stereo", kTried, "N", "paper mode: samples along each edge of the picture"},
         field::count<kStereo, kWarp, &StereoSettings::edge_samples>(1, kMaxSide)},
        {{"edge-bounds", "stereo", kTried, "KIND",
          "paper mode: width of the borders that are rendered after reprojection: as in the paper, or wide "
          "enough for disocclusion by near content too"},
         field::named<kStereo, kWarp, &StereoSettings::tight_edges>({"paper", "tight"})},
        {{"hole-error", "stereo", kTried, "E",
          "predicted mode: weight of the error expected in a hole's pixels"},
         field::number<kStereo, kWarp, &StereoSettings::hole_error>(0.0, kMaxExpectedError)},
        {{"newcomer-error", "stereo", kTried, "E",
          "predicted mode: error expected in a pixel covered by splats that the dominant eye does not see"},
         field::number<kStereo, kWarp, &StereoSettings::newcomer_error>(0.0, kMaxExpectedError)},
        {{"foveation", "stereo", kTried, "DEG",
          "angle around the gaze within which all errors count; beyond it, only errors that the eye can see "
          "count (predicted, temporal; mono and alternate with --periphery half); 0: off"},
         field::number<kStereo, &StereoOptions::foveation_deg>(0.0, 90.0)},
        {{"periphery", "stereo", kTried, "KIND",
          "mono, predicted, alternate and temporal modes, with --foveation: full resolution everywhere, or "
          "half of it where the eye would see no difference",
          "full; with view: half", /*required*/ false, /*by_command*/ true},
         field::named<kStereo, &StereoOptions::half_periphery>({"full", "half"})},
        {{"axes", "stereo", kWearer, "KIND",
          "in a headset, with --path or --motion: the axes of the pictures follow the view, or stay while "
          "the head turns by a few degrees; then each picture is resampled once to the view, as a headset's "
          "compositor does",
          "view; in a headset: stay", /*required*/ false, /*by_command*/ true},
         field::named<kStereo, &StereoOptions::axes>({"view", "stay"})},
        {{"gaze", "stereo", kPictures, "x,y,z",
          "direction of the gaze relative to the head: right, down, forward", "each lens's centre"},
         field::make<kStereo, &StereoOptions::gaze>("of any length", readDirection)},

        // Scene.
        {{"lod", "scene", kScenes, "N", "level of detail of a streamed SOG scene; 0 is the finest",
          "the finest within --memory-limit"},
         field::count<kLoad, &LoadOptions::lod>(0, kAny32)},
        {{"splat-budget", "scene", kWearer, "N",
          "largest number of splats of a streamed SOG scene to load at a time; levels are chosen by what the "
          "eyes see",
          "the finest level, or what the memory holds"},
         noneIfZero(field::count<kLoad, &LoadOptions::splat_budget>(1, kMaxSplats))},
        {{"scene-rate", "scene", kWearer, "HZ",
          "frames per second of a moving scene (a folder of numbered files)"},
         field::number<kLoad, &LoadOptions::scene_rate_hz>(0.01, kMaxRateHz)},
        {{"scene-blend", "scene", kWearer, "",
          "interpolate between two frames of a moving scene where their splats correspond"},
         field::flag<kLoad, &LoadOptions::scene_blend>()},
        {{"sh-degree", "scene", kScenes, "N",
          "highest band of spherical harmonics to keep; fewer bands take less memory and time",
          "the scene's"},
         field::count<kLoad, &LoadOptions::sh_degree>(0, kMaxShDegree)},
        {{"flatten", "scene", kScenes, "", "draw 3D Gaussians as discs, dropping each one's shortest axis"},
         field::flag<kLoad, &LoadOptions::flatten>()},
        {{"antialiased", "scene", kScenes, "", "dim small 3D Gaussians, for scenes trained with antialiasing",
          "the file's"},
         field::flag<kLoad, &LoadOptions::antialiased>()},
        {{"cache-limit", "scene", kScenes, "MIB",
          "disk space for keeping scenes from http and https addresses"},
         field::count<kLoad, &LoadOptions::cache_limit_mib>(0, kMaxMemoryMib)},
        {{"metres-per-unit", "scene", kWearer, "M", "metres in one scene unit"},
         field::make<&RunOptions::metres_per_unit>("greater than 0", readPositive)},

        // Run.
        {{"memory-limit", "run", kWearer, "MIB", "device memory that may be used", "all of it"},
         noneIfZero(field::count<&RunOptions::memory_limit_mib>(1, kMaxMemoryMib))},
        {{"device", "run", kDevices | kConvert, "NAME|INDEX", "GPU to use, by its number or part of its name",
          "the most capable"},
         field::text<&RunOptions::device>()},
    };
    return rows;
}

const OptionRow<RunOptions>* findRunRow(std::string_view key) {
    const auto found =
        std::ranges::find(runRows(), key, [](const auto& row) { return std::string_view(row.text.key); });
    return found == runRows().end() ? nullptr : &*found;
}

std::span<const OptionRow<RenderOptions>> renderRows() {
    static const std::vector<OptionRow<RenderOptions>> rows{
        {{"out", "", kRender, "DIR", "directory for pictures and report.json", "", /*required*/ true},
         field::file<&RenderOptions::out>()},
        {{"layout", "", kRender, "KIND",
          "each eye in a picture of its own, or both in one: side by side, or the left eye's above the right "
          "eye's"},
         field::named<&RenderOptions::layout>({"separate", "sbs", "tb"})},
        {{"projection", "", kRender, "KIND",
          "flat; or for headsets: vr180 (what lies ahead, for both eyes) or 360 (all around), both "
          "equirectangular, level and rendered in full"},
         field::named<&RenderOptions::projection>({"flat", "vr180", "360"})},
        {{"video", "", kRender, "", "with --path: also make video.mp4 of its frames, with ffmpeg"},
         field::flag<&RenderOptions::video>()},
        {{"resume", "", kRender, "",
          "with --path: continue after the frames that an interrupted run left in --out"},
         field::flag<&RenderOptions::resume>()},
        {{"path", "", kRender, "POSES.csv",
          "head poses relative to the camera; each is rendered as a numbered frame"},
         field::file<&RenderOptions::path>()},
        {{"path-axes", "", kRender, "AXES", "axes of --path"},
         field::named<&RenderOptions::path_axes>({"openxr", "unity"})},
        {{"from", "", kRender, "S", "second of --path at which to start; the head is then at the camera"},
         field::number<kPathSegment, &MotionSegment::from_s>(0.0, kMaxSeconds)},
        {{"seconds", "", kRender, "S", "how many seconds of --path to render", "the rest of it"},
         field::number<kPathSegment, &MotionSegment::seconds>(0.001, kMaxSeconds)},
        {{"rate", "", kRender, "HZ", "frames per second of --path, interpolated between its poses",
          "one for each pose"},
         field::number<kPathSegment, &MotionSegment::rate_hz>(0.001, kMaxRateHz)},
    };
    return rows;
}

std::span<const OptionRow<BenchOptions>> benchRows() {
    static const std::vector<OptionRow<BenchOptions>> rows{
        {{"out", "", kBench, "DIR", "directory for bench.json, bench.csv and bench.svg", "",
          /*required*/ true},
         field::file<&BenchOptions::out>()},
        {{"motion", "", kBench, "TRACE.csv", "head poses to play relative to the camera"},
         field::file<&BenchOptions::motion_file>()},
        {{"motion-axes", "", kBench, "AXES", "axes of --motion"},
         field::named<&BenchOptions::motion_axes>({"openxr", "unity"})},
        {{"from", "", kBench, "S", "second of --motion at which to start; the head is then at the camera"},
         field::number<kMotionSegment, &MotionSegment::from_s>(0.0, kMaxSeconds)},
        {{"seconds", "", kBench, "S", "how many seconds of --motion to play", "the rest of it"},
         field::number<kMotionSegment, &MotionSegment::seconds>(0.001, kMaxSeconds)},
        {{"rate", "", kBench, "HZ", "frames per second of --motion, interpolated between its poses",
          "one for each pose"},
         field::number<kMotionSegment, &MotionSegment::rate_hz>(0.001, kMaxRateHz)},
        {{"frame-time", "", kBench, "MS|PERCENT",
          "with --motion: time that a frame of temporal may take, in ms or as a share of two-pass's time "
          "(70%); the viewer's governor (balanced) chooses resolution and bound to keep to it",
          "no limit"},
         field::amount<&BenchOptions::frame_time>(readFrameTime)},
        {{"photos", "", kBench, "DIR", "photographs taken by the cameras of --cameras, to compare with"},
         field::file<&BenchOptions::photos_folder>()},
        {{"orders", "", kBench, "",
          "compare both orders of splats with each pixel's exact order, on the CPU, and count pixels that "
          "pop"},
         field::flag<&BenchOptions::orders>()},
        {{"every", "", kBench, "N",
          "score only every Nth frame of --motion (methods with a history still render all frames), or every "
          "Nth camera of --photos"},
         field::count<&BenchOptions::every>(1, kMaxStep)},
        {{"repeats", "", kBench, "N", "measured frames per method", "5, or the config's"},
         noneIfZero(field::count<&BenchOptions::repeats>(1, kMaxStep))},
        {{"lpips", "", kBench, "WEIGHTS",
          "also measure LPIPS, with this file of weights (SqueezeNet variant, version 0.1)"},
         field::file<&BenchOptions::lpips_weights>()},
    };
    return rows;
}

std::span<const OptionRow<ViewOptions>> viewRows() {
    static const std::vector<OptionRow<ViewOptions>> rows{
        {{"out", "", kView, "DIR", "directory for the simulated headset's pictures"},
         field::file<&ViewOptions::out>()},
        {{"compare", "", kView, "SCENE",
          "another scene of the same place to compare with: in a window, shown on the other side of a line; "
          "in a headset, shown while X or A is held"},
         field::file<&ViewOptions::compare>()},
        {{"desktop", "", kView, "", "show the scene in a window, even if there is a headset"},
         field::flag<&ViewOptions::desktop>()},
        {{"headset-only", "", kView, "",
          "never open a window: wait for a headset, and end with exit code 3 if there is no OpenXR runtime"},
         field::flag<&ViewOptions::headset_only>()},
        {{"frames", "", kView, "N",
          "stop after N frames of the scene; those before it is loaded do not count", "never"},
         noneIfZero(field::count<&ViewOptions::frames>(1, kMaxFrames))},
        {{"load-first", "", kView, "", "load the scene before the session starts, not during it"},
         field::flag<&ViewOptions::load_first>()},
        {{"hide-panel", "", kView, "", "start without the panel"}, field::flag<&ViewOptions::hide_panel>()},
        {{"hide-hands", "", kView, "", "draw neither hands nor controllers"},
         field::flag<&ViewOptions::hide_hands>()},
        {{"shaders", "", kView, "DIR",
          "for work on the shaders: F5 and a button in the panel reload them from this folder"},
         field::file<&ViewOptions::shaders>()},
        {{"simulate", "", kView, "[SCRIPT]", "use the simulated headset, driven by SCRIPT if given"},
         field::file<&ViewOptions::script>([](const Setting& s) { return s.text(); })},
    };
    return rows;
}

std::span<const OptionRow<SceneOptions>> sceneRows() {
    static const std::vector<OptionRow<SceneOptions>> rows{
        {{"splats", "", kScene, "N", "how many splats", "the scene's own number"},
         noneIfZero(field::count<&SceneOptions::splats>(1, kMaxSplats))},
        {{"out", "", kScene, "FILE.ply", "file to write", "", /*required*/ true},
         field::file<&SceneOptions::out>()},
    };
    return rows;
}

std::span<const OptionRow<ConvertOptions>> convertRows() {
    static const std::vector<OptionRow<ConvertOptions>> rows{
        {{"crop", "", kConvert, "x,y,z,r",
          "keep only the splats whose centres lie in this sphere, in scene units"},
         field::make<&ConvertOptions::crop>("", readSphere)},
        {{"keep", "", kConvert, "SHARE|N|SIZE",
          "keep a share of the splats (0.5), a number of them (100000), or as many as fit into a file of a "
          "given size (50MB): those that contribute most to the picture, adjusted to make up for the others",
          "all of them"},
         field::amount<&ConvertOptions::keep>(readKeep)},
        {{"levels", "", kConvert, "N",
          "levels of detail in OUT/lod-meta.json, each with half the splats of the one before",
          "until fewer than 50,000 are left"},
         noneIfZero(field::count<&ConvertOptions::levels>(1, 16))},
        {{"chunk-splats", "", kConvert, "N", "largest number of splats in a chunk of OUT/lod-meta.json",
          "524288"},
         noneIfZero(field::count<&ConvertOptions::chunk_splats>(4096, 16777216))},
    };
    return rows;
}

std::span<const OptionRow<CompareOptions>> compareRows() {
    static const std::vector<OptionRow<CompareOptions>> rows{
        {{"lpips", "", kCompare, "WEIGHTS",
          "also measure LPIPS, with this file of weights (SqueezeNet variant, version 0.1)"},
         field::file<&CompareOptions::lpips_weights>()},
        {{"pixels-per-degree", "", kCompare, "N", "pixels per degree that FLIP assumes", "67.02"},
         field::number<&CompareOptions::pixels_per_degree>(kFlipLeastPixelsPerDegree,
                                                           kFlipMostPixelsPerDegree)},
    };
    return rows;
}

std::span<const OptionRow<StabilityOptions>> stabilityRows() {
    static const std::vector<OptionRow<StabilityOptions>> rows{
        {{"out", "", kStability, "DIR", "directory for stability.txt, stability.csv and stability.svg", "",
          /*required*/ true},
         field::file<&StabilityOptions::out>()},
    };
    return rows;
}

std::span<const OptionRow<KernelsOptions>> kernelsRows() {
    static const std::vector<OptionRow<KernelsOptions>> rows{
        {{"out", "", kKernels, "DIR", "directory for kernels.json"}, field::file<&KernelsOptions::out>()},
        {{"filter", "", kKernels, "REGEX", "only kernels whose line (name and constants) matches this",
          "all"},
         field::text<&KernelsOptions::filter>()},
    };
    return rows;
}

std::string textOf(const OptionValue& value) {
    const auto convert = [](const auto& held) -> std::string {
        using Held = std::remove_cvref_t<decltype(held)>;
        if constexpr (std::is_same_v<Held, std::monostate>) {
            return "";
        } else if constexpr (std::is_same_v<Held, glm::dvec3>) {
            return fmt::format("{},{},{}", held.x, held.y, held.z);
        } else {
            return fmt::format("{}", held);
        }
    };
    return std::visit(convert, value);
}

std::string OptionDescription::help() const {
    std::string brackets = range;
    if (!standard.empty()) { brackets += fmt::format("{}default {}", range.empty() ? "" : "; ", standard); }
    return brackets.empty() ? text.help : fmt::format("{} ({})", text.help, brackets);
}

}  // namespace binosplat
