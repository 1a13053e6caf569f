// Planes are rated by what is in them and what stands on them, seen along their normal.
#include "engine/places/floor_choice.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace binosplat {

namespace {

constexpr std::size_t kMostForRating = 8192;
constexpr int kPlanCells = 24;                // of the longest side of a plane's content
constexpr int kFewInCell = 4;                 // may be floaters
constexpr std::size_t kFewStanding = 100;     // too few to say where things stand
constexpr double kAboutCosine = 0.70710678;   // 45 degrees: of the usual up
constexpr double kTiltedCosine = 0.93969262;  // 20 degrees: beyond, it must look like a floor
constexpr double kOtherCosine = 0.8660254;    // 30 degrees: another direction
constexpr double kFacingCosine = 0.9;
constexpr double kCeiling = 0.5;  // compared with a floor
constexpr double kBetterThanOthers = 2.0;
constexpr double kLeastCovered = 0.5, kLeastFacing = 0.4;
constexpr double kReachesFar = 1.2;  // beyond what stands on it: ground, not a wall
constexpr double kHoversFrom = 0.1;  // of the size
// Share of the breadth: on walls seen from the front, nothing stands out farther.
constexpr double kRelief = 0.4;

struct Rating {
    double covered = 0.0;  // the share, of what is seen along the normal, that has splats of the plane
    double facing = 0.0;   // the share of the plane's splats that face along its normal
    // How far from its middle nine tenths of the plane's splats are, relative to the others.
    double reach = 0.0;
    double low = 0.5;      // of what stands away from the rim, the share in the lower half
    double height = 0.0;   // nineteen in twenty of the others are lower
    double breadth = 0.0;  // the side of a square as large as what is seen along the normal
    bool hovers = true;    // only floaters stand on it
};

// Seen along the normal.
struct Seen {
    double u, v, h;
    bool is_floor;
};

std::vector<Seen> lookAlong(const std::vector<SplatSample>& samples, const FloorPlane& plane,
                            double& facing) {
    const glm::dvec3 across =
        std::abs(plane.up.x) < 0.7 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
    const glm::dvec3 u = glm::normalize(glm::cross(plane.up, across)), v = glm::cross(plane.up, u);
    std::vector<Seen> seen;
    std::size_t facing_count = 0, floor_count = 0;
    for (std::size_t i = 0; i < samples.size(); i += samples.size() / kMostForRating + 1) {
        const SplatSample& sample = samples[i];
        const double h = glm::dot(sample.centre, plane.up) - plane.height;
        if (h < -2.0 * plane.thickness) { continue; }
        const bool is_floor = std::abs(h) < plane.thickness;
        floor_count += is_floor;
        facing_count += is_floor && std::abs(glm::dot(sample.normal, plane.up)) > kFacingCosine;
        seen.push_back({glm::dot(sample.centre, u), glm::dot(sample.centre, v), h, is_floor});
    }
    facing = static_cast<double>(facing_count) / static_cast<double>(std::max<std::size_t>(floor_count, 1));
    return seen;
}

// The quantile at `share` of the values for which `of` gives one; 0 if there are none.
template <typename Of>
double quantileOf(const std::vector<Seen>& seen, double share, const Of& of) {
    std::vector<double> values;
    for (const Seen& one : seen) {
        if (const std::optional<double> value = of(one)) { values.push_back(*value); }
    }
    return values.empty() ? 0.0 : findQuantile(values, share);
}

Rating rate(const std::vector<SplatSample>& samples, const FloorPlane& plane) {
    Rating rating;
    const std::vector<Seen> seen = lookAlong(samples, plane, rating.facing);
    const auto ofFloor = [](double Seen::*along) {
        return [along](const Seen& one) { return one.is_floor ? std::optional(one.*along) : std::nullopt; };
    };
    const double middle_u = quantileOf(seen, 0.5, ofFloor(&Seen::u)),
                 middle_v = quantileOf(seen, 0.5, ofFloor(&Seen::v));
    const auto distanceOf = [&](const Seen& one) { return std::hypot(one.u - middle_u, one.v - middle_v); };
    const auto reachOf = [&](bool is_floor) {
        return quantileOf(seen, 0.9, [&](const Seen& one) {
            return one.is_floor == is_floor ? std::optional(distanceOf(one)) : std::nullopt;
        });
    };
    const double rim = reachOf(false);
    rating.reach = reachOf(true) / std::max(rim, 1e-300);
    const auto standing = [&](const Seen& one) {
        return one.h > 2.0 * plane.thickness ? std::optional(one.h) : std::nullopt;
    };
    rating.height = quantileOf(seen, 0.95, standing);
    rating.hovers = quantileOf(seen, 0.05, standing) >
                    kHoversFrom * std::hypot(rating.height, 2.0 * std::max(rim, reachOf(true)));

    struct PlanCell {
        int all = 0, floor = 0;
    };
    std::map<std::pair<int, int>, PlanCell> cells;
    const double side = 2.0 * std::max(rim, reachOf(true)) / kPlanCells;
    std::size_t inside = 0, low = 0;
    for (const Seen& one : seen) {
        PlanCell& cell =
            cells[{static_cast<int>(std::floor(one.u / side)), static_cast<int>(std::floor(one.v / side))}];
        ++cell.all;
        cell.floor += one.is_floor;
        if (one.h < 0.05 * rating.height || one.h > 0.95 * rating.height || distanceOf(one) > 0.85 * rim) {
            continue;
        }
        ++inside;
        low += one.h < 0.5 * rating.height;
    }
    const auto filled =
        std::ranges::count_if(cells, [](const auto& cell) { return cell.second.all >= kFewInCell; });
    const auto covered = std::ranges::count_if(
        cells, [](const auto& cell) { return cell.second.all >= kFewInCell && cell.second.floor > 0; });
    rating.covered = static_cast<double>(covered) / static_cast<double>(std::max<std::ptrdiff_t>(filled, 1));
    rating.breadth = side * std::sqrt(static_cast<double>(filled));
    if (inside >= kFewStanding) { rating.low = static_cast<double>(low) / static_cast<double>(inside); }
    return rating;
}

// Of a floor, or of a ceiling, whose things lie away from it.
double scoreOf(const FloorPlane& plane, const Rating& rating) {
    const bool is_ground = rating.reach >= kReachesFar;
    const double stands = plane.is_ceiling ? (is_ground ? 0.0 : kCeiling * (1.0 - rating.low))
                          : is_ground      ? 1.0
                                           : std::max(0.1, rating.low);
    return plane.share * rating.covered * (1.0 - 3.0 * plane.behind) * stands;
}

bool looksLikeFloor(const Rating& rating) {
    return rating.covered >= kLeastCovered &&
           (rating.facing >= kLeastFacing || rating.reach >= kReachesFar) && !rating.hovers;
}

bool isRelief(const Rating& rating) { return rating.height < kRelief * rating.breadth; }

}  // namespace

