// Planes on which a scene may stand: many of its splats lie in each, with the rest on one side.
#pragma once

#include "engine/scene/scene.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace binosplat {

// A sample of the visible splats, spread evenly over the file.
struct SplatSample {
    glm::dvec3 centre, normal;  // normal: along the shortest axis, of either sign
    double reach;               // two standard deviations of the longest axis
};
std::vector<SplatSample> sampleSplats(const Scene& scene, std::size_t most);

// The value below which a share of `values` lies, 0 to 1; there must be at least one. Reorders them.
double findQuantile(std::vector<double>& values, double share);

struct FloorPlane {
    glm::dvec3 up;     // unit; the rest of the scene is on this side
    double height;     // dot(up, p) of its points
    double thickness;  // how far from the plane a splat may be to belong to the floor
    double share;      // of the samples lie in it
    bool is_ceiling;   // `up` is right, but the plane is above the rest
    double behind;     // of the other samples lie beyond it
};

// All planes, in any direction, that hold many of the splats and have most of the others on one side, taken
// as floors. Each is unlike the others; floor_choice.h chooses.
std::vector<FloorPlane> findPlanes(const std::vector<SplatSample>& samples);

}  // namespace binosplat
