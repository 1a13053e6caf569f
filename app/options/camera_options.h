// Makes the eyes of a frame from camera options, camera files and headsets.
#pragma once

#include "app/options/options.h"
#include "engine/frame/stereo_frame.h"
#include "engine/geometry.h"
#include "engine/places/standpoint.h"
#include "engine/setup/camera_file.h"
#include "engine/setup/headset.h"

#include <array>
#include <optional>

namespace binosplat {

// Contents of the files that the options name, in the file's coordinates, so that errors in them are reported
// before the scene is loaded.
struct CameraFiles {
    std::optional<FileCamera> camera;
    std::optional<Headset> headset;
};
CameraFiles readCameraFiles(const CameraOptions& options);
// Throws Error unless the options' --view is one of their --cameras.
void requireView(const CameraOptions& options, const std::vector<FileCamera>& cameras);

struct Cameras {
    Eye middle;               // for `mono`
    std::array<Eye, 2> eyes;  // by Side
    double eye_distance;      // scene units
    // The resulting --eye, --look, --up and --fov-x (0 with a headset), in the file's coordinates; empty with
    // a camera file.
    std::optional<View> view;
    // Directions to the lenses' centres, in the eyes' axes.
    std::array<glm::dvec3, 2> lens_centres{glm::dvec3(0.0, 0.0, 1.0), glm::dvec3(0.0, 0.0, 1.0)};
    double near = kUsualNear;  // the resulting --near
    glm::dvec3 origin{0.0};    // the eyes' origin in the file: Scene::origin
};

// The eyes in the coordinates of the scene's `positions`. Missing options come from the files, then from the
// scene. Throws Error if the points do not define a view.
Cameras makeCameras(const RunOptions& options, const CameraFiles& files, const Scene& scene);

// The options' gazes for FrameSettings, by Side, or that of the single eye of `mono`; empty without
// foveation.
std::array<std::optional<Gaze>, 2> gazesOf(const Cameras& cameras, const StereoOptions& stereo);

// The same eyes on a head that has moved.
Cameras moveCameras(const Cameras& start, const Pose& world_from_middle);

}  // namespace binosplat
