// Places discs that are given in an eye's axes.
#include "app/stability_cases/stage_builder.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace binosplat::stability {

glm::dvec3 Random::direction() {
    // Points of a ball, scaled to its surface.
    while (true) {
        const glm::dvec3 v(between(-1.0, 1.0), between(-1.0, 1.0), between(-1.0, 1.0));
        const double length = glm::length(v);
        if (length > 0.1 && length < 1.0) { return v / length; }
    }
}

StageBuilder::StageBuilder(glm::uvec2 size_px, double fov_x_deg, const glm::dvec3& position_world) {
    scene.name = "stability";
    middle = {{glm::normalize(glm::dquat(0.93, 0.11, -0.21, 0.07)), position_world},
              intrinsicsFromFovX(fov_x_deg * std::numbers::pi / 180.0, size_px),
              size_px};
    setEyeDistance(0.063);
}

void StageBuilder::add(const Disc& disc) {
    const glm::dvec3 u = glm::normalize(disc.t_u), v = glm::normalize(disc.t_v - glm::dot(disc.t_v, u) * u);
    const glm::dquat camera_from_disc = glm::quat_cast(glm::dmat3(u, v, glm::cross(u, v)));
    scene.positions.emplace_back(transform(middle.world_from_camera, disc.centre));
    scene.rotations.emplace_back(glm::normalize(middle.world_from_camera.orientation * camera_from_disc));
    scene.scales.emplace_back(disc.scale);
    thicknesses_.push_back(static_cast<float>(disc.thickness));
    scene.opacities.push_back(static_cast<float>(disc.opacity));
    // colour = 0.5 + sqrt(1/pi)/2 f_dc
    for (int channel = 0; channel < 3; ++channel) {
        scene.sh.push_back(static_cast<float>((disc.colour[channel] - 0.5) / 0.28209479177387814));
    }
}

void StageBuilder::addWall(double depth) {
    Random random(99);
    for (int j = -6; j <= 6; ++j) {
        for (int i = -9; i <= 9; ++i) {
            // Uneven by a twentieth, or rounding would decide which of two discs at the same depth is in
            // front.
            add({.centre = depth * random.between(0.975, 1.025) * glm::dvec3(0.1 * i, 0.1 * j, 1.0),
                 .scale = glm::dvec2(0.06 * depth),
                 .opacity = 0.95,
                 .colour = {0.5 + 0.3 * std::sin(0.9 * i), 0.5 + 0.3 * std::cos(0.7 * j),
                            (i + j) % 2 == 0 ? 0.3 : 0.6}});
        }
    }
}

void StageBuilder::addClutter(int count, unsigned seed) {
    Random random(seed);
    for (int i = 0; i < count; ++i) {
        Disc disc;
        disc.centre.z = random.between(1.0, 3.5);
        disc.centre.x = disc.centre.z * random.between(-0.6, 0.6);
        disc.centre.y = disc.centre.z * random.between(-0.4, 0.4);
        turnAnyhow(disc, random);
        disc.scale = {random.between(0.03, 0.25), random.between(0.03, 0.25)};
        disc.opacity = random.between(0.3, 1.0);
        disc.colour = random.colour();
        add(disc);
    }
}

void StageBuilder::setEyeDistance(double distance, double canting_rad) {
    eyes_ = stereoPair(middle, distance);
    for (int e = 0; e < 2; ++e) {
        glm::dquat& orientation = eyes_[static_cast<std::size_t>(e)].world_from_camera.orientation;
        if (canting_rad != 0.0) {
            orientation =
                orientation * glm::angleAxis(e == kLeft ? -canting_rad : canting_rad, glm::dvec3(0, 1, 0));
        }
    }
}

Stage StageBuilder::finish() { return {std::move(scene), middle, eyes_, near}; }

Stage StageBuilder::finishGaussians() {
    scene.thicknesses = std::move(thicknesses_);
    return finish();
}

StageBuilder makeDiscRoom(glm::uvec2 size_px) {
    StageBuilder stage(size_px);
    stage.addWall();
    stage.addClutter(30, 1);
    return stage;
}

Disc placeDisc(Random& random, double nearest) {
    Disc disc;
    disc.centre.z = random.between(nearest, 3.5);
    disc.centre.x = disc.centre.z * random.between(-0.5, 0.5);
    disc.centre.y = disc.centre.z * random.between(-0.35, 0.35);
    disc.opacity = 0.9;
    disc.colour = random.colour();
    return disc;
}

void layAlongSight(Disc& disc, double angle_rad) {
    const glm::dvec3 sight = glm::normalize(disc.centre), beside(1.0, 0.0, 0.0);
    const glm::dvec3 across = glm::normalize(glm::cross(sight, beside));
    const glm::dvec3 normal = std::cos(angle_rad) * across + std::sin(angle_rad) * sight;
    disc.t_u = beside;
    disc.t_v = glm::cross(normal, beside);
}

void turnAnyhow(Disc& disc, Random& random) {
    disc.t_u = random.direction();
    do { disc.t_v = random.direction(); } while (std::abs(glm::dot(disc.t_u, disc.t_v)) > 0.9);
}

}  // namespace binosplat::stability
