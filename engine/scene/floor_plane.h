// The floor of a scene that does not say where up is: the plane that most of its splats lie in, with the rest on one side.
#pragma once

#include "engine/scene/scene.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace binosplat {

// Some of the splats that can be seen, spread evenly over the file.
struct SplatSample {
    glm::dvec3 centre, normal;  // normal: along the shortest axis, of either sign
    double reach;               // two standard deviations of the longest axis
};
std::vector<SplatSample> sampleSplats(const Scene& scene, std::size_t most);

// The value that a share of `values` lies below, 0 to 1; there is at least one. Reorders them.
double findQuantile(std::vector<double>& values, double share);

struct FloorPlane {
    glm::dvec3 up;     // unit; the rest of the scene is on this side
    double height;     // dot(up, p) of its points
    double thickness;  // how far from it a splat may lie and still be of the floor
    double share;      // of the samples lie in it
    bool is_ceiling;   // `up` is right, but what was found is above the rest
    double behind;     // of the other samples lie beyond it
};

// Empty where there is none. Planes within 45 degrees of `usual` count for more: on another one things must stand, not hover before it as
// before a wall, and it must hold three times as many splats or, where there is none of these, three in ten and reach far beyond them.
std::optional<FloorPlane> findFloorPlane(const std::vector<SplatSample>& samples, const glm::dvec3& usual);

}  // namespace binosplat
