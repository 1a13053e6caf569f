// The tiles of an eye's picture that the lens never shows.
#pragma once

#include "engine/geometry.h"
#include "xr/extensions/visibility_mask.h"

#include <cstdint>
#include <vector>

namespace binosplat::xr {

// The least distance of a hidden tile from the mesh's edge, in pixels. Compositors rotate a picture by the
// latest head motion, which shows pixels just under the mesh: the steps of tiles must not be visible there.
std::uint32_t hiddenMarginPx(const Intrinsics& intrinsics);

// A byte per tile, row-major: 1 if the centre of every pixel in it and within `margin_px` of it lies under
// the mesh. Pixels outside the picture count as hidden.
std::vector<std::uint8_t> findHiddenTiles(const HiddenMesh& mesh, const Intrinsics& intrinsics,
                                          glm::uvec2 size_px, std::uint32_t margin_px = 0);

}  // namespace binosplat::xr
