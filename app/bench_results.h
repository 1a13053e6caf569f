// What `bench` measured, as a table, JSON, CSV and plot.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace binosplat {

// One mode at one point of a series. Times are medians over the frames, in milliseconds of GPU time.
struct BenchResult {
    std::string series, scene, mode;
    std::uint64_t splats = 0;
    glm::uvec2 size_px{0, 0};  // per eye
    std::uint32_t frames = 0;
    std::vector<std::pair<std::string, double>> pass_ms;   // in frame order
    double total_ms = 0.0, least_ms = 0.0, most_ms = 0.0;  // the whole pair (one eye for mono)
    std::map<std::string, std::uint64_t> counters;
    std::uint64_t peak_gpu_bytes = 0;
    std::optional<double> ratio_to_two_pass, ratio_to_shared;  // of total_ms, in the same run
};

struct BenchRun {
    std::string device, config;
    std::vector<BenchResult> results;
};

double median(std::vector<double> values);

// The times by bare pass: "dominant 4_project" and "affiliated 4_project" add up to "4_project".
std::vector<std::pair<std::string, double>> byPass(const BenchResult& result);

// Fills in the ratios, where both modes were measured at the same point.
void compareModes(std::vector<BenchResult>& results);

std::string benchTable(const BenchRun& run);
std::string benchJson(const BenchRun& run);
std::string benchCsv(const BenchRun& run);
// Totals of all modes, and the passes of `shared`, against splats and against pixels where a series varies them.
std::string benchPlot(const BenchRun& run);

}  // namespace binosplat
