// The results of `bench`, and their evaluation: ratios, stages, the Pareto front.
#pragma once

#include "app/bench/bench_quality.h"
#include "app/bench/bench_stages.h"
#include "app/bench/statistics.h"
#include "engine/geometry.h"
#include "engine/mode.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace binosplat {

// The origins of `OriginScores` with columns in the tables.
inline constexpr const char* kOrigins[] = {"all", "reprojected", "interpolated", "patched"};

// One method at one point of a series. Times are medians over the frames, in milliseconds of GPU time;
// without a mode, they are wall-clock milliseconds of the float64 twin for one eye.
struct BenchResult {
    std::string series, scene, view, headset, method;
    std::optional<Mode> mode;  // empty: the twin
    double resolution = 1.0;   // see BenchMethod
    Side dominant = kLeft;
    std::string backbone;  // what the splats are drawn as: 2DGS or 3DGS
    std::uint64_t splats = 0;
    glm::uvec2 size_px{0, 0};  // per eye
    std::uint32_t frames = 0;
    PassTimes pass_ms;                                     // in frame order
    double total_ms = 0.0, least_ms = 0.0, most_ms = 0.0;  // the whole pair (one eye for mono)
    std::vector<double> frame_ms;                          // of each frame; the point's methods took turns
    std::map<std::string, std::uint64_t> counters;
    std::uint64_t peak_gpu_bytes = 0;
    std::vector<OriginScores> quality;  // of the affiliated eye; empty if it is rendered in full
    std::optional<SeenScores> seen;     // of the affiliated eye, if its gaze is known
    // Median of the ratios of frames that took turns, so that temporary slowness affects both. Ratio of
    // total_ms if they did not.
    std::optional<double> ratio_to_two_pass, ratio_to_shared;
    std::optional<double> ratio_to_twin;               // mono: to the twin
    double tiles_rendered = 1.0, work_rendered = 1.0;  // see FrameResult
    // See FrameResult, of all passes; 0 if every eye is rendered in full.
    double stereo_bytes_per_pixel = 0.0;
    // predicted: cost of warping a tile, in pairs of `shared`
    std::optional<double> move_cost;
    // No other method of the point is better in time and error.
    bool on_front = false;
};

struct BenchRun {
    std::string device, config;
    std::vector<BenchResult> results;
};

// True if both were measured at the same point: same series, scene, view, headset, backbone, splats and size.
bool samePoint(const BenchResult& a, const BenchResult& b);
// The mode's name in the tables; "twin" if there is none.
std::string modeNameOf(const BenchResult& result);
// The name of a file or folder without its path; a built-in scene's full name.
std::string bareSceneName(const std::string& scene);
// "atelier, near, quest2, 1000 splats (2DGS), 512x512 per eye".
std::string namePoint(const BenchResult& result);

// Fills in the ratios and the cost of warping, if both modes were measured at the same point.
void compareModes(std::vector<BenchResult>& results);

// Marks the Pareto front: of two methods with the same error the faster one, of two equally fast the closer
// one. Modes that render every eye in full have no error.
void markFront(std::vector<BenchResult>& results);

// 0 if it has no such counter.
std::uint64_t counterOf(const BenchResult& result, const std::string& name);

// The result's scores over one origin; null if it has none.
const OriginScores* scoresOf(const BenchResult& result, const std::string& origin);

// True if LPIPS was measured: its column is absent otherwise.
bool hasLpips(const std::vector<BenchResult>& results);

std::string benchTable(const BenchRun& run, std::size_t most_columns = SIZE_MAX);
std::string benchJson(const BenchRun& run);
std::string benchCsv(const BenchRun& run);
// Error against run time at every point, with the front; and time against splats and pixels if a series
// varies them.
std::string benchPlot(const BenchRun& run);

// Quoted if the text would break a row of CSV.
std::string csvCell(const std::string& value);

}  // namespace binosplat
