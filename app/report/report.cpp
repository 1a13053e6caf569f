// report.json of `render`.
#include "app/report/report.h"

#include "app/options/option_table.h"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace binosplat {

namespace {

using Json = nlohmann::ordered_json;

Json vectorJson(const glm::dvec3& vector) { return Json::array({vector.x, vector.y, vector.z}); }

Json eyeJson(const Eye& eye) {
    const glm::dquat& q = eye.world_from_camera.orientation;
    const Intrinsics& k = eye.intrinsics;
    return {{"position", vectorJson(eye.world_from_camera.position)},
            {"orientation_wxyz", Json::array({q.w, q.x, q.y, q.z})},
            {"fx", k.fx},
            {"fy", k.fy},
            {"cx", k.cx},
            {"cy", k.cy},
            {"width", eye.size_px.x},
            {"height", eye.size_px.y}};
}

Json valueJson(const OptionValue& value) {
    const auto convert = [](const auto& held) -> Json {
        using Held = std::remove_cvref_t<decltype(held)>;
        if constexpr (std::is_same_v<Held, std::monostate>) {
            return {};
        } else if constexpr (std::is_same_v<Held, glm::dvec3>) {
            return vectorJson(held);
        } else {
            return held;
        }
    };
    return std::visit(convert, value);
}

// Every option under its own name with the value that was used; null for one that did not apply.
Json optionsJson(const RenderOptions& options, const Cameras& cameras) {
    Json json{{"scene", options.scene},
              {"out", options.out.string()},
              {"config", options.run.config.empty() ? Json() : Json(options.run.config)}};
    for (const OptionRow<RunOptions>& row : runRows()) { json[row.text.key] = valueJson(row.field.value(options.run)); }
    // What the camera's options leave open comes from the scene, a headset or a camera file.
    json["eye"] = cameras.view ? vectorJson(cameras.view->eye) : Json();
    json["look"] = cameras.view ? vectorJson(cameras.view->look) : Json();
    json["up"] = cameras.view ? vectorJson(cameras.view->up) : Json();
    json["fov-x"] = cameras.view && cameras.view->fov_x_deg > 0.0 ? Json(cameras.view->fov_x_deg) : Json();
    json["size"] = fmt::format("{}x{}", cameras.middle.size_px.x, cameras.middle.size_px.y);
    json["view"] = options.run.camera.cameras_file.empty() ? Json() : Json(options.run.camera.view);
    json["ipd"] = cameras.eye_distance * options.run.metres_per_unit;
    return json;
}

}  // namespace

std::vector<std::pair<std::string, double>> addUp(const std::vector<std::pair<std::string, double>>& times) {
    std::vector<std::pair<std::string, double>> sums;
    for (const auto& [name, ms] : times) {
        const auto found = std::ranges::find(sums, name, &std::pair<std::string, double>::first);
        if (found == sums.end()) {
            sums.emplace_back(name, ms);
        } else {
            found->second += ms;
        }
    }
    return sums;
}

std::string reportJson(const FrameReport& report) {
    Json passes = Json::object(), counters = Json::object(), bytes = Json::object();
    for (const auto& [name, ms] : addUp(report.frame.gpu_ms)) { passes[name] = ms; }
    for (const auto& [name, count] : report.frame.counters) { counters[name] = count; }
    for (const auto& [name, count] : report.frame.stereo_bytes_per_pixel) { bytes[name] = count; }
    Json eyes = Json::object();
    if (report.options.run.stereo.mode == Mode::kMono) {
        eyes["mono"] = eyeJson(report.cameras.middle);
    } else {
        eyes["left"] = eyeJson(report.cameras.eyes[kLeft]);
        eyes["right"] = eyeJson(report.cameras.eyes[kRight]);
    }
    const Json root{{"device", report.device},
                    {"options", optionsJson(report.options, report.cameras)},
                    {"eyes", eyes},
                    {"gpu_ms", passes},
                    {"gpu_total_ms", report.frame.gpu_total_ms},
                    {"counters", counters},
                    {"stereo_bytes_per_pixel", bytes},
                    {"tiles_rendered", report.frame.tiles_rendered},
                    {"work_rendered", report.frame.work_rendered},
                    {"peak_gpu_bytes", report.frame.peak_gpu_bytes},
                    {"left_out", report.frame.left_out}};
    return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string reportTable(const FrameReport& report) {
    std::string table = fmt::format("{}, {}, {}x{} per eye, on {}\n", report.options.scene, nameOf(report.options.run.stereo.mode),
                                    report.cameras.middle.size_px.x, report.cameras.middle.size_px.y, report.device);
    const double percent = report.frame.gpu_total_ms > 0.0 ? 100.0 / report.frame.gpu_total_ms : 0.0;
    for (const auto& [name, ms] : addUp(report.frame.gpu_ms)) {
        table += fmt::format("  {:<28} {:>14.3f} ms {:>5.1f} %\n", name, ms, ms * percent);
    }
    table += fmt::format("  {:<28} {:>14.3f} ms\n", "total", report.frame.gpu_total_ms);
    for (const auto& [name, count] : report.frame.counters) { table += fmt::format("  {:<28} {:>14}\n", name, count); }
    if (!report.frame.stereo_bytes_per_pixel.empty()) {
        table += fmt::format("  {:<28} {:>14.1f} bytes\n", "moved for a pixel", report.frame.stereo_bytes_per_pixel.back().second);
        table += fmt::format("  {:<28} {:>14.1f} %, {:.1f} % of the work\n", "tiles rendered again", 100.0 * report.frame.tiles_rendered,
                             100.0 * report.frame.work_rendered);
    }
    table +=
        fmt::format("  {:<28} {:>14.1f} MiB\n", "peak GPU memory", static_cast<double>(report.frame.peak_gpu_bytes) / (1024.0 * 1024.0));
    return table;
}

}  // namespace binosplat
