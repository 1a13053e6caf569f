// Files of cameras, as trainings write them.
#pragma once

#include "tests/suite.h"

#include <glm/glm.hpp>

namespace binosplat::test {

inline constexpr const char* kNotTurned = "[[1, 0, 0], [0, 1, 0], [0, 0, 1]]";
inline std::string cameraJson(const std::string& name, const glm::dvec3& at,
                              const std::string& rotation = kNotTurned, glm::uvec2 size_px = {8, 8},
                              double focal_px = 8.0) {
    return fmt::format(R"({{"img_name": "{}", "position": [{}, {}, {}], "rotation": {}, "width": {},)"
                       R"( "height": {}, "fx": {}, "fy": {}}})",
                       name, at.x, at.y, at.z, rotation, size_px.x, size_px.y, focal_px, focal_px);
}

}  // namespace binosplat::test
