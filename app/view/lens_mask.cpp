// From the runtime's meshes to tiles.
#include "app/view/lens_mask.h"

#include "xr/convert.h"
#include "xr/hidden_tiles.h"

#include <algorithm>
#include <cmath>

namespace binosplat {

namespace {

// Angles may shiver by what float32 is exact to; a tenth of a milliradian is less than a pixel of any headset.
bool areSame(const XrFovf& a, const XrFovf& b) {
    constexpr float kShiver = 1e-4f;
    const auto near = [](float x, float y) { return std::abs(x - y) <= kShiver; };
    return near(a.angleLeft, b.angleLeft) && near(a.angleRight, b.angleRight) && near(a.angleUp, b.angleUp) &&
           near(a.angleDown, b.angleDown);
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
        const Intrinsics intrinsics = intrinsicsFromAngles(xr::fromXr(fov), size_px);
        eye.hidden = xr::findHiddenTiles(mesh, intrinsics, size_px, xr::hiddenMarginPx(intrinsics));
        if (std::ranges::find(eye.hidden, 1) == eye.hidden.end()) { eye.hidden.clear(); }
    }
    return {eyes_[0].hidden, eyes_[1].hidden};
}

}  // namespace binosplat
