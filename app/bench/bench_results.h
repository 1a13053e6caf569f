// What `bench` measured, and what follows from it: ratios, stages, the Pareto front.
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

// What the tables have columns for, of `OriginScores`.
inline constexpr const char* kOrigins[] = {"all", "reprojected", "interpolated", "patched"};

// One method at one point of a series. Times are medians over the frames, in milliseconds of GPU time; those without a mode are
// wall-clock milliseconds of the float64 twin for one eye.
struct BenchResult {
    std::string series, scene, view, headset, method;
    std::optional<Mode> mode;  // empty: the twin
    Side dominant = kLeft;
    std::string backbone;  // what the splats are drawn as: 2DGS or 3DGS
    std::uint64_t splats = 0;
    glm::uvec2 size_px{0, 0};  // per eye
    std::uint32_t frames = 0;
    PassTimes pass_ms;                                     // in frame order
    double total_ms = 0.0, least_ms = 0.0, most_ms = 0.0;  // the whole pair (one eye for mono)
    std::vector<double> frame_ms;                          // of each frame, in turn with those of the point's other methods
    std::map<std::string, std::uint64_t> counters;
    std::uint64_t peak_gpu_bytes = 0;
    std::vector<OriginScores> quality;  // of the affiliated eye; empty where it is rendered in full
    std::optional<SeenScores> seen;     // likewise, where it is known where the eye looks
    // Median of the ratios of frames that took turns: what slows the machine for a while slows both. Of total_ms where they did not.
    std::optional<double> ratio_to_two_pass, ratio_to_shared;
    std::optional<double> ratio_to_twin;               // mono: to the twin's
    double tiles_rendered = 1.0, work_rendered = 1.0;  // see FrameResult
    double stereo_bytes_per_pixel = 0.0;               // likewise, of all passes; 0 where every eye is rendered in full
    std::optional<double> move_cost;                   // predicted: what moving a tile took, in pairs of `shared`
    bool on_front = false;                             // no other method of the point is as fast and as close to the full render
};

struct BenchRun {
    std::string device, config;
    std::vector<BenchResult> results;
};

// Whether both were measured at the same point: same series, scene, view, headset, backbone, splats and size.
bool samePoint(const BenchResult& a, const BenchResult& b);
// As the tables write it; "twin" where there is no mode.
std::string modeNameOf(const BenchResult& result);
// Of a file or folder its own name, whole of a built-in scene.
std::string bareSceneName(const std::string& scene);
// "atelier, near, quest2, 1000 splats (2DGS), 512x512 per eye".
std::string namePoint(const BenchResult& result);

// Fills in the ratios and what moving cost, where both modes were measured at the same point.
void compareModes(std::vector<BenchResult>& results);

// Marks what is worth its time: of two methods with the same error the faster one, of two as fast the closer one. Modes that render
// every eye in full have no error.
void markFront(std::vector<BenchResult>& results);

// 0 where it has no such counter.
std::uint64_t counterOf(const BenchResult& result, const std::string& name);

// The result's scores over one origin; null where it has none.
const OriginScores* scoresOf(const BenchResult& result, const std::string& origin);

// Whether LPIPS was measured: its column is absent otherwise.
bool hasLpips(const std::vector<BenchResult>& results);

std::string benchTable(const BenchRun& run);
std::string benchJson(const BenchRun& run);
std::string benchCsv(const BenchRun& run);
// Error against run time at every point, the front drawn; and time against splats and pixels where a series varies them.
std::string benchPlot(const BenchRun& run);

// Quoted where the text would break a row of CSV.
std::string csvCell(const std::string& value);

}  // namespace binosplat
