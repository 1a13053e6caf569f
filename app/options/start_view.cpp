// Start views from cameras or, failing that, from the splats.
#include "app/options/start_view.h"

#include "app/options/camera_options.h"
#include "engine/builtin/procedural.h"
#include "engine/error.h"
#include "engine/files/scene_folder.h"
#include "engine/places/floor_choice.h"

#include <algorithm>
#include <cmath>

namespace binosplat {

namespace {

constexpr double kUsualFovXDegrees = 60.0;
// A camera that sees a smaller share of the splats belongs to another scene.
constexpr double kLeastSeen = 0.02;
constexpr std::size_t kMostForCameras = 4096;
constexpr double kAbout = 0.8660254;  // 30 degrees

std::optional<std::size_t> firstThatSees(const std::vector<FileCamera>& cameras, const Scene& scene) {
    const std::vector<SplatSample> samples = sampleSplats(scene, kMostForCameras);
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        const Eye& eye = cameras[i].eye;
        const Pose camera_from_world = inverse(eye.world_from_camera);
        const auto seen = std::ranges::count_if(samples, [&](const SplatSample& sample) {
            return isInPicture(eye, transform(camera_from_world, sample.centre));
        });
        if (seen > 0 && static_cast<double>(seen) >= kLeastSeen * static_cast<double>(samples.size())) {
            return i;
        }
    }
    return std::nullopt;
}

std::optional<StartView> viewAtCamera(const Scene& scene, const SceneCameras& own,
                                      const StandpointWish& wish) {
    const std::optional<std::size_t> first = firstThatSees(own.cameras, scene);
    if (!first) { return std::nullopt; }
    const FileCamera& camera = own.cameras[*first];
    const std::string at = fmt::format("at camera {} ({}) of {}", *first, camera.name, own.file.string());
    const auto with = [&](const std::optional<glm::dvec3>& up, const std::string& up_why) {
        const View view = viewFrom(camera.eye.world_from_camera, up, scene, wish.fov_x_deg);
        const bool keeps_own = up && glm::dot(view.up, glm::normalize(*up)) < kAbout;
        return StartView{view, at,
                         up_why + (keeps_own ? "; this camera looks along it and keeps its own" : "")};
    };
    if (wish.up) { return with(wish.up, "given"); }
    if (const auto found = upOfCameras(own.cameras, scene)) { return with(found->up, found->why); }
    return with({}, "this camera's, since the cameras look in all directions");
}

glm::dvec3 along(const FileCamera& camera, const glm::dvec3& axis) {
    return camera.eye.world_from_camera.orientation * axis;
}

// True for cameras that turn about their own up far more than they roll, as in front of a wall: a camera that
// looks straight down keeps its line of sight plumb, and is as free to turn about that.
bool keepLevel(const std::vector<FileCamera>& cameras, const glm::dvec3& ahead, const glm::dvec3& up) {
    constexpr double kLeastTurn = 0.005, kMoreThanRoll = 2.0;  // radians
    const glm::dvec3 right = glm::normalize(glm::cross(ahead, up));
    const auto spread = [&](const glm::dvec3& axis, const glm::dvec3& direction) {
        double sum = 0.0, squares = 0.0;
        for (const FileCamera& camera : cameras) {
            const double off = glm::dot(along(camera, axis), direction);
            sum += off;
            squares += off * off;
        }
        const auto count = static_cast<double>(cameras.size());
        return std::sqrt(std::max(squares / count - sum / count * sum / count, 0.0));
    };
    const double turn = spread({0.0, 0.0, 1.0}, right), roll = spread({1.0, 0.0, 0.0}, up);
    return turn > kLeastTurn && turn > kMoreThanRoll * roll;
}

// True for cameras that all look one way, and are as far apart along their own up as those of a drone that
// looks straight down, or of one in front of a facade: a walking person's are not.
bool mayLookDown(const std::vector<FileCamera>& cameras, const glm::dvec3& ahead, const glm::dvec3& up,
                 const Scene& scene) {
    constexpr double kAllOneWay = 0.97, kLeastApart = 0.5;  // of their distance from the scene
    if (!(glm::length(ahead) > kAllOneWay) || keepLevel(cameras, ahead, up)) { return false; }
    std::vector<double> heights, distances;
    for (const FileCamera& camera : cameras) {
        heights.push_back(glm::dot(camera.eye.world_from_camera.position, up));
        distances.push_back(glm::dot(camera.eye.world_from_camera.position, ahead));
    }
    std::vector<double> depths;
    for (const SplatSample& sample : sampleSplats(scene, kMostForCameras)) {
        depths.push_back(glm::dot(sample.centre, ahead));
    }
    if (depths.empty()) { return false; }
    const auto [low, high] = std::ranges::minmax(heights);
    const double distance = findQuantile(depths, 0.5) - findQuantile(distances, 0.5);
    return distance > 0.0 && high - low >= kLeastApart * distance;
}

}  // namespace

