// How two eyes relate: what the passes may share between them, and how pixels of one move into the other.
#pragma once

#include "engine/geometry.h"
#include "shaders/shared/types.h"

namespace binosplat {

// Computed once per frame, from the actual eyes; all code that asks whether two eyes are alike asks here.
// Rectified eyes have the same depths.
struct EyeRelation {
    gpu::PixelMap target_from_source, source_from_target;
    // Every point has the same depth for both eyes: one depth order serves both. Canted eyes differ.
    bool same_depths = false;
    // Pixels keep their row as well: the eyes are side by side and share fy and cy.
    bool rectified = false;
};

EyeRelation relate(const Eye& dominant, const Eye& affiliated);

}  // namespace binosplat
