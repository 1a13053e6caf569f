// The scene that moves, against the truth that procedural.h states.
#include "engine/scene/procedural.h"
#include "tests/engine/scene/ply_files.h"

#include <algorithm>
#include <numbers>

TEST_SUITE_BEGIN("clockwork");

namespace clockwork_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

constexpr std::uint64_t kFew = 4000;
constexpr double kTurn = 2.0 * std::numbers::pi;

Scene sceneAt(std::uint64_t frame, std::uint64_t splats = kFew) { return makeBuiltin("builtin:clockwork", splats, {}, frame); }

std::size_t stillCount(const Scene& scene) { return scene.size() * 3 / 5; }

// The splats, of those that move, for which `is_part` holds at frame 0.
template <typename IsPart>
std::vector<std::size_t> selectMoving(const Scene& scene, const IsPart& is_part) {
    std::vector<std::size_t> part;
    for (std::size_t i = stillCount(scene); i < scene.size(); ++i) {
        if (is_part(glm::dvec3(scene.positions[i]))) { part.push_back(i); }
    }
    return part;
}

// By an angle about z (x towards y) or about y (z towards x), with nothing but sines and cosines.
glm::dvec3 turnAboutZ(const glm::dvec3& v, double angle) {
    return {std::cos(angle) * v.x - std::sin(angle) * v.y, std::sin(angle) * v.x + std::cos(angle) * v.y, v.z};
}
glm::dvec3 turnAboutY(const glm::dvec3& v, double angle) {
    return {std::cos(angle) * v.x + std::sin(angle) * v.z, v.y, std::cos(angle) * v.z - std::sin(angle) * v.x};
}

double rise(std::uint64_t frame, double from, double to) {
    const double t = (static_cast<double>(frame) - from) / (to - from);
    return t <= 0.0 ? 0.0 : t >= 1.0 ? 1.0 : t * t * (3.0 - 2.0 * t);
}

// The centres of `part` have been turned about `pivot`, and so have their axes.
template <typename Turn>
void checkTurned(const Scene& rest, const Scene& moved, const std::vector<std::size_t>& part, const glm::dvec3& pivot, const Turn& turn) {
    double farthest = 0.0, skewest = 0.0;
    for (const std::size_t i : part) {
        farthest = std::max(farthest, glm::distance(pivot + turn(glm::dvec3(rest.positions[i]) - pivot), glm::dvec3(moved.positions[i])));
        for (const glm::vec3& axis : {glm::vec3(1.0f, 0.0f, 0.0f), glm::vec3(0.0f, 1.0f, 0.0f)}) {
            skewest = std::max(skewest, glm::distance(turn(glm::dvec3(rest.rotations[i] * axis)), glm::dvec3(moved.rotations[i] * axis)));
        }
    }
    CHECK(farthest < 1e-6);
    CHECK(skewest < 2e-6);
}

struct Wheel {
    int teeth;
    glm::dvec3 middle;
    double turns, tooth_deg;
    [[nodiscard]] double pitchRadius() const { return 0.025 * teeth; }
    [[nodiscard]] double angle(std::uint64_t frame) const { return kTurn * turns * static_cast<double>(frame) / 120.0; }
};
const double kFirst = -glm::degrees(std::atan2(4.0, 3.0));
const Wheel kWheels[] = {
    {18, {-0.39, 0.24, 1.6}, 2.0, kFirst}, {9, {0.015, -0.30, 1.6}, -4.0, kFirst + 200.0}, {6, {-0.285, -0.525, 1.6}, 6.0, kFirst + 105.0}};

}  // namespace

TEST_CASE("clockwork has the same splats in every frame, repeats after 120, and three fifths of it are still to the last bit") {
    CHECK(kClockworkFrames == 120);
    CHECK(builtinFrameCount("clockwork") == 120);
    CHECK(builtinFrameCount("builtin:clockwork") == 120);
    const Scene rest = sceneAt(0);
    const auto still = static_cast<std::ptrdiff_t>(stillCount(rest));
    std::vector<bool> has_changed(rest.size(), false);
    for (const std::uint64_t frame : {1u, 15u, 38u, 60u, 77u, 119u}) {
        CAPTURE(frame);
        const Scene scene = sceneAt(frame);
        REQUIRE(scene.size() == kFew);
        CHECK(scene.scales == rest.scales);
        CHECK(scene.sh == rest.sh);
        CHECK(scene.sh_degree == 0);
        CHECK_FALSE(scene.isGaussian3d());
        CHECK(std::equal(rest.positions.begin(), rest.positions.begin() + still, scene.positions.begin()));
        CHECK(std::equal(rest.rotations.begin(), rest.rotations.begin() + still, scene.rotations.begin()));
        CHECK(std::equal(rest.opacities.begin(), rest.opacities.begin() + still, scene.opacities.begin()));
        for (std::size_t i = 0; i < scene.size(); ++i) {
            has_changed[i] = has_changed[i] || scene.positions[i] != rest.positions[i] || scene.opacities[i] != rest.opacities[i];
        }
    }
    // The very middle of a wheel turns where it is.
    CHECK(std::count(has_changed.begin() + still, has_changed.end(), false) < 5);
    checkSameScene(sceneAt(120), rest);
    checkSameScene(sceneAt(120 * 7 + 38), sceneAt(38));
}

