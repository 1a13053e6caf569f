// Start views from cameras or, failing that, from the splats.
#include "app/options/start_view.h"

#include "app/options/camera_options.h"
#include "engine/error.h"
#include "engine/scene/floor_choice.h"
#include "engine/scene/scene_folder.h"

#include <algorithm>
#include <cmath>

namespace binosplat {

namespace {

constexpr double kUsualFovXDegrees = 60.0;
// A camera that sees a smaller share of the splats belongs to another scene.
constexpr double kLeastSeen = 0.02;
constexpr std::size_t kMostForCameras = 4096;

std::optional<std::size_t> firstThatSees(const std::vector<FileCamera>& cameras, const Scene& scene) {
    const std::vector<SplatSample> samples = sampleSplats(scene, kMostForCameras);
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        const Eye& eye = cameras[i].eye;
        const Pose camera_from_world = inverse(eye.world_from_camera);
        const auto seen = std::ranges::count_if(
            samples, [&](const SplatSample& sample) { return isInPicture(eye, transform(camera_from_world, sample.centre)); });
        if (seen > 0 && static_cast<double>(seen) >= kLeastSeen * static_cast<double>(samples.size())) { return i; }
    }
    return std::nullopt;
}

std::optional<StartView> viewAtCamera(const Scene& scene, const SceneCameras& own, const StandpointWish& wish) {
    const std::optional<std::size_t> first = firstThatSees(own.cameras, scene);
    if (!first) { return std::nullopt; }
    const FileCamera& camera = own.cameras[*first];
    const std::string at = fmt::format("at camera {} ({}) of {}", *first, camera.name, own.file.string());
    const auto with = [&](const std::optional<glm::dvec3>& up, const char* up_why) {
        return StartView{viewFrom(camera.eye.world_from_camera, up, scene, wish.fov_x_deg), at, up_why};
    };
    if (wish.up) { return with(wish.up, "given"); }
    if (const auto up = upOfCameras(own.cameras)) { return with(up, "the mean of all cameras'"); }
    // Those of a drone that look straight down have theirs in every direction.
    glm::dvec3 sum(0.0);
    for (const FileCamera& each : own.cameras) { sum += each.eye.world_from_camera.position; }
    if (const auto up = upBeneath(scene, sum / static_cast<double>(own.cameras.size()))) {
        return with(up, "of the floor beneath the cameras, as they look every way");
    }
    return with({}, "this camera's, as they look every way");
}

}  // namespace

SceneCameras readSceneCameras(const std::filesystem::path& scene) {
    SceneCameras own;
    own.file = findCameraFile(scene);
    if (own.file.empty()) { return own; }
    try {
        own.cameras = readCameraFile(own.file);
    } catch (const Error& error) { own.trouble = error.what(); }  // the scene can be shown without it
    return own;
}

std::optional<glm::dvec3> upOfCameras(const std::vector<FileCamera>& cameras) {
    glm::dvec3 sum(0.0);
    for (const FileCamera& camera : cameras) { sum += camera.eye.world_from_camera.orientation * glm::dvec3(0.0, -1.0, 0.0); }
    if (!(glm::length(sum) > 0.5 * static_cast<double>(cameras.size()))) { return std::nullopt; }
    return glm::normalize(sum);
}

View viewFrom(const Pose& world_from_camera, const std::optional<glm::dvec3>& up, const Scene& scene, double fov_x_deg) {
    const glm::dvec3 eye = world_from_camera.position, ahead = world_from_camera.orientation * glm::dvec3(0.0, 0.0, 1.0),
                     own_up = world_from_camera.orientation * glm::dvec3(0.0, -1.0, 0.0);
    // For a view straight along the mean up, only the camera's own up is usable.
    const bool usable = up && std::abs(glm::dot(glm::normalize(*up), ahead)) < 0.99;
    std::vector<double> depths;
    for (const SplatSample& sample : sampleSplats(scene, kMostForCameras)) {
        if (const double depth = glm::dot(sample.centre - eye, ahead); depth > 0.0) { depths.push_back(depth); }
    }
    const double distance = depths.empty() ? 1.0 : std::max(findQuantile(depths, 0.5), 1e-6);
    return {eye, eye + distance * ahead, usable ? glm::normalize(*up) : own_up, fov_x_deg};
}

StartView startView(const Scene& scene, const StandpointWish& wish) {
    if (const std::optional<View> view = isBuiltin(scene.name) ? builtinView(scene.name) : std::nullopt) {
        return {*view, "at the built-in scene's own view", "the built-in scene's own"};
    }
    const SceneCameras own = scene.name.empty() ? SceneCameras{} : readSceneCameras(scene.name);
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
        const FileCamera given = *readCameraFiles(camera).camera;
        return viewFrom(given.eye.world_from_camera, upOfCameras(readCameraFile(camera.cameras_file)), scene, fov_x_deg);
    }
    View view;
    if (camera.eye && camera.look && !isBuiltin(scene.name)) {
        view = {*camera.eye, *camera.look, hintsOf(scene).usual, fov_x_deg};
    } else {
        view = startView(scene, {fov_x_deg, metres_per_unit, camera.up}).view;
    }
    return {camera.eye.value_or(view.eye), camera.look.value_or(view.look), camera.up.value_or(view.up), view.fov_x_deg};
}

}  // namespace binosplat
