// Stores viewpoints as JSON: eye, look and up of each, with its name.
#include "app/view/scenes/viewpoints.h"

#include "app/options/start_view.h"
#include "app/view/placement/placement.h"
#include "app/view/settings/view_files.h"
#include "engine/address.h"
#include "engine/builtin/procedural.h"
#include "engine/error.h"
#include "engine/files/json_node.h"
#include "engine/platform.h"
#include "engine/setup/output_files.h"
#include "engine/setup/text_file.h"

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <sstream>
#include <utility>

namespace binosplat {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostKept = 1000;
constexpr const char* kExtension = ".viewpoints.json";
constexpr std::array kPoints{std::pair("eye", &View::eye), std::pair("look", &View::look),
                             std::pair("up", &View::up)};

fs::path keptFile(const std::string& source) { return viewFileStem(source).string() + kExtension; }
// A line of nine numbers for each, as earlier versions wrote it.
fs::path oldFile(const std::string& source) { return viewFileStem(source).string() + ".viewpoints.txt"; }

bool isView(const View& view) {
    const glm::dvec3 ahead = view.look - view.eye;
    const double length = glm::length(ahead) * glm::length(view.up);
    return std::isfinite(length) && length > 0.0 && glm::length(glm::cross(ahead, view.up)) > 1e-6 * length;
}

// Lines that are not a view are skipped.
std::vector<Viewpoint> readOld(const fs::path& file) {
    std::vector<Viewpoint> kept;
    std::istringstream lines(readTextFile(file, "a list of viewpoints"));
    for (std::string line; std::getline(lines, line) && kept.size() < kMostKept;) {
        std::istringstream numbers(line);
        View view{};
        for (const auto& [name, point] : kPoints) {
            numbers >> (view.*point).x >> (view.*point).y >> (view.*point).z;
        }
        if (numbers && isView(view)) {
            kept.push_back({fmt::format("your own {}", kept.size() + 1), view, true});
        }
    }
    return kept;
}

glm::dvec3 pointIn(const JsonNode& node) {
    node.requireArray(3);
    glm::dvec3 point(0.0);
    for (int i = 0; i < 3; ++i) {
        const JsonNode number = node.at(static_cast<std::size_t>(i));
        static_cast<void>(number.number());  // checks it
        point[i] = number.value.get<double>();
    }
    return point;
}

}  // namespace

std::vector<Viewpoint> readViewpoints(const fs::path& file) {
    const std::string text = readTextFile(file, "a list of viewpoints (JSON)"), name = file.string();
    const nlohmann::json document = parseJson(std::as_bytes(std::span(text)), name, "a list of viewpoints");
    const JsonNode list = JsonNode{document, name}.at("viewpoints");
    std::vector<Viewpoint> viewpoints;
    const std::size_t count = list.arraySize();
    check(count <= kMostKept, "{}: {} viewpoints, must be at most {}", name, count, kMostKept);
    for (std::size_t i = 0; i < count; ++i) {
        const JsonNode node = list.at(i);
        Viewpoint viewpoint{node.at("name").text(), {{}, {}, {}, 60.0}, true};
        for (const auto& [key, point] : kPoints) { viewpoint.view.*point = pointIn(node.at(key)); }
        check(isView(viewpoint.view),
              "{}: looks nowhere, must have a place to look at that is not the eye's, nor straight up",
              node.place());
        viewpoints.push_back(std::move(viewpoint));
    }
    return viewpoints;
}

void writeViewpoints(const fs::path& file, const std::vector<Viewpoint>& viewpoints) {
    check(viewpoints.size() <= kMostKept, "{}: {} viewpoints, which are more than {}", file.string(),
          viewpoints.size(), kMostKept);
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Viewpoint& viewpoint : viewpoints) {
        nlohmann::ordered_json entry{{"name", viewpoint.name}};
        for (const auto& [key, point] : kPoints) {
            const glm::dvec3& at = viewpoint.view.*point;
            entry[key] = {at.x, at.y, at.z};
        }
        list.push_back(std::move(entry));
    }
    // Names come from outside, so anything that is not UTF-8 is replaced.
    const nlohmann::ordered_json document{{"viewpoints", list}};
    OutputFiles files(file.parent_path());
    writeText(files.staging() / file.filename(),
              document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    files.publish();
}