TEST_CASE("the wheels turn in mesh, each about its own middle") {
    const Scene rest = sceneAt(0);
    for (const Wheel& wheel : kWheels) {
        CAPTURE(wheel.teeth);
        // Within the roots of its teeth there is nothing of its neighbours.
        const double root = wheel.pitchRadius() - 0.05;
        const auto part = selectMoving(
            rest, [&](const glm::dvec3& p) { return std::abs(p.z - 1.6) < 0.1 && glm::length(glm::dvec2(p - wheel.middle)) < root; });
        CHECK(part.size() > 30);
        for (const std::uint64_t frame : {1u, 37u, 90u}) {
            checkTurned(rest, sceneAt(frame), part, wheel.middle, [&](const glm::dvec3& v) { return turnAboutZ(v, wheel.angle(frame)); });
        }
        // The white tooth, in a frame in which it is not next to a neighbour's.
        const Scene scene = sceneAt(10);
        glm::dvec3 sum(0.0);
        for (std::size_t i = stillCount(scene); i < scene.size(); ++i) {
            const glm::dvec3 offset = glm::dvec3(scene.positions[i]) - wheel.middle;
            const double radius = glm::length(glm::dvec2(offset));
            const bool is_tooth = std::abs(offset.z + 0.04) < 1e-4 && radius > root && radius < wheel.pitchRadius() + 0.04;
            if (is_tooth && scene.sh[3 * i] > 0.4f && scene.sh[3 * i + 2] > 0.4f) { sum += offset; }
        }
        const glm::dvec3 found = turnAboutZ(sum, -glm::radians(wheel.tooth_deg) - wheel.angle(10));
        CHECK(std::abs(std::atan2(found.y, found.x)) < glm::radians(4.0));
    }
    // Where two wheels touch, a tooth of one meets a gap of the other at all times.
    for (int i = 0; i < 2; ++i) {
        const Wheel &a = kWheels[i], &b = kWheels[i + 1];
        const glm::dvec3 between = b.middle - a.middle;
        CHECK(glm::length(between) == doctest::Approx(a.pitchRadius() + b.pitchRadius()));
        for (std::uint64_t frame = 0; frame < 120; ++frame) {
            const double direction = std::atan2(between.y, between.x);
            const double teeth_a = (direction - glm::radians(a.tooth_deg) - a.angle(frame)) / kTurn * a.teeth,
                         teeth_b = (direction + 0.5 * kTurn - glm::radians(b.tooth_deg) - b.angle(frame)) / kTurn * b.teeth,
                         sum = teeth_a + teeth_b - 0.5;
            CHECK(std::abs(sum - std::round(sum)) < 1e-9);
        }
    }
}

