// Facts about where things stand: a straight edge of a wall is straight and at one place in space for both eyes, whatever their frusta.
#include "engine/geometry.h"
#include "tests/app/view/view_runs.h"

#include <doctest/doctest.h>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <numeric>
#include <optional>

TEST_SUITE_BEGIN("view_geometry");

namespace view_geometry_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

// builtin:step-edge: a grey wall of 0.75 at depth 2 ends at about x = 0, with a darker one behind it.
constexpr double kWallDepth = 2.0;
constexpr float kHalfway = 0.575f;

// A simulated eye, as the log has it: in STAGE, OpenXR's axes.
struct LoggedEye {
    glm::dvec3 position;
    glm::dquat orientation;
    double left, right, up, down;  // tangents
};

LoggedEye eyeOf(const nlohmann::json& frame, std::size_t side) {
    const nlohmann::json& eye = frame.at("eyes").at(side);
    const auto p = eye.at("pose").at("position").get<std::array<double, 3>>();
    const auto q = eye.at("pose").at("orientation").get<std::array<double, 4>>();
    const auto tangent = [&](const char* name) { return std::tan(eye.at("fov").at(name).get<double>()); };
    return {{p[0], p[1], p[2]}, {q[3], q[0], q[1], q[2]}, tangent("left"), tangent("right"), tangent("up"), tangent("down")};
}

// Where the wall's edge crosses a row, in pixels; empty if it does not.
std::optional<double> findEdge(const Image& picture, std::uint32_t row) {
    const auto grey = [&](std::uint32_t x) {
        return picture.values[(std::size_t{row} * picture.size_px.x + x) * static_cast<std::size_t>(picture.channels)];
    };
    for (std::uint32_t x = picture.size_px.x - 1; x > 0; --x) {
        if (grey(x - 1) < kHalfway || grey(x) >= kHalfway) { continue; }
        return x - 0.5 + static_cast<double>((grey(x - 1) - kHalfway) / (grey(x - 1) - grey(x)));
    }
    return std::nullopt;
}

// Where the edge is in the scene, row by row, if the wall is where it should be.
std::vector<glm::dvec2> traceEdge(const ViewRun& run, std::size_t frame, int side) {
    const LoggedEye eye = eyeOf(run.frames.at(frame), static_cast<std::size_t>(side));
    const Image picture = run.eye(frame, side);
    std::vector<glm::dvec2> points;
    for (std::uint32_t row = picture.size_px.y / 3; row < picture.size_px.y * 2 / 3; ++row) {
        const std::optional<double> column = findEdge(picture, row);
        if (!column) { continue; }
        const double x = *column / picture.size_px.x, y = (row + 0.5) / picture.size_px.y;
        const glm::dvec3 ray = eye.orientation * glm::dvec3(eye.left + x * (eye.right - eye.left), eye.up + y * (eye.down - eye.up), -1.0);
        // The scene's depth is -z of STAGE.
        const glm::dvec3 hit = eye.position + ray * ((-kWallDepth - eye.position.z) / ray.z);
        points.emplace_back(hit.x, hit.y);
    }
    return points;
}

// Mean and largest deviation of the edge's x.
struct Edge {
    double x, unevenness;
};
Edge measure(const std::vector<glm::dvec2>& points) {
    REQUIRE(points.size() > 40);
    const double mean = std::accumulate(points.begin(), points.end(), 0.0, [](double sum, const glm::dvec2& p) { return sum + p.x; }) /
                        static_cast<double>(points.size());
    double worst = 0.0;
    for (const glm::dvec2& p : points) { worst = std::max(worst, std::abs(p.x - mean)); }
    return {mean, worst};
}

// `made`: the right eye was made from the left one, whose silhouettes may be off by most of a pixel. A pixel is 0.02 wide there.
void checkEdge(const ViewRun& run, std::size_t frame, bool made) {
    CAPTURE(frame);
    const Edge left = measure(traceEdge(run, frame, kLeft)), right = measure(traceEdge(run, frame, kRight));
    CHECK(left.unevenness < 0.01);
    CHECK(right.unevenness < (made ? 0.02 : 0.01));
    CHECK(std::abs(left.x - right.x) < (made ? 0.02 : 0.004));
    CHECK(std::abs(left.x) < 0.06);
}

}  // namespace

TEST_CASE("a wall's edge stays straight and in its place, in asymmetric, canted, tilted and changing frusta") {
    const Workplace work;
    const std::string script =
        "rate 50\nsize 208 192\nframes every 5\nipd 0.068\n"
        "eye left angles -48 36 40 -44\neye right angles -36 48 40 -44\neye left cant 8\neye right cant 8\n"
        "head 0 position 0 1.6 0\nhead 0.15 position 0 1.6 0\nhead 0.25 position 0.2 1.7 -0.3 rotation 0.05 0.1 0.12 0.98\n"
        "at 0.4 eye left angles -40 50 30 -50\nat 0.4 eye right angles -30 35 45 -35\nat 0.54 exit\n";
    const std::string scene = "builtin:step-edge --load-first --hide-panel --hide-hands --eye 0,0,0 --look 0,0,4";
    for (const std::string mode : {"two-pass", "shared", "predicted"}) {
        CAPTURE(mode);
        const ViewRun run = runView(work, mode, script, scene + " --mode " + mode);
        checkClean(run);
        for (const std::size_t frame : {5, 15, 25}) { checkEdge(run, frame, mode == "predicted"); }
    }
}

TEST_CASE("swapped eyes would be noticed") {
    const Workplace work;
    const ViewRun run = runView(work, "run", "rate 90\nsize 192 192\nframes every 10\nat 0.13 exit\n",
                                "builtin:step-edge --load-first --hide-panel --hide-hands --mode two-pass --eye 0,0,0 --look 0,0,4");
    ViewRun swapped = run;
    for (auto& frame : swapped.frames) { std::swap(frame.at("eyes").at(0), frame.at("eyes").at(1)); }
    CHECK(std::abs(measure(traceEdge(swapped, 10, kLeft)).x - measure(traceEdge(swapped, 10, kRight)).x) > 0.05);
}

}  // namespace view_geometry_test
