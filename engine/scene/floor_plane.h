// Planes on which a scene may stand: each contains many of its splats and has the rest on one side.
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

// The value below which a share (0 to 1) of `values` lies; there must be at least one. Reorders them.
double findQuantile(std::vector<double>& values, double share);

struct FloorPlane {
    glm::dvec3 up;     // unit; the rest of the scene is on this side
    double height;     // dot(up, p) of its points
    double thickness;  // how far from the plane a splat may be to belong to the floor
    double share;      // of the samples that lie in it
    bool is_ceiling;   // `up` is right, but the plane is above the rest
    double behind;     // share of the other samples that lie beyond it
};

// All planes, in any direction, that contain many of the splats and have most of the others on one side, as
// possible floors. No two are alike; floor_choice.h chooses among them.
std::vector<FloorPlane> findPlanes(const std::vector<SplatSample>& samples);

}  // namespace binosplat
