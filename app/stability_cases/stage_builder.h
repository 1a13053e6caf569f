// Small scenes given in the axes of an eye that is itself moved and turned: nothing about them is aligned
// with the world.
#pragma once

#include "app/stability_cases/catalogue.h"

#include <cstdint>
#include <random>

namespace binosplat::stability {

// The same numbers on every machine.
class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}
    double between(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_() >> 8) / 16777216.0;
    }
    glm::dvec3 colour() { return {between(0.0, 1.0), between(0.0, 1.0), between(0.0, 1.0)}; }
    glm::dvec3 direction();

private:
    std::mt19937 engine_;
};

// A disc, or a 3D Gaussian, in camera space. t_u and t_v are made orthonormal, t_u keeps its direction.
struct Disc {
    glm::dvec3 centre{0.0, 0.0, 2.0};
    glm::dvec3 t_u{1.0, 0.0, 0.0}, t_v{0.0, 1.0, 0.0};
    glm::dvec2 scale{0.1};
    double thickness = 0.0;  // along t_u x t_v; of 3D Gaussians
    double opacity = 0.8;
    glm::dvec3 colour{0.5};
};

inline constexpr glm::uvec2 kSizePx{96, 64};

class StageBuilder {
public:
    // An eye at `position_world`, turned, that sees 60 degrees; the eyes stand 0.063 apart.
    explicit StageBuilder(glm::uvec2 size_px = kSizePx, double fov_x_deg = 60.0,
                          const glm::dvec3& position_world = {0.3, -0.2, 0.1});
    void add(const Disc& disc);
    // A wall of overlapping opaque discs `depth` in front of the eye, patterned, and a little wider than the
    // view.
    void addWall(double depth = 4.0);
    // Discs of all directions between the eye and the wall.
    void addClutter(int count, unsigned seed);
    void setEyeDistance(double distance, double canting_rad = 0.0);

    Scene scene;
    Stage finish();           // of discs
    Stage finishGaussians();  // of 3D Gaussians

    Eye middle;
    double near = 0.2;

private:
    std::array<Eye, 2> eyes_;
    std::vector<float> thicknesses_;
};

// A wall with some clutter in front of it.
StageBuilder makeDiscRoom(glm::uvec2 size_px = kSizePx);
// Somewhere in view between the wall and the eye.
Disc placeDisc(Random& random, double nearest = 0.8);

// Of a disc that is seen: its normal is all but perpendicular to the line of sight, and to the line between
// the eyes.
void layAlongSight(Disc& disc, double angle_rad);
// In any direction.
void turnAnyhow(Disc& disc, Random& random);

}  // namespace binosplat::stability
