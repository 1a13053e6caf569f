// Counts a scene's splats: those that cost time without being visible, and those that are probably rubbish.
#pragma once

#include "engine/scene/scene.h"

#include <cstdint>

namespace binosplat {

struct SceneSurvey {
    // The longest side of the box that holds the middle 90 % of the centres along each axis: sky and floaters
    // do not count.
    double size = 0.0;
    std::uint64_t transparent = 0;  // opacity under 1/255: they never reach a pixel
    std::uint64_t opaque = 0;       // over 99 %
    // The shortest axis of 3D Gaussians, or the shorter axis of discs, is under kThinMetres.
    std::uint64_t thin = 0;
    std::uint64_t large = 0;  // the longest axis is over kLargeShare of the size
    // Visible splats, no longer than a cell, with fewer than kFewNeighbours in the cells around them,
    // counting themselves. A cell is kCellShare of the size wide.
    std::uint64_t floaters = 0;
    glm::dvec3 middle{0.0};    // the median of the centres, along each axis
    double half_radius = 0.0;  // half of the splats are within it
};
inline constexpr double kThinMetres = 0.001, kLargeShare = 0.1, kCellShare = 0.02;
inline constexpr std::uint64_t kFewNeighbours = 5;

// Lengths of splats are standard deviations.
SceneSurvey surveyScene(const Scene& scene, double metres_per_unit = 1.0);

}  // namespace binosplat
