// The lie of a scene's splats, in the wearer's axes (right, up and ahead), with the floor kept separate.
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
    [[nodiscard]] glm::dvec3 world(double x, double h, double z) const {
        return x * right + h * up + z * ahead;
    }
};

// The front of a scene is the side from which the wearer looks ahead.
Axes axesOf(const glm::dvec3& up, bool y_up);

struct Range {
    double low, high;
    [[nodiscard]] double middle() const { return 0.5 * (low + high); }
    [[nodiscard]] double length() const { return high - low; }
};
// The range without a share of the values at either end.
Range rangeOf(std::vector<double> values, double beyond);

// The scene's properties that do not depend on the standpoint.
struct Lie {
    std::vector<Spot> spots;
    Range x, z;              // of nine tenths of all
    double floor_h, height;  // of the floor, and of nineteen in twenty of the rest above it
    bool has_floor;
};

// The values of `of` over the spots for which it has one.
template <typename Of>
std::vector<double> valuesOf(const std::vector<Spot>& spots, const Of& of) {
    std::vector<double> values;
    for (const Spot& spot : spots) {
        if (const std::optional<double> value = of(spot)) { values.push_back(*value); }
    }
    return values;
}

// Without what is far beyond the rest, such as hills and sky: a landscape has more of that than of the place
// where one stands.
std::vector<SplatSample> coreOf(std::vector<SplatSample> samples);

Lie lieOf(const std::vector<SplatSample>& samples, const Axes& axes, const std::optional<FloorPlane>& floor);

// Along the scene's own sides: the vertical box with the smallest base.
Axes alongSides(const std::vector<SplatSample>& samples, const Axes& axes);

}  // namespace binosplat
