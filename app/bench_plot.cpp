// The plots of a bench run: time against splats and against pixels, per mode and per pass.
#include "app/bench_results.h"
#include "app/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace binosplat {

namespace {

double pixelsOf(const BenchResult& result) { return static_cast<double>(result.size_px.x) * static_cast<double>(result.size_px.y); }

PlotLine& lineOf(PlotPanel& panel, const std::string& label) {
    const auto found = std::ranges::find(panel.lines, label, &PlotLine::label);
    if (found != panel.lines.end()) { return *found; }
    return panel.lines.emplace_back(PlotLine{label, {}});
}

// Which results belong together in a panel: one scene and one series.
using Group = std::pair<std::string, std::string>;
bool belongs(const BenchResult& result, const Group& group) { return result.scene == group.first && result.series == group.second; }

// The axis along which a group varies; pixels if both or none do.
bool variesSplats(const BenchRun& run, const Group& group) {
    std::set<std::uint64_t> splats;
    std::set<double> pixels;
    for (const BenchResult& result : run.results) {
        if (!belongs(result, group)) { continue; }
        splats.insert(result.splats);
        pixels.insert(pixelsOf(result));
    }
    return splats.size() > 1 && pixels.size() == 1;
}

// The other axis, which does not vary in a well-made series.
std::string heldFixed(const BenchRun& run, const Group& group, bool against_splats) {
    const auto first = std::ranges::find_if(run.results, [&](const BenchResult& result) { return belongs(result, group); });
    return against_splats ? fmt::format("{}x{}", first->size_px.x, first->size_px.y) : fmt::format("{} splats", first->splats);
}

}  // namespace

std::string benchPlot(const BenchRun& run) {
    std::vector<Group> groups;
    for (const BenchResult& result : run.results) {
        if (std::ranges::find(groups, Group{result.scene, result.series}) == groups.end()) {
            groups.emplace_back(result.scene, result.series);
        }
    }
    std::vector<PlotPanel> panels;
    for (const Group& group : groups) {
        const bool against_splats = variesSplats(run, group);
        const std::string x_label = against_splats ? "splats in the scene" : "pixels per eye";
        const std::string where = fmt::format("{}, {}", group.first, heldFixed(run, group, against_splats));
        PlotPanel totals{where + ": each mode", x_label, "GPU time, ms", {}};
        PlotPanel passes{where + ": passes of shared", x_label, "GPU time, ms", {}};
        for (const BenchResult& result : run.results) {
            if (!belongs(result, group)) { continue; }
            const double x = against_splats ? static_cast<double>(result.splats) : pixelsOf(result);
            lineOf(totals, result.mode).points.emplace_back(x, result.total_ms);
            if (result.mode != "shared") { continue; }
            for (const auto& [name, ms] : byPass(result)) { lineOf(passes, name).points.emplace_back(x, ms); }
        }
        panels.push_back(totals);
        if (!passes.lines.empty()) { panels.push_back(passes); }
    }
    return drawPlot("GPU time on " + run.device, panels);
}

}  // namespace binosplat
