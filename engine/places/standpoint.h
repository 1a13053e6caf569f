// The standpoint for a scene without cameras, derived from its splats alone; one in fifty may be a floater.
#pragma once

#include "engine/geometry.h"
#include "engine/scene/scene.h"

#include <optional>
#include <string>

namespace binosplat {

struct StandpointWish {
    double fov_x_deg = 60.0;
    double metres_per_unit = 1.0;    // for the height of eyes, where the scene is about as large as it says
    std::optional<glm::dvec3> up{};  // if it is known
};

struct Standpoint {
    View view;
    std::string why;     // half a sentence: "inside: ...", "outside: ..."
    std::string up_why;  // where up is from, likewise: "of the floor: ..."
    bool is_inside = false;
};

// A scene that surrounds its middle, a room or a street, is entered: at eye height over its floor, near the middle of the dense part but
// clear of it, facing the densest part. Anything else is viewed from the front (from -z where y points down, from +z where it points
// up) so that nine tenths of the splats fill the picture's width. Up is `wish.up`, else the floor's (floor_choice.h), else as the file or
// its format says.
Standpoint judgeStandpoint(const Scene& scene, const StandpointWish& wish = {});

// The nearest depth that is drawn unless it is given: a fifth of the size below, of scenes smaller than a unit.
inline constexpr double kUsualNear = 0.2;
double usualNear(const Scene& scene);

// The box, along the axes, with nine tenths of the splats that one stands in or in front of: hills and sky beyond do not count.
struct SceneCore {
    glm::dvec3 middle{0.0};
    double size = 0.0;  // its longest side
};
SceneCore measureCore(const Scene& scene);
inline double coreSize(const Scene& scene) { return measureCore(scene).size; }

// The up of the plane that lies beneath cameras whose mean place is given, if there is one. `doubtful`: up as they have it, unless the file
// says how it is; any floor about that is taken before the others.
std::optional<glm::dvec3> upBeneath(const Scene& scene, const glm::dvec3& cameras, const std::optional<glm::dvec3>& doubtful = {});

// The height of the floor along `up`, a unit vector, if there is one: dot(up, p) of its points.
std::optional<double> floorHeight(const Scene& scene, const glm::dvec3& up);

}  // namespace binosplat
