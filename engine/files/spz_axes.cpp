// The numbers are bits plus one: x points right instead of left; the vertical one of y and z points up
// instead of down; the other one to the front instead of back; z is the vertical one.
#include "engine/files/spz_axes.h"

#include "engine/files/quantized.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace binosplat {

namespace {

constexpr std::uint32_t kRight = 1, kUp = 2, kFront = 4, kVerticalZ = 8;
constexpr std::uint32_t kCoordinateSystem = 0xadbe0003u;

glm::vec3 signsOf(std::uint32_t bits) {
    return {(bits & kRight) != 0 ? 1.0f : -1.0f, (bits & kUp) != 0 ? -1.0f : 1.0f,
            (bits & kFront) != 0 ? 1.0f : -1.0f};
}

// Maps the file's axes to right, down, forward.
glm::dmat3 matrixOf(std::uint32_t bits) {
    const glm::dvec3 signs(signsOf(bits));
    const glm::dvec3 right(signs.x, 0.0, 0.0), down(0.0, signs.y, 0.0), forward(0.0, 0.0, signs.z);
    // The columns say where x, y, z point.
    return (bits & kVerticalZ) != 0 ? glm::dmat3(right, forward, down) : glm::dmat3(right, down, forward);
}

}  // namespace

SpzAxes::SpzAxes(std::uint32_t system)
    : system_(system),
      signs_(signsOf(system - 1)),
      z_is_up_(((system - 1) & kVerticalZ) != 0),
      sh_turn_(matrixOf(system - 1)) {
    for (std::size_t k = 0; k < sh_signs_.size() && !z_is_up_; ++k) {
        std::array<float, 15> unit{};
        unit[k] = 1.0f;
        sh_turn_.apply(unit.data(), 3);
        sh_signs_[k] = std::copysign(1.0f, unit[k]);
    }
}

std::string SpzAxes::describe() const {
    const std::uint32_t bits = system_ - 1;
    const char *vertical = (bits & kUp) != 0 ? "up" : "down",
               *level = (bits & kFront) != 0 ? "front" : "back";
    if (z_is_up_) { std::swap(vertical, level); }
    return fmt::format("x {}, y {}, z {}; {}-handed", (bits & kRight) != 0 ? "right" : "left", vertical,
                       level, glm::determinant(matrixOf(bits)) > 0.0 ? "right" : "left");
}

glm::vec3 SpzAxes::turn(const glm::vec3& position) const {
    return signs_ * (z_is_up_ ? glm::vec3(position.x, position.z, position.y) : position);
}

glm::quat SpzAxes::turn(const glm::quat& rotation) const {
    glm::quat turned = rotation;
    glm::vec3 signs = signs_;
    if (z_is_up_) {
        // A quarter turn about x maps z to y and y to -z.
        const float half = std::sqrt(0.5f);
        turned = glm::quat(half, -half, 0.0f, 0.0f) * rotation;
        signs.z = -signs.z;
    }
    // Signs s turn R into diag(s) R diag(s), which is the same ellipsoid: axes have no sign.
    return {turned.w, signs.y * signs.z * turned.x, signs.x * signs.z * turned.y,
            signs.x * signs.y * turned.z};
}

void SpzAxes::turnSh(float* rest, int sh_degree) const {
    if (z_is_up_) { return sh_turn_.apply(rest, sh_degree); }
    for (std::size_t k = 0; k < static_cast<std::size_t>(sh_degree * (sh_degree + 2)); ++k) {
        rest[k] = sh_signs_[k] * rest[k] + 0.0f;
    }  // no -0
}

std::optional<std::uint32_t> findSpzAxes(std::span<const std::byte> records) {
    while (records.size() >= 8) {
        const auto type = loadLittle<std::uint32_t>(records, 0),
                   bytes = loadLittle<std::uint32_t>(records, 4);
        records = records.subspan(8);
        if (bytes > records.size()) { break; }
        if (type == kCoordinateSystem && bytes >= 4) { return loadLittle<std::uint32_t>(records, 0); }
        records = records.subspan(bytes);
    }
    return std::nullopt;
}

}  // namespace binosplat
