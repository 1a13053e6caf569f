// Tries planes through one splat along its face and planes through three splats, and fits the best ones to
// the splats near them.
#include "engine/scene/floor_plane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

namespace binosplat {

namespace {

constexpr int kTries = 1500;                // of either kind
constexpr std::size_t kFewForFloor = 256;   // fewer do not make a floor
constexpr std::size_t kMostAtFirst = 2048;  // samples by which each try is judged
constexpr std::size_t kKept = 12;           // tries that are fitted
constexpr double kAlikeCosine = 0.9962;     // 5 degrees
constexpr double kThickness = 0.01;         // of the size, to each side
constexpr double kLeastShare = 0.08;        // of all splats
constexpr double kMostBehind = 0.15;        // of the others
// Share of the size: the standard deviation of a corridor that is an eighth as wide as it is long.
constexpr double kLeastAcross = 0.03;

struct Plane {
    glm::dvec3 normal{0.0};
    double height = 0.0;
    std::size_t inliers = 0;
};

// The diagonal of the box with nine tenths of the samples along each axis; and the middle of all samples.
double sizeOf(const std::vector<SplatSample>& samples, glm::dvec3& middle) {
    glm::dvec3 sides(0.0);
    std::vector<double> values(samples.size());
    for (int axis = 0; axis < 3; ++axis) {
        std::ranges::transform(samples, values.begin(),
                               [&](const SplatSample& sample) { return sample.centre[axis]; });
        const double low = findQuantile(values, 0.05);
        sides[axis] = findQuantile(values, 0.95) - low;
        middle[axis] = findQuantile(values, 0.5);
    }
    return glm::length(sides);
}

std::size_t countIn(const std::vector<SplatSample>& samples, std::size_t step, const Plane& plane,
                    double thickness) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < samples.size(); i += step) {
        count += std::abs(glm::dot(samples[i].centre, plane.normal) - plane.height) < thickness;
    }
    return count;
}

// The direction in which points with this covariance spread least: two steps of (trace - covariance)^n leave
// it of `near`.
glm::dvec3 leastSpread(const glm::dmat3& covariance, const glm::dvec3& near) {
    const double trace = covariance[0][0] + covariance[1][1] + covariance[2][2];
    if (!(trace > 0.0)) { return near; }
    glm::dmat3 power = (glm::dmat3(1.0) * trace - covariance) / trace;
    for (int i = 0; i < 8; ++i) {
        power = power * power;
        power /= std::max(power[0][0] + power[1][1] + power[2][2], 1e-300);
    }
    const glm::dvec3 found = power * near;
    return glm::length(found) > 1e-9 ? glm::normalize(found) : near;
}

// Fits to the splats near the plane, farther ones first: where walls begin at the floor, the splats nearest
// to the plane are all the floor's.
Plane fit(const std::vector<SplatSample>& samples, Plane plane, double thickness) {
    for (const double near : {2.0 * thickness, thickness, thickness, 0.5 * thickness, 0.5 * thickness,
                              0.25 * thickness, 0.25 * thickness}) {
        glm::dvec3 sum(0.0);
        std::vector<glm::dvec3> inside;
        for (const SplatSample& sample : samples) {
            if (std::abs(glm::dot(sample.centre, plane.normal) - plane.height) < near) {
                inside.push_back(sample.centre), sum += sample.centre;
            }
        }
        if (inside.size() < 3) { break; }
        const glm::dvec3 mean = sum / static_cast<double>(inside.size());
        glm::dmat3 covariance(0.0);
        for (const glm::dvec3& point : inside) {
            covariance += glm::outerProduct(point - mean, point - mean);
        }
        plane.normal = leastSpread(covariance, plane.normal);
        plane.height = glm::dot(mean, plane.normal);
    }
    plane.inliers = countIn(samples, 1, plane, thickness);
    return plane;
}

std::vector<Plane> tryPlanes(const std::vector<SplatSample>& samples, double thickness) {
    std::mt19937 random(1);
    const auto pick = [&]() -> const SplatSample& { return samples[random() % samples.size()]; };
    const std::size_t step = samples.size() / kMostAtFirst + 1;
    std::vector<Plane> tried;
    for (int i = 0; i < 2 * kTries; ++i) {
        const SplatSample& first = pick();
        glm::dvec3 normal = first.normal;
        if (i % 2 == 1) {
            const SplatSample& second = pick();
            normal = glm::cross(second.centre - first.centre, pick().centre - first.centre);
            if (!(glm::length(normal) > 0.0)) { continue; }
            normal = glm::normalize(normal);
        }
        Plane plane{normal, glm::dot(normal, first.centre)};
        plane.inliers = countIn(samples, step, plane, thickness);
        tried.push_back(plane);
    }
    return tried;
}

bool isLike(const Plane& a, const Plane& b, const glm::dvec3& middle, double thickness) {
    const double side = glm::dot(a.normal, b.normal) < 0.0 ? -1.0 : 1.0;
    const double apart = glm::dot(a.normal - side * b.normal, middle) - a.height + side * b.height;
    return side * glm::dot(a.normal, b.normal) > kAlikeCosine && std::abs(apart) < 2.0 * thickness;
}

