// Facts about a window's camera and what its eyes see.
#include "app/desktop/camera_mover.h"
#include "app/desktop/desktop_pictures.h"
#include "app/desktop/desktop_window.h"
#include "app/desktop/scene_pictures.h"
#include "tests/suite.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

SUITE(orbit_camera) {

const View kView{{0.3, -1.5, -3.0}, {0.2, -1.0, 0.5}, {0.1, -1.0, 0.05}, 60.0};
const glm::dvec3 kUnder(0.7, -0.9, 1.2);
const glm::uvec2 kSizePx(800, 600);

glm::dvec2 pixelOf(const Eye& eye, const glm::dvec3& point) {
    const glm::dvec3 p = transform(inverse(eye.world_from_camera), point);
    return {eye.intrinsics.fx * p.x / p.z + eye.intrinsics.cx,
            eye.intrinsics.fy * p.y / p.z + eye.intrinsics.cy};
}
Eye eyeOf(const OrbitCamera& camera) { return eyesOf(camera, {}, kSizePx).front(); }
void checkUpright(const OrbitCamera& camera) {
    const glm::dvec3 up_camera = glm::conjugate(camera.pose().orientation) * kView.up;
    CHECK(up_camera.x == doctest::Approx(0.0));
    CHECK(up_camera.y < 0.0);
}

TEST_CASE("what is under the pointer stays there or follows it, and the camera stays upright") {
    CameraMover mover;
    mover.set(OrbitCamera(kView));
    CHECK(glm::distance(mover.camera().centre(), kView.look) < 1e-9);
    const double focal_px = eyeOf(mover.camera()).intrinsics.fx;
    const glm::dvec2 start = pixelOf(eyeOf(mover.camera()), kUnder), step(70.0, -40.0);
    const auto isUnder = [&](const glm::dvec2& place) {
        return glm::distance(pixelOf(eyeOf(mover.camera()), kUnder), place) < 1e-6;
    };
    const auto drag = [&](CameraMover::Drag how, const glm::dvec2& by) {
        mover.beginDrag(how, start, kUnder, focal_px, kSizePx.y);
        mover.dragTo(start + by);
    };
    drag(CameraMover::Drag::kOrbit, step);
    checkUpright(mover.camera());
    CHECK(isUnder(start));
    CHECK(glm::distance(mover.camera().position(), kView.eye) > 0.5);
    mover.turnWheel(3.0, kUnder);
    CHECK(isUnder(start));
    // Touchpads turn the wheel by parts of a step.
    const OrbitCamera there = mover.camera();
    mover.turnWheel(-1.0, kUnder);
    for (int i = 0; i < 4; ++i) { mover.turnWheel(0.25, kUnder); }
    CHECK(glm::distance(mover.camera().position(), there.position()) < 1e-9);
    // And pinches, by as much as the fingers move apart.
    mover.turnWheel(wheelStepsOf(2.0), kUnder);
    CHECK(glm::distance(mover.camera().position(), kUnder) ==
          doctest::Approx(0.5 * glm::distance(there.position(), kUnder)));
    mover.turnWheel(wheelStepsOf(0.5), kUnder);
    CHECK(mover.camera().distance() < 0.7 * glm::distance(kView.eye, kView.look));
    drag(CameraMover::Drag::kPan, step);
    CHECK(isUnder(start + step));
    // It is never upside down.
    drag(CameraMover::Drag::kOrbit, {0.0, 5000.0});
    checkUpright(mover.camera());
}

TEST_CASE("keys and gamepads fly, four times as fast if asked; a stick near its rest does nothing") {
    const View level{{0.0, 0.0, -1.0}, {0.0, 0.0, 3.0}, {0.0, -1.0, 0.0}, 60.0};
    const auto flown = [&](const HeldMotion& held) {
        CameraMover mover;
        mover.set(OrbitCamera(level));
        mover.pass(held, 0.1);
        return mover.camera().position() - level.eye;
    };
    const double step = glm::length(flown({.fly = {0.0, 0.0, 1.0}}));
    CHECK(step > 0.1);
    CHECK(glm::length(flown({.fly = {0.0, 0.0, 1.0}, .fast = true})) == doctest::Approx(4.0 * step));
    CHECK_FALSE(motionOf({}).isAny());
    CHECK_FALSE(motionOf({{0.1, -0.14}, {-0.1, 0.1}, -0.9, -1.0}).isAny());
    const HeldMotion held = motionOf({{0.5, -1.0}, {-0.7, 0.8}, 1.0, -1.0, true});
    CHECK(these(held.fly == glm::dvec3(0.5, 1.0, 1.0), held.turn == glm::dvec2(-0.7, -0.8), held.fast) ==
          these(true, true, true));
    CHECK(motionOf({.right_trigger = 1.0}).fly.y == -1.0);
    // GLFW's axes: left x and y, right x and y, left and right trigger; the left bumper is button 4.
    const GLFWgamepadstate pad{{0, 0, 0, 0, 1}, {0.5f, -0.75f, -0.625f, 0.875f, 0.25f, -1.0f}};
    const HeldMotion by_pad = motionOfGamepad(pad), flat = motionOfGamepad({{}, {0, 0, 0, 0, -1.0f, 0.5f}});
    CHECK(these(by_pad.fly, by_pad.turn, by_pad.fast) ==
          these(glm::dvec3(0.5, 0.625, 0.75), glm::dvec2(-0.625, -0.875), true));
    CHECK(these(flat.fly, flat.fast) == these(glm::dvec3(0.0, -0.75, 0.0), false));
    for (const int shift : {0, GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT}) {
        for (const auto& [name, ahead] :
             {std::pair('W', glm::dvec3(0, 0, 1)), std::pair('S', glm::dvec3(0, 0, -1)),
              std::pair('D', glm::dvec3(1, 0, 0)), std::pair('A', glm::dvec3(-1, 0, 0)),
              std::pair('Q', glm::dvec3(0, 1, 0)), std::pair('E', glm::dvec3(0, -1, 0))}) {
            const HeldMotion keys = motionOfKeys([&](int key) { return key == name || key == shift; });
            CAPTURE(name);
            CHECK(glm::distance(glm::normalize(flown(keys)), ahead) < 1e-6);
            CHECK(keys.fast == (shift != 0));
        }
    }
}

TEST_CASE("a way ends where it leads, the shorter way round; a new centre comes into the middle") {
    CameraMover mover;
    OrbitCamera from(kView);
    from.turn(3.0, 0.0);
    OrbitCamera to(kView);
    to.turn(-3.0, 0.2);
    const glm::dvec3 half = OrbitCamera::between(from, to, 0.5).pose().orientation * glm::dvec3(0, 0, 1);
    CHECK(glm::dot(half, glm::normalize(kView.look - kView.eye)) < -0.8);
    mover.set(from);
    mover.glideTo(to);
    for (int i = 0; i < 100; ++i) { mover.pass({}, 0.01); }
    CHECK(these(mover.isGliding(), mover.camera()) == these(false, OrbitCamera::between(from, to, 1.0)));
    CHECK(glm::distance(mover.camera().centre(), to.centre()) < 1e-9);
    mover.glideTo(from);
    mover.pass({.fly = {0.0, 0.0, 1.0}}, 0.01);
    CHECK_FALSE(mover.isGliding());
    const glm::dvec2 middle(0.5 * glm::dvec2(kSizePx));
    CHECK(glm::distance(pixelOf(eyeOf(to.centredOn(kUnder)), kUnder), middle) < 1e-6);
    const OrbitCamera whole = to.framing(kUnder, 2.0, 1.0);
    CHECK(glm::distance(pixelOf(eyeOf(whole), kUnder), middle) < 1e-6);
    CHECK(std::asin(2.0 / whole.distance()) == doctest::Approx(0.5));
}

TEST_CASE("what lies in the plane of the screen is at one pixel for both eyes, what is nearer is crossed") {
    const OrbitCamera camera(kView);
    for (const double plane : {1.0, 2.0}) {
        const WindowSight sight{WindowStereo::kSideBySide, 0.05, plane, 1.0};
        const std::vector<Eye> eyes = eyesOf(camera, sight, kSizePx);
        REQUIRE(eyes.size() == 2);
        CHECK(
            glm::distance(eyes[kLeft].world_from_camera.position, eyes[kRight].world_from_camera.position) ==
            doctest::Approx(0.05 * plane * camera.distance()));
        const auto parallax = [&](double share) {
            const glm::dvec3 point = glm::mix(camera.position(), camera.centre(), share);
            return pixelOf(eyes[kRight], point).x - pixelOf(eyes[kLeft], point).x;
        };
        CHECK(parallax(plane) == doctest::Approx(0.0));
        CHECK(parallax(0.5 * plane) < -1.0);
        CHECK(parallax(3.0 * plane) > 1.0);
        const glm::dvec2 place(123.0, 456.0);
        CHECK(glm::distance(pixelOf(eyes[kRight], pointAt(eyes[kRight], place, 2.0)), place) < 1e-9);
    }
    const auto eyeAt = [](WindowStereo stereo, const glm::dvec2& place) {
        return partAt(partsOf(stereo, {100, 60}), place)->eye;
    };
    CHECK(these(eyeAt(WindowStereo::kSideBySide, {20, 30}), eyeAt(WindowStereo::kSideBySide, {70, 30})) ==
          these(kLeft, kRight));
    CHECK(these(eyeAt(WindowStereo::kCrossEyed, {20, 30}), eyeAt(WindowStereo::kTopBottom, {20, 40})) ==
          these(kRight, kRight));
    CHECK_FALSE(partAt(partsOf(WindowStereo::kMono, {100, 60}), {100, 30}).has_value());
    // Quarters cover a part of odd width, too, and see there what the whole does.
    constexpr glm::uvec2 kPart(101, 60);
    const Eye whole = eyesOf(OrbitCamera(), {}, kPart)[0];
    glm::ivec2 covered(0);
    for (int quarter = 0; quarter < 4; ++quarter) {
        const WindowPart at = quarterOf(kPart, quarter);
        const Eye eye = quarterOf(whole, kPart, quarter, 2.0);
        CHECK(eye.size_px == 2u * glm::uvec2(at.size_px));
        const glm::dvec2 place = glm::dvec2(at.at_px) + 3.5, there(7.0);
        CHECK(glm::distance(pointAt(whole, place, 2.0), pointAt(eye, there, 2.0)) < 1e-12);
        covered += glm::ivec2(quarter % 2 == 0 ? 0 : at.at_px.x + at.size_px.x,
                              quarter < 2 ? 0 : at.at_px.y + at.size_px.y);
    }
    CHECK(covered == 2 * glm::ivec2(kPart));
    // However slow the device is, if a quarter does not take too long.
    const auto smooths = [&](SmoothAtRest wish, double samples, double ms) {
        return becomesSmooth(wish, samples, kPart, ms);
    };
    CHECK(smooths(SmoothAtRest::kAuto, 2.0, 900.0));
    CHECK_FALSE(smooths(SmoothAtRest::kAuto, 2.0, 1100.0));
    CHECK(smooths(SmoothAtRest::kOn, 2.0, 1100.0));
    CHECK_FALSE(smooths(SmoothAtRest::kOff, 2.0, 1.0));
    CHECK_FALSE(smooths(SmoothAtRest::kOn, 2.2, 1.0));
    CHECK_FALSE(becomesSmooth(SmoothAtRest::kOn, 2.0, {8000, 4500}, 1.0));
}

TEST_CASE("the first picture is coarse, those in motion keep up with the display, with a size that rests") {
    CHECK(MotionScale().scale() < 1.0);
    CHECK(MotionScale(/*is_software*/ true).scale() < MotionScale().scale());
    // The scale after many pictures that take one of these times each in full.
    const auto scaleFor = [](const std::array<double, 2>& full_ms, double refresh_hz) {
        MotionScale motion;
        std::set<double> last;
        for (std::size_t i = 0; i < 100; ++i) {
            motion.measure(motion.scale(), full_ms[i % 2] * motion.scale() * motion.scale(), refresh_hz);
            if (i >= 50) { last.insert(motion.scale()); }
        }
        CHECK(last.size() == 1);
        return motion.scale();
    };
    CHECK(scaleFor({12.0, 12.0}, 60.0) == 1.0);
    CHECK(scaleFor({12.0, 12.0}, 144.0) == doctest::Approx(std::sqrt(0.5)));
    CHECK(scaleFor({84.0, 48.0}, 60.0) == doctest::Approx(0.5));
}

}  // SUITE(orbit_camera)
