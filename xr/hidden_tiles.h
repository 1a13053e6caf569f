// Which tiles of an eye's picture the lens never shows.
#pragma once

#include "engine/geometry.h"
#include "xr/session.h"

#include <cstdint>
#include <vector>

namespace binosplat::xr {

// A byte a tile, row-major: 1 where every pixel's centre lies under the mesh. Pixels beside the picture, in the last tiles of rows and
// columns, count as hidden.
std::vector<std::uint8_t> findHiddenTiles(const HiddenMesh& mesh, const Intrinsics& intrinsics, glm::uvec2 size_px);

}  // namespace binosplat::xr
