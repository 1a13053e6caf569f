// What `bench` measured, as JSON and CSV.
#include "app/bench/bench_results.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

namespace binosplat {

namespace {

using Json = nlohmann::ordered_json;

Json timesJson(const NamedTimes& times) {
    Json json = Json::object();
    for (const auto& [name, ms] : times) { json[name] = json.contains(name) ? json[name].get<double>() + ms : ms; }
    return json;
}

// PSNR is null where the pictures are equal: JSON has no infinity.
Json qualityJson(const std::vector<OriginScores>& quality) {
    Json json = Json::object();
    for (const OriginScores& scores : quality) {
        Json one{{"pixels", scores.pixels}, {"mean_square", scores.mean_square}, {"psnr_db", scores.psnrDb()}};
        if (!std::isfinite(scores.psnrDb())) { one["psnr_db"] = nullptr; }
        if (scores.ssim) { one["ssim"] = *scores.ssim; }
        if (scores.flip) { one["flip"] = *scores.flip; }
        if (scores.lpips) { one["lpips"] = *scores.lpips; }
        json[scores.origin] = one;
    }
    return json;
}

Json resultJson(const BenchResult& result) {
    Json counters = Json::object();
    for (const auto& [name, count] : result.counters) { counters[name] = count; }
    Json json{{"series", result.series},
              {"scene", result.scene},
              {"view", result.view},
              {"headset", result.headset},
              {"splats", result.splats},
              {"backbone", result.backbone},
              {"width", result.size_px.x},
              {"height", result.size_px.y},
              {"method", result.method},
              {"mode", modeNameOf(result)},
              {"frames", result.frames},
              {"gpu_ms", timesJson(byLabel(result.pass_ms))},
              {"stage_ms", timesJson(stagesOf(result.mode, result.pass_ms))},
              {"gpu_total_ms", result.total_ms},
              {"gpu_total_least_ms", result.least_ms},
              {"gpu_total_most_ms", result.most_ms}};
    if (result.ratio_to_two_pass) { json["ratio_to_two_pass"] = *result.ratio_to_two_pass; }
    if (result.ratio_to_shared) { json["ratio_to_shared"] = *result.ratio_to_shared; }
    if (result.ratio_to_twin) { json["ratio_to_twin"] = *result.ratio_to_twin; }
    if (!result.quality.empty()) { json["affiliated_against_full"] = qualityJson(result.quality); }
    if (result.seen) {
        json["seen_by_the_eye"] = {
            {"mean_square", result.seen->mean_square}, {"psnr_db", result.seen->psnrDb()}, {"noticed", result.seen->noticed}};
        if (!std::isfinite(result.seen->psnrDb())) { json["seen_by_the_eye"]["psnr_db"] = nullptr; }
    }
    if (result.move_cost) { json["move_cost"] = *result.move_cost; }
    json["tiles_rendered"] = result.tiles_rendered;
    json["work_rendered"] = result.work_rendered;
    json["stereo_bytes_per_pixel"] = result.stereo_bytes_per_pixel;
    json["on_front"] = result.on_front;
    json["counters"] = counters;
    json["peak_gpu_bytes"] = result.peak_gpu_bytes;
    return json;
}

// A column of the CSV: its head, and its cell for a result.
struct Column {
    std::string head;
    std::function<std::string(const BenchResult&)> cell;
};

std::string number(const std::optional<double>& value) { return value ? fmt::format("{:.6g}", *value) : std::string(); }

std::string timeCell(const NamedTimes& times, const std::string& name) {
    const auto found = std::ranges::find(times, name, &std::pair<std::string, double>::first);
    return found == times.end() ? "" : fmt::format("{:.6g}", found->second);
}

std::vector<Column> fixedColumns(const BenchRun& run) {
    using R = const BenchResult&;
    return {{"device", [device = run.device](R) { return csvCell(device); }},
            {"series", [](R r) { return csvCell(r.series); }},
            {"scene", [](R r) { return csvCell(r.scene); }},
            {"view", [](R r) { return csvCell(r.view); }},
            {"headset", [](R r) { return csvCell(r.headset); }},
            {"splats", [](R r) { return fmt::format("{}", r.splats); }},
            {"backbone", [](R r) { return r.backbone; }},
            {"width", [](R r) { return fmt::format("{}", r.size_px.x); }},
            {"height", [](R r) { return fmt::format("{}", r.size_px.y); }},
            {"method", [](R r) { return csvCell(r.method); }},
            {"mode", [](R r) { return modeNameOf(r); }},
            {"frames", [](R r) { return fmt::format("{}", r.frames); }},
            {"gpu_total_ms", [](R r) { return number(r.total_ms); }},
            {"gpu_total_least_ms", [](R r) { return number(r.least_ms); }},
            {"gpu_total_most_ms", [](R r) { return number(r.most_ms); }},
            {"ratio_to_two_pass", [](R r) { return number(r.ratio_to_two_pass); }},
            {"ratio_to_shared", [](R r) { return number(r.ratio_to_shared); }},
            {"ratio_to_twin", [](R r) { return number(r.ratio_to_twin); }},
            {"move_cost", [](R r) { return number(r.move_cost); }},
            {"seen_psnr_db", [](R r) { return r.seen ? number(r.seen->psnrDb()) : ""; }},
            {"noticed", [](R r) { return r.seen ? number(r.seen->noticed) : ""; }},
            {"tiles_rendered", [](R r) { return number(r.tiles_rendered); }},
            {"work_rendered", [](R r) { return number(r.work_rendered); }},
            {"stereo_bytes_per_pixel", [](R r) { return number(r.stereo_bytes_per_pixel); }},
            {"peak_gpu_bytes", [](R r) { return fmt::format("{}", r.peak_gpu_bytes); }},
            {"on_front", [](R r) { return std::string(r.on_front ? "1" : "0"); }}};
}

// Passes and counters that any result has, in order of first appearance.
template <typename Entries>
std::vector<std::string> namesIn(const BenchRun& run, Entries&& entries) {
    std::vector<std::string> names;
    for (const BenchResult& result : run.results) {
        for (const auto& [name, value] : entries(result)) {
            if (std::ranges::find(names, name) == names.end()) { names.push_back(name); }
        }
    }
    return names;
}

std::vector<Column> allColumns(const BenchRun& run) {
    std::vector<Column> columns = fixedColumns(run);
    for (const std::string origin : kOrigins) {
        const auto add = [&](const char* what, auto&& of) {
            columns.push_back({origin + " " + what, [origin, of](const BenchResult& r) {
                                   const OriginScores* scores = scoresOf(r, origin);
                                   return scores == nullptr ? std::string() : number(of(*scores));
                               }});
        };
        add("pixels", [](const OriginScores& s) { return std::optional(static_cast<double>(s.pixels)); });
        add("psnr_db", [](const OriginScores& s) { return std::optional(s.psnrDb()); });
        add("ssim", [](const OriginScores& s) { return s.ssim; });
        add("flip", [](const OriginScores& s) { return s.flip; });
        if (origin == "all" && hasLpips(run.results)) {
            add("lpips", [](const OriginScores& s) { return s.lpips; });
        }
    }
    for (const std::string stage : kStages) {
        columns.push_back({stage + " ms", [stage](const BenchResult& r) { return timeCell(stagesOf(r.mode, r.pass_ms), stage); }});
    }
    for (const std::string& pass : namesIn(run, [](const BenchResult& r) { return byLabel(r.pass_ms); })) {
        columns.push_back({pass + " ms", [pass](const BenchResult& r) { return timeCell(byLabel(r.pass_ms), pass); }});
    }
    for (const std::string& counter : namesIn(
             run, [](const BenchResult& r) -> const auto& { return r.counters; })) {
        columns.push_back({counter, [counter](const BenchResult& r) {
                               return r.counters.contains(counter) ? fmt::format("{}", r.counters.at(counter)) : std::string();
                           }});
    }
    return columns;
}

}  // namespace

std::string benchJson(const BenchRun& run) {
    Json results = Json::array();
    for (const BenchResult& result : run.results) { results.push_back(resultJson(result)); }
    const Json root{{"device", run.device}, {"config", run.config}, {"results", results}};
    return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string benchCsv(const BenchRun& run) {
    const std::vector<Column> columns = allColumns(run);
    std::string csv;
    for (const Column& column : columns) { csv += fmt::format("{}{}", csv.empty() ? "" : ",", csvCell(column.head)); }
    csv += "\n";
    for (const BenchResult& result : run.results) {
        for (std::size_t i = 0; i < columns.size(); ++i) { csv += fmt::format("{}{}", i == 0 ? "" : ",", columns[i].cell(result)); }
        csv += "\n";
    }
    return csv;
}

}  // namespace binosplat
