// What lies far outside of a scene: its sky and far background, which all levels of detail show alike.
#pragma once

#include <glm/glm.hpp>

#include <optional>
#include <span>

namespace binosplat {

// The splats whose centres are farther than `beyond` from `middle`, scene units.
struct Surroundings {
    glm::vec3 middle{0.0f};
    float beyond = 0.0f;

    [[nodiscard]] bool has(const glm::vec3& centre) const { return glm::distance(centre, middle) > beyond; }
};

// Empty if hardly anything is that far outside, or if it is too much to be always shown.
std::optional<Surroundings> findSurroundings(std::span<const glm::vec3> centres);

}  // namespace binosplat
