// How two eyes relate: what the passes may share between them, and how pixels of one move into the other.
#pragma once

#include "engine/geometry.h"
#include "shaders/shared/types.h"

namespace binosplat {

// Computed once per frame, from the actual eyes; all code that needs to know how two eyes differ asks here.
// Rectified eyes have the same depths.
struct EyeRelation {
    gpu::PixelMap target_from_source, source_from_target;
    // Every point has the same depth for both eyes, so one depth order is right for both. Canted eyes differ.
    bool same_depths = false;
    // Pixels keep their row as well: the eyes are side by side and share fy and cy.
    bool rectified = false;
};

EyeRelation relate(const Eye& dominant, const Eye& affiliated);

}  // namespace binosplat
