// The tiles of both eyes' pictures that the headset's lenses hide.
#pragma once

#include "xr/session.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace binosplat {

class LensMask {
public:
    // The hidden tiles for each eye, as FrameSettings expects them, valid until the next call; empty if
    // nothing is hidden. Recomputed only if a mesh, the angles or the size have changed. Meshes with the same
    // `version` as in the last call are the same meshes.
    std::array<std::span<const std::uint8_t>, 2> update(const std::array<xr::HiddenMesh, 2>& meshes,
                                                        int version, const std::array<xr::EyeView, 2>& views,
                                                        glm::uvec2 size_px);

private:
    struct Eye {
        int mesh_version = -1;
        xr::HiddenMesh mesh;
        XrFovf fov{};
        glm::uvec2 size_px{0, 0};
        std::vector<std::uint8_t> hidden;
    };
    std::array<Eye, 2> eyes_;
};

}  // namespace binosplat
