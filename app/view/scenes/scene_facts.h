// A description of a scene, for the wearer.
#pragma once

#include "engine/scene/scene.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace binosplat {

struct SceneFacts {
    std::uint64_t splats = 0, left_out = 0;  // left_out: broken ones in the file
    std::string kind;                        // how splats are drawn, and what they are in the file
    int sh_degree = 0, sh_degree_in_file = 0;
    std::uint64_t device_bytes = 0;
    double size_units = 0.0;  // of its core, see SceneCore
    glm::dvec3 middle{0.0};   // the core's
    // Everything in it, for a folder; 0: made by the program, or from the web.
    std::uint64_t file_bytes = 0;
    bool is_from_web = false;
};

// For a scene as it was loaded from `source`.
SceneFacts factsOf(const Scene& scene, const LoadNotes& notes, const std::string& source);

// "12.3 MiB".
std::string inMib(std::uint64_t bytes);
// In a line: "125 000 splats, 3D Gaussians, 12.3 MiB".
std::string describeBriefly(const SceneFacts& facts);

// Names and values. `metres_per_unit` is the wearer's current scale.
std::vector<std::pair<std::string, std::string>> describeFacts(const SceneFacts& facts,
                                                               double metres_per_unit);

}  // namespace binosplat
