// The passes of a frame, in frame order, each with the struct of its push constants: what it reads and
// writes.
#ifndef BINOSPLAT_SHADERS_SHARED_PASSES_H
#define BINOSPLAT_SHADERS_SHARED_PASSES_H

#include "types.h"

BINOSPLAT_BEGIN_SHARED

// cull_pages: in a scene whose chunks come and go, the pages that may hold splats that cull keeps.
struct CullPagesPass {
    ScenePages pages;
    EyeViews eyes;
    CoherentUints page_bits;     // out: one bit per page
    CoherentUints word_offsets;  // out: visible pages before each word of page_bits
    // out: the visible pages, ascending, and what lib/block.glsl needs to find them
    CoherentUints page_list;
    ListStates visible_pages;  // out; per_item: one workgroup per page
    uint page_count;
    uint first_eye;
    uint eye_count;
};

// cull: which splats may touch a pixel of any eye.
struct CullPass {
    SceneChunks chunks;
    EyeViews eyes;
    // In a scene of pages: the blocks of kCullBlock splats to examine; otherwise all are.
    Uints page_list;
    ListStates visible_pages;    // and how many there are
    Uints visible_bits;          // out: one bit per splat of these blocks
    CoherentUints group_counts;  // out: visible splats before each block
    ListStates visible;          // out
    uint splat_count;
    uint chunk_bits;
    uint first_eye;
    uint eye_count;
    uint capacity;          // of the list
    uint at_once;           // how many targets are rendered from it at the same time
    Uints first_tile_mask;  // if only the chosen tiles of each eye count: lib/tile_mask.glsl
    Uints last_tile_mask;
};

// compact: the visible splats in the scene's order, with the depth or the distance of their centres as sort
// keys.
struct CompactPass {
    SceneChunks chunks;
    EyeViews eyes;
    Uints page_list;  // as in CullPass
    ListStates visible_pages;
    Uints visible_bits;
    Uints group_offsets;  // CullPass::group_counts
    ListStates visible;
    Uints keys;    // out
    Uints splats;  // out: indices into the scene
    uint splat_count;
    uint chunk_bits;
    uint order_eye;    // the eye whose depths are the keys
    uint by_distance;  // 1: the keys are distances from `middle`, between the eyes
    Place middle;
};

// project: the visible splats, front to back, as each eye sees them, and how many tiles each touches.
struct ProjectPass {
    SceneChunks chunks;
    EyeViews eyes;  // of the targets, from the first on
    Uints order;    // indices into the scene, front to back
    ListStates visible;
    ProjectedSplats splats;  // out
    UVec2s tile_sets;        // out: lib/tile_set.glsl
    // out: tiles before each block of kListBlock splats; one target's blocks after the other's
    CoherentUints group_sums;
    ListStates pairs;  // out: one for each tile that a splat touches
    TargetStates targets;
    uint chunk_bits;
    uint splats_apart;  // from one target's splats and sets to the next one's
    uint capacity;      // of the pairs
    uint is_dimmed;     // 1: Gaussians that were trained with an opacity that the low-pass dims
};

// bin: a (tile, splat) pair for each tile that a splat touches, front to back.
struct BinPass {
    EyeViews eyes;
    ProjectedSplats splats;
    UVec2s tile_sets;
    Uints group_sums;
    ListStates visible;
    ListStates pairs;
    Uints tiles;  // out, with the ranks if these have bits there: lib/pair_word.glsl
    Uints ranks;  // out otherwise: the splats' places among those of their target
    TargetStates targets;
    uint splats_apart;  // as in ProjectPass
    uint all_tiles;     // of all targets
    uint rank_bits;
};

// tile_ranges: where each tile's pairs are once they are sorted by tile. Under a mask also which tiles have
// any; the others become background.
struct TileRangesPass {
    EyeViews eyes;
    Uints tiles;         // BinPass::tiles, sorted
    ListStates pairs;    // also counts finished workgroups
    UVec2s ranges;       // out: begin and end, equal where a tile has no pairs
    ListStates visible;  // under a mask: the splats of the pairs
    TargetStates targets;
    vec3 background;
    uint rank_bits;  // as in BinPass
};

// rasterize: blending, one workgroup per tile.
struct RasterizePass {
    EyeViews eyes;
    ProjectedSplats splats;
    Uints ranks;  // BinPass::ranks or, if these have bits there, BinPass::tiles; sorted
    UVec2s ranges;
    TargetStates targets;
    vec3 background;
    // The depth by which a pixel is reprojected: kDepthInverse, or one of those that D gives.
    uint depth_choice;
    uint is_light;      // 1: colours and background are light, to be encoded after blending
    uint splats_apart;  // as in ProjectPass
    uint rank_bits;     // as in BinPass
    uint is_dimmed;     // as in ProjectPass
    // 1: D is instead A times the depth at which blending passes a half. With half floats, for pictures from
    // which none is reprojected.
    uint keeps_surface;
};

