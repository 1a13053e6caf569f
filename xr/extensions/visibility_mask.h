// XR_KHR_visibility_mask: the parts of the eyes' pictures that the lenses never show.
#pragma once

#include "xr/instance.h"

#include <array>
#include <cstdint>
#include <vector>

namespace binosplat::xr {

// A part of an eye's picture that the lenses never show: triangles in the plane z = -1 of the eye (OpenXR
// axes).
struct HiddenMesh {
    std::vector<XrVector2f> vertices;
    std::vector<std::uint32_t> indices;
};

// The meshes of both eyes in a session; empty without the extension.
class HiddenMeshes {
public:
    HiddenMeshes(const Instance& instance, XrSession session, XrViewConfigurationType views);

    // After XR_TYPE_EVENT_DATA_VISIBILITY_MASK_CHANGED_KHR.
    void read(std::uint32_t eye);
    [[nodiscard]] const std::array<HiddenMesh, 2>& meshes() const { return meshes_; }
    // Changes whenever a mesh is read again.
    [[nodiscard]] int version() const { return version_; }

private:
    const Instance& instance_;
    XrSession session_;
    XrViewConfigurationType views_;
    std::array<HiddenMesh, 2> meshes_;
    int version_ = 0;
};

}  // namespace binosplat::xr
