// Changes of axes, and extents that ignore what is far away.
#include "engine/places/lie.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace binosplat {

namespace {

Axes turned(const Axes& axes, double angle_rad) {
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    return {c * axes.right + s * axes.ahead, axes.up, c * axes.ahead - s * axes.right};
}

}  // namespace

Axes axesOf(const glm::dvec3& up, bool y_up) {
    // As if the scene had been turned about x: with y up it is seen from +z, with z up from -y.
    const double side = std::abs(up.y) > 0.7 ? -up.y : y_up ? -1.0 : 1.0;
    glm::dvec3 ahead(0.0, 0.0, std::copysign(1.0, side));
    ahead -= glm::dot(ahead, up) * up;
    if (glm::length(ahead) < 0.2) {
        ahead = std::copysign(1.0, up.z) * (glm::dvec3(0.0, 1.0, 0.0) - up.y * up);
    }
    ahead = glm::normalize(ahead);
    return {glm::normalize(glm::cross(ahead, up)), up, ahead};
}

Range rangeOf(std::vector<double> values, double beyond) {
    if (values.empty()) { return {0.0, 0.0}; }
    std::ranges::sort(values);
    const std::size_t cut = static_cast<std::size_t>(beyond * static_cast<double>(values.size()));
    return {values[cut], values[values.size() - 1 - cut]};
}

std::vector<SplatSample> coreOf(std::vector<SplatSample> samples) {
    if (samples.empty()) { return samples; }
    // Half of the splats stay at each step.
    constexpr double kFar = 4.0, kCore = 3.0;  // times the median distance
    for (int i = 0; i < 4; ++i) {
        glm::dvec3 middle;
        std::vector<double> values(samples.size());
        for (int axis = 0; axis < 3; ++axis) {
            std::ranges::transform(samples, values.begin(),
                                   [&](const SplatSample& sample) { return sample.centre[axis]; });
            middle[axis] = findQuantile(values, 0.5);
        }
        const auto distanceOf = [&](const SplatSample& sample) {
            return glm::distance(sample.centre, middle);
        };
        std::ranges::transform(samples, values.begin(), distanceOf);
        const double half = findQuantile(values, 0.5);
        if (!(half > 0.0) || findQuantile(values, 0.95) <= kFar * half) { break; }
        std::erase_if(samples, [&](const SplatSample& sample) { return distanceOf(sample) > kCore * half; });
    }
    return samples;
}

Lie lieOf(const std::vector<SplatSample>& samples, const Axes& axes, const std::optional<FloorPlane>& floor) {
    Lie lie{{}, {}, {}, 0.0, 0.0, floor && !floor->is_ceiling};
    for (const SplatSample& sample : samples) {
        const double h = glm::dot(sample.centre, axes.up);
        const bool is_floor = lie.has_floor && std::abs(h - floor->height) < 2.0 * floor->thickness;
        lie.spots.push_back({glm::dot(sample.centre, axes.right), h, glm::dot(sample.centre, axes.ahead),
                             sample.reach, is_floor});
    }
    lie.x = rangeOf(valuesOf(lie.spots, [](const Spot& s) { return std::optional(s.x); }), 0.05);
    lie.z = rangeOf(valuesOf(lie.spots, [](const Spot& s) { return std::optional(s.z); }), 0.05);
    const Range h = rangeOf(valuesOf(lie.spots, [](const Spot& s) { return std::optional(s.h); }), 0.04);
    lie.floor_h = lie.has_floor ? floor->height : h.low;
    lie.height = h.high - lie.floor_h;
    return lie;
}

Axes alongSides(const std::vector<SplatSample>& samples, const Axes& axes) {
    constexpr int kTurns = 18;
    const std::size_t step = samples.size() / 2048 + 1;
    Axes best = axes;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kTurns; ++i) {
        const Axes tried = turned(axes, 1.5707963267948966 * i / kTurns);
        std::vector<double> x, z;
        for (std::size_t j = 0; j < samples.size(); j += step) {
            x.push_back(glm::dot(samples[j].centre, tried.right)),
                z.push_back(glm::dot(samples[j].centre, tried.ahead));
        }
        const double area = rangeOf(std::move(x), 0.05).length() * rangeOf(std::move(z), 0.05).length();
        if (area < 0.98 * least) { least = area, best = tried; }
    }
    return best;
}

}  // namespace binosplat
