// The standpoint for a scene without cameras, derived from its splats alone; one in fifty may be a floater.
#pragma once

#include "engine/geometry.h"
#include "engine/scene/scene.h"

#include <optional>
#include <string>

namespace binosplat {

struct StandpointWish {
    double fov_x_deg = 60.0;
    double metres_per_unit = 1.0;    // for the height of the eyes, if the scene is about as large as it says
    std::optional<glm::dvec3> up{};  // if known
};

struct Standpoint {
    View view;
    std::string why;     // half a sentence: "inside: ...", "outside: ..."
    std::string up_why;  // why up is as it is, likewise: "of the floor: ..."
    bool is_inside = false;
};

// A scene that surrounds its middle, such as a room or a street, is entered: at eye height above its floor,
// near the middle of the dense part but clear of it, facing the densest part. Anything else is viewed from
// the front (from -z if y points down, from +z if it points up) so that nine tenths of the splats fill the
// picture's width. Up is `wish.up`, or else the floor's (floor_choice.h), or else what the file or its format
// says.
Standpoint judgeStandpoint(const Scene& scene, const StandpointWish& wish = {});

// The nearest depth that is drawn unless one is given: a fifth of the size below, for scenes smaller than a
// unit.
inline constexpr double kUsualNear = 0.2;
double usualNear(const Scene& scene);

// The box, along the axes, with nine tenths of the splats of the scene proper: hills and sky beyond do not
// count.
struct SceneCore {
    glm::dvec3 middle{0.0};
    double size = 0.0;  // its longest side
};
SceneCore measureCore(const Scene& scene);
inline double coreSize(const Scene& scene) { return measureCore(scene).size; }

// The up of the plane beneath cameras whose mean place is given, if there is one. `doubtful`: the up that
// cameras suggest, unless the file states one; any floor around it is taken before the others.
std::optional<glm::dvec3> upBeneath(const Scene& scene, const glm::dvec3& cameras,
                                    const std::optional<glm::dvec3>& doubtful = {});

// The height of the floor along `up`, a unit vector, if there is one: dot(up, p) of its points.
std::optional<double> floorHeight(const Scene& scene, const glm::dvec3& up);

}  // namespace binosplat
