// Which tiles of an eye's picture the lens never shows.
#pragma once

#include "engine/geometry.h"
#include "xr/session.h"

#include <cstdint>
#include <vector>

namespace binosplat::xr {

// How near the mesh's edge a tile may come, in pixels. Compositors turn a picture by what the head turned since, and bring in what lay
// just under the mesh: a tile's steps must not be seen there.
std::uint32_t hiddenMarginPx(const Intrinsics& intrinsics);

// A byte a tile, row-major: 1 where the centre of every pixel in it and within `margin_px` of it lies under the mesh. Pixels beside the
// picture count as hidden.
std::vector<std::uint8_t> findHiddenTiles(const HiddenMesh& mesh, const Intrinsics& intrinsics, glm::uvec2 size_px,
                                          std::uint32_t margin_px = 0);

}  // namespace binosplat::xr
