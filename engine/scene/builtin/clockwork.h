// The parts of builtin:clockwork, one function per file's idea. Shapes are drafted in the axes of lighting.h, whose window is in the far
// wall: half a turn about y from the scene's own, so that the light comes from behind the eye.
#pragma once

#include "engine/scene/builtin/patch.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <functional>
#include <vector>

namespace binosplat::builtin::clockwork {

inline constexpr float kOpacity = 0.95f;

// From the scene's axes to those of lighting.h, and back.
inline glm::vec3 turnAbout(const glm::vec3& v) { return {-v.x, v.y, -v.z}; }

// A round thing that faces the eye. Angles run from x towards y, clockwise as seen.
struct Round {
    glm::vec3 centre;
    float half_thickness;
    // `depth` away from the eye, from the middle plane.
    [[nodiscard]] glm::vec3 at(float radius, float angle, float depth) const {
        return turnAbout(centre + glm::vec3(radius * std::cos(angle), radius * std::sin(angle), depth));
    }
};

// Its face between two radii, and its edge at a radius from one angle to another; `outward`: seen from outside.
void addFace(Draft& draft, const Round& round, float inner, float outer, const MaterialAt& material, float detail);
void addEdge(Draft& draft, const Round& round, float radius, const glm::vec2& angles, bool outward, const MaterialAt& material,
             float detail);

// Where a thing is: a point p of it at rest has come to pivot + turn (p - pivot) + shift.
struct Placement {
    glm::dquat turn{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 shift{0.0};
    double opacity = 1.0;  // times its own
};

struct Thing {
    Draft draft;
    glm::dvec3 pivot{0.0};  // in the scene's axes, as its placements are
    std::function<Placement(double frame)> placeAt;
};

void addRoom(Draft& draft);                  // what stays: wall, table, posts, the clock's case and dial, the lamp's foot
void addWheels(std::vector<Thing>& things);  // three toothed wheels
void addClock(std::vector<Thing>& things);   // hand, pendulum, cuckoo and its door
void addLamp(std::vector<Thing>& things);    // a globe of light

}  // namespace binosplat::builtin::clockwork
