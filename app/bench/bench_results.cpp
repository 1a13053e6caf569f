// Evaluating the results of `bench`.
#include "app/bench/bench_results.h"

#include "engine/builtin/procedural.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <tuple>

namespace binosplat {

namespace {

const BenchResult* findMode(const std::vector<BenchResult>& results, const BenchResult& like,
                            std::optional<Mode> mode) {
    const auto found = std::ranges::find_if(results, [&](const BenchResult& other) {
        return other.mode == mode && other.resolution == 1.0 && samePoint(other, like);
    });
    return found == results.end() ? nullptr : &*found;
}

std::optional<double> ratioTo(const BenchResult& result, const BenchResult* other) {
    if (other == nullptr || !(other->total_ms > 0.0)) { return std::nullopt; }
    if (result.frame_ms.empty() || result.frame_ms.size() != other->frame_ms.size()) {
        return result.total_ms / other->total_ms;
    }
    std::vector<double> ratios;
    for (std::size_t i = 0; i < result.frame_ms.size(); ++i) {
        ratios.push_back(result.frame_ms[i] / other->frame_ms[i]);
    }
    return median(ratios);
}

// The time to reproject a tile, in units of the affiliated eye's rendering time per pair of tile and splat,
// or of both eyes' if they are rendered at once.
std::optional<double> moveCost(const BenchResult& predicted, const BenchResult* shared) {
    const std::uint64_t moved = counterOf(predicted, "tiles_weighed_as_reprojected");
    if (predicted.mode != Mode::kPredicted || shared == nullptr || moved == 0) { return std::nullopt; }
    const std::uint64_t left = counterOf(*shared, "tile_pairs_left"),
                        right = counterOf(*shared, "tile_pairs_right");
    const NamedTimes stages = stagesOf(Mode::kShared, shared->pass_ms);
    const std::optional<double> both_ms = sumOf(stages, "both eyes");
    const auto pairs = static_cast<double>(both_ms ? left + right : shared->dominant == kLeft ? right : left);
    const double pair_ms =
        pairs > 0.0 ? (both_ms ? both_ms : sumOf(stages, "affiliated")).value_or(0.0) / pairs : 0.0;
    if (!(pair_ms > 0.0)) { return std::nullopt; }
    return sumOf(stagesOf(Mode::kPredicted, predicted.pass_ms), "reprojection").value_or(0.0) /
           static_cast<double>(moved) / pair_ms;
}

// True if a result takes part in the comparison of error and time.
bool isPair(const BenchResult& result) { return result.mode && result.mode != Mode::kMono; }

std::optional<double> meanSquareOf(const BenchResult& result) {
    const OriginScores* all = scoresOf(result, "all");
    if (all == nullptr && result.resolution == 1.0 && result.mode && rendersBothInFull(*result.mode)) {
        return 0.0;
    }
    return isPair(result) && all != nullptr ? std::optional(all->mean_square) : std::nullopt;
}

}  // namespace

std::string bareSceneName(const std::string& scene) {
    const std::filesystem::path path(scene);
    return isBuiltin(scene) ? scene : (path.has_filename() ? path : path.parent_path()).filename().string();
}

std::string modeNameOf(const BenchResult& result) {
    return result.mode ? std::string(nameOf(*result.mode)) : "twin";
}

bool samePoint(const BenchResult& a, const BenchResult& b) {
    const auto point = [](const BenchResult& r) {
        return std::tie(r.series, r.scene, r.view, r.headset, r.backbone, r.splats, r.size_px.x, r.size_px.y);
    };
    return point(a) == point(b);
}

std::string namePoint(const BenchResult& result) {
    std::string name = bareSceneName(result.scene);
    for (const std::string& part : {result.view, result.headset}) {
        if (!part.empty()) { name += ", " + part; }
    }
    return fmt::format("{}, {} splats ({}), {}x{} per eye", name, result.splats, result.backbone,
                       result.size_px.x, result.size_px.y);
}

void compareModes(std::vector<BenchResult>& results) {
    for (BenchResult& result : results) {
        if (result.mode == Mode::kMono) {
            result.ratio_to_twin = ratioTo(result, findMode(results, result, std::nullopt));
        }
        if (!result.mode) { continue; }  // another clock
        result.ratio_to_two_pass = ratioTo(result, findMode(results, result, Mode::kTwoPass));
        const BenchResult* shared = findMode(results, result, Mode::kShared);
        result.ratio_to_shared = ratioTo(result, shared);
        result.move_cost = moveCost(result, shared);
    }
}

void markFront(std::vector<BenchResult>& results) {
    const auto beats = [&](const BenchResult& other, const BenchResult& result) {
        if (!samePoint(other, result)) { return false; }
        const std::optional<double> theirs = meanSquareOf(other), ours = meanSquareOf(result);
        return theirs && *theirs <= *ours && other.total_ms <= result.total_ms &&
               (*theirs < *ours || other.total_ms < result.total_ms);
    };
    for (BenchResult& result : results) {
        result.on_front =
            meanSquareOf(result).has_value() &&
            std::ranges::none_of(results, [&](const BenchResult& other) { return beats(other, result); });
    }
}

std::uint64_t counterOf(const BenchResult& result, const std::string& name) {
    const auto found = result.counters.find(name);
    return found == result.counters.end() ? 0 : found->second;
}

const OriginScores* scoresOf(const BenchResult& result, const std::string& origin) {
    const auto found = std::ranges::find(result.quality, origin, &OriginScores::origin);
    return found == result.quality.end() ? nullptr : &*found;
}

bool hasLpips(const std::vector<BenchResult>& results) {
    return std::ranges::any_of(results, [](const BenchResult& result) {
        const OriginScores* all = scoresOf(result, "all");
        return all != nullptr && all->lpips.has_value();
    });
}

std::string csvCell(const std::string& value) {
    if (value.find_first_of(",\"\n") == std::string::npos) { return value; }
    std::string quoted = "\"";
    for (char c : value) { quoted += c == '"' ? "\"\"" : std::string(1, c); }
    return quoted + "\"";
}

}  // namespace binosplat
