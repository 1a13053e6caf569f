// Takes places from even sequences, and judges them by the clearance around them.
#include "engine/places/standing_views.h"

#include "engine/places/floor_choice.h"
#include "engine/places/lie.h"
#include "engine/places/standpoint.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace binosplat {

namespace {

constexpr std::size_t kMostJudged = 8192;
constexpr double kFovXDegrees = 60.0, kFaceDegrees = 92.0;         // faces of a cube that overlap
constexpr double kNarrowestDegrees = 1.0, kWidestDegrees = 100.0;  // for a view that shows a part
constexpr double kGoldenAngle = 2.399963229728653;
constexpr std::array kHeights{1.0, 0.75, 1.1};  // of the eyes, relative to a standing person's
// Distances of shells, relative to the one from which everything is seen.
constexpr std::array kDistances{1.0, 0.6, 0.8};
constexpr double kClear = 0.25, kInner = 0.9;  // in heights of the eyes; of the scene's sides
constexpr std::size_t kTriedPerPlace = 24;
constexpr std::size_t kFaces = 6;

double fractionOf(double value) { return value - std::floor(value); }

// Two numbers from 0 to 1, evenly spread over the unit square however many are taken (Roberts 2018, R2).
glm::dvec2 evenPoint(std::size_t i) {
    const auto n = static_cast<double>(i + 1);
    return {fractionOf(0.7548776662466927 * n), fractionOf(0.5698402909980532 * n)};
}

// A view from a shell around the middle of what is looked at.
View viewOfShell(const View& start, const Axes& axes, bool has_floor, std::size_t i) {
    const double distance = glm::length(start.eye - start.look) * kDistances.at(i % kDistances.size());
    const double lowest = std::sin(glm::radians(has_floor ? 4.0 : -50.0)),
                 highest = std::sin(glm::radians(70.0));
    const double up = lowest +
                      (highest - lowest) * fractionOf(0.6180339887498949 * static_cast<double>(i) + 0.3),
                 level = std::sqrt(1.0 - up * up);
    const double turn = kGoldenAngle * static_cast<double>(i);
    const glm::dvec3 from = axes.world(level * std::sin(turn), up, -level * std::cos(turn));
    return {start.look + distance * from, start.look, start.up, kFovXDegrees};
}

// The clearance that all but two in a thousand of the samples leave.
double clearanceAt(const std::vector<SplatSample>& samples, const glm::dvec3& place) {
    std::vector<double> distances;
    distances.reserve(samples.size());
    for (const SplatSample& sample : samples) {
        distances.push_back(glm::distance(sample.centre, place) - sample.reach);
    }
    return findQuantile(distances, 0.002);
}

// A place within the scene's sides: the clearest of several tries, unless one of the first is clear enough.
glm::dvec3 findPlace(const Lie& lie, const Axes& axes, const std::vector<SplatSample>& samples,
                     double eye_height, std::size_t place) {
    glm::dvec3 best{0.0};
    double clearest = -1e300;
    for (std::size_t i = 0; i < kTriedPerPlace && clearest < kClear * eye_height; ++i) {
        const glm::dvec2 at = kInner * (evenPoint(place * kTriedPerPlace + i) - 0.5);
        const double h = lie.floor_h + eye_height * kHeights.at(place % kHeights.size());
        const glm::dvec3 tried =
            axes.world(lie.x.middle() + at.x * lie.x.length(), h, lie.z.middle() + at.y * lie.z.length());
        const double clearance = clearanceAt(samples, tried);
        if (clearance > clearest) { clearest = clearance, best = tried; }
    }
    return best;
}

View viewOfFace(const Axes& axes, const glm::dvec3& eye, double turn, std::size_t face) {
    const glm::dvec3 ahead = axes.world(std::sin(turn), 0.0, std::cos(turn)),
                     right = axes.world(std::cos(turn), 0.0, -std::sin(turn));
    if (face >= 4) { return {eye, eye + (face == 4 ? axes.up : -axes.up), ahead, kFaceDegrees}; }
    const glm::dvec3 look = face % 2 == 0 ? ahead : right;
    return {eye, face < 2 ? eye + look : eye - look, axes.up, kFaceDegrees};
}

}  // namespace

std::vector<View> standingViews(const Scene& scene, std::size_t count, std::size_t first) {
    const Standpoint start = judgeStandpoint(scene);
    const std::vector<SplatSample> samples = coreOf(sampleSplats(scene, kMostJudged));
    const glm::dvec3 up = glm::normalize(start.view.up);
    std::optional<FloorPlane> floor =
        chooseFloor(samples, {.usual = up, .known = UpHints::Known::kDirection});
    if (floor && (floor->is_ceiling || glm::dot(floor->up, up) < 0.98)) { floor.reset(); }
    const Axes axes = start.is_inside ? alongSides(samples, axesOf(up, scene.y_up)) : axesOf(up, scene.y_up);
    std::vector<View> views;
    if (!start.is_inside) {
        for (std::size_t i = first; i < first + count; ++i) {
            views.push_back(viewOfShell(start.view, axes, floor.has_value(), i));
        }
        return views;
    }
    const Lie lie = lieOf(samples, axes, floor);
    const double eye_height = glm::dot(start.view.eye, up) - lie.floor_h;
    glm::dvec3 eye{0.0};
    for (std::size_t i = first; i < first + count; ++i) {
        const std::size_t place = i / kFaces;
        if (i == first || i % kFaces == 0) { eye = findPlace(lie, axes, samples, eye_height, place); }
        views.push_back(viewOfFace(axes, eye, kGoldenAngle * static_cast<double>(place), i % kFaces));
    }
    return views;
}

std::vector<View> viewsOnto(const glm::dvec3& low, const glm::dvec3& high, std::span<const View> from,
                            std::size_t count) {
    std::vector<View> places;
    for (const View& view : from) {
        if (std::ranges::find(places, view.eye, &View::eye) == places.end()) { places.push_back(view); }
    }
    const glm::dvec3 middle = 0.5 * (low + high);
    const double radius = std::max(0.5 * glm::length(high - low), 1e-6);
    std::vector<View> views;
    count = std::min(count, places.size());
    for (std::size_t i = 0; i < count; ++i) {
        View view = places[i * places.size() / count];
        const double distance = glm::distance(view.eye, middle);
        // Inside a part, the view is straight ahead.
        if (distance > 0.1 * radius) { view.look = middle; }
        const double half = distance > radius ? glm::degrees(std::asin(radius / distance)) : kWidestDegrees;
        view.fov_x_deg = std::clamp(2.0 * half, kNarrowestDegrees, kWidestDegrees);
        const glm::dvec3 ahead = glm::normalize(view.look - view.eye);
        const glm::dvec3 side =
            std::abs(ahead.x) < 0.7 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 0.0, 1.0);
        if (std::abs(glm::dot(ahead, glm::normalize(view.up))) > 0.99) { view.up = side; }
        views.push_back(view);
    }
    return views;
}

}  // namespace binosplat
