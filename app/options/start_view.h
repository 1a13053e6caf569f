// Where one stands in a scene at first, and why there.
#pragma once

#include "app/options/options.h"
#include "engine/scene/scene.h"
#include "engine/scene/standpoint.h"
#include "engine/setup/camera_file.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace binosplat {

// The cameras.json that lies with a scene, see findCameraFile.
struct SceneCameras {
    std::filesystem::path file;  // empty: there is none
    std::vector<FileCamera> cameras;
    std::string trouble;  // why it cannot be read
};
SceneCameras readSceneCameras(const std::filesystem::path& scene);

// The mean up of cameras, unless they look every way.
std::optional<glm::dvec3> upOfCameras(const std::vector<FileCamera>& cameras);

// What the camera sees, upright along `up`: look is as far away as the middle of the scene.
View viewFrom(const Pose& world_from_camera, const std::optional<glm::dvec3>& up, const Scene& scene, double fov_x_deg);

struct StartView {
    View view;
    std::string why;  // one line
};

// The built-in scene's own; or at the first of the cameras that lie with the scene (by its name) from which it is seen; or as judged from
// the splats, see judgeStandpoint.
StartView startView(const Scene& scene, const StandpointWish& wish = {});

// With what the options say in place of that; of --cameras its --view. Throws Error if that cannot be read.
View startView(const Scene& scene, const CameraOptions& camera, double metres_per_unit);

}  // namespace binosplat
