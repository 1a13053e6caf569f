// Singular values of the transformed axes, by one-sided Jacobi rotations.
#include "engine/scene/placed_splat.h"

#include <algorithm>
#include <cmath>

namespace binosplat {

namespace {

// How far a rotation from a single-precision file may be from an exact one.
constexpr double kAlike = 1e-5;

// A unit vector at right angles to a unit vector.
glm::dvec3 anyNormal(const glm::dvec3& v) {
    const glm::dvec3 other = std::abs(v.x) < 0.6 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
    return glm::normalize(glm::cross(v, other));
}

}  // namespace

bool isSimilarity(const glm::dmat3& matrix) {
    const glm::dmat3 squares = glm::transpose(matrix) * matrix;
    const double square = (squares[0][0] + squares[1][1] + squares[2][2]) / 3.0;
    for (int i = 0; i < 9; ++i) {
        if (!(std::abs(squares[i / 3][i % 3] - (i % 4 == 0 ? square : 0.0)) <= kAlike * square)) {
            return false;
        }
    }
    return square > 0.0;
}

glm::dmat3 nearestRotation(const glm::dmat3& matrix) {
    // Newton's iteration (Higham 1986); it would need some steps for the scale of a similarity alone.
    glm::dmat3 q = matrix / std::cbrt(std::abs(glm::determinant(matrix)));
    for (int step = 0; step < 60; ++step) {
        const glm::dmat3 next = 0.5 * (q + glm::transpose(glm::inverse(q)));
        double change = 0.0;
        for (int i = 0; i < 9; ++i) {
            change = std::max(change, std::abs(next[i / 3][i % 3] - q[i / 3][i % 3]));
        }
        q = next;
        if (change < 1e-15) { break; }
    }
    return q;
}

Ellipsoid place(const glm::dmat3& matrix, const Ellipsoid& ellipsoid) {
    // The ellipsoid is the unit ball under the columns of `axes`, and stays the same whatever rotation is
    // applied first.
    glm::dmat3 axes = matrix * glm::mat3_cast(ellipsoid.rotation);
    for (int i = 0; i < 3; ++i) { axes[i] *= ellipsoid.scales[i]; }
    for (int sweep = 0; sweep < 40; ++sweep) {
        bool changed = false;
        for (const auto& [a, b] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)}) {
            const double aa = glm::dot(axes[a], axes[a]), bb = glm::dot(axes[b], axes[b]),
                         ab = glm::dot(axes[a], axes[b]);
            if (std::abs(ab) <= 1e-15 * std::sqrt(aa * bb)) { continue; }
            changed = true;
            const double ratio = (bb - aa) / (2.0 * ab),
                         tangent = std::copysign(1.0, ratio) / (std::abs(ratio) + std::hypot(1.0, ratio));
            const double cosine = 1.0 / std::hypot(1.0, tangent), sine = cosine * tangent;
            const glm::dvec3 old = axes[a];
            axes[a] = cosine * old - sine * axes[b];
            axes[b] = sine * old + cosine * axes[b];
        }
        if (!changed) { break; }
    }
    Ellipsoid placed{};
    glm::dmat3 directions(0.0);
    int known = 0;
    for (int i = 0; i < 3; ++i) {
        placed.scales[i] = glm::length(axes[i]);
        if (!(placed.scales[i] > 0.0)) { continue; }
        directions[i] = axes[i] / placed.scales[i];
        ++known;
    }
    // Axes without extent get the directions that the others leave.
    if (known == 0) { directions = glm::dmat3(1.0); }
    for (int i = 0; i < 3 && known > 0; ++i) {
        const int next = (i + 1) % 3, after = (i + 2) % 3;
        if (placed.scales[i] > 0.0) { continue; }
        const bool has_next = directions[next] != glm::dvec3(0.0),
                   has_after = directions[after] != glm::dvec3(0.0);
        directions[i] = has_next && has_after ? glm::cross(directions[next], directions[after])
                                              : anyNormal(directions[has_next ? next : after]);
    }
    if (glm::determinant(directions) < 0.0) { directions[2] = -directions[2]; }  // an axis has no sign
    placed.rotation = glm::normalize(glm::quat_cast(directions));
    return placed;
}

}  // namespace binosplat
