// A line of nine numbers for each that was kept: eye, look, up.
#include "app/view/scenes/viewpoints.h"

#include "app/options/start_view.h"
#include "app/view/placement/placement.h"
#include "app/view/settings/view_files.h"
#include "engine/error.h"
#include "engine/setup/output_files.h"
#include "engine/setup/text_file.h"

#include <cmath>
#include <sstream>

namespace binosplat {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostKept = 1000;

fs::path keptFile(const std::string& source) { return viewFileStem(source).string() + ".viewpoints.txt"; }

bool isView(const View& view) {
    const glm::dvec3 ahead = view.look - view.eye;
    const double length = glm::length(ahead) * glm::length(view.up);
    return std::isfinite(length) && length > 0.0 && glm::length(glm::cross(ahead, view.up)) > 1e-6 * length;
}

}  // namespace

std::vector<View> keptViews(const std::string& source) {
    std::vector<View> kept;
    try {
        std::istringstream lines(readTextFile(keptFile(source), "a list of viewpoints"));
        for (std::string line; std::getline(lines, line) && kept.size() < kMostKept;) {
            std::istringstream numbers(line);
            View view{};
            for (glm::dvec3* const point : {&view.eye, &view.look, &view.up}) { numbers >> point->x >> point->y >> point->z; }
            if (numbers && isView(view)) { kept.push_back(view); }
        }
    } catch (const Error&) {}  // no list, or an unreadable one, which the next viewpoint replaces
    return kept;
}

Viewpoint ownViewpoint(std::size_t number, const View& view) { return {fmt::format("your own {}", number), view}; }

std::vector<Viewpoint> findViewpoints(const Scene& scene, const std::string& source, const fs::path& camera_file) {
    std::vector<FileCamera> cameras;
    try {
        cameras = camera_file.empty() ? readSceneCameras(source, scene.origin).cameras : readCameraFile(camera_file, scene.origin);
    } catch (const Error&) {}  // the file was read before, but is gone
    const std::optional<CamerasUp> found = upOfCameras(cameras, scene);
    std::vector<Viewpoint> viewpoints;
    for (const FileCamera& camera : cameras) {
        const Pose& pose = camera.eye.world_from_camera;
        const glm::dvec3 ahead = pose.orientation * glm::dvec3(0.0, 0.0, 1.0), own_up = pose.orientation * glm::dvec3(0.0, -1.0, 0.0);
        View view{pose.position, pose.position + ahead, found ? found->up : own_up, 60.0};
        if (!isView(view)) { view.up = own_up; }
        viewpoints.push_back({camera.name, view});
    }
    std::size_t number = 0;
    for (View view : keptViews(source)) {
        view.eye -= scene.origin, view.look -= scene.origin;
        viewpoints.push_back(ownViewpoint(++number, view));
    }
    return viewpoints;
}

void keepViewpoint(const std::string& source, const View& view) {
    std::vector<View> kept = keptViews(source);
    check(kept.size() < kMostKept, "{}: {} viewpoints are kept, and there can be no more", source, kMostKept);
    kept.push_back(view);
    std::string text;
    for (const auto& [eye, look, up, fov] : kept) {
        text += fmt::format("{} {} {}  {} {} {}  {} {} {}\n", eye.x, eye.y, eye.z, look.x, look.y, look.z, up.x, up.y, up.z);
    }
    const fs::path file = keptFile(source);
    OutputFiles files(file.parent_path());
    writeText(files.staging() / file.filename(), text);
    files.publish();
}

Similarity placedAt(const View& view, const Similarity& scene_from_room, const Pose& room_from_head) {
    // Upright, looking that way, and turned back by the head's heading in the room.
    const glm::dquat head_turn = lookAt(glm::dvec3(0.0), levelAhead(room_from_head), {0.0, -1.0, 0.0}).orientation;
    const glm::dquat upright = startPlacement(view, 1.0).orientation;
    Similarity placed{glm::normalize(upright * glm::conjugate(head_turn)), glm::dvec3(0.0), scene_from_room.scale};
    placed.position = view.eye - transform(placed, room_from_head.position);
    return placed;
}

View viewOf(const Similarity& scene_from_room, const Pose& room_from_head) {
    const Pose eye = transform(scene_from_room, room_from_head);
    return {eye.position, eye.position + scene_from_room.scale * (eye.orientation * glm::dvec3(0.0, 0.0, 1.0)),
            scene_from_room.orientation * glm::dvec3(0.0, -1.0, 0.0), 60.0};
}

}  // namespace binosplat
