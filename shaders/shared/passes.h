// The passes of a frame, in frame order: for each the struct of its push constants, i.e. what it reads and writes.
#ifndef BINOSPLAT_SHADERS_SHARED_PASSES_H
#define BINOSPLAT_SHADERS_SHARED_PASSES_H

#include "types.h"

BINOSPLAT_BEGIN_SHARED

// 1_cull: which splats may touch a pixel of any eye.
struct CullPass {
    SceneChunks chunks;
    EyeViews eyes;
    Uints visible_bits;  // out: a bit a splat
    Uints group_counts;  // out: visible splats of each workgroup
    uint splat_count;
    uint chunk_bits;
    uint first_eye;
    uint eye_count;
};

// 2_compact: the visible splats in the scene's order, with the depth of their centres as sort keys.
struct CompactPass {
    SceneChunks chunks;
    EyeViews eyes;
    Uints visible_bits;
    Uints group_offsets;  // exclusive prefix sums of CullPass::group_counts
    ListStates visible;
    Uints keys;    // out
    Uints splats;  // out: indices into the scene
    uint splat_count;
    uint chunk_bits;
    uint order_eye;
};

// 4_project: the visible splats, front to back, as one eye sees them, and how many tiles each meets.
struct ProjectPass {
    SceneChunks chunks;
    EyeViews eyes;
    Uints order;  // indices into the scene, front to back
    ListStates visible;
    ProjectedSplats splats;  // out
    UVec2s tile_boxes;       // out: x0 | y0 << 16, x1 | y1 << 16, half open
    Uints tile_counts;       // out
    EyeCounterss counters;   // out
    uint chunk_bits;
    uint eye;
};

// 5_bin: a (tile, splat) pair for each tile a splat meets, front to back.
struct BinPass {
    EyeViews eyes;
    ProjectedSplats splats;
    UVec2s tile_boxes;
    Uints pair_offsets;  // exclusive prefix sums of ProjectPass::tile_counts
    ListStates visible;
    ListStates pairs;
    Uints tiles;  // out
    Uints ranks;  // out: indices into `splats`
    uint eye;
};

// 6_tile_ranges: where each tile's pairs lie once they are sorted by tile.
struct TileRangesPass {
    Uints tiles;
    ListStates pairs;
    UVec2s ranges;  // out: begin and end; tiles without pairs keep the zeros they came with
};

// 7_rasterize: blending, a workgroup a tile.
struct RasterizePass {
    EyeViews eyes;
    ProjectedSplats splats;
    Uints ranks;
    UVec2s ranges;
    Vec4s colours;                 // out, a value a pixel: sum w c + T background, and sum w
    Floats depths;                 // out: D = sum w z
    Vec2s inverse_depth_moments;   // out where asked for: I = sum w/z, J = sum w/z^2
    vec3 background;
    uint eye;
};

// Exclusive prefix sums of `values` in place, in three steps: sums of blocks, their sums, and the blocks again.
struct ScanReducePass {
    Uints values;
    Uints block_sums;  // out
    ListStates list;   // whose length `values` has
};
struct ScanSpinePass {
    Uints block_sums;   // in and out
    ListStates list;    // of kScanBlock blocks; or null, and `block_count` says how many
    ListStates result;  // out: a list as long as the sum
    uint block_count;
    uint capacity;      // of that list
};
struct ScanApplyPass {
    Uints values;  // in and out
    Uints block_sums;
    ListStates list;
};

// A stable radix sort of (key, value), up to 8 bits a round, reduce then scan: needs neither forward progress between workgroups
// nor a subgroup width.
struct SortCountPass {
    Uints keys;
    Uints histograms;  // out: [digit][block]
    ListStates list;
    uint shift;
    uint digits;  // a power of two, at most kMaxDigits
};
struct SortSpinePass {
    Uints histograms;  // in and out: exclusive prefix sums along the blocks
    Uints totals;      // out: a sum a digit
    ListStates list;
};
struct SortScatterPass {
    Uints keys_in, values_in;
    Uints keys_out, values_out;
    Uints histograms;
    Uints totals;
    ListStates list;
    uint shift;
    uint digits;
};

BINOSPLAT_END_SHARED

#endif
