// The axes of an SPZ file, which its extension SPZ_ADOBE_coordinate_system may name, and the conversion of
// splats to the axes of trained PLY scenes.
#pragma once

#include "engine/scene/sh_turn.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace binosplat {

class SpzAxes {
public:
    // Right, up, back; the last one that the extension knows is right, front, up.
    static constexpr std::uint32_t kUsual = 4, kLast = 16;

    // `system` is the extension's number, 1 to kLast.
    explicit SpzAxes(std::uint32_t system = kUsual);

    // The directions of x, y and z, and their handedness.
    [[nodiscard]] std::string describe() const;

    // To axes right, down, forward.
    [[nodiscard]] glm::vec3 turn(const glm::vec3& position) const;
    [[nodiscard]] glm::quat turn(const glm::quat& rotation) const;
    // One channel from band 1 on, in place.
    void turnSh(float* rest, int sh_degree) const;

private:
    std::uint32_t system_;
    glm::vec3 signs_;  // of right, down, forward
    bool z_is_up_;     // or down: y and z have changed places
    ShTurn sh_turn_;
    std::array<float, 15> sh_signs_{};  // enough if y and z keep their places
};

// The number in the records of a file's extensions, if there is one. Records are type, length and content,
// one after the other; a broken one ends the search.
std::optional<std::uint32_t> findSpzAxes(std::span<const std::byte> records);

}  // namespace binosplat