// contribute: how much each splat contributes to an eye's picture and, compared with a wanted picture, in
// which direction the splat's colour, opacity and size should change. Only for thinning out scenes
// (engine/levels).
struct ContributePass {
    EyeViews eyes;
    ProjectedSplats splats;
    Uints ranks;  // as in RasterizePass
    UVec2s ranges;
    Uints order;           // the splats' indices in the scene
    FloatColours picture;  // as rasterized
    FloatColours wanted;
    // in and out: kErrorSums or kContributionSums per splat of the scene, of 64 bits, the lower word first
    Uints sums;
    uint eye;
    uint rank_bits;
};

// weigh: predicted: which tiles are cheaper to render than to reproject, and whether reprojecting anything
// pays.
struct WeighPass {
    WarpViews warp;
    UVec2s ranges;      // of the source's pairs
    Uints moving;       // null: the source's pixels cannot be reprojected
    Uints tile_kinds;   // out, except where it is kTileHidden
    Uints tile_costs;   // out: in pairs
    Uints tile_errors;  // out: zeros
    Uints tile_depths;  // out: what the source sees in the middle of each tile, as a word of `moving`
    Uints tile_mask;    // out: zeros
    Uints price_bins;   // out: zeros
    Uints shown_mask;   // if the source has hidden tiles: the shown ones
    ListStates visible;
    ListStates masked_tiles;  // counts finished workgroups; empty so far
    WarpCounterss counters;
    uint kinds_given;  // 1: tile_kinds says which tiles no lens shows; otherwise all are shown
};

// depth_bounds: paper: how often each depth occurs in the source.
struct DepthBoundsPass {
    WarpViews warp;
    FloatColours colours;
    HalfColours half_colours;
    Uints moving;
    Uints bins;  // out: kDepthBins counts
};

// edge_rois: paper: the borders that the source does not see (section 3.5, step 1).
struct EdgeRoisPass {
    WarpViews warp;
    Uints bins;
    Uints tile_kinds;  // out, except where it is kTileHidden
    Uints shown_mask;  // as in WeighPass
    WarpCounterss counters;
};

// reproject: moves the source's pixels to where the target sees them; the nearest stays.
struct ReprojectPass {
    WarpViews warp;
    Uints moving;
    Uints arrivals;    // in: zeros; out: lib/moving_pixel.glsl
    Uints shown_mask;  // if the source has hidden tiles: the shown ones
};

// resample: every pixel that is not rendered is sampled at its place in the source; tiles get their expected
// error.
struct ResamplePass {
    WarpViews warp;
    FloatColours source;
    HalfColours half_source;
    Uints moving;         // the source's pixels or, if reproject ran, its arrivals
    FloatColours target;  // out; `moving` may lie in the same row
    HalfColours half_target;
    // out if requested, otherwise null: D, alpha over the inverse depth with which the place was found
    Floats depths;
    Uints tile_kinds;
    // out if errors are predicted, otherwise null; for the odd rows null, or in: kSeenCoarsely by price
    Uints tile_errors;
    Uints pixel_classes;  // out if requested: 2 bits per pixel, kCovered, kGap or kHole
    WarpCounterss counters;
    Uints shown_mask;     // if the source has hidden tiles: the shown ones; otherwise null
    vec3 background;      // of hidden tiles
    uint first_row;       // 1: the odd rows, if rows are two apart
    uint copies_colours;  // 1: they are copied, not sampled
    uint groups_holes;    // 1: holes will be grouped: `target` gets a ComponentPixel for each of their pixels
};

// warp_history and warp_pixels: an eye's picture, warped from the one that it showed before, and each tile's
// error so far. With half-float colours, these are their addresses, too.
struct WarpHistoryPass {
    HistoryViews view;
    FloatColours source;  // the history
    Uints source_words;   // its pixels' depths: lib/moving_pixel.glsl
    HistoryTiles source_tiles;
    FloatColours target;   // out
    Uints target_words;    // out
    HistoryTiles tiles;    // out
    Uints tile_kinds;      // out: 0, or kTileHidden
    Uints tile_mask;       // out: zeros
    Uints price_bins;      // out: zeros
    Uints shown_mask;      // if parts are hidden: the shown tiles; otherwise null
    Uints history_shown;   // the same for the history
    HistoryBlocks blocks;  // from warp_history to warp_pixels: the blocks whose pixels are made one by one
    HistoryBlockLists block_list;
};

