// How two eyes stand to each other: what the passes may share between them, and how pixels of one move into the other.
#pragma once

#include "engine/geometry.h"
#include "shaders/shared/types.h"

namespace binosplat {

// Computed once a frame, of the eyes as they are; everything that asks whether two eyes are alike asks here. Eyes that are rectified have
// the same depths.
struct EyeRelation {
    gpu::PixelMap target_from_source, source_from_target;
    // Every point is as deep for one eye as for the other: one depth order serves both. Canted eyes differ.
    bool same_depths = false;
    // Pixels keep their row as well: the eyes stand side by side and share fy and cy.
    bool rectified = false;
};

EyeRelation relate(const Eye& dominant, const Eye& affiliated);

}  // namespace binosplat