UpHints hintsOf(const Scene& scene) {
    UpHints hints;
    hints.usual.y = scene.y_up ? 1.0 : -1.0;
    hints.front.z = scene.y_up ? 1.0 : -1.0;
    if (scene.vertical_axis == 1) { hints.known = UpHints::Known::kDirection; }
    if (scene.vertical_axis == 0 || scene.vertical_axis == 2) {
        hints = {.usual = glm::dvec3(0.0), .front = {0.0, -1.0, 0.0}, .known = UpHints::Known::kAxis};
        hints.usual[scene.vertical_axis] = 1.0;
    }
    return hints;
}

std::optional<FloorPlane> chooseFloor(const std::vector<SplatSample>& samples, const UpHints& hints) {
    struct Candidate {
        FloorPlane floor;
        double score;
        bool is_possible;
    };
    const auto isUsual = [&](const Candidate& one) {
        return glm::dot(one.floor.up, hints.usual) >= kAboutCosine;
    };
    const auto isKnownNotToBe = [&](double along_usual) {
        return (hints.known == UpHints::Known::kDirection && along_usual < kAboutCosine) ||
               (hints.known == UpHints::Known::kAxis && std::abs(along_usual) < kAboutCosine);
    };
    std::vector<Candidate> candidates;
    for (const FloorPlane& plane : findPlanes(samples)) {
        const Rating rating = rate(samples, plane);
        const double along_usual = glm::dot(plane.up, hints.usual);
        const bool looks_like_one = looksLikeFloor(rating);
        if (!isKnownNotToBe(along_usual)) {
            const bool is_above = !hints.seen_from || glm::dot(plane.up, *hints.seen_from) > plane.height;
            const bool may_be_wall =
                !hints.seen_from && glm::dot(plane.up, hints.front) > kAboutCosine && isRelief(rating);
            const bool is_floor =
                (along_usual >= kTiltedCosine && !hints.is_doubtful) || (looks_like_one && !may_be_wall);
            candidates.push_back({plane, scoreOf(plane, rating), is_above && is_floor});
        }
        if (along_usual <= -kAboutCosine && !hints.seen_from) {
            const FloorPlane ceiling{-plane.up,   -plane.height, plane.thickness,
                                     plane.share, true,          plane.behind};
            candidates.push_back({ceiling, scoreOf(ceiling, rating), looks_like_one});
        }
    }
    const Candidate *usual = nullptr, *other = nullptr;
    for (const Candidate& candidate : candidates) {
        const Candidate*& best = isUsual(candidate) ? usual : other;
        if (candidate.is_possible && (best == nullptr || candidate.score > best->score)) {
            best = &candidate;
        }
    }
    const auto isBetter = [&](const Candidate& than) {
        return glm::dot(other->floor.up, than.floor.up) > kOtherCosine ||
               other->score >= kBetterThanOthers * than.score;
    };
    // Whichever is the usual up, cameras are above the ground.
    const bool is_better = hints.is_doubtful ? usual == nullptr
                           : hints.seen_from
                               ? usual == nullptr || (other != nullptr && other->score > usual->score)
                               : other != nullptr && std::ranges::all_of(candidates, isBetter);
    if (other != nullptr && is_better) { return other->floor; }
    return usual != nullptr ? std::optional(usual->floor) : std::nullopt;
}

}  // namespace binosplat
