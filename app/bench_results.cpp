// What `bench` measured, as a table, JSON and CSV.
#include "app/bench_results.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace binosplat {

namespace {

using Json = nlohmann::ordered_json;

auto pointOf(const BenchResult& result) { return std::tie(result.series, result.scene, result.splats, result.size_px.x, result.size_px.y); }

std::optional<double> ratioTo(const BenchResult& result, const std::string& mode, const std::vector<BenchResult>& results) {
    for (const BenchResult& other : results) {
        if (other.mode == mode && pointOf(other) == pointOf(result) && other.total_ms > 0.0) { return result.total_ms / other.total_ms; }
    }
    return std::nullopt;
}

std::string text(const std::optional<double>& ratio) { return ratio ? fmt::format("{:.3f}", *ratio) : "-"; }

std::uint64_t counter(const BenchResult& result, const std::string& name) {
    const auto found = result.counters.find(name);
    return found == result.counters.end() ? 0 : found->second;
}

// A counter that is kept per eye, added up.
std::uint64_t ofBothEyes(const BenchResult& result, const std::string& name) {
    return counter(result, name) + counter(result, name + "_left") + counter(result, name + "_right");
}

// Quoted where the text would break the row.
std::string cell(const std::string& value) {
    if (value.find_first_of(",\"\n") == std::string::npos) { return value; }
    std::string quoted = "\"";
    for (char c : value) { quoted += c == '"' ? "\"\"" : std::string(1, c); }
    return quoted + "\"";
}

// The names of all counters or passes that any result has, in order of first appearance.
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

}  // namespace

double median(std::vector<double> values) {
    if (values.empty()) { return 0.0; }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    const double upper = *middle;
    return values.size() % 2 == 1 ? upper : 0.5 * (upper + *std::max_element(values.begin(), middle));
}

std::vector<std::pair<std::string, double>> byPass(const BenchResult& result) {
    std::map<std::string, double> sums;  // the number in front of a pass's name makes this the order of the frame
    for (const auto& [name, ms] : result.pass_ms) { sums[name.substr(name.rfind(' ') + 1)] += ms; }
    return {sums.begin(), sums.end()};
}

void compareModes(std::vector<BenchResult>& results) {
    for (BenchResult& result : results) {
        result.ratio_to_two_pass = ratioTo(result, "two-pass", results);
        result.ratio_to_shared = ratioTo(result, "shared", results);
    }
}

std::string benchTable(const BenchRun& run) {
    std::string table = fmt::format("device: {}\n", run.device);
    const BenchResult* previous = nullptr;
    for (const BenchResult& result : run.results) {
        if (previous == nullptr || pointOf(*previous) != pointOf(result)) {
            table += fmt::format("\n{}: {}, {} splats, {}x{} per eye, median of {} frames\n", result.series, result.scene, result.splats,
                                 result.size_px.x, result.size_px.y, result.frames);
            table += fmt::format("  {:<10} {:>10} {:>19} {:>12} {:>11} {:>10}", "mode", "GPU ms", "least..most", "/ two-pass", "/ shared",
                                 "peak MiB");
            for (const auto& [name, ms] : byPass(result)) { table += fmt::format(" {:>13}", name); }
            table += "\n";
        }
        const std::string range = fmt::format("{:.3f}..{:.3f}", result.least_ms, result.most_ms);
        table += fmt::format("  {:<10} {:>10.3f} {:>19} {:>12} {:>11} {:>10.1f}", result.mode, result.total_ms, range,
                             text(result.ratio_to_two_pass), text(result.ratio_to_shared),
                             static_cast<double>(result.peak_gpu_bytes) / (1024.0 * 1024.0));
        table += fmt::format(" {:>10} {:>11}", ofBothEyes(result, "splats_visible"), ofBothEyes(result, "tile_pairs"));
        for (const auto& [name, ms] : byPass(result)) { table += fmt::format(" {:>13.3f}", ms); }
        table += "\n";
        previous = &result;
    }
    return table;
}

std::string benchJson(const BenchRun& run) {
    Json results = Json::array();
    for (const BenchResult& result : run.results) {
        Json passes = Json::object(), counters = Json::object();
        for (const auto& [name, ms] : result.pass_ms) { passes[name] = ms; }
        for (const auto& [name, count] : result.counters) { counters[name] = count; }
        Json entry{{"series", result.series},
                   {"scene", result.scene},
                   {"splats", result.splats},
                   {"width", result.size_px.x},
                   {"height", result.size_px.y},
                   {"mode", result.mode},
                   {"frames", result.frames},
                   {"gpu_ms", passes},
                   {"gpu_total_ms", result.total_ms},
                   {"gpu_total_least_ms", result.least_ms},
                   {"gpu_total_most_ms", result.most_ms}};
        if (result.ratio_to_two_pass) { entry["ratio_to_two_pass"] = *result.ratio_to_two_pass; }
        if (result.ratio_to_shared) { entry["ratio_to_shared"] = *result.ratio_to_shared; }
        entry["counters"] = counters;
        entry["peak_gpu_bytes"] = result.peak_gpu_bytes;
        results.push_back(entry);
    }
    const Json root{{"device", run.device}, {"config", run.config}, {"results", results}};
    return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string benchCsv(const BenchRun& run) {
    const auto passes = namesIn(
        run, [](const BenchResult& result) -> const auto& { return result.pass_ms; });
    const auto counters = namesIn(
        run, [](const BenchResult& result) -> const auto& { return result.counters; });
    std::string csv =
        "device,series,scene,splats,width,height,mode,frames,gpu_total_ms,gpu_total_least_ms,gpu_total_most_ms,ratio_to_two_pass,ratio_to_"
        "shared,peak_gpu_bytes";
    for (const std::string& name : passes) { csv += fmt::format(",{}", cell(name + " ms")); }
    for (const std::string& name : counters) { csv += fmt::format(",{}", cell(name)); }
    csv += "\n";
    const auto number = [](const std::optional<double>& value) { return value ? fmt::format("{:.6g}", *value) : std::string(); };
    for (const BenchResult& result : run.results) {
        csv +=
            fmt::format("{},{},{},{},{},{},{},{},{:.6g},{:.6g},{:.6g},{},{},{}", cell(run.device), cell(result.series), cell(result.scene),
                        result.splats, result.size_px.x, result.size_px.y, result.mode, result.frames, result.total_ms, result.least_ms,
                        result.most_ms, number(result.ratio_to_two_pass), number(result.ratio_to_shared), result.peak_gpu_bytes);
        for (const std::string& name : passes) {
            const auto found = std::ranges::find(result.pass_ms, name, &std::pair<std::string, double>::first);
            csv += found == result.pass_ms.end() ? "," : fmt::format(",{:.6g}", found->second);
        }
        for (const std::string& name : counters) {
            csv += result.counters.contains(name) ? fmt::format(",{}", counter(result, name)) : ",";
        }
        csv += "\n";
    }
    return csv;
}

}  // namespace binosplat
