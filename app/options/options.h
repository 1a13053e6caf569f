// The user's settings, typed and checked: the command line over the config file over the defaults.
#pragma once

#include "app/options/amounts.h"
#include "app/scores/flip.h"
#include "engine/geometry.h"
#include "engine/passes/stereo_settings.h"
#include "engine/setup/head_motion.h"
#include "engine/setup/settings.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace binosplat {

// The eyes: places and views. Missing values come from --cameras, --headset or the scene.
struct CameraOptions {
    std::optional<glm::dvec3> eye, look, up;
    std::optional<double> fov_x_deg;
    std::optional<glm::uvec2> size_px;
    std::string cameras_file;
    std::uint32_t view = 0;
    std::string headset;
    // absent: usualNear of the scene; kUsualNear of the wearer's metres in a headset
    std::optional<double> near;
    glm::dvec3 background{0.0};
};

// What the axes of an eye's pictures follow.
enum class Axes {
    kView,  // the view, in every frame
    kStay,  // nothing, until the view leaves the picture: StayingAxes
};

struct StereoOptions {
    Mode mode = Mode::kPredicted;
    Side dominant = kLeft;
    std::optional<Order> order;  // absent: the scene's, usually by depth
    bool per_eye = false;
    StereoSettings warp{.move_cost = kDefaultMoveCost};
    std::optional<double> ipd_m;
    double foveation_deg = 0.0;   // around the gaze, within which all errors count; 0: everywhere
    bool half_periphery = false;  // with foveation: half resolution where the eyes would not see more
    Axes axes = Axes::kView;
    // In the head's axes: x right, y down, z forward; absent: at the lenses' centres.
    std::optional<glm::dvec3> gaze;
    bool operator==(const StereoOptions&) const = default;
};

inline constexpr double kDefaultIpdMetres = 0.063;

// How a scene is loaded: its level, and how 3D Gaussians are drawn.
struct LoadOptions {
    std::optional<std::uint32_t> lod;  // level of detail, 0 the finest; absent: the finest that fits
    // For a scene with levels, chosen for each leaf by the view; 0: as many as time allows.
    std::uint64_t splat_budget = 0;
    // If there is no splat_budget: as many as suit the device; 0: as many as fit; not an option.
    std::uint64_t most_splats = 0;
    std::optional<std::uint32_t> sh_degree;  // the highest to keep; absent: the scene's
    bool flatten = false;                    // 3D Gaussians as discs, without their shortest axis
    std::uint64_t cache_limit_mib = 4096;    // on disk, for scenes from the web
    double scene_rate_hz = 30.0;             // frames per second of a moving scene
    bool scene_blend = false;                // interpolate between two of them if their splats correspond
    // Dim opacities by the low-pass, even if the file does not say so.
    bool antialiased = false;
    bool operator==(const LoadOptions&) const = default;
};

// Common to `render` and `bench`.
struct RunOptions {
    CameraOptions camera;
    StereoOptions stereo;
    LoadOptions load;
    double metres_per_unit = 1.0;
    std::string device;
    std::uint64_t memory_limit_mib = 0;  // of device memory; 0: none
    std::string config;
};

// Both eyes' pictures: in files of their own, or in one, the left eye's on the left or above.
enum class PictureLayout { kSeparate, kSideBySide, kTopBottom };
// As a window shows it; everything ahead of two eyes; everything around the midpoint between them. The last
// two on a grid of equal angles.
enum class Projection { kFlat, kVr180, k360 };

struct RenderOptions {
    std::string scene;
    std::filesystem::path out;
    RunOptions run;
    // --path: head poses to render, relative to the camera; empty: one frame
    std::string path;
    MotionAxes path_axes = MotionAxes::kOpenXr;  // --path-axes: of the recording
    MotionSegment segment;                       // --from, --seconds, --rate: of the path
    PictureLayout layout = PictureLayout::kSeparate;
    Projection projection = Projection::kFlat;
    bool video = false;   // --video: also a film of the path
    bool resume = false;  // --resume: continue after the frames that exist
};

