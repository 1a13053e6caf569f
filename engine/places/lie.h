// The lie of a scene's splats: in axes of the wearer's own, right, up and ahead, with the floor apart.
#pragma once

#include "engine/scene/floor_plane.h"

#include <glm/glm.hpp>

#include <optional>
#include <vector>

namespace binosplat {

// A sample in the wearer's axes.
struct Spot {
    double x, h, z;  // right, up, ahead
    double reach;
    bool is_floor;
};

struct Axes {
    glm::dvec3 right, up, ahead;
    [[nodiscard]] glm::dvec3 world(double x, double h, double z) const { return x * right + h * up + z * ahead; }
};

// The front of a scene is where one looks ahead from.
Axes axesOf(const glm::dvec3& up, bool y_up);

struct Range {
    double low, high;
    [[nodiscard]] double middle() const { return 0.5 * (low + high); }
    [[nodiscard]] double length() const { return high - low; }
};
// Without a share of the values at either end.
Range rangeOf(std::vector<double> values, double beyond);

// The scene's properties that do not depend on the standpoint.
struct Lie {
    std::vector<Spot> spots;
    Range x, z;              // nine tenths of all
    double floor_h, height;  // of the floor, and of nineteen in twenty of the rest above it
    bool has_floor;
};

// What `of` says of each spot, if it does.
template <typename Of>
std::vector<double> valuesOf(const std::vector<Spot>& spots, const Of& of) {
    std::vector<double> values;
    for (const Spot& spot : spots) {
        if (const std::optional<double> value = of(spot)) { values.push_back(*value); }
    }
    return values;
}

// Without what lies far beyond the rest, such as hills and sky: a landscape has more of it than of what one stands in.
std::vector<SplatSample> coreOf(std::vector<SplatSample> samples);

Lie lieOf(const std::vector<SplatSample>& samples, const Axes& axes, const std::optional<FloorPlane>& floor);

// Along the scene's own sides: those about the vertical with the smallest box.
Axes alongSides(const std::vector<SplatSample>& samples, const Axes& axes);

}  // namespace binosplat
