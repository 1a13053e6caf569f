// The results of `bench` as tables on a terminal: per point one of methods and one of passes.
#include "app/bench/bench_results.h"
#include "app/report/text_columns.h"

#include <fmt/format.h>

#include <algorithm>

namespace binosplat {

namespace {

std::string thousandths(const std::optional<double>& value) {
    return value ? fmt::format("{:.3f}", *value) : "-";
}

std::string psnrText(const OriginScores* scores) {
    if (scores == nullptr) { return "-"; }
    return scores->mean_square == 0.0 ? "equal" : fmt::format("{:.2f}", scores->psnrDb());
}

std::string scoreText(const std::optional<double>& score) {
    return score ? fmt::format("{:.4f}", *score) : "-";
}

// The sum of a counter that is kept per eye.
std::uint64_t ofBothEyes(const BenchResult& result, const std::string& name) {
    return counterOf(result, name) + counterOf(result, name + "_left") + counterOf(result, name + "_right");
}

std::string methodsTable(const std::vector<const BenchResult*>& point, bool with_lpips, std::size_t most) {
    TextColumns columns;
    std::vector<std::string> head{"method",       "front",    "ms",       "least",   "most",
                                  "/ two-pass",   "/ shared", "peak MiB", "PSNR dB", "reprojected",
                                  "interpolated", "patched",  "SSIM",     "FLIP"};
    if (with_lpips) { head.emplace_back("LPIPS"); }
    for (const char* rest :
         {"tiles again", "% of work", "bytes a px", "commands", "holes px", "gaps px", "pairs"}) {
        head.emplace_back(rest);
    }
    columns.addRow(std::move(head));
    for (const BenchResult* r : point) {
        std::vector<std::string> row{r->method, r->on_front ? "*" : ""};
        for (const double ms : {r->total_ms, r->least_ms, r->most_ms}) {
            row.push_back(fmt::format("{:.3f}", ms));
        }
        row.push_back(thousandths(r->ratio_to_two_pass));
        row.push_back(thousandths(r->ratio_to_shared));
        row.push_back(
            !r->mode ? "-"
                     : fmt::format("{:.1f}", static_cast<double>(r->peak_gpu_bytes) / (1024.0 * 1024.0)));
        for (const char* origin : kOrigins) { row.push_back(psnrText(scoresOf(*r, origin))); }
        const OriginScores* all = scoresOf(*r, "all");
        row.push_back(scoreText(all != nullptr ? all->ssim : std::nullopt));
        row.push_back(scoreText(all != nullptr ? all->flip : std::nullopt));
        if (with_lpips) { row.push_back(scoreText(all != nullptr ? all->lpips : std::nullopt)); }
        const bool reprojects = r->counters.contains("tiles_patched");
        row.push_back(reprojects ? fmt::format("{}", ofBothEyes(*r, "tiles_patched")) : "-");
        row.push_back(r->counters.contains("work_full") ? fmt::format("{:.1f}", 100.0 * r->work_rendered)
                                                        : "-");
        row.push_back(reprojects ? fmt::format("{:.1f}", r->stereo_bytes_per_pixel) : "-");
        row.push_back(!r->mode ? "-" : fmt::format("{}", ofBothEyes(*r, "commands")));
        for (const char* name : {"pixels_hole", "pixels_gap"}) {
            row.push_back(reprojects ? fmt::format("{}", ofBothEyes(*r, name)) : "-");
        }
        row.push_back(!r->mode ? "-" : fmt::format("{}", ofBothEyes(*r, "tile_pairs")));
        columns.addRow(std::move(row));
    }
    return columns.text(most);
}

std::string timesTable(const std::vector<const BenchResult*>& point, std::size_t most) {
    std::vector<std::string> passes;
    for (const BenchResult* r : point) {
        auto next = passes.begin();  // a new pass is inserted after its predecessor
        for (const auto& [name, ms] : byPass(r->pass_ms)) {
            const auto found = std::ranges::find(passes, name);
            next = (found != passes.end() ? found : passes.insert(next, name)) + 1;
        }
    }
    TextColumns columns;
    std::vector<std::string> head{"ms by stage, then by pass"};
    for (const char* stage : kStages) { head.emplace_back(stage); }
    head.insert(head.end(), passes.begin(), passes.end());
    columns.addRow(head);
    for (const BenchResult* r : point) {
        std::vector<std::string> row{r->method};
        const NamedTimes stages = stagesOf(r->mode, r->pass_ms), times = byPass(r->pass_ms);
        for (const char* stage : kStages) { row.push_back(thousandths(sumOf(stages, stage))); }
        for (const std::string& name : passes) { row.push_back(thousandths(sumOf(times, name))); }
        columns.addRow(std::move(row));
    }
    return columns.text(most);
}

}  // namespace

std::string benchTable(const BenchRun& run, std::size_t most_columns) {
    std::string table = fmt::format("device: {}\n", run.device);
    for (std::size_t begin = 0, end = 0; begin < run.results.size(); begin = end) {
        std::vector<const BenchResult*> point;
        for (end = begin; end < run.results.size() && samePoint(run.results[begin], run.results[end]);
             ++end) {
            point.push_back(&run.results[end]);
        }
        table += fmt::format("\n{}: {}, median of {} frames\n", point[0]->series, namePoint(*point[0]),
                             point[0]->frames);
        table += methodsTable(point, hasLpips(run.results), most_columns) + timesTable(point, most_columns);
        for (const BenchResult* r : point) {
            if (r->move_cost) {
                table += fmt::format("  {}: reprojecting a tile took as long as rendering {:.0f} pairs\n",
                                     r->method, *r->move_cost);
            }
            if (r->seen && r->seen->mean_square == 0.0) {
                table += fmt::format("  {}: the eye sees no error\n", r->method);
            } else if (r->seen) {
                table += fmt::format(
                    "  {}: the eye sees an error of {:.2f} dB, and notices it in {:.2f} % of the tiles that "
                    "have one\n",
                    r->method, r->seen->psnrDb(), 100.0 * r->seen->noticed);
            }
            if (r->ratio_to_twin && *r->ratio_to_twin > 0.0) {
                table += fmt::format("  mono is {:.2f} times as fast as its float64 twin on the CPU\n",
                                     1.0 / *r->ratio_to_twin);
            }
        }
    }
    return table;
}

}  // namespace binosplat
