// The sequences: heads that stop, oscillate, turn fast, and scenes that are hard to make from the frames
// before.
#include "app/stability_cases/sequences.h"

#include "app/stability_cases/extreme_scenes.h"
#include "app/stability_cases/stage_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace binosplat::stability {
namespace {

using Eyes = std::array<Eye, 2>;

// The head at a place in the axes of where it started, turned to the right by `yaw_rad`.
Eyes headAt(const Stage& stage, const glm::dvec3& place, double yaw_rad = 0.0) {
    Eye middle = stage.middle;
    middle.world_from_camera.position += middle.world_from_camera.orientation * place;
    middle.world_from_camera.orientation =
        middle.world_from_camera.orientation * glm::angleAxis(yaw_rad, glm::dvec3(0, 1, 0));
    return stereoPair(middle, 0.063);
}

// 3 mm per frame, which is 0.27 m/s at 90 frames per second, and a turn of 10 degrees per second.
Eyes walk(const Stage& stage, int frame) {
    return headAt(stage, static_cast<double>(frame) * glm::dvec3(0.0028, 0.0006, 0.0008), 0.002 * frame);
}
Eyes walkAndStop(const Stage& stage, int frame) { return walk(stage, std::min(frame, 5)); }
// The picture moves to the left by a quarter of a pixel, and back.
Eyes tremble(const Stage& stage, int frame) {
    return headAt(stage, glm::dvec3(0.0), frame % 2 * 0.25 / stage.middle.intrinsics.fx);
}
// At 90 frames per second.
Eyes turnFast(const Stage& stage, int frame) {
    return headAt(stage, glm::dvec3(0.0), frame * std::numbers::pi / 90.0);
}
Eyes passByWall(const Stage& stage, int frame) { return headAt(stage, glm::dvec3(0.005 * frame, 0.0, 0.0)); }
// By less than the change that drops a history.
Eyes changeAngles(const Stage& stage, int frame) {
    Eyes eyes = walk(stage, frame);
    for (Eye& eye : eyes) {
        eye.intrinsics =
            intrinsicsFromFovX((60.0 + 0.5 * (frame % 5)) * std::numbers::pi / 180.0, eye.size_px);
    }
    return eyes;
}
// As a runtime may that scales its pictures.
Eyes changeSize(const Stage& stage, int frame) {
    Eyes eyes = walk(stage, frame);
    for (Eye& eye : eyes) {
        eye.size_px -= glm::uvec2(8, 5) * static_cast<unsigned>(frame % 4);
        eye.intrinsics =
            intrinsicsFromFovX((60.0 + 0.7 * (frame % 5)) * std::numbers::pi / 180.0, eye.size_px);
    }
    return eyes;
}

Stage makeWholeRoom() { return makeDiscRoom().finish(); }
// Specks of less than a pixel, light and dark.
Stage makeSpecks() {
    StageBuilder stage({48, 32});
    stage.addWall();
    Random random(8);
    for (int i = 0; i < 250; ++i) {
        Disc disc = placeDisc(random, 2.0);
        disc.scale = glm::dvec2(0.01);
        disc.opacity = 0.99;
        disc.colour = glm::dvec3(i % 2 == 0 ? 0.0 : 1.0);
        stage.add(disc);
    }
    return stage.finish();
}
Stage makeOtherRoom() {
    StageBuilder stage;
    stage.addWall(2.5);
    stage.addClutter(30, 77);
    return stage.finish();
}
// All around the eye.
Stage makeSurround() {
    StageBuilder stage;
    Random random(21);
    for (int i = 0; i < 900; ++i) {
        Disc disc;
        const glm::dvec3 direction = random.direction();
        disc.centre = random.between(3.0, 4.0) * direction;
        disc.t_u =
            glm::cross(direction, std::abs(direction.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0));
        disc.t_v = glm::cross(direction, disc.t_u);
        disc.scale = {random.between(0.1, 0.3), random.between(0.1, 0.3)};
        disc.opacity = 0.9;
        disc.colour = random.colour();
        stage.add(disc);
    }
    return stage.finish();
}
Stage makeNeedleRoom() { return makeNeedles(1e3); }
Stage makeNearWall() {
    StageBuilder stage;
    stage.addWall(0.6);
    return stage.finish();
}

}  // namespace

std::string Sequence::title() const { return fmt::format("{}, {}", name, nameOf(mode)); }

std::vector<Sequence> makeSequences() {
    std::vector<Sequence> sequences;
    const auto add = [&](const Sequence& both, double temporal_db, std::optional<double> alternate_db) {
        sequences.push_back(both);
        sequences.back().psnr_db = temporal_db;
        if (!alternate_db) { return; }
        sequences.push_back(both);
        sequences.back().mode = Mode::kAlternate;
        sequences.back().psnr_db = *alternate_db;
    };
    add({.name = "a head that stops",
         .make = makeWholeRoom,
         .eyes = walkAndStop,
         .frames = 42,
         .equal_from = 35,
         .reason = "from 30 frames after it stopped, it always sees the full render"},
        37.0, 44.0);
    add({.name = "a quarter of a pixel to and fro",
         .make = makeSpecks,
         .eyes = tremble,
         .frames = 501,
         .first_scored = 50,
         .score_every = 25,
         .drift_db = 1.0,
         .beyond = 0.1,
         .bias = 0.005,
         .reason = "pictures that are sampled again and again blur until they are rendered, but neither ring "
                   "nor drift"},
        30.0, {});
    add({.name = "the same, nothing rendered again",
         .make = makeSpecks,
         .eyes = tremble,
         .frames = 501,
         .budget = 0.0,
         .first_scored = 50,
         .score_every = 45,
         .beyond = 0.1,
         .bias = 0.005,
         .reason = "sampled 500 times: no frequency comes out stronger than it went in"},
        17.0, {});
    add({.name = "the same in half floats",
         .make = makeSpecks,
         .eyes = tremble,
         .frames = 501,
         .budget = 0.0,
         .half_floats = true,
         .first_scored = 50,
         .score_every = 45,
         .beyond = 0.1,
         .bias = 0.005,
         .reason = "likewise, rounded 500 times"},
        17.0, {});
    add({.name = "a turn of 180 degrees a second",
         .make = makeSurround,
         .eyes = turnFast,
         .frames = 46,
         .reason = "2 degrees a frame: each frame shows 3 % that the last one did not"},
        27.0, 29.0);
    add({.name = "needles",
         .make = makeNeedleRoom,
         .eyes = walk,
         .frames = 31,
         .reason = "thinner than pixels, which then have no single depth"},
        28.0, 27.0);
    add({.name = "along a wall",
         .make = makeNearWall,
         .eyes = passByWall,
         .frames = 31,
         .reason = "it moves by 0.7 pixels a frame, and has the same depth everywhere"},
        50.0, 54.0);
    add({.name = "a scene that is exchanged",
         .make = makeWholeRoom,
         .eyes = walk,
         .frames = 21,
         .exchanged_at = 10,
         .make_other = makeOtherRoom,
         .reason = "nothing of one scene shows in the other"},
        37.0, 43.0);
    add({.name = "angles that change in each frame",
         .make = makeWholeRoom,
         .eyes = changeAngles,
         .frames = 21,
         .reason = "a history with other angles is one of a smaller or larger picture"},
        36.0, 41.0);
    add({.name = "size and angles that change in each frame",
         .make = makeWholeRoom,
         .eyes = changeSize,
         .frames = 21,
         .reason = "a history of another size is warped like any other"},
        35.0, 41.0);
    return sequences;
}

}  // namespace binosplat::stability
