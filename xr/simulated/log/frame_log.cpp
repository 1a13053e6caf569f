// The log of frames. nlohmann-json writes the shortest digits that read back as the same double.
#include "xr/simulated/log/frame_log.h"

#include "xr/simulated/system.h"

#include <nlohmann/json.hpp>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace simulated {

namespace {

// Keys stay in the order written here, the order of a reader's questions.
using Json = nlohmann::ordered_json;

Json jsonOf(const Pose& pose) {
    const glm::dvec3& p = pose.position;
    const glm::dquat& q = pose.orientation;
    return {{"position", {p.x, p.y, p.z}}, {"orientation", {q.x, q.y, q.z, q.w}}};
}

Json jsonOf(const Fov& fov) {
    return {{"left", fov.left_rad}, {"right", fov.right_rad}, {"up", fov.up_rad}, {"down", fov.down_rad}};
}

Json jsonOf(const LoggedView& view) {
    Json json;
    if (!view.name.empty()) { json["view"] = view.name; }
    json["swapchain"] = view.swapchain;
    json["image"] = view.image_index;
    json["array_layer"] = view.array_index;
    json["format"] = view.format;
    json["rect"] = {view.x, view.y, view.width, view.height};
    if (view.pose) { json["pose"] = jsonOf(*view.pose); }
    if (view.fov) { json["fov"] = jsonOf(*view.fov); }
    if (view.depth) {
        json["depth"] = {{"format", view.depth->format},
                         {"min", view.depth->min_depth},
                         {"max", view.depth->max_depth},
                         {"near", view.depth->near_z},
                         {"far", view.depth->far_z}};
    }
    return json;
}

Json jsonOf(const LoggedLayer& layer) {
    Json json{{"type", layer.type},
              {"flags", layer.flags},
              {"space", layer.space},
              {"stage_from_space", jsonOf(layer.stage_from_space)}};
    if (layer.pose) { json["pose"] = jsonOf(*layer.pose); }
    if (layer.size_m) { json["size"] = {layer.size_m->x, layer.size_m->y}; }
    for (const auto& [name, value] : layer.numbers) { json[name] = value; }
    if (!layer.eye_visibility.empty()) { json["eye_visibility"] = layer.eye_visibility; }
    json["views"] = Json::array();
    for (const LoggedView& view : layer.views) { json["views"].push_back(jsonOf(view)); }
    return json;
}

// Names may come from an application: bytes that are not UTF-8 are replaced instead of throwing.
std::string textOf(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace

std::string makeFrameLine(const FrameRecord& record) {
    Json json{{"frame", record.frame},
              {"display_time_ns", record.display_time_ns},
              {"period_ns", record.period_ns},
              {"should_render", record.should_render},
              {"session_state", record.session_state},
              {"blend_mode", record.blend_mode},
              {"head", jsonOf(record.stage_from_head)}};
    json["eyes"] = Json::array();
    for (const LoggedEye& eye : record.eyes) {
        Json& logged =
            json["eyes"].emplace_back(Json{{"pose", jsonOf(eye.stage_from_eye)}, {"fov", jsonOf(eye.fov)}});
        if (eye.inset) { logged["inset"] = jsonOf(*eye.inset); }
    }
    json["layers"] = Json::array();
    for (const LoggedLayer& layer : record.layers) { json["layers"].push_back(jsonOf(layer)); }
    json["events"] = record.events;
    if (record.gpu_ms) { json["gpu_ms"] = *record.gpu_ms; }
    if (!record.picture.empty()) { json["picture"] = record.picture; }
    return textOf(json);
}

std::string makeBetweenLine(const BetweenRecord& record) {
    Json json;
    if (!record.refused.empty()) { json = {{"refused", record.refused}, {"reason", record.reason}}; }
    json["session_state"] = record.session_state;
    json["display_time_ns"] = record.display_time_ns;
    if (!record.refused.empty()) { json["should_render"] = record.should_render; }
    json["events"] = record.events;
    return textOf(json);
}

FrameLog::FrameLog(const std::filesystem::path& path) : path_(path), file_(createFile(path), &std::fclose) {
    if (file_ == nullptr) {
        throw std::runtime_error(path_.string() + ": cannot be made (" + std::strerror(errno) + ")");
    }
}

void FrameLog::write(const std::string& line) {
    const std::string ended = line + '\n';
    const bool is_written = std::fwrite(ended.data(), 1, ended.size(), file_.get()) == ended.size() &&
                            std::fflush(file_.get()) == 0;
    if (!is_written) {
        throw std::runtime_error(path_.string() + ": cannot be written (" + std::strerror(errno) + ")");
    }
}

}  // namespace simulated
