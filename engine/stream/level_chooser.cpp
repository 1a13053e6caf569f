// Worth by distance and angle; a greedy walk down the list of steps.
#include "engine/stream/level_chooser.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace binosplat {

namespace {

// A step that was chosen the time before counts this much more, and one that was not this much less.
constexpr double kKept = 1.25;
// A level that is off by more than this, 36 dB, is not fine enough while its splats are farther apart than
// this share of the usual limit.
constexpr float kMostError = 2.5e-4f;
constexpr double kCloser = 0.5;

struct Sphere {
    glm::dvec3 centre;
    double radius;
};

Sphere around(const LodLeaf& leaf) {
    const glm::dvec3 low(leaf.low), high(leaf.high);
    return {0.5 * (low + high), 0.5 * glm::length(high - low)};
}

// The angle between a sphere and the edge of an eye's view; 0 if part of it may be visible.
double angleOutside(const Sphere& sphere, const Eye& eye, const Pose& camera_from_world) {
    const glm::dvec3 c = transform(camera_from_world, sphere.centre);
    const double distance = glm::length(c);
    if (distance <= sphere.radius) { return 0.0; }
    const double from_axis = std::acos(std::clamp(c.z / distance, -1.0, 1.0));
    // Where the edge is in that direction: at the nearer of the picture's two sides.
    const Intrinsics& k = eye.intrinsics;
    const double across = std::hypot(c.x, c.y);
    const double least = 1e-3;  // an axis outside of the picture
    const double side_x = c.x > 0.0 ? (eye.size_px.x - k.cx) / k.fx : k.cx / k.fx;
    const double side_y = c.y > 0.0 ? (eye.size_px.y - k.cy) / k.fy : k.cy / k.fy;
    double edge = std::numbers::pi / 2.0;
    if (across > 0.0) {
        const double inverse_tangent = std::max(std::abs(c.x) / across / std::max(side_x, least),
                                                std::abs(c.y) / across / std::max(side_y, least));
        edge = std::atan(1.0 / inverse_tangent);
    }
    return std::max(0.0, from_axis - std::asin(sphere.radius / distance) - edge);
}

double distanceToBox(const LodLeaf& leaf, const glm::dvec3& point) {
    return glm::length(point - glm::clamp(point, glm::dvec3(leaf.low), glm::dvec3(leaf.high)));
}

std::uint64_t pagesOf(std::uint64_t splats, std::uint32_t page_splats) {
    return (splats + page_splats - 1) / page_splats;
}

}  // namespace

void LevelChooser::addSteps(std::uint32_t leaf, double area_px, double weight, const ChoiceSettings& settings,
                            const LevelsThere& there) {
    const std::vector<LodRange>& levels = leaves_[leaf].levels;
    const std::vector<float>& errors = leaves_[leaf].errors;
    const std::uint32_t before = choices_.levels[leaf];
    // From the finest on, the levels that have fewer splats than all finer ones; the others are useless. Then
    // the other way round.
    const std::size_t first = steps_.size();
    for (std::uint32_t level = 0; level < levels.size(); ++level) {
        const std::uint64_t splats = levels[level].splats.count;
        if (!there.has({leaf, level}, levels[level].file) ||
            (steps_.size() > first && splats >= steps_.back().splats)) {
            continue;
        }
        steps_.push_back({0.0, leaf, level, 0, splats, pagesOf(splats, settings.page_splats)});
    }
    std::reverse(steps_.begin() + static_cast<std::ptrdiff_t>(first), steps_.end());
    const auto errorOf = [&](const Step& step) { return static_cast<double>(errors[step.level]); };
    const auto gain = [&](const Step& from, const Step& to) {
        return std::max(errorOf(from) - errorOf(to), 0.0) / static_cast<double>(to.splats - from.splats);
    };
    std::size_t kept = first;
    for (std::size_t i = first; i < steps_.size(); ++i) {
        Step step = steps_[i];
        const bool is_coarsest = i == first;
        const Step& coarser = steps_[is_coarsest ? i : i - 1];
        double seen = weight * area_px;
        if (!is_first_) {
            seen *= before != LevelChoices::kNone && before <= step.level ? kKept : 1.0 / kKept;
        }
        step.worth = seen / std::sqrt(static_cast<double>(step.splats) * static_cast<double>(coarser.splats));
        const bool is_wrong = !is_coarsest && !errors.empty() && errors[coarser.level] > kMostError;
        const double finest_px = is_wrong ? kCloser * settings.finest_px : settings.finest_px;
        if (!is_coarsest && step.worth < finest_px * finest_px) { break; }
        if (!is_coarsest && !errors.empty()) {
            // A step that gains less for each of its splats than the next one is taken together with it.
            while (kept - first > 1 &&
                   gain(steps_[kept - 1], step) > gain(steps_[kept - 2], steps_[kept - 1])) {
                --kept;
            }
            step.worth = seen * gain(steps_[kept - 1], step);
        }
        steps_[kept++] = step;
    }
    steps_.resize(kept);
    for (std::size_t i = kept; i-- > first;) {
        steps_[i].order = static_cast<std::uint32_t>(i - first);
        if (i == first) { continue; }
        steps_[i].splats -= steps_[i - 1].splats;
        steps_[i].pages -= steps_[i - 1].pages;
    }
}

