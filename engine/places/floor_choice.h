// The floor among a scene's planes, and with it the direction that is up.
#pragma once

#include "engine/scene/floor_plane.h"

#include <optional>
#include <vector>

namespace binosplat {

// What is known of up beside the splats.
struct UpHints {
    glm::dvec3 usual{0.0, -1.0, 0.0};                                          // up by convention, unit
    glm::dvec3 front{0.0, 0.0, -1.0};                                          // the side that scenes are usually seen from, unit
    enum class Known { kNothing, kAxis, kDirection } known = Known::kNothing;  // up is about `usual`, or about its opposite
    std::optional<glm::dvec3> seen_from{};                                     // the mean place of the cameras
    bool is_doubtful = false;                                                  // `usual`: only what looks like a floor bears it out
};
UpHints hintsOf(const Scene& scene);

// The plane that the scene stands on: it holds many splats and lies beneath nearly all, and things stand on it. About the usual up, to 45
// degrees, the best plane is taken, or a ceiling; in another direction it must be better than all planes that lead elsewhere, face up, not
// be a wall that things float before, and, where it faces the front, be no wall with a relief. If there are `seen_from`, these are above;
// and where the usual up is doubtful any floor about it is taken before the others.
std::optional<FloorPlane> chooseFloor(const std::vector<SplatSample>& samples, const UpHints& hints);

}  // namespace binosplat