// newcomers: predicted: splats that only the target sees, by the tiles that hold them.
struct NewcomersPass {
    SceneChunks chunks;
    EyeViews eyes;
    WarpViews warp;
    Uints tile_depths;  // WeighPass
    Uints order;
    ListStates visible;
    UVec2s source_sets;  // the tiles that each splat touches in the source: lib/tile_set.glsl
    Uints tile_kinds;
    Uints tile_errors;
    WarpCounterss counters;
    uint chunk_bits;
    uint eye;
    uint is_dimmed;  // as in ProjectPass
};

// components: paper: connected holes inside the picture (section 3.5, step 2), in steps: see the shader.
struct ComponentsPass {
    WarpViews warp;
    ComponentPixels pixels;  // in and out, of holes
    Uints pixel_classes;
    PixelBoxes boxes;  // out: of each component
    Uints tile_kinds;  // in and out
    WarpCounterss counters;
    uint box_capacity;
    uint slots_apart;  // from one pixel to the next: 1 in a picture of half floats, otherwise 2
};

// mark_changed: where parts of the scene came, went or faded, a history is wrong.
struct MarkChangedPass {
    HistoryTiles tiles;  // in and out, of the picture being made
    ChangedRects rects;
    uvec2 size_tiles;
    uint count;  // of rects, at least 1
};

// price: predicted: the cost of rendering each tile's error away, and how much there is at each price.
struct PricePass {
    TargetStates targets;
    ListStates chosen;  // of the first target: counts finished workgroups
    // Cost of the tiles in each bin, without a history as if errors were seen whole; greatest error per pair
    // last.
    CoherentUints price_bins;
    uint most_cost;  // under a bound, in pairs: the lists' capacity
};

// select: the tiles to render, as a list and as a mask.
struct SelectPass {
    TargetStates targets;
    ListStates chosen;  // as in PricePass
    ListStates visible;
    uint at_once;  // how many of the targets are rendered at the same time
};

// A stable radix sort of (key, value), up to 9 bits per round, by reduce-then-scan: assumes neither forward
// progress between workgroups nor a subgroup width.
struct SortCountPass {
    Uints keys;
    CoherentUints histograms;  // out: [block][digit], in the run's earlier blocks
    CoherentUints run_sums;    // out: [run][digit], in the earlier runs
    Uints digit_begins;        // out
    ListStates list;
    uint shift;
    uint digits;  // a power of two, at most kMaxDigits
};
struct SortScatterPass {
    Uints keys_in, values_in;  // values: null if the keys are all there is
    Uints keys_out, values_out;
    Uints histograms;
    Uints run_sums;
    Uints digit_begins;
    ListStates list;
    uint shift;
    uint digits;
};

// present: an eye's picture in the headset's format.
struct PresentPass {
    FloatColours colours;
    HalfColours half_colours;
    Floats depths;  // D, if its depth is wanted
    // Instead of D, for a picture that later ones are made from: lib/moving_pixel.glsl; otherwise null.
    Uints words;
    Uints tile_kinds;      // for a tint by how each pixel was made; otherwise null
    Uints pixel_classes;   // for the tint, or null
    Uints pixels;          // out: 8 bits per channel; with `over` also in: what is behind the splats
    Floats device_depths;  // out if requested, otherwise null: depth_scale / depth + depth_offset
    // The same for the content of `pixels`, or null: splats behind it do not show; may be device_depths.
    Floats mesh_depths;
    uvec2 size_px;
    float depth_scale;
    float depth_offset;
    uint blue_first;   // 1: BGRA in place of RGBA
    uint linear;       // 1: the image is not sRGB: its bytes count as light
    uint see_through;  // 1: write alpha, for what the headset shows behind the picture
    uint over;         // 1: blended over the content of `pixels`; then the picture has no background
    uint is_cut;       // 1: splats were tested one by one as they were blended, so pixels are not
    uint kept_bits;    // bits in each word of `pixels` that stay as they are, for a picture of both eyes
    uint of_surface;   // 1: D/A is a surface's depth, see RasterizePass
};

// turn: shows a presented picture in a view with other axes.
struct TurnPass {
    Uints pixels;   // of the picture, as PresentPass leaves them
    Uints shown;    // out: of the view
    vec3 column_x;  // of the matrix from places in the view, in pixels, to those in the picture
    vec3 column_y;
    vec3 column_z;
    uvec2 picture_px;
    uvec2 view_px;
    uint linear;  // 1: bytes count as light
};

BINOSPLAT_END_SHARED

#endif
