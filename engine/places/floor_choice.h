// Chooses a scene's floor among its planes, and with it the direction of up.
#pragma once

#include "engine/scene/floor_plane.h"

#include <optional>
#include <vector>

namespace binosplat {

// What is known about up apart from the splats.
struct UpHints {
    glm::dvec3 usual{0.0, -1.0, 0.0};  // up by convention, unit
    // The side from which scenes are usually seen, unit.
    glm::dvec3 front{0.0, 0.0, -1.0};
    // Up is about `usual`, or about its opposite.
    enum class Known { kNothing, kAxis, kDirection } known = Known::kNothing;
    std::optional<glm::dvec3> seen_from{};  // mean position of the cameras
    // `usual` needs confirmation by a floor
    bool is_doubtful = false;
};
UpHints hintsOf(const Scene& scene);

// The plane on which the scene stands: it contains many splats and lies beneath nearly all others, and things
// stand on it. Within 45 degrees of the usual up, the best plane or a ceiling is chosen. In other directions,
// a plane must be better than all those with other normals, face up, and not be a wall in front of which
// things float; if it faces the front, it must not be a wall with a relief. If `seen_from` is set, it must be
// above the floor; if the usual up is doubtful, any floor around it is preferred to others.
std::optional<FloorPlane> chooseFloor(const std::vector<SplatSample>& samples, const UpHints& hints);

}  // namespace binosplat
