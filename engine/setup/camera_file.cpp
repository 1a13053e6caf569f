// cameras.json as 3DGS or 2DGS training leaves it; errors in entries name the camera and the key.
#include "engine/setup/camera_file.h"

#include "engine/error.h"
#include "engine/setup/text_file.h"
#include "engine/setup/values.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace binosplat {

namespace {

using Json = nlohmann::json;

// The current place in the file, for messages.
struct Place {
    std::string file;
    std::size_t camera;
};

std::string describe(const Place& place) { return fmt::format("{}: camera {}", place.file, place.camera); }

const Json& member(const Place& place, const Json& camera, const char* key) {
    const auto found = camera.find(key);
    check(found != camera.end(), "{}: {} is missing, must be given", describe(place), key);
    return *found;
}

double number(const Place& place, const Json& value, const std::string& key) {
    check(value.is_number() && std::isfinite(value.get<double>()), "{}: {} is {}, must be a finite number",
          describe(place), key, value.dump());
    return value.get<double>();
}

double focal(const Place& place, const Json& camera, const char* key) {
    const double value = number(place, member(place, camera, key), key);
    check(value > 0.0, "{}: {} is {}, must be greater than 0", describe(place), key, value);
    return value;
}

std::uint32_t side(const Place& place, const Json& camera, const char* key) {
    const double value = number(place, member(place, camera, key), key);
    check(value >= 1.0 && value <= kMaxSide && value == std::floor(value),
          "{}: {} is {}, must be a whole number from 1 to {}", describe(place), key, value, kMaxSide);
    return static_cast<std::uint32_t>(value);
}

glm::dvec3 vector(const Place& place, const Json& value, const std::string& key) {
    check(value.is_array() && value.size() == 3, "{}: {} is {}, must be an array of 3 numbers",
          describe(place), key, value.dump());
    return {number(place, value[0], key), number(place, value[1], key), number(place, value[2], key)};
}

glm::dquat orientation(const Place& place, const Json& camera) {
    const Json& rows = member(place, camera, "rotation");
    check(rows.is_array() && rows.size() == 3, "{}: rotation is {}, must be 3 rows of 3 numbers",
          describe(place), rows.dump());
    glm::dmat3 world_from_camera(0.0);
    for (int row = 0; row < 3; ++row) {
        const glm::dvec3 values =
            vector(place, rows[static_cast<std::size_t>(row)], fmt::format("rotation[{}]", row));
        for (int column = 0; column < 3; ++column) { world_from_camera[column][row] = values[column]; }
    }
    // Files keep six digits or more; 1e-3 tells a rotation from a matrix with scale, shear or reflection.
    const glm::dmat3 deviation = glm::transpose(world_from_camera) * world_from_camera - glm::dmat3(1.0);
    double largest = 0.0;
    for (int i = 0; i < 9; ++i) { largest = std::max(largest, std::abs(deviation[i / 3][i % 3])); }
    check(largest < 1e-3 && glm::determinant(world_from_camera) > 0.0,
          "{}: rotation is {}, must be a rotation (orthonormal rows, determinant +1)", describe(place),
          rows.dump());
    return glm::normalize(glm::quat_cast(world_from_camera));
}

FileCamera readCamera(const Place& place, const Json& camera) {
    check(camera.is_object(), "{} is {}, must be an object", describe(place), camera.dump().substr(0, 40));
    FileCamera result;
    result.name = camera.contains("img_name") && camera["img_name"].is_string()
                      ? camera["img_name"].get<std::string>()
                      : fmt::format("{}", place.camera);
    result.eye.size_px = {side(place, camera, "width"), side(place, camera, "height")};
    result.eye.world_from_camera = {orientation(place, camera),
                                    vector(place, member(place, camera, "position"), "position")};
    Intrinsics& intrinsics = result.eye.intrinsics;
    intrinsics.fx = focal(place, camera, "fx");
    intrinsics.fy = focal(place, camera, "fy");
    intrinsics.cx = camera.contains("cx") ? number(place, camera["cx"], "cx") : 0.5 * result.eye.size_px.x;
    intrinsics.cy = camera.contains("cy") ? number(place, camera["cy"], "cy") : 0.5 * result.eye.size_px.y;
    return result;
}

}  // namespace

std::vector<FileCamera> readCameraFile(const std::filesystem::path& path, const glm::dvec3& origin) {
    const std::string file = path.string();
    const std::string text = readTextFile(path, "a cameras.json", kMostRecordingBytes);
    Json root;
    try {
        // Cameras are four levels deep; anything much deeper cannot even be quoted in a message.
        root = Json::parse(text, [&](int depth, Json::parse_event_t, const Json&) {
            check(depth < 64, "{}: nested {} levels deep, must be an array of cameras", file, depth);
            return true;
        });
    } catch (const Json::parse_error& error) {
        fail("{}: byte {}: not valid JSON, must be an array of cameras", file, error.byte);
    } catch (const Json::exception& error) {
        fail("{}: {}, must be an array of cameras", file, error.what());
    }
    check(root.is_array() && !root.empty(),
          "{}: holds no cameras, must be a JSON array of at least one camera", file);
    std::vector<FileCamera> cameras;
    for (std::size_t i = 0; i < root.size(); ++i) {
        cameras.push_back(readCamera({file, i}, root[i]));
        cameras.back().eye.world_from_camera.position -= origin;
    }
    return cameras;
}

Eye resize(const Eye& eye, glm::uvec2 size_px) {
    const double x = static_cast<double>(size_px.x) / eye.size_px.x,
                 y = static_cast<double>(size_px.y) / eye.size_px.y;
    const Intrinsics& k = eye.intrinsics;
    return {eye.world_from_camera, {k.fx * x, k.fy * y, k.cx * x, k.cy * y}, size_px};
}

}  // namespace binosplat