TEST_CASE("the hand turns, the pendulum swings, the cuckoo comes out of its door and the lamp goes out") {
    const Scene rest = sceneAt(0, 10'000);
    const glm::dvec3 pin(0.62, -0.46, 2.44), pivot(0.62, -0.10, 2.48), hinge(0.495, -0.985, 2.545), globe(0.94, 0.38, 2.0);
    const auto wheels = selectMoving(rest, [](const glm::dvec3& p) { return p.z < 1.7; });
    const auto hand = selectMoving(rest, [&](const glm::dvec3& p) { return glm::distance(p, pin) < 0.33 && p.z < 2.445; });
    const auto pendulum = selectMoving(rest, [&](const glm::dvec3& p) { return p.y > -0.13 && std::abs(p.z - pivot.z) < 0.021; });
    const auto cuckoo = selectMoving(rest, [](const glm::dvec3& p) { return p.z > 2.58; });
    const auto door = selectMoving(rest, [&](const glm::dvec3& p) { return std::abs(p.z - hinge.z) < 1e-5; });
    const auto lamp = selectMoving(rest, [&](const glm::dvec3& p) { return std::abs(glm::distance(p, globe) - 0.15) < 1e-4; });
    for (const auto& part : {wheels, hand, pendulum, cuckoo, door, lamp}) { CHECK(part.size() > 20); }
    CHECK(wheels.size() + hand.size() + pendulum.size() + cuckoo.size() + door.size() + lamp.size() == rest.size() - stillCount(rest));
    const auto highest = [&](const std::vector<std::size_t>& part) {
        return *std::ranges::min_element(part, {}, [&](std::size_t i) { return rest.positions[i].y; });
    };
    CHECK(glm::distance(glm::dvec3(rest.positions[highest(hand)]), pin - glm::dvec3(0.0, 0.31, 0.0)) < 0.03);

    for (const std::uint64_t frame : {9u, 26u, 41u, 46u, 60u, 70u, 80u, 95u, 119u}) {
        CAPTURE(frame);
        const Scene scene = sceneAt(frame, 10'000);
        const double s = static_cast<double>(frame) / 120.0;
        checkTurned(rest, scene, hand, pin, [&](const glm::dvec3& v) { return turnAboutZ(v, 2.0 * kTurn * s); });
        const double swing = glm::radians(20.0) * std::sin(2.0 * kTurn * s);
        checkTurned(rest, scene, pendulum, pivot, [&](const glm::dvec3& v) { return turnAboutZ(v, swing); });
        const double open = glm::radians(115.0) * (rise(frame, 20.0, 32.0) - rise(frame, 76.0, 88.0));
        checkTurned(rest, scene, door, hinge, [&](const glm::dvec3& v) { return turnAboutY(v, open); });
        const double out = 0.35 * (rise(frame, 32.0, 44.0) - rise(frame, 64.0, 76.0));
        double farthest = 0.0;
        for (const std::size_t i : cuckoo) {
            const glm::dvec3 expected = glm::dvec3(rest.positions[i]) - glm::dvec3(0.0, 0.0, out);
            farthest = std::max(farthest, glm::distance(expected, glm::dvec3(scene.positions[i])));
        }
        CHECK(farthest < 1e-6);
        const double opacity = 0.95 * (1.0 - rise(frame, 40.0, 52.0) + rise(frame, 88.0, 100.0));
        for (const std::size_t i : lamp) {
            REQUIRE(scene.opacities[i] == doctest::Approx(opacity));
            REQUIRE(scene.positions[i] == rest.positions[i]);
        }
    }
    for (const std::size_t i : lamp) { REQUIRE(rest.opacities[i] > 0.9f); }
    for (const std::uint64_t frame : {52u, 70u, 88u}) {
        const Scene scene = sceneAt(frame, 10'000);
        for (const std::size_t i : lamp) { REQUIRE(scene.opacities[i] == 0.0f); }
    }
}

TEST_CASE("quaternions of clockwork are unit and never change their sign, from the last frame to the first, too") {
    Scene before = sceneAt(119, 2000);
    double longest = 0.0, least_cosine = 1.0;
    for (std::uint64_t frame = 0; frame < 120; ++frame) {
        const Scene scene = sceneAt(frame, 2000);
        for (std::size_t i = 0; i < scene.size(); ++i) {
            longest = std::max(longest, std::abs(glm::length(glm::dquat(scene.rotations[i])) - 1.0));
            least_cosine = std::min(least_cosine, glm::dot(glm::dquat(before.rotations[i]), glm::dquat(scene.rotations[i])));
        }
        before = scene;
    }
    CHECK(longest < 1e-6);
    // Nothing turns faster than the smallest wheel, 18 degrees a frame.
    CHECK(least_cosine == doctest::Approx(std::cos(glm::radians(9.0))).epsilon(1e-5));
}

TEST_CASE("clockwork has exactly the splats asked for, finer ones if there are more") {
    const auto meanArea = [](const Scene& scene) {
        double sum = 0.0;
        for (const glm::vec2& scale : scene.scales) { sum += static_cast<double>(scale.x) * scale.y; }
        return sum / static_cast<double>(scene.size());
    };
    const double area = meanArea(sceneAt(25, 20'000));
    for (const std::uint64_t splats : {2000u, 2001u, 9999u, 60'000u}) {
        CAPTURE(splats);
        const Scene scene = sceneAt(25, splats);
        REQUIRE(scene.size() == splats);
        CHECK(scene.sh.size() == 3 * splats);
        CHECK(meanArea(scene) * static_cast<double>(splats) == doctest::Approx(20'000.0 * area).epsilon(splats < 9000 ? 0.2 : 0.05));
        for (const float opacity : scene.opacities) { REQUIRE(opacity == doctest::Approx(0.95f)); }
    }
    CHECK(makeBuiltin("clockwork").size() == 20'000);
    CHECK(contains(loadError("builtin:clockwork", 1999), "1999 splats asked for, expected 2000 to 1000000"));
}

TEST_CASE("scenes that do not move have frame 0 alone") {
    for (const BuiltinInfo& info : listBuiltins()) {
        if (info.name == "clockwork") { continue; }
        CAPTURE(info.name);
        CHECK(builtinFrameCount(info.name) == 1);
        std::string message;
        try {
            (void)makeBuiltin(info.name, 0, {}, 1);
        } catch (const Error& error) { message = error.what(); }
        CHECK(message == info.name + ": frame 1 asked for, expected 0: this scene does not move");
    }
    CHECK_NOTHROW((void)makeBuiltin("builtin:one-splat", 1, {}, 0));
    CHECK(builtinFrameCount("castle") == 1);
}

}  // namespace clockwork_test
