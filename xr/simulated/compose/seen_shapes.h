// Layers that surround the wearer, as one eye sees them: linear light and alpha where a pixel's ray meets
// them.
#pragma once

#include "xr/simulated/compose/compose.h"
#include "xr/simulated/compose/texels.h"

#include <glm/mat3x3.hpp>

#include <optional>
#include <vector>

namespace simulated {

// An eye's rays in a layer's axes.
struct LayerRays {
    glm::dvec3 eye;
    glm::dmat3 layer_from_eye;

    LayerRays(const EyeView& eye_view, const Pose& stage_from_layer);
};

class SeenCylinder {
public:
    SeenCylinder(const EyeView& eye, const CylinderLayer& layer);
    [[nodiscard]] std::optional<glm::dvec4> at(std::uint32_t x, std::uint32_t y,
                                               const glm::dvec3& direction_eye) const;

private:
    Sampler sampler_;
    LayerRays rays_;
    CylinderLayer layer_;
};

class SeenSphere {
public:
    SeenSphere(const EyeView& eye, const SphereLayer& layer);
    [[nodiscard]] std::optional<glm::dvec4> at(std::uint32_t x, std::uint32_t y,
                                               const glm::dvec3& direction_eye) const;

private:
    Sampler sampler_;
    LayerRays rays_;
    SphereLayer layer_;
};

class SeenCube {
public:
    SeenCube(const EyeView& eye, const CubeLayer& layer);
    [[nodiscard]] std::optional<glm::dvec4> at(std::uint32_t x, std::uint32_t y,
                                               const glm::dvec3& direction_eye) const;

private:
    std::vector<Sampler> faces_;
    LayerRays rays_;
};

}  // namespace simulated
