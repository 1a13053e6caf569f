// The results of `bench` as JSON and CSV.
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
    for (const auto& [name, ms] : times) {
        json[name] = json.contains(name) ? json[name].get<double>() + ms : ms;
    }
    return json;
}

// PSNR is null if the pictures are equal: JSON has no infinity.
Json numberOrNull(const std::optional<double>& value) {
    return value && std::isfinite(*value) ? Json(*value) : Json();
}

Json qualityJson(const std::vector<OriginScores>& quality) {
    Json json = Json::object();
    for (const OriginScores& scores : quality) {
        Json one{{"pixels", scores.pixels},
                 {"mean_square", scores.mean_square},
                 {"psnr_db", numberOrNull(scores.psnrDb())}};
        if (scores.ssim) { one["ssim"] = *scores.ssim; }
        if (scores.flip) { one["flip"] = *scores.flip; }
        if (scores.lpips) { one["lpips"] = *scores.lpips; }
        json[scores.origin] = one;
    }
    return json;
}

// The fields of both files; null if a result lacks them.
Json fieldsOf(const BenchResult& r) {
    return {{"series", r.series},
            {"scene", r.scene},
            {"view", r.view},
            {"headset", r.headset},
            {"splats", r.splats},
            {"backbone", r.backbone},
            {"width", r.size_px.x},
            {"height", r.size_px.y},
            {"method", r.method},
            {"mode", modeNameOf(r)},
            {"resolution", r.resolution},
            {"frames", r.frames},
            {"gpu_total_ms", r.total_ms},
            {"gpu_total_least_ms", r.least_ms},
            {"gpu_total_most_ms", r.most_ms},
            {"ratio_to_two_pass", numberOrNull(r.ratio_to_two_pass)},
            {"ratio_to_shared", numberOrNull(r.ratio_to_shared)},
            {"ratio_to_twin", numberOrNull(r.ratio_to_twin)},
            {"move_cost", numberOrNull(r.move_cost)},
            {"seen_psnr_db", r.seen ? numberOrNull(r.seen->psnrDb()) : Json()},
            {"noticed", r.seen ? Json(r.seen->noticed) : Json()},
            {"tiles_rendered", r.tiles_rendered},
            {"work_rendered", r.work_rendered},
            {"stereo_bytes_per_pixel", r.stereo_bytes_per_pixel},
            {"peak_gpu_bytes", r.peak_gpu_bytes},
            {"on_front", r.on_front}};
}

Json resultJson(const BenchResult& result) {
    Json json = Json::object();
    const Json fields = fieldsOf(result);
    for (const auto& [name, value] : fields.items()) {
        if (!value.is_null()) { json[name] = value; }
    }
    json["gpu_ms"] = timesJson(byLabel(result.pass_ms));
    json["stage_ms"] = timesJson(stagesOf(result.mode, result.pass_ms));
    if (!result.quality.empty()) { json["affiliated_against_full"] = qualityJson(result.quality); }
    json["counters"] = result.counters;
    return json;
}

// A column of the CSV: its head, and its cell for a result.
struct Column {
    std::string head;
    std::function<std::string(const BenchResult&)> cell;
};

std::string number(const std::optional<double>& value) {
    return value ? fmt::format("{:.6g}", *value) : std::string();
}

std::string cellOf(const Json& value) {
    if (value.is_null()) { return {}; }
    if (value.is_string()) { return csvCell(value.get<std::string>()); }
    if (value.is_boolean()) { return value.get<bool>() ? "1" : "0"; }
    return value.is_number_float() ? number(value.get<double>()) : value.dump();
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
    std::vector<Column> columns{
        {"device", [device = run.device](const BenchResult&) { return csvCell(device); }}};
    const Json fields = fieldsOf({});
    for (const auto& field : fields.items()) {
        columns.push_back({field.key(), [name = field.key()](const BenchResult& r) {
                               return cellOf(fieldsOf(r).at(name));
                           }});
    }
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
        columns.push_back({stage + " ms", [stage](const BenchResult& r) {
                               return number(sumOf(stagesOf(r.mode, r.pass_ms), stage));
                           }});
    }
    for (const std::string& pass : namesIn(run, [](const BenchResult& r) { return byLabel(r.pass_ms); })) {
        columns.push_back(
            {pass + " ms", [pass](const BenchResult& r) { return number(sumOf(byLabel(r.pass_ms), pass)); }});
    }
    for (const std::string& counter : namesIn(
             run, [](const BenchResult& r) -> const auto& { return r.counters; })) {
        columns.push_back({counter, [counter](const BenchResult& r) {
                               return r.counters.contains(counter) ? fmt::format("{}", r.counters.at(counter))
                                                                   : std::string();
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
    for (const Column& column : columns) {
        csv += fmt::format("{}{}", csv.empty() ? "" : ",", csvCell(column.head));
    }
    csv += "\n";
    for (const BenchResult& result : run.results) {
        for (std::size_t i = 0; i < columns.size(); ++i) {
            csv += fmt::format("{}{}", i == 0 ? "" : ",", columns[i].cell(result));
        }
        csv += "\n";
    }
    return csv;
}

}  // namespace binosplat