const LevelChoices& LevelChooser::choose(std::span<const Eye> eyes, const ChoiceSettings& settings,
                                         const LevelsThere& there) {
    is_first_ = choices_.levels.empty();
    choices_.levels.resize(leaves_.size(), LevelChoices::kNone);
    steps_.clear();
    const glm::dvec3 middle = middleOf(eyes);
    std::vector<Pose> cameras;
    double focal_px = 0.0;
    for (const Eye& eye : eyes) {
        cameras.push_back(inverse(eye.world_from_camera));
        focal_px = std::max(focal_px, std::sqrt(eye.intrinsics.fx * eye.intrinsics.fy));
    }
    for (std::uint32_t l = 0; l < leaves_.size(); ++l) {
        const Sphere sphere = around(leaves_[l]);
        double outside = std::numbers::pi;
        for (std::size_t e = 0; e < eyes.size(); ++e) {
            outside = std::min(outside, angleOutside(sphere, eyes[e], cameras[e]));
        }
        // Most of a leaf is farther away than its nearest point.
        const double distance =
            std::max(distanceToBox(leaves_[l], middle) + 0.5 * sphere.radius, settings.nearest);
        const double size_px = focal_px * 2.0 * sphere.radius / distance;
        // A leaf without extent is a pixel somewhere.
        addSteps(l, std::max(size_px * size_px, 1.0), std::exp(-outside / settings.look_ahead_rad), settings,
                 there);
    }
    std::ranges::sort(steps_, [](const Step& a, const Step& b) {
        const auto key = [](const Step& step) {
            return std::tuple(step.order > 0, -step.worth, step.leaf, step.order);
        };
        return key(a) < key(b);
    });
    std::vector<std::uint32_t> taken(leaves_.size(), 0);  // how many of its steps
    std::ranges::fill(choices_.levels, LevelChoices::kNone);
    choices_.coarsest.clear();
    choices_.finer.clear();
    choices_.splats = choices_.pages = 0;
    for (const Step& step : steps_) {
        const bool fits =
            choices_.splats + step.splats <= settings.splats && choices_.pages + step.pages <= settings.pages;
        if (!fits || taken[step.leaf] != step.order) { continue; }
        ++taken[step.leaf];
        choices_.levels[step.leaf] = step.level;
        choices_.splats += step.splats;
        choices_.pages += step.pages;
        if (step.order < 2) {
            (step.order == 0 ? choices_.coarsest : choices_.finer).push_back({step.leaf, step.level});
        }
    }
    // The leaves that gain most by their first step are refined first; of the levels that they pass, only the
    // last is loaded.
    for (LeafLevel& one : choices_.finer) { one.level = choices_.levels[one.leaf]; }
    return choices_;
}

}  // namespace binosplat
