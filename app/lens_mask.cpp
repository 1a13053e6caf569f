// From the runtime's meshes to tiles.
#include "app/lens_mask.h"

#include "xr/convert.h"
#include "xr/hidden_tiles.h"

#include <algorithm>

namespace binosplat {

namespace {

bool areSame(const XrFovf& a, const XrFovf& b) {
    return a.angleLeft == b.angleLeft && a.angleRight == b.angleRight && a.angleUp == b.angleUp && a.angleDown == b.angleDown;
}

}  // namespace

std::array<std::span<const std::uint8_t>, 2> LensMask::update(const xr::Session& session, const std::array<xr::EyeView, 2>& views,
                                                              glm::uvec2 size_px) {
    for (std::size_t e = 0; e < 2; ++e) {
        Eye& eye = eyes_[e];
        const XrFovf& fov = views[e].fov;
        if (eye.mesh_version == session.hiddenMeshVersion() && eye.size_px == size_px && areSame(eye.fov, fov)) { continue; }
        eye = {session.hiddenMeshVersion(), fov, size_px, {}};
        const xr::HiddenMesh& mesh = session.hiddenMeshes()[e];
        if (mesh.indices.empty()) { continue; }
        eye.hidden = xr::findHiddenTiles(mesh, intrinsicsFromAngles(xr::fromXr(fov), size_px), size_px);
        if (std::ranges::find(eye.hidden, 1) == eye.hidden.end()) { eye.hidden.clear(); }
    }
    return {eyes_[0].hidden, eyes_[1].hidden};
}

}  // namespace binosplat
