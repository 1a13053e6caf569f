// The moving things of builtin:clockwork, and how they move; procedural.h has the same in words.
#include "engine/scene/builtin/builtin.h"
#include "engine/scene/builtin/clockwork.h"
#include "engine/scene/builtin/noise.h"
#include "engine/scene/builtin/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace binosplat::builtin::clockwork {

namespace {

constexpr double kFrames = static_cast<double>(kClockworkFrames), kTurn = 2.0 * std::numbers::pi;
const glm::dvec3 kAhead(0.0, 0.0, 1.0), kDown(0.0, 1.0, 0.0);

// From 0 at frame `from` to 1 at frame `to`, at rest at both.
double ease(double frame, double from, double to) {
    const double t = std::clamp((frame - from) / (to - from), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// Turned about its pivot by `angle(frame)`.
template <typename Angle>
auto turning(const glm::dvec3& axis, const Angle& angle) {
    return [=](double frame) { return Placement{.turn = glm::angleAxis(angle(frame), axis)}; };
}

// Turned metal: rings about the middle, a little worn.
MaterialAt metal(const glm::vec3& colour, const glm::vec3& centre, float ring) {
    return [=](const glm::vec3& p, const glm::vec2&) {
        const glm::vec2 at = glm::vec2(turnAbout(p) - centre);
        const float rings = 0.5f + 0.5f * std::cos(2.0f * kPi * glm::length(at) / ring), worn = fractalNoise(at * 9.0f, 3u) - 0.5f;
        return Material{colour * (0.76f + 0.30f * rings + 0.25f * worn), glm::vec3(0.0f), kOpacity};
    };
}

// The half angle at which a tooth or a spoke ends, by the radius.
using HalfAngle = std::function<float(float radius)>;

// A tooth or a spoke from one radius to another: its face and both flanks.
void addArm(Draft& draft, const Round& round, float angle, const glm::vec2& radii, const HalfAngle& half_angle, const MaterialAt& material,
            float detail) {
    const float middle = 0.5f * (radii.x + radii.y), h = round.half_thickness;
    Patch face;
    face.point = [=](const glm::vec2& uv) {
        const float r = glm::mix(radii.x, radii.y, uv.y);
        return round.at(r, angle + (2.0f * uv.x - 1.0f) * half_angle(r), -h);
    };
    face.material = material;
    face.size_m = {2.0f * middle * half_angle(middle), radii.y - radii.x};
    face.detail = detail;
    face.behind = [inside = round.at(middle, angle, h)](const glm::vec3&) { return inside; };
    draft.add(face);
    for (const float side : {-1.0f, 1.0f}) {
        Patch flank = face;
        flank.point = [=](const glm::vec2& uv) {
            const float r = glm::mix(radii.x, radii.y, uv.y);
            return round.at(r, angle + side * half_angle(r), h * (2.0f * uv.x - 1.0f));
        };
        flank.size_m = {2.0f * h, radii.y - radii.x};
        flank.detail = 0.5f * detail;
        flank.behind = [inside = round.at(middle, angle, 0.0f)](const glm::vec3&) { return inside; };
        draft.add(std::move(flank));
    }
}

struct Wheel {
    glm::vec3 centre;
    int teeth;
    double turns;  // in the loop; an even number, so that quaternions, too, come back to where they began
    float tooth_deg;
    glm::vec3 colour;
    float hub, rim;  // between these radii there are spokes; equal: none
    int spokes;
};

constexpr float kModule = 0.05f, kHalfThickness = 0.04f;

// Involute flanks with a pressure angle of 20 degrees, a hundredth of the pitch thinner on each side; radial below the base circle.
HalfAngle involute(int teeth) {
    const float pitch_radius = 0.5f * kModule * static_cast<float>(teeth), pressure = glm::radians(20.0f);
    const auto inv = [](float angle) { return std::tan(angle) - angle; };
    return [=](float radius) {
        const float at = std::acos(std::min(1.0f, pitch_radius * std::cos(pressure) / radius));
        return 0.48f * kPi / static_cast<float>(teeth) + inv(pressure) - inv(at);
    };
}

Thing makeWheel(const Wheel& wheel) {
    Thing thing;
    const Round round{wheel.centre, kHalfThickness};
    const float pitch_radius = 0.5f * kModule * static_cast<float>(wheel.teeth), root = pitch_radius - kModule,
                tip = pitch_radius + 0.8f * kModule, first = glm::radians(wheel.tooth_deg),
                step = 2.0f * kPi / static_cast<float>(wheel.teeth);
    const MaterialAt body = metal(wheel.colour, wheel.centre, 0.05f), white = metal({0.50f, 0.48f, 0.44f}, wheel.centre, 0.05f);
    Draft& draft = thing.draft;
    const HalfAngle tooth = involute(wheel.teeth);
    for (int i = 0; i < wheel.teeth; ++i) {
        const float angle = first + step * static_cast<float>(i);
        const MaterialAt& paint = i == 0 ? white : body;
        addArm(draft, round, angle, {root, tip}, tooth, paint, 1.3f);
        addEdge(draft, round, tip, {angle - tooth(tip), angle + tooth(tip)}, true, paint, 0.6f);
        addEdge(draft, round, root, {angle + tooth(root), angle + step - tooth(root)}, true, body, 0.6f);
    }
    addFace(draft, round, wheel.rim, root, body, 1.0f);
    if (wheel.hub < wheel.rim) {
        addFace(draft, round, 0.0f, wheel.hub, body, 1.0f);
        const HalfAngle spoke = [half_width = 0.3f * wheel.hub](float radius) { return std::asin(half_width / radius); };
        const float turn = 2.0f * kPi / static_cast<float>(wheel.spokes);
        for (int i = 0; i < wheel.spokes; ++i) {
            const float angle = first + turn * static_cast<float>(i);
            addArm(draft, round, angle, {wheel.hub, wheel.rim}, spoke, body, 1.0f);
            addEdge(draft, round, wheel.hub, {angle + spoke(wheel.hub), angle + turn - spoke(wheel.hub)}, true, body, 0.5f);
            addEdge(draft, round, wheel.rim, {angle + spoke(wheel.rim), angle + turn - spoke(wheel.rim)}, false, body, 0.5f);
        }
    }
    // A boss, the end of the axle.
    const Round boss{wheel.centre - glm::vec3(0.0f, 0.0f, kHalfThickness + 0.015f), 0.015f};
    const float boss_radius = 0.03f + 0.25f * wheel.hub;
    const MaterialAt steel = metal({0.14f, 0.14f, 0.15f}, wheel.centre, boss_radius);
    addFace(draft, boss, 0.0f, boss_radius, steel, 1.5f);
    addEdge(draft, boss, boss_radius, {0.0f, 2.0f * kPi}, true, steel, 1.0f);

    draft.occluders().push_back({Occluder::Shape::kEllipsoid, turnAbout(wheel.centre), {root, root, kHalfThickness}, 0.0f});
    thing.pivot = wheel.centre;
    thing.placeAt = turning(kAhead, [turns = wheel.turns](double frame) { return kTurn * turns * frame / kFrames; });
    return thing;
}

}  // namespace

void addFace(Draft& draft, const Round& round, float inner, float outer, const MaterialAt& material, float detail) {
    Patch patch;
    patch.point = [=](const glm::vec2& uv) { return round.at(glm::mix(inner, outer, uv.y), 2.0f * kPi * uv.x, -round.half_thickness); };
    patch.material = material;
    patch.size_m = {kPi * (inner + outer), outer - inner};
    patch.detail = detail;
    patch.behind = [inside = turnAbout(round.centre + glm::vec3(0.0f, 0.0f, 100.0f))](const glm::vec3&) { return inside; };
    draft.add(std::move(patch));
}

void addEdge(Draft& draft, const Round& round, float radius, const glm::vec2& angles, bool outward, const MaterialAt& material,
             float detail) {
    Patch patch;
    patch.point = [=](const glm::vec2& uv) {
        return round.at(radius, glm::mix(angles.x, angles.y, uv.x), round.half_thickness * (2.0f * uv.y - 1.0f));
    };
    patch.material = material;
    patch.size_m = {radius * (angles.y - angles.x), 2.0f * round.half_thickness};
    patch.detail = detail;
    patch.behind = [middle = turnAbout(round.centre), outward](const glm::vec3& point) {
        const glm::vec3 axis(middle.x, middle.y, point.z);
        return outward ? axis : 2.0f * point - axis;
    };
    draft.add(std::move(patch));
}

void addWheels(std::vector<Thing>& things) {
    const float first = -glm::degrees(std::atan2(4.0f, 3.0f));  // where the first touches the second
    things.push_back(makeWheel({{-0.39f, 0.24f, 1.6f}, 18, 2.0, first, {0.27f, 0.155f, 0.035f}, 0.14f, 0.30f, 6}));
    things.push_back(makeWheel({{0.015f, -0.30f, 1.6f}, 9, -4.0, first + 200.0f, {0.26f, 0.075f, 0.035f}, 0.065f, 0.135f, 3}));
    things.push_back(makeWheel({{-0.285f, -0.525f, 1.6f}, 6, 6.0, first + 105.0f, {0.05f, 0.125f, 0.18f}, 0.0f, 0.0f, 0}));
}

void addClock(std::vector<Thing>& things) {
    // The hand: a blade that begins on the far side of its pin.
    Thing hand;
    const Round pin{{0.62f, -0.46f, 2.44f}, 0.015f};
    Patch blade;
    blade.point = [pin](const glm::vec2& uv) {
        const float along = glm::mix(-0.09f, 0.31f, uv.x), half_width = glm::mix(0.028f, 0.012f, uv.x);
        return turnAbout(pin.centre + glm::vec3(half_width * (2.0f * uv.y - 1.0f), -along, 0.0f));
    };
    blade.material = plain({0.16f, 0.012f, 0.01f}, kOpacity);
    blade.size_m = {0.40f, 0.04f};
    blade.detail = 1.5f;
    blade.behind = [](const glm::vec3& point) { return point - glm::vec3(0.0f, 0.0f, 1.0f); };
    hand.draft.add(std::move(blade));
    const MaterialAt brass = metal({0.25f, 0.15f, 0.04f}, pin.centre, 0.04f);
    addFace(hand.draft, {pin.centre - glm::vec3(0.0f, 0.0f, 0.01f), 0.015f}, 0.0f, 0.04f, brass, 1.5f);
    hand.pivot = pin.centre;
    hand.placeAt = turning(kAhead, [](double frame) { return 2.0 * kTurn * frame / kFrames; });
    things.push_back(std::move(hand));

    // The pendulum: a rod and a bob.
    Thing pendulum;
    const glm::vec3 pivot(0.62f, -0.10f, 2.48f);
    const Round bob{pivot + glm::vec3(0.0f, 0.62f, 0.0f), 0.02f};
    addQuad(pendulum.draft,
            {turnAbout(pivot + glm::vec3(-0.014f, -0.02f, 0.0f)),
             turnAbout({0.028f, 0.0f, 0.0f}),
             {0.0f, 0.52f, 0.0f},
             turnAbout({0.0f, 0.0f, -9.0f})},
            plain({0.06f, 0.035f, 0.02f}, kOpacity), 1.2f);
    const MaterialAt gold = metal({0.30f, 0.18f, 0.04f}, bob.centre, 0.075f);
    addFace(pendulum.draft, bob, 0.0f, 0.14f, gold, 1.2f);
    addEdge(pendulum.draft, bob, 0.14f, {0.0f, 2.0f * kPi}, true, gold, 0.8f);
    pendulum.pivot = pivot;
    pendulum.placeAt = turning(kAhead, [](double frame) { return glm::radians(20.0) * std::sin(2.0 * kTurn * frame / kFrames); });
    things.push_back(std::move(pendulum));

    // The cuckoo: a box with eyes and a beak, on a board.
    Thing cuckoo;
    const glm::vec3 body(0.62f, -0.985f, 2.705f);
    const MaterialAt feathers = [body](const glm::vec3& p, const glm::vec2&) {
        const glm::vec3 at = turnAbout(p) - body;
        const bool front = at.z < -0.0695f;
        const float eye = glm::length(glm::vec2(std::abs(at.x) - 0.042f, at.y + 0.03f));
        const float wing = front ? 1.0f : glm::smoothstep(0.0f, 0.01f, std::abs(at.y - 0.01f) + std::abs(at.z) - 0.06f);
        glm::vec3 colour = glm::mix(glm::vec3(0.20f, 0.09f, 0.01f), glm::vec3(0.42f, 0.25f, 0.03f), wing);
        if (front) { colour = glm::mix(glm::vec3(0.02f), colour, glm::smoothstep(0.016f, 0.022f, eye)); }
        return Material{colour, glm::vec3(0.0f), kOpacity};
    };
    addBox(cuckoo.draft, {turnAbout(body), {0.08f, 0.08f, 0.07f}, 0.0f, true}, feathers, 1.6f, false);
    addBox(cuckoo.draft, {turnAbout(body + glm::vec3(0.0f, 0.015f, -0.09f)), {0.022f, 0.016f, 0.02f}, 0.0f, true},
           plain({0.40f, 0.09f, 0.01f}, kOpacity), 1.6f, false);
    addBox(cuckoo.draft, {turnAbout(body + glm::vec3(0.0f, 0.09f, 0.0f)), {0.05f, 0.01f, 0.07f}, 0.0f, true},
           plain({0.14f, 0.075f, 0.03f}, kOpacity), 1.0f, false);
    cuckoo.placeAt = [](double frame) {
        return Placement{.shift = {0.0, 0.0, -0.35 * (ease(frame, 32.0, 44.0) - ease(frame, 64.0, 76.0))}};
    };
    things.push_back(std::move(cuckoo));

    // Its door, hinged on the left.
    Thing door;
    const glm::vec3 hinge(0.495f, -0.985f, 2.545f);
    const MaterialAt panel = [](const glm::vec3&, const glm::vec2& uv) {
        const glm::vec2 edge = glm::min(uv, 1.0f - uv);
        const float frame = 1.0f - glm::smoothstep(0.12f, 0.15f, std::min(edge.x, edge.y));
        return Material{glm::mix(glm::vec3(0.22f, 0.03f, 0.015f), glm::vec3(0.36f, 0.27f, 0.14f), frame), glm::vec3(0.0f), kOpacity};
    };
    addQuad(door.draft,
            {turnAbout(hinge - glm::vec3(0.0f, 0.13f, 0.0f)),
             turnAbout({0.25f, 0.0f, 0.0f}),
             {0.0f, 0.26f, 0.0f},
             turnAbout({0.0f, 0.0f, -9.0f})},
            panel, 1.3f);
    door.pivot = hinge;
    door.placeAt = turning(kDown, [](double frame) { return glm::radians(115.0) * (ease(frame, 20.0, 32.0) - ease(frame, 76.0, 88.0)); });
    things.push_back(std::move(door));
}

void addLamp(std::vector<Thing>& things) {
    Thing globe;
    const glm::vec3 centre(0.94f, 0.38f, 2.0f);
    const MaterialAt glow = [centre](const glm::vec3& p, const glm::vec2&) {
        const glm::vec3 out = glm::normalize(turnAbout(p) - centre);
        return Material{glm::vec3(0.0f), glm::mix(glm::vec3(1.1f, 0.42f, 0.08f), glm::vec3(3.0f, 1.9f, 0.75f), out.z * out.z), kOpacity};
    };
    addCushion(globe.draft, {turnAbout(centre), glm::vec3(0.15f), 0.0f}, 2.0f, glow, 0.8f, false);
    globe.placeAt = [](double frame) { return Placement{.opacity = 1.0 - ease(frame, 40.0, 52.0) + ease(frame, 88.0, 100.0)}; };
    things.push_back(std::move(globe));
}

}  // namespace binosplat::builtin::clockwork