// Those with the most splats, no two alike: a table full of things is tried a hundred times before the ground
// beneath it.
std::vector<Plane> bestOf(std::vector<Plane> tried, std::size_t most, const glm::dvec3& middle,
                          double thickness) {
    std::ranges::sort(tried, std::greater<>(), &Plane::inliers);
    std::vector<Plane> kept;
    for (const Plane& plane : tried) {
        if (kept.size() == most) { break; }
        if (std::ranges::none_of(
                kept, [&](const Plane& other) { return isLike(plane, other, middle, thickness); })) {
            kept.push_back(plane);
        }
    }
    return kept;
}

// Empty if splats are on both sides, or if the plane is a strip.
std::optional<FloorPlane> asFloor(const std::vector<SplatSample>& samples, const Plane& plane, double size,
                                  double thickness) {
    std::size_t above = 0, below = 0;
    glm::dvec3 sum(0.0);
    for (const SplatSample& sample : samples) {
        const double height = glm::dot(sample.centre, plane.normal) - plane.height;
        above += height > 2.0 * thickness;
        below += height < -2.0 * thickness;
        if (std::abs(height) < thickness) { sum += sample.centre; }
    }
    const double share = static_cast<double>(plane.inliers) / static_cast<double>(samples.size());
    const std::size_t others = above + below, behind = std::min(above, below);
    if (share < kLeastShare || others == 0 ||
        static_cast<double>(behind) > kMostBehind * static_cast<double>(others)) {
        return std::nullopt;
    }
    const glm::dvec3 mean = sum / static_cast<double>(plane.inliers);
    glm::dmat3 covariance(0.0);
    for (const SplatSample& sample : samples) {
        if (std::abs(glm::dot(sample.centre, plane.normal) - plane.height) >= thickness) { continue; }
        covariance += glm::outerProduct(sample.centre - mean, sample.centre - mean) /
                      static_cast<double>(plane.inliers);
    }
    // The smaller spread within the plane: what remains after the larger one's share.
    const double trace = covariance[0][0] + covariance[1][1] + covariance[2][2];
    glm::dvec3 longest = glm::dvec3(0.3, 0.5, 0.8);
    for (int i = 0; i < 32; ++i) { longest = glm::normalize(covariance * longest + 1e-300); }
    const double across = trace - glm::dot(longest, covariance * longest);
    if (across < kLeastAcross * kLeastAcross * size * size) { return std::nullopt; }
    const bool rest_is_above = above >= below;
    const glm::dvec3 up = rest_is_above ? plane.normal : -plane.normal;
    return FloorPlane{up,        rest_is_above ? plane.height : -plane.height,
                      thickness, share,
                      false,     static_cast<double>(behind) / static_cast<double>(others)};
}

}  // namespace

std::vector<SplatSample> sampleSplats(const Scene& scene, std::size_t most) {
    std::vector<SplatSample> samples;
    const std::size_t step = scene.size() / most + 1;
    for (std::size_t begin = 0; begin < scene.size(); begin += step) {
        // One out of each `step`, but not always the same one, since files have an order.
        std::uint64_t mixed = (begin / step + 1) * 0x9e3779b97f4a7c15u;
        mixed ^= mixed >> 32;
        const std::size_t i = std::min<std::size_t>(begin + mixed % step, scene.size() - 1);
        if (i < scene.opacities.size() && scene.opacities[i] < 1.0f / 255.0f) { continue; }
        const glm::vec2 scale = i < scene.scales.size() ? scene.scales[i] : glm::vec2(0.0f);
        const glm::dquat turn =
            i < scene.rotations.size() ? glm::dquat(scene.rotations[i]) : glm::dquat(1.0, 0.0, 0.0, 0.0);
        samples.push_back({glm::dvec3(scene.positions[i]), turn * glm::dvec3(0.0, 0.0, 1.0),
                           2.0 * static_cast<double>(std::max(scale.x, scale.y))});
    }
    return samples;
}

double findQuantile(std::vector<double>& values, double share) {
    const auto rank =
        static_cast<std::ptrdiff_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
}

std::vector<FloorPlane> findPlanes(const std::vector<SplatSample>& samples) {
    if (samples.size() < kFewForFloor) { return {}; }
    glm::dvec3 middle;
    const double size = sizeOf(samples, middle), thickness = kThickness * size;
    if (!(size > 0.0) || !std::isfinite(size)) { return {}; }
    // The best planes are kept separately for each of the axes: elsewhere there may be many tries that are
    // better but are not floors.
    std::array<std::vector<Plane>, 3> about;
    for (const Plane& plane : tryPlanes(samples, thickness)) {
        const glm::dvec3 along = glm::abs(plane.normal);
        about[along.x > along.y && along.x > along.z ? 0 : along.y > along.z ? 1 : 2].push_back(plane);
    }
    std::vector<Plane> fitted;
    for (std::vector<Plane>& planes : about) {
        for (const Plane& plane : bestOf(std::move(planes), kKept, middle, thickness)) {
            fitted.push_back(fit(samples, plane, thickness));
        }
    }
    std::vector<FloorPlane> found;
    for (const Plane& plane : bestOf(std::move(fitted), 3 * kKept, middle, thickness)) {
        if (const std::optional<FloorPlane> floor = asFloor(samples, plane, size, thickness)) {
            found.push_back(*floor);
        }
    }
    return found;
}

}  // namespace binosplat
