// Moving eyes, by a millionth of a unit per frame.
#include "app/stability_cases/stage_builder.h"

#include <cmath>

namespace binosplat::stability {
namespace {

constexpr double kStep = 1e-6;
constexpr int kFrames = 61;
constexpr double kHalfWay = kStep * (kFrames - 1) / 2.0;
// A hit that falls to 1/255 one frame earlier here than there.
constexpr double kOneFlip = 1.0 / 255.0 + 1e-3;

// A disc that the eye meets halfway, among others; `along` is the path to it.
Stage makeMeeting(Disc disc, const glm::dvec3& meeting, const glm::dvec3& along) {
    StageBuilder stage;
    stage.addWall();
    stage.addClutter(30, 31);
    disc.centre = meeting + kHalfWay * along;
    disc.opacity = 0.9;
    disc.colour = {0.9, 0.2, 0.4};
    stage.add(disc);
    return stage.finish();
}

const glm::dvec3 kForward{0.0, 0.0, 1.0}, kDown{0.0, 1.0, 0.0};
const Disc kFacing{.t_u = {1.0, 0.0, 0.0}, .t_v = {0.0, 1.0, 0.0}, .scale = glm::dvec2(0.3)};
// Its normal is 80 degrees from the line of sight: much of it is beyond the near plane.
const Disc kTilted{
    .t_u = {1.0, 0.0, 0.0}, .t_v = {0.0, std::sin(0.17), std::cos(0.17)}, .scale = glm::dvec2(0.6)};
const Disc kLevel{.t_u = {1.0, 0.0, 0.0}, .t_v = {0.0, 0.0, 1.0}, .scale = glm::dvec2(0.6)};

}  // namespace

std::vector<Path> makePaths() {
    const auto path = [](const char* name, const Disc& disc, const glm::dvec3& meeting,
                         const glm::dvec3& direction, const char* reason) {
        return Path{name,
                    [=] { return makeMeeting(disc, meeting, direction); },
                    kStep * direction,
                    kFrames,
                    kOneFlip,
                    reason};
    };
    // Half a step beyond the near plane, so that rounding, which differs between devices, does not decide in
    // any frame what is in front of it.
    constexpr double kNear = 0.2 + 0.5 * kStep;
    const glm::dvec3 eye(0.0), near_plane(0.0, 0.0, kNear), ahead(0.0, 0.0, 1.5), beside(0.1, 0.15, kNear);
    return {
        path("through a disc that it faces", kFacing, eye, kForward, "none of it is beyond the near plane"),
        path("through a tilted disc", kTilted, eye, kForward,
             "the part beyond the near plane moves on smoothly"),
        path("a facing disc meets the near plane", kFacing, near_plane, kForward,
             "all of it disappears from one frame to the next, in the twin too"),
        path("a tilted disc's centre meets the near plane", kTilted, beside, kForward,
             "its low-pass disappears, the rest stays"),
        path("along a disc's plane", kLevel, ahead, kForward,
             "its plane holds the eye in every frame: only the low-pass is left"),
        path("through a disc's plane, from above to below", kLevel, ahead, kDown,
             "edge-on within 2e-5 rad, one side and then the other"),
    };
}

}  // namespace binosplat::stability
