// Where one starts in a scene, and why.
#pragma once

#include "app/options/options.h"
#include "engine/places/standpoint.h"
#include "engine/scene/scene.h"
#include "engine/setup/camera_file.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace binosplat {

// The cameras.json that belongs to a scene, see findCameraFile.
struct SceneCameras {
    std::filesystem::path file;  // empty: there is none
    std::vector<FileCamera> cameras;
    std::string trouble;  // why it cannot be read
};
// Positions are relative to `origin`, the scene's.
SceneCameras readSceneCameras(const std::filesystem::path& scene, const glm::dvec3& origin);

// The up direction that cameras suggest, and the reason, in one line.
struct CamerasUp {
    glm::dvec3 up;
    std::string why;
};
// The mean up of the cameras, or that of the floor beneath them if they look in every direction or may all
// look straight down. Empty if neither is known.
std::optional<CamerasUp> upOfCameras(const std::vector<FileCamera>& cameras, const Scene& scene);

// The camera's view, upright along `up`: `look` is at the median depth of the scene.
View viewFrom(const Pose& world_from_camera, const std::optional<glm::dvec3>& up, const Scene& scene,
              double fov_x_deg);

struct StartView {
    View view;
    std::string why, up_why;  // one line each
};

// The built-in scene's own view; or that of the first of the scene's cameras (found by its name) that sees
// it; or one derived from the splats, see judgeStandpoint.
StartView startView(const Scene& scene, const StandpointWish& wish = {});

// The same, overridden by the options; with --cameras, its --view. Throws Error if that cannot be read.
View startView(const Scene& scene, const CameraOptions& camera, double metres_per_unit);

}  // namespace binosplat
