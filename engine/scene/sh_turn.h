// Harmonics in other axes: each band is transformed within itself.
#pragma once

#include <glm/glm.hpp>

#include <array>

namespace binosplat {

class ShTurn {
public:
    // `target_from_source` is a rotation, perhaps mirrored.
    explicit ShTurn(const glm::dmat3& target_from_source);

    // Turns the bands 1 to `sh_degree` of one colour channel in place; `rest` begins with band 1.
    void apply(float* rest, int sh_degree) const;

private:
    // For each band, from 1 on: its (2 l + 1)^2 matrix, row by row.
    std::array<std::array<double, 49>, 3> bands_{};
};

}  // namespace binosplat
