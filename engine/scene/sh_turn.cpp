// The matrix of a band, from values in directions all around. A function f of the band, seen in the target's
// axes, is f(source_from_target d), which is again in the band. So its coefficients follow exactly from at
// least as many values as it has coefficients.
#include "engine/scene/sh_turn.h"

#include "engine/scene/sh_basis.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace binosplat {

namespace {

constexpr int kDirections = 48;

// Evenly spread: a spiral whose turns advance by the golden angle.
glm::dvec3 spiralDirection(int i) {
    const double z = 1.0 - (2.0 * i + 1.0) / kDirections, radius = std::sqrt(1.0 - z * z),
                 angle = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
    return {radius * std::cos(angle), radius * std::sin(angle), z};
}

// Solves a x = b for all columns of b by elimination with pivots. `a` is nearly a multiple of the identity.
void solve(std::array<std::array<double, 7>, 7>& a, std::array<std::array<double, 7>, 7>& b, std::size_t n) {
    for (std::size_t column = 0; column < n; ++column) {
        std::size_t pivot = column;
        for (std::size_t row = column + 1; row < n; ++row) {
            if (std::abs(a[row][column]) > std::abs(a[pivot][column])) { pivot = row; }
        }
        std::swap(a[column], a[pivot]);
        std::swap(b[column], b[pivot]);
        for (std::size_t row = 0; row < n; ++row) {
            if (row == column) { continue; }
            const double factor = a[row][column] / a[column][column];
            for (std::size_t i = 0; i < n; ++i) {
                a[row][i] -= factor * a[column][i], b[row][i] -= factor * b[column][i];
            }
        }
    }
    for (std::size_t row = 0; row < n; ++row) {
        for (std::size_t i = 0; i < n; ++i) { b[row][i] /= a[row][row]; }
    }
}

}  // namespace

ShTurn::ShTurn(const glm::dmat3& target_from_source) {
    const glm::dmat3 source_from_target = glm::transpose(target_from_source);
    for (std::size_t band = 1; band <= 3; ++band) {
        const std::size_t n = 2 * band + 1, first = band * band;
        // Normal equations: (T^t T) matrix = T^t S, where T and S hold the band in each direction in both
        // axes.
        std::array<std::array<double, 7>, 7> squares{}, products{};
        for (int i = 0; i < kDirections; ++i) {
            const glm::dvec3 d = spiralDirection(i);
            const std::array<double, 16> in_target = shBasis(d), in_source = shBasis(source_from_target * d);
            for (std::size_t row = 0; row < n; ++row) {
                for (std::size_t column = 0; column < n; ++column) {
                    squares[row][column] += in_target[first + row] * in_target[first + column];
                    products[row][column] += in_target[first + row] * in_source[first + column];
                }
            }
        }
        solve(squares, products, n);
        for (std::size_t row = 0; row < n; ++row) {
            for (std::size_t column = 0; column < n; ++column) {
                bands_[band - 1][row * n + column] = products[row][column];
            }
        }
    }
}

void ShTurn::apply(float* rest, int sh_degree) const {
    for (std::size_t band = 1; band <= static_cast<std::size_t>(sh_degree); ++band) {
        const std::size_t n = 2 * band + 1;
        float* values = rest + band * band - 1;
        std::array<double, 7> turned{};
        for (std::size_t row = 0; row < n; ++row) {
            for (std::size_t column = 0; column < n; ++column) {
                turned[row] += bands_[band - 1][row * n + column] * static_cast<double>(values[column]);
            }
        }
        for (std::size_t row = 0; row < n; ++row) { values[row] = static_cast<float>(turned[row]); }
    }
}

}  // namespace binosplat
