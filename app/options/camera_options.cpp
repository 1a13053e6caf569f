// From camera options, camera files and headsets to the eyes of a frame.
#include "app/options/camera_options.h"

#include "app/options/start_view.h"
#include "engine/error.h"

namespace binosplat {

namespace {

constexpr double kDefaultFovXDegrees = 60.0;
constexpr glm::uvec2 kDefaultSize{1024, 1024};

Cameras placeCameras(const RunOptions& options, const CameraFiles& files, const Scene& scene) {
    const CameraOptions& camera = options.camera;
    const double default_ipd_m = files.headset ? files.headset->eye_distance_m : kDefaultIpdMetres;
    const double eye_distance = options.stereo.ipd_m.value_or(default_ipd_m) / options.metres_per_unit;

    if (files.camera) {
        Eye middle = camera.size_px ? resize(files.camera->eye, *camera.size_px) : files.camera->eye;
        middle.world_from_camera.position -= scene.origin;
        return {middle, stereoPair(middle, eye_distance), eye_distance, std::nullopt};
    }
    View view = startView(scene, camera, options.metres_per_unit);
    // A built-in scene's own angle belongs to its own view; if options place the eye, the usual one is used.
    const bool placed = camera.eye || camera.look;
    view.fov_x_deg = camera.fov_x_deg.value_or(placed ? kDefaultFovXDegrees : view.fov_x_deg);
    const Pose world_from_middle = lookAt(view.eye, view.look, view.up);
    if (files.headset) {
        view.fov_x_deg = 0.0;
        const glm::uvec2 size_px = camera.size_px.value_or(files.headset->size_px);
        return {headsetMiddle(*files.headset, world_from_middle, size_px),
                headsetEyes(*files.headset, world_from_middle, eye_distance, size_px), eye_distance, view,
                files.headset->lens_centres};
    }
    const glm::uvec2 size_px = camera.size_px.value_or(kDefaultSize);
    const Eye middle{world_from_middle, intrinsicsFromFovX(glm::radians(view.fov_x_deg), size_px), size_px};
    return {middle, stereoPair(middle, eye_distance), eye_distance, view};
}

}  // namespace

void requireView(const CameraOptions& options, const std::vector<FileCamera>& cameras) {
    check(options.view < cameras.size(), "{}: --view is {}, must be 0 to {}", options.cameras_file,
          options.view, cameras.size() - 1);
}

CameraFiles readCameraFiles(const CameraOptions& options) {
    CameraFiles files;
    if (!options.cameras_file.empty()) {
        const std::vector<FileCamera> cameras = readCameraFile(options.cameras_file, glm::dvec3(0.0));
        requireView(options, cameras);
        files.camera = cameras[options.view];
    }
    if (!options.headset.empty()) { files.headset = readHeadset(findHeadset(options.headset)); }
    return files;
}

Cameras makeCameras(const RunOptions& options, const CameraFiles& files, const Scene& scene) {
    Cameras cameras = placeCameras(options, files, scene);
    cameras.near = options.camera.near ? *options.camera.near : usualNear(scene);
    cameras.origin = scene.origin;
    if (cameras.view) { cameras.view->eye += scene.origin, cameras.view->look += scene.origin; }
    return cameras;
}

std::array<std::optional<Gaze>, 2> gazesOf(const Cameras& cameras, const StereoOptions& stereo) {
    std::array<std::optional<Gaze>, 2> gazes;
    if (stereo.foveation_deg == 0.0) { return gazes; }
    const double clear_rad = glm::radians(stereo.foveation_deg);
    if (stereo.mode == Mode::kMono) {
        // As seen through both lenses: midway between the directions in which they are sharpest.
        glm::dvec3 middle(0.0);
        for (std::size_t side = 0; side < 2; ++side) {
            middle +=
                cameras.eyes[side].world_from_camera.orientation * glm::normalize(cameras.lens_centres[side]);
        }
        gazes[0] =
            Gaze{stereo.gaze.value_or(glm::conjugate(cameras.middle.world_from_camera.orientation) * middle),
                 clear_rad};
        return gazes;
    }
    for (std::size_t side = 0; side < 2; ++side) {
        // The target is assumed to be far away: both eyes turn alike.
        const glm::dquat eye_from_middle = glm::conjugate(cameras.eyes[side].world_from_camera.orientation) *
                                           cameras.middle.world_from_camera.orientation;
        const glm::dvec3 direction =
            stereo.gaze ? eye_from_middle * *stereo.gaze : cameras.lens_centres[side];
        gazes[side] = Gaze{direction, clear_rad};
    }
    return gazes;
}

Cameras moveCameras(const Cameras& start, const Pose& world_from_middle) {
    Cameras moved = start;
    moved.middle.world_from_camera = world_from_middle;
    for (std::size_t side = 0; side < 2; ++side) {
        const Pose middle_from_eye =
            compose(inverse(start.middle.world_from_camera), start.eyes[side].world_from_camera);
        moved.eyes[side].world_from_camera = compose(world_from_middle, middle_from_eye);
    }
    return moved;
}

}  // namespace binosplat
