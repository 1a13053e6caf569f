// A scene in numbers: for `info`, for the report, and for choosing which passes to leave out.
#pragma once

#include "engine/scene/scene.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace binosplat {

struct SceneSummary {
    std::uint64_t splats = 0;
    glm::vec3 min_position{0.0f}, max_position{0.0f};  // of the centres; zero if the scene is empty
    int sh_degree = 0;
    bool gaussian_3d = false;                                         // otherwise all splats are discs
    std::array<std::uint64_t, kMaxShDegree + 1> splats_using_band{};  // splats with a non-zero coefficient in each SH band
    // Quantiles 0, 0.05, 0.5, 0.95, 1 over the splats; scale is the longer axis, aspect the shorter over the longer.
    std::array<float, 5> opacity_quantiles{}, scale_quantiles{}, aspect_quantiles{};
    std::uint64_t invisible_splats = 0;  // opacity under 1/255: they never reach a pixel
    std::uint64_t host_bytes = 0;        // of the scene's arrays
    std::vector<std::string> left_out;   // what rendering this scene does not need, one phrase each
};
inline constexpr std::array<double, 5> kSummaryQuantiles{0.0, 0.05, 0.5, 0.95, 1.0};

// `notes` adds what loading has already left out.
SceneSummary describeScene(const Scene& scene, const LoadNotes* notes = nullptr);

// "1.5,20,-3": with four digits, or enough for thousandths of `size`.
std::string describePlace(const glm::dvec3& place, double size);

// Bytes of the scene's arrays on the host.
std::uint64_t sceneMemoryBytes(const Scene& scene);

}  // namespace binosplat
