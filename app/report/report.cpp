// report.json of `render`.
#include "app/report/report.h"

#include "app/options/option_table.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace binosplat {

namespace {

using Json = nlohmann::ordered_json;

Json vectorJson(const glm::dvec3& vector) { return Json::array({vector.x, vector.y, vector.z}); }

// In the file's coordinates.
Json eyeJson(const Eye& eye, const glm::dvec3& origin) {
    const glm::dquat& q = eye.world_from_camera.orientation;
    const Intrinsics& k = eye.intrinsics;
    return {{"position", vectorJson(eye.world_from_camera.position + origin)},
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

// Every option under its own name with the value that was used; null for options that did not apply.
Json optionsJson(const RenderOptions& options, const Cameras& cameras) {
    Json json{{"scene", options.scene},
              {"config", options.run.config.empty() ? Json() : Json(options.run.config)}};
    for (const OptionRow<RenderOptions>& row : renderRows()) {
        json[row.text.key] = valueJson(row.field.value(options));
    }
    if (options.path.empty()) { json["path-axes"] = Json(); }
    for (const OptionRow<RunOptions>& row : runRows()) {
        json[row.text.key] = valueJson(row.field.value(options.run));
    }
    // Missing camera options come from the scene, a headset or a camera file.
    json["eye"] = cameras.view ? vectorJson(cameras.view->eye) : Json();
    json["look"] = cameras.view ? vectorJson(cameras.view->look) : Json();
    json["up"] = cameras.view ? vectorJson(cameras.view->up) : Json();
    json["fov-x"] = cameras.view && cameras.view->fov_x_deg > 0.0 ? Json(cameras.view->fov_x_deg) : Json();
    json["near"] = cameras.near;
    json["size"] = fmt::format("{}x{}", cameras.middle.size_px.x, cameras.middle.size_px.y);
    json["view"] = options.run.camera.cameras_file.empty() ? Json() : Json(options.run.camera.view);
    json["ipd"] = cameras.eye_distance * options.run.metres_per_unit;
    return json;
}

Json eyesJson(const Cameras& cameras, bool mono) {
    if (mono) { return {{"mono", eyeJson(cameras.middle, cameras.origin)}}; }
    return {{"left", eyeJson(cameras.eyes[kLeft], cameras.origin)},
            {"right", eyeJson(cameras.eyes[kRight], cameras.origin)}};
}

// `json`, with a frame's costs added.
Json withCosts(Json json, const FrameResult& frame) {
    Json passes = Json::object(), counters = Json::object(), bytes = Json::object();
    for (const auto& [label, ms] : addUp(frame.gpu_ms)) { passes[label.text()] = ms; }
    for (const auto& [name, count] : frame.counters.named()) { counters[name] = count; }
    for (const auto& [name, count] : frame.stereo_bytes_per_pixel) { bytes[name] = count; }
    json["gpu_ms"] = passes;
    json["gpu_total_ms"] = frame.gpu_total_ms;
    json["counters"] = counters;
    json["stereo_bytes_per_pixel"] = bytes;
    json["tiles_rendered"] = frame.tiles_rendered;
    json["work_rendered"] = frame.work_rendered;
    return json;
}

std::string printed(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::vector<double> sortedTotals(const PathReport& report) {
    std::vector<double> totals;
    for (const PathFrame& frame : report.frames) { totals.push_back(frame.frame.gpu_total_ms); }
    std::ranges::sort(totals);
    return totals;
}

// How many splats of a streamed scene were drawn; empty for others.
std::string streamedLine(const PathReport& report) {
    const auto of = [](const PathFrame& frame) { return frame.frame.counters.splats_read; };
    if (!report.frames.front().frame.counters.streaming) { return {}; }
    const auto [least, most] = std::ranges::minmax(report.frames, {}, of);
    const std::uint64_t budget = report.options.run.load.splat_budget;
    return fmt::format("  {} to {} splats drawn in a frame{}\n", of(least), of(most),
                       budget > 0 ? fmt::format(", of a budget of {}", budget) : std::string());
}

}  // namespace

PassTimes addUp(const PassTimes& times) {
    PassTimes sums;
    for (const PassTime& time : times) {
        const auto found = std::ranges::find(sums, time.label, &PassTime::label);
        (found == sums.end() ? sums.emplace_back(PassTime{time.label}) : *found).ms += time.ms;
    }
    return sums;
}

std::string reportJson(const FrameReport& report) {
    const bool mono = report.options.run.stereo.mode == Mode::kMono;
    Json root = withCosts({{"device", report.device},
                           {"options", optionsJson(report.options, report.cameras)},
                           {"eyes", eyesJson(report.cameras, mono)}},
                          report.frame);
    root["peak_gpu_bytes"] = report.frame.peak_gpu_bytes;
    root["left_out"] = report.frame.left_out;
    return printed(root);
}

std::string reportJson(const PathReport& report) {
    const bool mono = report.options.run.stereo.mode == Mode::kMono;
    Json frames = Json::array();
    std::uint64_t peak_bytes = 0;
    for (const PathFrame& frame : report.frames) {
        frames.push_back(
            withCosts({{"time_s", frame.time_s}, {"eyes", eyesJson(frame.cameras, mono)}}, frame.frame));
        peak_bytes = std::max(peak_bytes, frame.frame.peak_gpu_bytes);
    }
    const std::vector<double> totals = sortedTotals(report);
    return printed({{"device", report.device},
                    {"options", optionsJson(report.options, report.start)},
                    {"median_gpu_total_ms", totals[totals.size() / 2]},
                    {"most_gpu_total_ms", totals.back()},
                    {"peak_gpu_bytes", peak_bytes},
                    {"frames", frames}});
}

std::string reportTable(const PathReport& report) {
    const std::vector<double> totals = sortedTotals(report);
    return fmt::format(
               "{}, {}, {}x{} per eye, on {}\n  {} frames along {}, median {:.3f} ms, longest {:.3f} ms\n",
               report.options.scene, nameOf(report.options.run.stereo.mode), report.start.middle.size_px.x,
               report.start.middle.size_px.y, report.device, totals.size(), report.options.path,
               totals[totals.size() / 2], totals.back()) +
           streamedLine(report);
}

std::string reportTable(const FrameReport& report) {
    std::string table = fmt::format("{}, {}, {}x{} per eye, on {}\n", report.options.scene,
                                    nameOf(report.options.run.stereo.mode), report.cameras.middle.size_px.x,
                                    report.cameras.middle.size_px.y, report.device);
    const double percent = report.frame.gpu_total_ms > 0.0 ? 100.0 / report.frame.gpu_total_ms : 0.0;
    for (const auto& [label, ms] : addUp(report.frame.gpu_ms)) {
        table += fmt::format("  {:<28} {:>14.3f} ms {:>5.1f} %\n", label.text(), ms, ms * percent);
    }
    table += fmt::format("  {:<28} {:>14.3f} ms\n", "total", report.frame.gpu_total_ms);
    for (const auto& [name, count] : report.frame.counters.named()) {
        table += fmt::format("  {:<28} {:>14}\n", name, count);
    }
    if (!report.frame.stereo_bytes_per_pixel.empty()) {
        table += fmt::format("  {:<28} {:>14.1f} bytes\n", "memory traffic per pixel",
                             report.frame.stereo_bytes_per_pixel.back().second);
        table += fmt::format("  {:<28} {:>14.1f} %, {:.1f} % of the work\n", "tiles rendered again",
                             100.0 * report.frame.tiles_rendered, 100.0 * report.frame.work_rendered);
    }
    table += fmt::format("  {:<28} {:>14.1f} MiB\n", "peak GPU memory",
                         static_cast<double>(report.frame.peak_gpu_bytes) / (1024.0 * 1024.0));
    return table;
}

}  // namespace binosplat
