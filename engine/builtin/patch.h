// A generated scene as a list of parametric surface patches, and their conversion into any number of splats.
#pragma once

#include "engine/builtin/lighting.h"
#include "engine/scene/scene.h"

#include <functional>
#include <vector>

namespace binosplat::builtin {

// The material of a surface at a point; colours are linear.
struct Material {
    glm::vec3 albedo{0.5f};
    glm::vec3 emission{0.0f};
    float opacity = 0.97f;
};
using MaterialAt = std::function<Material(const glm::vec3& point, const glm::vec2& uv)>;

// A surface over the unit square. Splats lie in rows along u; their number per row follows the row's length,
// and their scales follow the spacing along both axes, so a patch has no gaps at any count, stretched or not.
struct Patch {
    std::function<glm::vec3(const glm::vec2& uv)> point;
    MaterialAt material;
    glm::vec2 size_m{1.0f};  // mean extents along u and v
    float detail = 1.0f;     // splats per area, relative
    // A point at the back of the surface near `point`.
    std::function<glm::vec3(const glm::vec3& point)> behind;
    bool lit = true;         // false: emission alone
    bool two_sided = false;  // lit through, as leaves and curtains are
    bool glossy = false;     // mirrors the room by SH of degree 3
};

class Draft {
public:
    Patch& add(Patch patch);
    std::vector<Occluder>& occluders() { return occluders_; }

    // Exactly `count` splats, spread over the patches by area times detail.
    [[nodiscard]] Scene make(std::uint64_t count, const Room& room, const Progress& progress) const;

private:
    std::vector<Patch> patches_;
    std::vector<Occluder> occluders_;
};

}  // namespace binosplat::builtin