fs::path sharedViewpoints(const std::string& source) {
    if (isBuiltin(source) || isAddress(source)) {
        const fs::path folder = userPicturesFolder();
        check(!folder.empty(), "{}: viewpoints cannot be shared, since HOME is not set", source);
        const std::string name = source.substr(source.find_last_of("/:") + 1);
        return folder / (fs::path(name).stem().string() + kExtension);
    }
    std::error_code ignored;
    fs::path place = fs::absolute(source, ignored).lexically_normal();
    if (!place.has_filename()) { place = place.parent_path(); }
    return place.parent_path() /
           ((fs::is_directory(place, ignored) ? place.filename() : place.stem()).string() + kExtension);
}

std::vector<Viewpoint> keptViewpoints(const std::string& source) {
    const auto read = [&](const auto& find) -> std::optional<std::vector<Viewpoint>> {
        try {
            return find();
        } catch (const Error&) { return std::nullopt; }  // none, or unreadable: will be replaced
    };
    if (const auto kept = read([&] { return readViewpoints(keptFile(source)); })) { return *kept; }
    if (const auto old = read([&] { return readOld(oldFile(source)); })) { return *old; }
    const bool is_on_disk = !isBuiltin(source) && !isAddress(source);
    if (!is_on_disk) { return {}; }
    return read([&] { return readViewpoints(sharedViewpoints(source)); }).value_or(std::vector<Viewpoint>());
}

void keepViewpoints(const std::string& source, const std::vector<Viewpoint>& own) {
    writeViewpoints(keptFile(source), own);
    std::error_code ignored;
    fs::remove(oldFile(source), ignored);  // they are in the new file
}

std::vector<Viewpoint> findViewpoints(const Scene& scene, const std::string& source,
                                      const fs::path& camera_file) {
    std::vector<FileCamera> cameras;
    try {
        cameras = camera_file.empty() ? readSceneCameras(source, scene.origin).cameras
                                      : readCameraFile(camera_file, scene.origin);
    } catch (const Error&) {}  // the file was read before, but is gone
    const std::optional<CamerasUp> found = upOfCameras(cameras, scene);
    std::vector<Viewpoint> viewpoints;
    for (const FileCamera& camera : cameras) {
        const Pose& pose = camera.eye.world_from_camera;
        const glm::dvec3 ahead = pose.orientation * glm::dvec3(0.0, 0.0, 1.0),
                         own_up = pose.orientation * glm::dvec3(0.0, -1.0, 0.0);
        View view{pose.position, pose.position + ahead, found ? found->up : own_up, 60.0};
        if (!isView(view)) { view.up = own_up; }
        viewpoints.push_back({camera.name, view});
    }
    for (Viewpoint& own : keptViewpoints(source)) {
        own.view.eye -= scene.origin, own.view.look -= scene.origin;
        viewpoints.push_back(std::move(own));
    }
    return viewpoints;
}

Similarity placedAt(const View& view, const Similarity& scene_from_room, const Pose& room_from_head) {
    // Upright, looking that way, and turned back by the head's heading in the room.
    const glm::dquat head_turn =
        lookAt(glm::dvec3(0.0), levelAhead(room_from_head), {0.0, -1.0, 0.0}).orientation;
    const glm::dquat upright = startPlacement(view, 1.0).orientation;
    Similarity placed{glm::normalize(upright * glm::conjugate(head_turn)), glm::dvec3(0.0),
                      scene_from_room.scale};
    placed.position = view.eye - transform(placed, room_from_head.position);
    return placed;
}

View viewOf(const Similarity& scene_from_room, const Pose& room_from_head) {
    const Pose eye = transform(scene_from_room, room_from_head);
    return {eye.position,
            eye.position + scene_from_room.scale * (eye.orientation * glm::dvec3(0.0, 0.0, 1.0)),
            scene_from_room.orientation * glm::dvec3(0.0, -1.0, 0.0), 60.0};
}

}  // namespace binosplat
