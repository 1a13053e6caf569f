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
    UVec2s tile_sets;       // out: lib/tile_set.glsl
    Uints tile_counts;       // out
    EyeCounterss counters;   // out
    Uints tiles_before;      // under a mask: how many masked tiles there are before each, and one more for all
    StereoViews stereo;      // where `splats` holds what the other eye, shifted along x, saw
    uint chunk_bits;
    uint eye;
};

// 5_bin and 5_bin_large: a (tile, splat) pair for each tile a splat meets, front to back.
struct BinPass {
    ProjectedSplats splats;
    UVec2s tile_sets;
    Uints pair_offsets;  // exclusive prefix sums of ProjectPass::tile_counts
    ListStates visible;
    ListStates pairs;
    Uints tiles;        // out
    Uints ranks;        // out: indices into `splats`
    Uints large_splats;  // out of 5_bin, in no order: what is left to 5_bin_large
    EyeCounterss counters;
    Uints tiles_before;  // under a mask, as in ProjectPass
    uvec2 size_tiles;
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
    Vec4s colours;         // out, a value a pixel: sum w c + T background, and sum w
    Floats depths;         // out where asked for: D = sum w z
    StereoPixels moments;  // out where asked for: I = sum w/z and J = sum w/z^2; nothing has reached the pixel yet
    Uints tile_list;          // under a mask: the tiles to render
    ListStates masked_tiles;  // likewise: how many
    vec3 background;
    uint eye;
};

// 8a_reproject: the dominant eye's pixels go to where the affiliated eye sees them; the nearest stays.
struct ReprojectPass {
    StereoViews stereo;
    Vec4s colours;  // dominant
    Floats depths;
    StereoPixels pixels;  // in: moments of the dominant pixel; out: `nearest` of the affiliated one
    Uints shown_before;   // where the dominant eye has hidden tiles: how many shown ones there are before each, and one more for all
};

// 8b_resolve: every pixel of the affiliated eye gets a place in the dominant picture, and tiles their expected error.
struct ResolvePass {
    StereoViews stereo;
    Vec4s colours;  // dominant
    StereoPixels pixels;
    Uints tile_errors;  // out, where errors are predicted
    Uints tile_kinds;   // where the affiliated eye has hidden tiles: these are neither counted nor wrong
    StereoCounterss counters;
};

// 8c_depth_bounds: how often each depth occurs in the dominant picture.
struct DepthBoundsPass {
    StereoViews stereo;
    Vec4s colours;
    Floats depths;
    StereoPixels pixels;
    Uints bins;  // out: kDepthBins counts
};

// 8d_edge_rois: the borders that the dominant eye does not see (paper, section 3.5, step 1).
struct EdgeRoisPass {
    StereoViews stereo;
    Uints bins;
    Uints tile_kinds;  // out, but where it is kTileHidden
    StereoCounterss counters;
};

// 8e_components: connected holes inside the picture (paper, section 3.5, step 2), in steps: see the shader.
struct ComponentsPass {
    StereoViews stereo;
    ComponentPixels pixels;
    PixelBoxes boxes;  // out: of each component
    Uints tile_kinds;  // in and out
    StereoCounterss counters;
    uint box_capacity;
};

// 8f_newcomers: splats that only the affiliated eye sees, by the tiles they stand in.
struct NewcomersPass {
    SceneChunks chunks;
    EyeViews eyes;
    StereoViews stereo;
    StereoPixels pixels;
    Uints order;
    ListStates visible;
    Uints dominant_offsets;  // prefix sums of the dominant eye's tile counts
    ListStates dominant_pairs;
    Uints tile_errors;
    StereoCounterss counters;
    uint chunk_bits;
    uint eye;
};

// 8g_select: the tiles that are rendered again, as a list and as prefix sums.
struct SelectPass {
    StereoViews stereo;
    Uints tile_errors;
    Uints tile_kinds;    // in or, where errors are predicted, out but for kTileHidden
    Uints tile_list;     // out
    Uints tiles_before;  // out
    ListStates visible;
    ListStates masked_tiles;    // out
    ListStates masked_visible;  // out: as long as `visible`, or empty if no tile is masked
    StereoCounterss counters;
    Uints shown_before;  // as in ReprojectPass
};

// 9_resample: the colour of each pixel of the affiliated eye that no tile will render again.
struct ResamplePass {
    StereoViews stereo;
    Vec4s dominant;
    StereoPixels pixels;  // in
    Vec4s affiliated;     // out, in the same place
    Floats depths;        // out where asked for: D, alpha over the inverse depth that the place was found by
    Uints tile_kinds;
    Uints pixel_classes;  // out: 2 bits a pixel, kCovered, kGap or kHole
    vec3 background;      // of tiles that are hidden
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
    uint digits;
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

// 10_present: an eye's picture as the headset takes it.
struct PresentPass {
    Vec4s colours;
    Floats depths;         // D, where its depth is wanted
    Uints tile_kinds;      // where it shows what made it
    Uints pixel_classes;   // likewise
    Uints pixels;          // out: 8 bits a channel
    Floats device_depths;  // out where wanted: near / depth
    uvec2 size_px;
    float near;
};

BINOSPLAT_END_SHARED

#endif
