// Splats under a transform that need not be rigid: a Gaussian remains a Gaussian, since its covariance is
// transformed with it.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace binosplat {

struct Ellipsoid {
    glm::dquat rotation;  // its columns are the axes
    glm::dvec3 scales;    // of the axes, not negative
};

// True if a matrix is a rotation, perhaps mirrored, times one scale for all directions.
bool isSimilarity(const glm::dmat3& matrix);

// The rotation, perhaps mirrored, that is nearest to an invertible matrix: the orthogonal part of its polar
// decomposition.
glm::dmat3 nearestRotation(const glm::dmat3& matrix);

// The image of an ellipsoid with a unit rotation under `matrix`.
Ellipsoid place(const glm::dmat3& matrix, const Ellipsoid& ellipsoid);

}  // namespace binosplat
