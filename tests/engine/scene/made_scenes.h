// Made scenes to stand in: rooms, streets, objects and what surrounds them.
#pragma once

#include "engine/scene/standpoint.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace binosplat::test {

inline const glm::dvec3 kUp(0, -1, 0);

// Scenes in metres, y down: the floor is y = 0.
class Maker {
public:
    // A rectangle of splats: its corner and two sides, splats evenly at random, facing its normal.
    Maker& wall(const glm::dvec3& corner, const glm::dvec3& a, const glm::dvec3& b, double per_square_metre = 250.0, double bumps = 0.0) {
        const glm::dvec3 normal = glm::normalize(glm::cross(a, b));
        const auto count = static_cast<int>(per_square_metre * glm::length(glm::cross(a, b)));
        for (int i = 0; i < count; ++i) { add(corner + next() * a + next() * b + bumps * (next() - 0.5) * normal, normal); }
        return *this;
    }
    // The sides, the top and the bottom of a box.
    Maker& box(const glm::dvec3& low, const glm::dvec3& high, double per_square_metre = 250.0) {
        const glm::dvec3 s = high - low, x(s.x, 0, 0), y(0, s.y, 0), z(0, 0, s.z);
        wall(low, x, y, per_square_metre).wall(low, y, z, per_square_metre).wall(low, x, z, per_square_metre);
        return wall(high, -x, -y, per_square_metre).wall(high, -y, -z, per_square_metre).wall(high, -x, -z, per_square_metre);
    }
    Maker& ball(const glm::dvec3& centre, double radius, int count) {
        std::normal_distribution<double> bell;
        for (int i = 0; i < count; ++i) {
            const glm::dvec3 normal = glm::normalize(glm::dvec3(bell(random_), bell(random_), bell(random_)));
            add(centre + radius * normal, normal);
        }
        return *this;
    }
    // Splats from here on are so large.
    Maker& sized(double size) {
        size_ = size;
        return *this;
    }
    // One splat in fifty lies far away, or anywhere.
    Maker& floaters(double within) {
        for (std::size_t i = 0, count = scene_.size() / 49; i < count; ++i) {
            add(within * (2.0 * glm::dvec3(next(), next(), next()) - 1.0), {0, 0, 1});
            scene_.scales.back() = glm::vec2(0.2f);
        }
        return *this;
    }
    Maker& turn(const glm::dquat& turn, double scale = 1.0) {
        for (std::size_t i = 0; i < scene_.size(); ++i) {
            scene_.positions[i] = glm::vec3(scale * (turn * glm::dvec3(scene_.positions[i])));
            scene_.rotations[i] = glm::quat(turn * glm::dquat(scene_.rotations[i]));
            scene_.scales[i] *= static_cast<float>(scale);
        }
        return *this;
    }
    [[nodiscard]] const Scene& scene() const { return scene_; }

private:
    double next() { return std::uniform_real_distribution<double>()(random_); }
    void add(const glm::dvec3& centre, const glm::dvec3& normal) {
        const glm::dvec3 across = glm::abs(normal.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        const glm::dvec3 u = glm::normalize(glm::cross(normal, across));
        scene_.positions.emplace_back(centre);
        scene_.rotations.emplace_back(glm::quat_cast(glm::mat3(u, glm::cross(normal, u), normal)));
        scene_.scales.emplace_back(static_cast<float>(size_));
        scene_.opacities.push_back(0.9f);
    }

    Scene scene_;
    double size_ = 0.03;
    std::mt19937 random_{7};
};

// 6 by 5 metres, 2.8 high, with a table full of things in one corner and a cupboard.
inline Maker room() {
    Maker made;
    made.box({-3, -2.8, 0}, {3, 0, 5});
    made.box({1.2, -0.8, 3.2}, {2.4, 0, 4.2}, 2000.0);
    return made.box({-2.9, -2.0, 1.0}, {-2.3, 0.0, 2.0});
}

inline Maker street() {
    Maker made;
    made.wall({-4, 0, -20}, {8, 0, 0}, {0, 0, 40}, 40.0, 0.1);
    for (const double side : {-4.0, 4.0}) { made.wall({side, -9, -20}, {0, 9, 0}, {0, 0, 40}, 20.0); }
    return made.box({-3.5, -1.5, 2}, {-1.8, 0, 6}, 150.0);
}

// A head on a pedestal, with nothing about it.
inline Maker statue() {
    Maker made;
    made.ball({0.2, -1.9, 0.1}, 0.4, 6000);
    return made.box({0.0, -1.5, -0.1}, {0.4, -0.1, 0.3}, 1000.0);
}

inline Maker statueOnGround() {
    Maker made = statue();
    return made.wall({-2.5, 0, -2.5}, {5, 0, 0}, {0, 0, 5}, 200.0);
}

inline double degreesBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::degrees(std::acos(std::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.0, 1.0)));
}

inline bool isInside(const Standpoint& point) { return point.why.starts_with("inside"); }

// With floaters and without, as it is, turned about the vertical and tilted: `check` is told what happened, in the scene's own axes.
template <typename Check>
void tryLies(const std::function<Maker()>& make, const Check& check) {
    for (const bool has_floaters : {false, true}) {
        for (const double tilt : {0.0, 0.3, 0.6}) {
            for (const double heading : {0.0, 0.7, 2.5}) {
                const glm::dquat turn =
                    glm::angleAxis(tilt, glm::normalize(glm::dvec3(1, 0, 0.4))) * glm::angleAxis(heading, glm::dvec3(0, 1, 0));
                Maker made = make();
                if (has_floaters) { made.floaters(30.0); }
                made.turn(turn);
                Standpoint point = judgeStandpoint(made.scene());
                CAPTURE(has_floaters);
                CAPTURE(tilt);
                CAPTURE(heading);
                CAPTURE(point.why);
                for (glm::dvec3* const end : {&point.view.eye, &point.view.look, &point.view.up}) { *end = glm::conjugate(turn) * *end; }
                check(point, tilt);
            }
        }
    }
}

}  // namespace binosplat::test
