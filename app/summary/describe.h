// A scene in numbers: for `info`, for the report, and for deciding which passes are not needed.
#pragma once

#include "engine/scene/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace binosplat {

struct SceneSummary {
    std::uint64_t splats = 0;
    glm::vec3 min_position{0.0f}, max_position{0.0f};  // of the centres; zero if the scene is empty
    int sh_degree = 0;
    bool gaussian_3d = false;  // otherwise all splats are discs
    // Splats with a non-zero coefficient in each SH band.
    std::array<std::uint64_t, kMaxShDegree + 1> splats_using_band{};
    // Quantiles 0, 0.05, 0.5, 0.95, 1 over the splats; scale is the longer axis, aspect the shorter over the
    // longer.
    std::array<float, 5> opacity_quantiles{}, scale_quantiles{}, aspect_quantiles{};
    std::uint64_t invisible_splats = 0;  // opacity under 1/255: never visible
    std::uint64_t host_bytes = 0;        // of the scene's arrays
    std::vector<std::string> left_out;   // what rendering this scene does not need, one phrase each
};
inline constexpr std::array<double, 5> kSummaryQuantiles{0.0, 0.05, 0.5, 0.95, 1.0};

// The quantiles of `values` at these shares, 0 to 1; zeros if there are no values. Reorders `values`.
template <std::size_t N>
std::array<float, N> findQuantiles(std::vector<float>& values, const std::array<double, N>& shares) {
    std::array<float, N> quantiles{};
    for (std::size_t i = 0; i < N && !values.empty(); ++i) {
        const auto rank =
            static_cast<std::ptrdiff_t>(std::llround(shares[i] * static_cast<double>(values.size() - 1)));
        std::nth_element(values.begin(), values.begin() + rank, values.end());
        quantiles[i] = values[static_cast<std::size_t>(rank)];
    }
    return quantiles;
}

// `notes` adds what was already skipped while loading.
SceneSummary describeScene(const Scene& scene, const LoadNotes* notes = nullptr);

// "1.5,20,-3": with four digits, or enough for thousandths of `size`.
std::string describePlace(const glm::dvec3& place, double size);

// Bytes of the scene's arrays on the host.
std::uint64_t sceneMemoryBytes(const Scene& scene);

}  // namespace binosplat
