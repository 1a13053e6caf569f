// Counting over a scene.
#include "app/summary/describe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace binosplat {

namespace {

void countBands(const Scene& scene, SceneSummary& summary) {
    const auto width = static_cast<std::size_t>(3 * shCoefficientCount(scene.sh_degree));
    for (std::size_t splat = 0; splat < scene.size(); ++splat) {
        const float* sh = scene.sh.data() + splat * width;
        for (int band = 0; band <= scene.sh_degree; ++band) {
            const float* begin = sh + 3 * band * band;
            const bool used = std::any_of(begin, sh + 3 * shCoefficientCount(band),
                                          [](float value) { return value != 0.0f; });
            summary.splats_using_band[static_cast<std::size_t>(band)] += used;
        }
    }
}

void listLeftOut(const LoadNotes* notes, SceneSummary& summary) {
    if (summary.sh_degree < kMaxShDegree) {
        summary.left_out.push_back(fmt::format("SH bands {} to {}", summary.sh_degree + 1, kMaxShDegree));
        if (notes != nullptr && notes->sh_degree_in_file > summary.sh_degree) {
            summary.left_out.back() += notes->sh_limited ? " (as asked)" : " (in the file, but zero)";
        }
    }
    if (summary.invisible_splats > 0) {
        summary.left_out.push_back(fmt::format("{} splats of opacity under 1/255", summary.invisible_splats));
    }
    if (notes == nullptr) { return; }
    if (notes->three_scales && !summary.gaussian_3d) {
        summary.left_out.emplace_back("the shortest axis of each splat");
    }
    const std::uint64_t broken = notes->skipped_not_finite + notes->skipped_zero_rotation;
    if (broken > 0) { summary.left_out.push_back(fmt::format("{} broken splats", broken)); }
}

}  // namespace

std::string describePlace(const glm::dvec3& place, double size) {
    const auto digitsOf = [&](double value) {
        const double more = size > 0.0 && value != 0.0 ? std::ceil(std::log10(std::abs(value) / size)) : 0.0;
        return static_cast<int>(std::clamp(4.0 + more, 4.0, 17.0));
    };
    return fmt::format("{:.{}g},{:.{}g},{:.{}g}", place.x, digitsOf(place.x), place.y, digitsOf(place.y),
                       place.z, digitsOf(place.z));
}

std::uint64_t sceneMemoryBytes(const Scene& scene) {
    return scene.positions.size() * sizeof(glm::vec3) + scene.rotations.size() * sizeof(glm::quat) +
           scene.scales.size() * sizeof(glm::vec2) +
           (scene.thicknesses.size() + scene.opacities.size() + scene.sh.size()) * sizeof(float);
}

SceneSummary describeScene(const Scene& scene, const LoadNotes* notes) {
    SceneSummary summary;
    summary.splats = scene.size();
    summary.sh_degree = scene.sh_degree;
    summary.gaussian_3d = scene.isGaussian3d();
    summary.host_bytes = sceneMemoryBytes(scene);
    if (scene.size() > 0) { summary.min_position = summary.max_position = scene.positions[0]; }
    for (const glm::vec3& position : scene.positions) {
        summary.min_position = glm::min(summary.min_position, position);
        summary.max_position = glm::max(summary.max_position, position);
    }
    countBands(scene, summary);

    std::vector<float> values = scene.opacities;
    summary.invisible_splats = static_cast<std::uint64_t>(
        std::count_if(values.begin(), values.end(), [](float o) { return o < 1.0f / 255.0f; }));
    summary.opacity_quantiles = findQuantiles(values, kSummaryQuantiles);
    for (std::size_t i = 0; i < scene.size(); ++i) {
        values[i] = std::max(scene.scales[i].x, scene.scales[i].y);
    }
    summary.scale_quantiles = findQuantiles(values, kSummaryQuantiles);
    for (std::size_t i = 0; i < scene.size(); ++i) {
        const float longer = std::max(scene.scales[i].x, scene.scales[i].y);
        values[i] = longer > 0.0f ? std::min(scene.scales[i].x, scene.scales[i].y) / longer : 1.0f;
    }
    summary.aspect_quantiles = findQuantiles(values, kSummaryQuantiles);
    listLeftOut(notes, summary);
    return summary;
}

}  // namespace binosplat
