// A hand of average size: lengths in metres, in the axes of its wrist (x right, y out of the back of the
// hand, -z to the fingertips). They are for the right hand; the left is its mirror image.
#include "xr/simulated/script/hand_model.h"

#include <glm/mat3x3.hpp>

namespace simulated {

namespace {

struct Finger {
    glm::dvec3 metacarpal, knuckle;
    std::array<double, 3> bones_m;  // from the knuckle to the tip
    double radius_m;
};

constexpr std::array<Finger, 4> kFingers{
    {{{-0.020, 0.0, -0.030}, {-0.027, 0.0, -0.090}, {0.040, 0.025, 0.020}, 0.009},
     {{-0.004, 0.0, -0.030}, {-0.004, 0.0, -0.094}, {0.045, 0.028, 0.021}, 0.009},
     {{0.011, 0.0, -0.030}, {0.017, 0.0, -0.088}, {0.041, 0.026, 0.020}, 0.008},
     {{0.022, 0.0, -0.030}, {0.035, 0.0, -0.078}, {0.032, 0.020, 0.018}, 0.007}}};
constexpr std::array<glm::dvec3, 4> kThumb{
    {{-0.025, -0.010, -0.025}, {-0.045, -0.015, -0.055}, {-0.055, -0.017, -0.085}, {-0.060, -0.018, -0.110}}};
constexpr glm::dvec3 kPalm(0.0, 0.0, -0.060);
constexpr double kCurl_rad = 1.3;  // of each joint of a closed fist

// The hand's axes in the grip's: open fingers point along its -y, and its x goes through the palm.
Pose gripFromWrist(Side side) {
    const double mirror = side == kLeft ? -1.0 : 1.0;
    const glm::dmat3 axes(glm::dvec3(0, 0, mirror), glm::dvec3(mirror, 0, 0), glm::dvec3(0, 1, 0));
    const glm::dquat orientation = glm::quat_cast(axes);
    constexpr double kPalmBesideGrip_m = 0.02;
    return {orientation, glm::dvec3(mirror * kPalmBesideGrip_m, 0, 0) - orientation * kPalm};
}

glm::dvec3 mirrored(const glm::dvec3& place, Side side) {
    return {side == kLeft ? -place.x : place.x, place.y, place.z};
}

}  // namespace

std::array<HandJoint, kHandJoints> makeHandJoints(Side side, const Pose& stage_from_grip, double index_curl,
                                                  double others_curl) {
    const Pose stage_from_wrist = compose(stage_from_grip, gripFromWrist(side));
    std::array<HandJoint, kHandJoints> joints;
    std::size_t next = 0;
    const auto add = [&](const glm::dvec3& place, const glm::dquat& orientation, double radius_m) {
        joints[next++] = {compose(stage_from_wrist, {orientation, mirrored(place, side)}), radius_m};
    };
    const glm::dquat straight(1.0, 0.0, 0.0, 0.0);
    add(kPalm, straight, 0.025);
    add({0.0, 0.0, 0.0}, straight, 0.028);
    for (const glm::dvec3& place : kThumb) { add(place, straight, 0.011); }
    for (const Finger& finger : kFingers) {
        const double curl = &finger == &kFingers.front() ? index_curl : others_curl;
        add(finger.metacarpal, straight, finger.radius_m);
        glm::dvec3 place = finger.knuckle;
        glm::dquat orientation = straight;
        for (const double bone_m : finger.bones_m) {
            // Down, towards the palm.
            orientation = orientation * glm::angleAxis(-curl * kCurl_rad, glm::dvec3(1, 0, 0));
            add(place, orientation, finger.radius_m);
            place += orientation * glm::dvec3(0, 0, -bone_m);
        }
        add(place, orientation, finger.radius_m);
    }
    return joints;
}

}  // namespace simulated
