// From the runtime's meshes to tiles.
#include "app/view/headset/lens_mask.h"

#include "xr/convert.h"
#include "xr/hidden_tiles.h"

#include <algorithm>
#include <cmath>

namespace binosplat {

namespace {

// Angles, and with them the corners of meshes, may jitter by float32 rounding; a tenth of a milliradian is
// less than a pixel of any headset.
bool areNear(float a, float b) { return std::abs(a - b) <= 1e-4f; }

bool areSame(const XrFovf& a, const XrFovf& b) {
    return areNear(a.angleLeft, b.angleLeft) && areNear(a.angleRight, b.angleRight) &&
           areNear(a.angleUp, b.angleUp) && areNear(a.angleDown, b.angleDown);
}

bool areSame(const xr::HiddenMesh& a, const xr::HiddenMesh& b) {
    const auto same = [](const XrVector2f& p, const XrVector2f& q) {
        return areNear(p.x, q.x) && areNear(p.y, q.y);
    };
    return a.indices == b.indices && std::ranges::equal(a.vertices, b.vertices, same);
}

}  // namespace

std::array<std::span<const std::uint8_t>, 2> LensMask::update(const std::array<xr::HiddenMesh, 2>& meshes,
                                                              int version,
                                                              const std::array<xr::EyeView, 2>& views,
                                                              glm::uvec2 size_px) {
    for (std::size_t e = 0; e < 2; ++e) {
        Eye& eye = eyes_[e];
        const XrFovf& fov = views[e].fov;
        const xr::HiddenMesh& mesh = meshes[e];
        const bool has_same_mesh = eye.mesh_version == version || areSame(eye.mesh, mesh);
        eye.mesh_version = version;
        if (has_same_mesh && eye.size_px == size_px && areSame(eye.fov, fov)) { continue; }
        eye = {version, mesh, fov, size_px, {}};
        if (mesh.indices.empty()) { continue; }
        const Intrinsics intrinsics = intrinsicsFromAngles(xr::fromXr(fov), size_px);
        eye.hidden = xr::findHiddenTiles(mesh, intrinsics, size_px, xr::hiddenMarginPx(intrinsics));
        if (std::ranges::find(eye.hidden, 1) == eye.hidden.end()) { eye.hidden.clear(); }
    }
    return {eyes_[0].hidden, eyes_[1].hidden};
}

}  // namespace binosplat
