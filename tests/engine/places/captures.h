// Captures like people's own, each made here at a small size with the difficulties of its kind.
#pragma once

#include "engine/builtin/procedural.h"
#include "engine/places/standpoint.h"
#include "tests/suite.h"

namespace binosplat::test {

inline const glm::dvec3 kUp(0, -1, 0);

inline void turnScene(Scene& scene, const glm::dquat& turn, double scale = 1.0) {
    for (std::size_t i = 0; i < scene.size(); ++i) {
        scene.positions[i] = glm::vec3(scale * (turn * glm::dvec3(scene.positions[i])));
        scene.rotations[i] = glm::quat(turn * glm::dquat(scene.rotations[i]));
        scene.scales[i] *= static_cast<float>(scale);
    }
}

// Scenes in metres, y down: the floor is y = 0.
class Maker {
public:
    // A rectangle of splats, given by a corner and two sides: spread evenly at random, and facing its normal.
    Maker& wall(const glm::dvec3& corner, const glm::dvec3& a, const glm::dvec3& b,
                double per_square_metre = 250.0, double bumps = 0.0) {
        const glm::dvec3 normal = glm::normalize(glm::cross(a, b));
        const auto count = static_cast<int>(per_square_metre * glm::length(glm::cross(a, b)));
        for (int i = 0; i < count; ++i) {
            const double bump = bumps * (next() - 0.5), v = next(), u = next();
            add(corner + u * a + v * b + bump * normal, normal);
        }
        return *this;
    }
    // The sides, the top and, last, the bottom of a box.
    Maker& box(const glm::dvec3& low, const glm::dvec3& high, double per_square_metre = 250.0,
               bool has_bottom = true) {
        const glm::dvec3 s = high - low, x(s.x, 0, 0), y(0, s.y, 0), z(0, 0, s.z);
        wall(low, x, y, per_square_metre).wall(low, y, z, per_square_metre).wall(low, x, z, per_square_metre);
        wall(high, -x, -y, per_square_metre).wall(high, -y, -z, per_square_metre);
        return has_bottom ? wall(high, -x, -z, per_square_metre) : *this;
    }
    Maker& ball(const glm::dvec3& centre, double radius, int count) {
        std::normal_distribution<double> bell;
        for (int i = 0; i < count; ++i) {
            const double z = bell(random_), y = bell(random_), x = bell(random_);
            const glm::dvec3 normal = glm::normalize(glm::dvec3(x, y, z));
            add(centre + radius * normal, normal);
        }
        return *this;
    }
    // Splats from now on have this size.
    Maker& sized(double size) {
        size_ = size;
        return *this;
    }
    // One splat in fifty is far away, or anywhere.
    Maker& floaters(double within) {
        for (std::size_t i = 0, count = scene_.size() / 49; i < count; ++i) {
            add(within * (2.0 * inUnitBox() - 1.0), {0, 0, 1});
            scene_.scales.back() = glm::vec2(0.2f);
        }
        return *this;
    }
    Maker& turn(const glm::dquat& turn, double scale = 1.0) {
        turnScene(scene_, turn, scale);
        return *this;
    }
    Maker& fill(const glm::dvec3& low, const glm::dvec3& high, int count) {
        for (int i = 0; i < count; ++i) { add(low + inUnitBox() * (high - low), {0, 1, 0}); }
        return *this;
    }
    [[nodiscard]] const Scene& scene() const { return scene_; }

private:
    // Numbers are drawn one by one: processors differ in the order in which they evaluate arguments.
    glm::dvec3 inUnitBox() {
        const double z = next(), y = next(), x = next();
        return {x, y, z};
    }
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

// 6 by 5 metres and 2.8 high, with a table full of things in one corner and a cupboard.
inline Maker room() {
    return Maker()
        .box({-3, -2.8, 0}, {3, 0, 5})
        .box({1.2, -0.8, 3.2}, {2.4, 0, 4.2}, 2000.0)
        .box({-2.9, -2.0, 1.0}, {-2.3, 0.0, 2.0});
}

inline Maker street() {
    Maker made;
    made.wall({-4, 0, -20}, {8, 0, 0}, {0, 0, 40}, 40.0, 0.1);
    for (const double side : {-4.0, 4.0}) { made.wall({side, -9, -20}, {0, 9, 0}, {0, 0, 40}, 20.0); }
    return made.box({-3.5, -1.5, 2}, {-1.8, 0, 6}, 150.0);
}

// A head on a pedestal.
inline Maker statue() {
    return Maker().ball({0.2, -1.9, 0.1}, 0.4, 6000).box({0.0, -1.5, -0.1}, {0.4, -0.1, 0.3}, 1000.0);
}

inline Maker statueOnGround() { return statue().wall({-2.5, 0, -2.5}, {5, 0, 0}, {0, 0, 5}, 200.0); }

// A crate of half a metre is not a room, although it has a floor, walls and a ceiling.
inline Maker crate() { return Maker().box({-0.3, -0.5, -0.25}, {0.3, 0, 0.25}, 8000.0); }

// A table with a vase on a lawn, a hedge around it, and a distant sky that has a fifth of the splats.
inline Maker garden() {
    Maker made;
    made.wall({-9, 0, -9}, {18, 0, 0}, {0, 0, 18}, 60.0, 0.05)
        .box({-0.7, -0.75, -0.7}, {0.7, -0.7, 0.7}, 2000.0);
    made.ball({0.1, -0.95, 0.0}, 0.2, 9000).sized(0.1);
    for (const double side : {-9.0, 9.0}) {
        made.wall({side, -4, -9}, {0, 4, 0}, {0, 0, 18}, 60.0, 1.0)
            .wall({-9, -4, side}, {0, 4, 0}, {18, 0, 0}, 60.0, 1.0);
    }
    return made.sized(2.0).ball({0, -5, 0}, 80.0, 12000);
}

// A scan on a desk: the object, a piece of the desk, and the room around it as a distant, thin shell.
inline Maker scannedToy() {
    return Maker()
        .sized(0.003)
        .ball({0, -0.12, 0}, 0.06, 20000)
        .box({-0.04, -0.06, -0.04}, {0.04, 0, 0.04}, 400000.0)
        .wall({-0.3, 0, -0.3}, {0.6, 0, 0}, {0, 0, 0.6}, 20000.0)
        .sized(0.1)
        .ball({0, -1, 0}, 4.0, 6000);
}

// Things on a table and the wide wall behind them, seen only from the front.
inline Maker facingForward() {
    Maker made;
    for (const double x : {-0.8, 0.0, 0.7}) { made.ball({x, -0.3, 3.0 + 0.3 * x}, 0.25, 5000); }
    return made.wall({-1.6, 0, 2.4}, {3.2, 0, 0}, {0, 0, 1.6}, 800.0)
        .sized(0.08)
        .wall({-5, -3, 7}, {10, 0, 0}, {0, 4, 0}, 400.0, 0.2);
}

// Three walls and a floor: the camera never entered the fourth part of the room.
inline Maker openRoom() {
    return Maker()
        .wall({-3, 0, 0}, {6, 0, 0}, {0, 0, 5})
        .wall({-3, -2.8, 5}, {6, 0, 0}, {0, 2.8, 0})
        .wall({-3, -2.8, 0}, {0, 2.8, 0}, {0, 0, 5})
        .wall({3, -2.8, 0}, {0, 2.8, 0}, {0, 0, 5})
        .box({-0.9, -0.8, 2.8}, {0.9, 0, 3.8}, 1500.0);
}

inline Maker corridor() {
    return Maker().box({-1, -2.5, -8}, {1, 0, 8}, 150.0).box({0.5, -1, 3}, {1, 0, 4}, 1500.0);
}

// From a drone.
inline Maker town() {
    Maker made;
    made.sized(0.6).wall({-150, 0, -150}, {300, 0, 0}, {0, 0, 300}, 0.2, 0.5);
    for (int i = -3; i <= 3; ++i) {
        for (int k = -3; k <= 3; ++k) {
            const glm::dvec3 low(40.0 * i - 12.0, -12.0 - 6.0 * ((i * i + 3 * k) & 3), 40.0 * k - 12.0);
            made.box(low, {low.x + 24.0, 0.0, low.z + 24.0}, 0.3);
        }
    }
    return made;
}

// A car of which only the outside is seen, in a yard of which only the ground is seen.
inline Maker car() {
    return Maker()
        .box({-0.9, -0.9, -2.2}, {0.9, -0.2, 2.2}, 900.0, false)
        .box({-0.7, -1.5, -1.2}, {0.7, -0.9, 1.0}, 900.0, false)
        .sized(0.06)
        .wall({-6, 0, -6}, {12, 0, 0}, {0, 0, 12}, 60.0, 0.03);
}

// A wall with balconies, seen from the front.
inline Maker relief() {
    Maker made;
    made.wall({-5, -6, 0}, {10, 0, 0}, {0, 6, 0}, 300.0);
    for (const double x : {-3.5, -1.0, 1.5}) { made.box({x, -4.5, -0.8}, {x + 1.5, -3.0, 0}, 400.0, false); }
    return made;
}

// A wall with something in front of it that has most of the splats.
inline Maker fence() {
    Maker made;
    made.wall({-3, -3, 0}, {6, 0, 0}, {0, 6, 0});
    for (const double x : {-0.8, -0.4, 0.0, 0.4, 0.8}) {
        made.wall({x, -1, -2}, {0.02, 0, 0}, {0, 2, 0}, 2000.0);
    }
    return made;
}

inline double degreesBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::degrees(std::acos(std::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.0, 1.0)));
}

inline bool isInside(const Standpoint& point) { return point.why.starts_with("inside"); }

}  // namespace binosplat::test
