// The plots of a bench run: error against time at every point, and time against splats and pixels.
#include "app/bench/bench_results.h"
#include "app/plot/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <set>

namespace binosplat {

namespace {

double pixelsOf(const BenchResult& result) {
    return static_cast<double>(result.size_px.x) * static_cast<double>(result.size_px.y);
}

std::optional<double> errorOf(const BenchResult& result) {
    const OriginScores* all = scoresOf(result, "all");
    return all == nullptr ? std::nullopt : std::optional(all->psnrDb());
}

std::optional<double> seenErrorOf(const BenchResult& result) {
    return result.seen ? std::optional(result.seen->psnrDb()) : std::nullopt;
}

// One panel per point whose methods have an error: a series of points per mode; the points of the Pareto
// front are joined if `draws_front`.
std::vector<PlotPanel> errorPanels(const BenchRun& run, const char* y_label,
                                   std::optional<double> (*psnrDbOf)(const BenchResult&), bool draws_front) {
    std::vector<PlotPanel> panels;
    for (std::size_t begin = 0, end = 0; begin < run.results.size(); begin = end) {
        const BenchResult& first = run.results[begin];
        PlotPanel panel{.title = namePoint(first), .x_label = "GPU time of the pair, ms", .y_label = y_label};
        panel.x_scale = panel.y_scale = Scale::kLinear;
        PlotLine front{.label = "Pareto front", .dots = false};
        std::map<std::optional<Mode>, std::size_t> methods;  // by mode
        for (end = begin; end < run.results.size() && samePoint(first, run.results[end]); ++end) {
            ++methods[run.results[end].mode];
        }
        for (std::size_t i = begin; i < end; ++i) {
            const BenchResult& result = run.results[i];
            const std::optional<double> psnr_db = psnrDbOf(result);
            if (result.mode && rendersBothInFull(*result.mode) && result.resolution == 1.0) {
                panel.marks.push_back({result.method + " (no error)", result.total_ms});
            }
            if (!psnr_db) { continue; }
            PlotLine& line = lineOf(panel, modeNameOf(result));
            line.joined = false;
            line.points.emplace_back(result.total_ms, *psnr_db);
            // If there are many, only the front is named.
            line.names.push_back(methods[result.mode] < 6 || result.on_front ? result.method : "");
            if (result.on_front) { front.points.emplace_back(result.total_ms, *psnr_db); }
        }
        if (panel.lines.empty()) { continue; }
        if (draws_front) {
            std::ranges::sort(front.points);
            panel.lines.push_back(std::move(front));
        }
        panels.push_back(std::move(panel));
    }
    return panels;
}

// Results that share a panel: equal in everything but splats and size.
using Group = std::array<std::string, 4>;
Group groupOf(const BenchResult& result) {
    return {result.scene, result.series, result.view, result.headset};
}

struct Extent {
    std::set<std::uint64_t> splats;
    std::set<double> pixels;
    const BenchResult* first = nullptr;
};

Extent extentOf(const BenchRun& run, const Group& group) {
    Extent extent;
    for (const BenchResult& result : run.results) {
        if (groupOf(result) != group) { continue; }
        extent.splats.insert(result.splats);
        extent.pixels.insert(pixelsOf(result));
        if (extent.first == nullptr) { extent.first = &result; }
    }
    return extent;
}

// Time against splats or pixels, whichever varies in the group; pixels if both do.
std::vector<PlotPanel> scalingPanels(const BenchRun& run, const Group& group) {
    const Extent extent = extentOf(run, group);
    const bool against_splats = extent.splats.size() > 1 && extent.pixels.size() == 1;
    const std::string x_label = against_splats ? "splats in the scene" : "pixels per eye";
    const std::string fixed = against_splats
                                  ? fmt::format("{}x{}", extent.first->size_px.x, extent.first->size_px.y)
                                  : fmt::format("{} splats", extent.first->splats);
    PlotPanel totals{
        .title = fmt::format("{}, {}: each method", group[0], fixed), .x_label = x_label, .y_label = "ms"};
    PlotPanel passes{.title = fmt::format("{}, {}: passes of shared", group[0], fixed),
                     .x_label = x_label,
                     .y_label = "GPU time, ms"};
    for (const BenchResult& result : run.results) {
        if (groupOf(result) != group) { continue; }
        const double x = against_splats ? static_cast<double>(result.splats) : pixelsOf(result);
        lineOf(totals, result.method).points.emplace_back(x, result.total_ms);
        if (result.mode != Mode::kShared || result.resolution < 1.0) { continue; }
        for (const auto& [name, ms] : byPass(result.pass_ms)) {
            lineOf(passes, name).points.emplace_back(x, ms);
        }
    }
    return {totals, passes};
}

}  // namespace

std::string benchPlot(const BenchRun& run) {
    std::vector<PlotPanel> panels = errorPanels(run, "PSNR of the affiliated eye, dB", errorOf, true);
    std::ranges::move(errorPanels(run, "PSNR of what the eye sees of the error, dB", seenErrorOf, false),
                      std::back_inserter(panels));
    std::set<Group> done;
    for (const BenchResult& result : run.results) {
        const Group group = groupOf(result);
        const Extent extent = extentOf(run, group);
        if (!done.insert(group).second) { continue; }
        if (extent.splats.size() * extent.pixels.size() > 1 || panels.empty()) {
            std::ranges::move(scalingPanels(run, group), std::back_inserter(panels));
        }
    }
    return drawPlot("Measured on " + run.device, panels);
}

}  // namespace binosplat
