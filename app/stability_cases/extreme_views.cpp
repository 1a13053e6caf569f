// Unusual worlds and views, with ordinary discs.
#include "app/stability_cases/extreme_scenes.h"
#include "app/stability_cases/stage_builder.h"

#include <cmath>
#include <numbers>

namespace binosplat::stability {
namespace {

StageBuilder makeRoom(glm::uvec2 size_px = kSizePx, double fov_x_deg = 60.0,
                      const glm::dvec3& position_world = {0.3, -0.2, 0.1}) {
    StageBuilder stage(size_px, fov_x_deg, position_world);
    stage.addWall();
    stage.addClutter(90, 21);
    return stage;
}

}  // namespace

Stage makeUnit(double unit) {
    Stage stage = makeRoom().finish();
    for (glm::vec3& position : stage.scene.positions) { position = glm::vec3(glm::dvec3(position) * unit); }
    for (glm::vec2& scale : stage.scene.scales) { scale = glm::vec2(glm::dvec2(scale) * unit); }
    for (Eye* eye : {&stage.middle, &stage.eyes[kLeft], &stage.eyes[kRight]}) {
        eye->world_from_camera.position *= unit;
    }
    stage.near *= unit;
    return stage;
}

Stage makeFarOff(double offset) {
    return makeRoom(kSizePx, 60.0, glm::dvec3(0.3 + offset, -0.2 - offset, 0.1 + offset)).finish();
}

Stage makeTwoPlaces(double distance) {
    StageBuilder stage = makeRoom(kSizePx, 60.0, glm::dvec3(0.3 + distance, -0.2, 0.1 - distance));
    // Three times as many splats around the world's origin.
    Random random(22);
    const std::size_t elsewhere = 3 * stage.scene.size();
    for (std::size_t i = 0; i < elsewhere; ++i) {
        stage.add({.scale = glm::dvec2(0.1), .colour = random.colour()});
        stage.scene.positions.back() = glm::vec3(random.direction());
    }
    return stage.finish();
}

Stage makeEyeDistance(double distance) {
    StageBuilder stage = makeRoom();
    stage.setEyeDistance(distance);
    return stage.finish();
}

Stage makeCanting(double degrees) {
    StageBuilder stage = makeRoom();
    stage.setEyeDistance(0.063, degrees * std::numbers::pi / 180.0);
    return stage.finish();
}

Stage makeFieldOfView(double degrees) {
    StageBuilder stage = makeRoom(kSizePx, degrees);
    // Content behind and beside the eye counts here, too.
    Random random(23);
    for (int i = 0; i < 200; ++i) {
        Disc disc;
        turnAnyhow(disc, random);
        disc.centre = random.between(0.8, 3.0) * random.direction();
        disc.scale = {random.between(0.03, 0.3), random.between(0.03, 0.3)};
        disc.colour = random.colour();
        stage.add(disc);
    }
    return stage.finish();
}

Stage makeImage(glm::uvec2 size_px) { return makeRoom(size_px).finish(); }

Stage makeEmpty() { return StageBuilder().finish(); }

Stage makeCovered() {
    StageBuilder stage;
    Random random(24);
    for (int i = 0; i < 100; ++i) {
        Disc disc{.centre = {0.0, 0.0, random.between(1.0, 4.0)},
                  .scale = glm::dvec2(10.0),
                  .opacity = random.between(0.05, 0.3)};
        disc.t_u = {1.0, 0.0, random.between(-0.3, 0.3)};
        disc.t_v = {0.0, 1.0, random.between(-0.3, 0.3)};
        disc.colour = random.colour();
        stage.add(disc);
    }
    return stage.finish();
}

Stage makeCloud() {
    StageBuilder stage(kSizePx, 100.0);
    Random random(25);
    for (int i = 0; i < 1500; ++i) {
        Disc disc;
        turnAnyhow(disc, random);
        disc.centre = random.between(0.0, 3.0) * random.direction();
        disc.scale = {std::exp(random.between(-6.0, 0.0)), std::exp(random.between(-6.0, 0.0))};
        disc.opacity = random.between(0.0, 1.0);
        disc.colour = random.colour();
        stage.add(disc);
    }
    return stage.finish();
}

}  // namespace binosplat::stability