SceneCameras readSceneCameras(const std::filesystem::path& scene, const glm::dvec3& origin) {
    SceneCameras own;
    own.file = findCameraFile(scene);
    if (own.file.empty()) { return own; }
    try {
        own.cameras = readCameraFile(own.file, origin);
    } catch (const Error& error) { own.trouble = error.what(); }  // the scene can be shown without it
    return own;
}

std::optional<CamerasUp> upOfCameras(const std::vector<FileCamera>& cameras, const Scene& scene) {
    if (cameras.empty()) { return std::nullopt; }
    glm::dvec3 up(0.0), ahead(0.0), place(0.0);
    for (const FileCamera& camera : cameras) {
        up += along(camera, {0.0, -1.0, 0.0}) / static_cast<double>(cameras.size());
        ahead += along(camera, {0.0, 0.0, 1.0}) / static_cast<double>(cameras.size());
        place += camera.eye.world_from_camera.position / static_cast<double>(cameras.size());
    }
    // A drone's cameras that look straight down have their up in every direction, or all along one course.
    if (!(glm::length(up) > 0.5)) {
        const auto floor = upBeneath(scene, place);
        return floor ? std::optional(CamerasUp{
                           *floor, "that of the floor beneath the cameras, which look in all directions"})
                     : std::nullopt;
    }
    up = glm::normalize(up);
    if (mayLookDown(cameras, ahead, up, scene)) {
        const auto floor = upBeneath(scene, place, up);
        if (floor && glm::dot(*floor, ahead) < -kAbout) {
            return CamerasUp{*floor, "that of the floor beneath the cameras, which all look straight down"};
        }
    }
    return CamerasUp{up, "the mean of all cameras'"};
}

View viewFrom(const Pose& world_from_camera, const std::optional<glm::dvec3>& up, const Scene& scene,
              double fov_x_deg) {
    const glm::dvec3 eye = world_from_camera.position,
                     ahead = world_from_camera.orientation * glm::dvec3(0.0, 0.0, 1.0),
                     own_up = world_from_camera.orientation * glm::dvec3(0.0, -1.0, 0.0);
    // For a view straight along the mean up, only the camera's own up is usable.
    const bool usable = up && std::abs(glm::dot(glm::normalize(*up), ahead)) < 0.99;
    std::vector<double> depths;
    for (const SplatSample& sample : sampleSplats(scene, kMostForCameras)) {
        if (const double depth = glm::dot(sample.centre - eye, ahead); depth > 0.0) {
            depths.push_back(depth);
        }
    }
    const double distance = depths.empty() ? 1.0 : std::max(findQuantile(depths, 0.5), 1e-6);
    return {eye, eye + distance * ahead, usable ? glm::normalize(*up) : own_up, fov_x_deg};
}

StartView startView(const Scene& scene, const StandpointWish& wish) {
    if (const std::optional<View> view = isBuiltin(scene.name) ? builtinView(scene.name) : std::nullopt) {
        return {*view, "at the built-in scene's own view", "the built-in scene's own"};
    }
    const SceneCameras own = scene.name.empty() ? SceneCameras{} : readSceneCameras(scene.name, scene.origin);
    if (const auto at_camera = viewAtCamera(scene, own, wish)) { return *at_camera; }
    const Standpoint judged = judgeStandpoint(scene, wish);
    std::string why = judged.why;
    if (!own.trouble.empty()) {
        why += "; not at a camera: " + own.trouble;
    } else if (!own.cameras.empty()) {
        why += fmt::format("; not at a camera: none of {} sees the scene", own.file.string());
    }
    return {judged.view, why, judged.up_why};
}

View startView(const Scene& scene, const CameraOptions& camera, double metres_per_unit) {
    const double fov_x_deg = camera.fov_x_deg.value_or(kUsualFovXDegrees);
    if (!camera.cameras_file.empty()) {
        const std::vector<FileCamera> given = readCameraFile(camera.cameras_file, scene.origin);
        requireView(camera, given);
        const auto up = upOfCameras(given, scene);
        return viewFrom(given[camera.view].eye.world_from_camera, up ? std::optional(up->up) : std::nullopt,
                        scene, fov_x_deg);
    }
    const auto inScene = [&](const std::optional<glm::dvec3>& place) {
        return place ? std::optional(*place - scene.origin) : place;
    };
    const std::optional<glm::dvec3> eye = inScene(camera.eye), look = inScene(camera.look);
    View view;
    if (eye && look && !isBuiltin(scene.name)) {
        view = {*eye, *look, hintsOf(scene).usual, fov_x_deg};
    } else {
        view = startView(scene, {fov_x_deg, metres_per_unit, camera.up}).view;
    }
    return {eye.value_or(view.eye), look.value_or(view.look), camera.up.value_or(view.up), view.fov_x_deg};
}

}  // namespace binosplat
