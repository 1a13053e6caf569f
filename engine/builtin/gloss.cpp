// A reflection maps each SH band onto itself, so the mirrored room is exactly of degree 3 if the room is; and
// a product of two functions of degree 3 is integrated exactly by 4 Gauss-Legendre rings of 8 points each.
#include "engine/builtin/gloss.h"

#include <cmath>
#include <numbers>

namespace binosplat::builtin {

namespace {

struct Quadrature {
    std::array<glm::vec3, 32> directions;
    std::array<float, 32> weights;  // sum to 4 pi
    std::array<std::array<float, 16>, 32> sh;
};

Quadrature makeQuadrature() {
    constexpr std::array<float, 4> kNodes{-0.8611363116f, -0.3399810436f, 0.3399810436f, 0.8611363116f};
    constexpr std::array<float, 4> kWeights{0.3478548451f, 0.6521451549f, 0.6521451549f, 0.3478548451f};
    Quadrature result;
    for (std::size_t ring = 0; ring < 4; ++ring) {
        for (std::size_t i = 0; i < 8; ++i) {
            const float angle = std::numbers::pi_v<float> / 4.0f * (static_cast<float>(i) + 0.5f),
                        radius = std::sqrt(1.0f - kNodes[ring] * kNodes[ring]);
            const std::size_t at = ring * 8 + i;
            result.directions[at] = {radius * std::cos(angle), radius * std::sin(angle), kNodes[ring]};
            result.weights[at] = kWeights[ring] * std::numbers::pi_v<float> / 4.0f;
            result.sh[at] = evaluateSh(result.directions[at]);
        }
    }
    return result;
}

// A smooth lobe of degree 3 about an axis: ((1 + t) / 2)^3, which is 1 ahead and falls to a half at 54
// degrees.
float lobe(const glm::vec3& direction, const glm::vec3& axis) {
    const float t = 0.5f + 0.5f * glm::dot(direction, axis);
    return t * t * t;
}
// A narrower lobe: a Legendre sum whose weights fall off, so that it hardly rings (down to -0.08 behind the
// axis).
float sharpLobe(const glm::vec3& direction, const glm::vec3& axis) {
    const float t = glm::dot(direction, axis);
    const float p2 = 1.5f * t * t - 0.5f, p3 = 2.5f * t * t * t - 1.5f * t;
    return (1.0f + 2.6f * t + 3.3f * p2 + 2.4f * p3) / 9.3f;
}

}  // namespace

std::array<float, 16> evaluateSh(const glm::vec3& d) {
    const float x = d.x, y = d.y, z = d.z, xx = x * x, yy = y * y, zz = z * z;
    return {0.28209479f,
            -0.48860251f * y,
            0.48860251f * z,
            -0.48860251f * x,
            1.09254843f * x * y,
            -1.09254843f * y * z,
            0.31539157f * (2.0f * zz - xx - yy),
            -1.09254843f * x * z,
            0.54627422f * (xx - yy),
            -0.59004359f * y * (3.0f * xx - yy),
            2.89061144f * x * y * z,
            -0.45704579f * y * (4.0f * zz - xx - yy),
            0.37317633f * z * (2.0f * zz - 3.0f * xx - 3.0f * yy),
            -0.45704579f * x * (4.0f * zz - xx - yy),
            1.44530572f * z * (xx - yy),
            -0.59004359f * x * (xx - 3.0f * yy)};
}

std::array<glm::vec3, 16> projectGloss(const glm::vec3& point, const glm::vec3& normal,
                                       const glm::vec3& window, const glm::vec3& lamp) {
    static const Quadrature kQuadrature = makeQuadrature();
    const glm::vec3 to_window = glm::normalize(window - point), to_lamp = glm::normalize(lamp - point),
                    up(0.0f, -1.0f, 0.0f);
    const glm::vec3 to_skylight =
        // A second bright spot, behind the user's left shoulder.
        glm::normalize(glm::vec3(-0.75f, -0.75f, -0.6f));
    std::array<glm::vec3, 16> sh{};
    for (std::size_t i = 0; i < kQuadrature.directions.size(); ++i) {
        const glm::vec3 mirrored = glm::reflect(kQuadrature.directions[i], normal);
        const glm::vec3 shine = glm::vec3(0.60f, 0.66f, 0.72f) * sharpLobe(mirrored, to_window) +
                                glm::vec3(0.22f, 0.14f, 0.06f) * sharpLobe(mirrored, to_lamp) +
                                glm::vec3(0.34f, 0.33f, 0.32f) * sharpLobe(mirrored, to_skylight) +
                                glm::vec3(0.10f, 0.10f, 0.11f) * lobe(mirrored, up);
        for (std::size_t k = 0; k < 16; ++k) {
            sh[k] += shine * (kQuadrature.weights[i] * kQuadrature.sh[i][k]);
        }
    }
    return sh;
}

}  // namespace binosplat::builtin