struct BenchOptions {
    std::vector<std::string> scenes;  // empty: those of the config
    std::filesystem::path out;
    RunOptions run;
    // The part of `run.camera` from the command line, not from the config.
    CameraOptions asked;
    // The config's tables that only the bench reads, see bench_plan.h.
    std::vector<SettingsTable> tables;
    std::string motion_file;                       // --motion: head poses to play, relative to the camera
    MotionAxes motion_axes = MotionAxes::kOpenXr;  // --motion-axes: of the recording
    MotionSegment segment;                         // --from, --seconds, --rate: of the motion
    std::string photos_folder;                     // --photos: photographs of the cameras of --cameras
    FrameTime frame_time;                          // --frame-time: of a motion's frames
    std::uint32_t every = 1;                       // --every: of a motion's poses or of the cameras
    // --repeats: measured frames per method; 0: as the config says
    std::uint32_t repeats = 0;
    // --orders: compare each order of splats with each pixel's own order
    bool orders = false;
    // --lpips: also measure LPIPS, whatever the config's scores; empty: as in the config
    std::string lpips_weights;
};

struct ViewOptions {
    std::string scene;
    std::string compare;                // another scene of the same place, to compare with; empty: none
    RunOptions run;                     // its camera: where the wearer starts, near, background
    std::vector<SettingsTable> tables;  // the config's [view], see view_settings.h
    bool simulate = false;
    std::string script;  // of the simulated headset; empty: at rest
    // Directory for the simulated headset's pictures; empty: chosen by the command.
    std::filesystem::path out;
    std::uint64_t frames = 0;       // stop after this many; 0: never
    bool load_first = false;        // before the session starts, so that runs are repeatable
    bool hide_panel = false;        // at the start
    bool browse = false;            // the panel opens with the list of scenes
    bool hide_hands = false;        // and controllers
    std::filesystem::path shaders;  // folder to reload them from; see shaderFolder
    bool desktop = false;           // in a window, even if there is a headset
    bool headset_only = false;      // never in a window
    double usual_rate_hz = 0.0;     // the rate that suits the device, if the headset has it; no option
};

struct InfoOptions {
    std::string scene;
    LoadOptions load;
};

struct SceneOptions {
    std::string name;
    std::uint64_t splats = 0;  // 0: the scene's own default
    std::filesystem::path out;
};

struct ConvertOptions {
    std::string scene;
    LoadOptions load;
    std::filesystem::path out;
    std::optional<glm::dvec4> crop;  // --crop: centre and radius of the sphere to keep, in scene units
    std::optional<Keep> keep;        // --keep: those that show most; absent: all splats
    // --cameras: from which they are judged; empty: from where a person could stand
    std::string cameras_file;
    std::string device;
    // Of a streamed scene, lod-meta.json:
    std::uint32_t levels = 0;        // --levels; 0: as many as the scene asks for
    std::uint64_t chunk_splats = 0;  // --chunk-splats: at most, in a file; 0: the usual number
    [[nodiscard]] bool isStreamed() const { return out.filename() == "lod-meta.json"; }
};

struct CompareOptions {
    std::filesystem::path first, second;
    std::string lpips_weights;                        // empty: no LPIPS
    double pixels_per_degree = kFlipPixelsPerDegree;  // of FLIP
};

struct StabilityOptions {
    std::filesystem::path out;
    std::string device;
};

struct KernelsOptions {
    std::filesystem::path out;  // empty: printed only
    std::string device;
    std::string filter;  // a regular expression; empty: all kernels
};

struct HelpText {
    std::string text;
};

using Options = std::variant<RenderOptions, BenchOptions, ViewOptions, InfoOptions, SceneOptions,
                             ConvertOptions, CompareOptions, StabilityOptions, KernelsOptions, HelpText>;

// Throws Error: kUsage if the command line cannot be understood, kBadInput for a bad value or config file.
Options parseOptions(int argument_count, const char* const* arguments);

// Typed values of merged settings; missing ones stay as in `options`.
RunOptions runOptions(const Settings& settings, const RunOptions& options = {});

}  // namespace binosplat
