// Facts about the simulated headset's poses and visibility mask.
#include "xr/simulated/compose/geometry.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

TEST_SUITE_BEGIN("simulated_geometry");

namespace simulated_geometry_test {

using namespace simulated;

namespace {

constexpr double kQuarter = std::numbers::pi / 2.0;

bool isNear(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) < 1e-12; }

Pose turnedLeft(double angle_rad, const glm::dvec3& position) { return {glm::angleAxis(angle_rad, glm::dvec3(0, 1, 0)), position}; }

// Twice the area, positive if counter-clockwise.
double signedArea(const Mesh& mesh, std::size_t triangle) {
    const glm::dvec2 a(mesh.vertices[mesh.indices[3 * triangle]]), b(mesh.vertices[mesh.indices[3 * triangle + 1]]),
        c(mesh.vertices[mesh.indices[3 * triangle + 2]]);
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

double areaOf(const Mesh& mesh) {
    double area = 0.0;
    for (std::size_t triangle = 0; triangle < mesh.indices.size() / 3; ++triangle) { area += 0.5 * signedArea(mesh, triangle); }
    return area;
}

const Fov kFov{std::atan(-1.0), std::atan(0.5), std::atan(0.75), std::atan(-1.25)};  // 1.5 x 2 in tangents

}  // namespace

TEST_CASE("composed poses apply the inner first") {
    // A metre ahead of a head that looks left is at -x.
    const Pose pose = compose(turnedLeft(kQuarter, {1, 0, 0}), Pose{{1, 0, 0, 0}, {0, 0, -1}});
    CHECK(isNear(pose.position, {0, 0, 0}));
    CHECK(isNear(transform(pose, {0, 0, -2}), {-2, 0, 0}));
}

TEST_CASE("a pose and its inverse cancel") {
    const Pose pose = compose(turnedLeft(0.3, {1, 2, 3}), Pose{glm::angleAxis(0.7, glm::dvec3(1, 0, 0)), {-4, 5, 6}});
    CHECK(isNear(transform(inverse(pose), transform(pose, {7, 8, 9})), {7, 8, 9}));
    CHECK(isNear(compose(pose, inverse(pose)).position, {0, 0, 0}));
}

TEST_CASE("interpolation meets its ends") {
    const Pose from = turnedLeft(0.2, {1, 2, 3}), to = turnedLeft(1.0, {3, 2, 1});
    CHECK(isNear(interpolate(from, to, 0.0).position, from.position));
    CHECK(isNear(interpolate(from, to, 1.0).position, to.position));
    CHECK(isNear(interpolate(from, to, 0.25).orientation * glm::dvec3(0, 0, -1), {-std::sin(0.4), 0, -std::cos(0.4)}));
}

TEST_CASE("levelling keeps the heading alone") {
    const Pose tilted{turnedLeft(0.5, {}).orientation * glm::angleAxis(0.6, glm::dvec3(1, 0, 0)) * glm::angleAxis(0.2, glm::dvec3(0, 0, 1)),
                      {1, 2, 3}};
    const Pose level = makeLevel(tilted);
    CHECK(level.position == tilted.position);
    CHECK(isNear(level.orientation * glm::dvec3(0, 0, -1), {-std::sin(0.5), 0, -std::cos(0.5)}));
    CHECK(isNear(level.orientation * glm::dvec3(0, 1, 0), {0, 1, 0}));
}

TEST_CASE("levelling a head that looks straight up keeps its right") {
    const Pose up{turnedLeft(0.5, {}).orientation * glm::angleAxis(kQuarter, glm::dvec3(1, 0, 0)), {}};
    CHECK(isNear(makeLevel(up).orientation * glm::dvec3(1, 0, 0), {std::cos(0.5), 0, -std::sin(0.5)}));
}

TEST_CASE("the left eye is on the left and turns left") {
    const Pose left = headFromEye(kLeft, 0.06, 0.1), right = headFromEye(kRight, 0.06, 0.1);
    CHECK(isNear(left.position, {-0.03, 0, 0}));
    CHECK(isNear(right.position, {0.03, 0, 0}));
    CHECK((left.orientation * glm::dvec3(0, 0, -1)).x == doctest::Approx(-std::sin(0.1)));
    CHECK((right.orientation * glm::dvec3(0, 0, -1)).x == doctest::Approx(std::sin(0.1)));
}

TEST_CASE("an inset lies about its middle, and in its view") {
    const Fov view{-0.8, 0.6, 0.5, -0.7};
    const auto isInset = [&](const glm::dvec2& middle_rad, double half_rad, const Fov& expected) {
        const Fov found = makeInset(view, middle_rad, half_rad);
        CHECK(found.left_rad == doctest::Approx(expected.left_rad));
        CHECK(found.right_rad == doctest::Approx(expected.right_rad));
        CHECK(found.up_rad == doctest::Approx(expected.up_rad));
        CHECK(found.down_rad == doctest::Approx(expected.down_rad));
        CHECK(found.left_rad >= view.left_rad);
        CHECK(found.right_rad <= view.right_rad);
        CHECK(found.up_rad <= view.up_rad);
        CHECK(found.down_rad >= view.down_rad);
    };
    isInset({0.1, -0.2}, 0.3, {-0.2, 0.4, 0.1, -0.5});
    isInset({0.5, 0.0}, 0.3, {0.0, 0.6, 0.3, -0.3});
    isInset({-3.0, -1.0}, 0.3, {-0.8, -0.2, -0.1, -0.7});
    isInset({0.5, 0.4}, 0.65, {-0.7, 0.6, 0.5, -0.7});
    isInset({0.5, 0.4}, 2.0, view);
}

TEST_CASE("hidden and visible mesh fill the view together") {
    const Mesh hidden = makeHiddenMesh(kFov), visible = makeVisibleMesh(kFov);
    REQUIRE(hidden.indices.size() % 3 == 0);
    CHECK(areaOf(hidden) + areaOf(visible) == doctest::Approx(1.5 * 2.0));
    // A polygon of 64 corners on the ellipse has 32 sin(pi / 32) instead of pi.
    CHECK(areaOf(visible) == doctest::Approx(32.0 * std::sin(std::numbers::pi / 32.0) * 0.75 * 1.0));
}

TEST_CASE("mask triangles are counter-clockwise") {
    for (const Mesh& mesh : {makeHiddenMesh(kFov), makeVisibleMesh(kFov)}) {
        for (std::size_t triangle = 0; triangle < mesh.indices.size() / 3; ++triangle) { CHECK(signedArea(mesh, triangle) > 0.0); }
    }
}

TEST_CASE("mask vertices stay inside the view") {
    for (const Mesh& mesh : {makeHiddenMesh(kFov), makeVisibleMesh(kFov), makeVisibleOutline(kFov)}) {
        for (const std::uint32_t index : mesh.indices) { REQUIRE(index < mesh.vertices.size()); }
        for (const glm::vec2& vertex : mesh.vertices) {
            CHECK(vertex.x >= -1.0f - 1e-6f);
            CHECK(vertex.x <= 0.5f + 1e-6f);
            CHECK(vertex.y >= -1.25f - 1e-6f);
            CHECK(vertex.y <= 0.75f + 1e-6f);
        }
    }
}

TEST_CASE("the outline touches the four edges") {
    const Mesh outline = makeVisibleOutline(kFov);
    const auto [left, right] = std::ranges::minmax(outline.vertices, {}, &glm::vec2::x);
    CHECK(left.x == doctest::Approx(-1.0));
    CHECK(right.x == doctest::Approx(0.5));
    const auto [down, up] = std::ranges::minmax(outline.vertices, {}, &glm::vec2::y);
    CHECK(down.y == doctest::Approx(-1.25));
    CHECK(up.y == doctest::Approx(0.75));
    CHECK(outline.indices.size() == outline.vertices.size());
}

}  // namespace simulated_geometry_test
