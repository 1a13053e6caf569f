// The passes of a frame, in frame order: for each the struct of its push constants, i.e. what it reads and writes.
#ifndef BINOSPLAT_SHADERS_SHARED_PASSES_H
#define BINOSPLAT_SHADERS_SHARED_PASSES_H

#include "types.h"

BINOSPLAT_BEGIN_SHARED

// cull_pages: of a scene whose chunks come and go, the pages that may hold such splats.
struct CullPagesPass {
    ScenePages pages;
    EyeViews eyes;
    CoherentUints page_bits;     // out: a bit a page
    CoherentUints word_offsets;  // out: how many visible pages there are before each word of these
    Uints page_list;             // out: the visible pages, ascending
    ListStates visible_pages;    // out; per_item is a workgroup for each
    uint page_count;
    uint first_eye;
    uint eye_count;
};

// cull: which splats may touch a pixel of any eye.
struct CullPass {
    SceneChunks chunks;
    EyeViews eyes;
    Uints page_list;             // of a scene in pages: the blocks of kCullBlock splats that are looked at; otherwise all
    ListStates visible_pages;    // likewise: how many
    Uints visible_bits;          // out: a bit a splat of these blocks
    CoherentUints group_counts;  // out: how many visible splats there are before each block
    ListStates visible;          // out
    uint splat_count;
    uint chunk_bits;
    uint first_eye;
    uint eye_count;
    uint capacity;          // of the list
    Uints first_tile_mask;  // where only the chosen tiles of each eye count: lib/tile_mask.glsl
    Uints last_tile_mask;
};

// compact: the visible splats in the scene's order, with the depth or the distance of their centres as sort keys.
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
    uint order_eye;  // whose depths
    Place middle;    // between the eyes, where distances are wanted
};

// project: the visible splats, front to back, as one eye sees them, and how many tiles each meets.
struct ProjectPass {
    SceneChunks chunks;
    EyeViews eyes;
    Uints order;  // indices into the scene, front to back
    ListStates visible;
    ProjectedSplats splats;    // out
    UVec2s tile_sets;          // out: lib/tile_set.glsl
    Uints tile_counts;         // out
    CoherentUints group_sums;  // out: how many tiles there are before each kListBlock of splats
    ListStates pairs;          // out: as long as there are tiles
    EyeCounterss counters;     // out
    Uints tile_mask;           // under a mask: lib/tile_mask.glsl
    uint chunk_bits;
    uint eye;
    uint capacity;  // of the pairs
};

// bin and bin_large: a (tile, splat) pair for each tile a splat meets, front to back.
struct BinPass {
    ProjectedSplats splats;
    UVec2s tile_sets;
    Uints tile_counts;
    Uints group_sums;
    ListStates visible;
    ListStates pairs;
    Uints tiles;         // out
    Uints ranks;         // out: indices into `splats`
    Uints large_splats;  // out of bin, in no order: what is left to bin_large
    Uints large_begins;  // likewise: where the pairs of each begin
    EyeCounterss counters;
    Uints tile_mask;  // under a mask, as in ProjectPass
    uvec2 size_tiles;
    float low_pass;  // EyeView
};

// tile_ranges: where each tile's pairs lie once they are sorted by tile. Under a mask also which tiles have any; the others become
// background.
struct TileRangesPass {
    Uints tiles;
    ListStates pairs;         // counts workgroups
    UVec2s ranges;            // out: begin and end, equal where a tile has no pairs
    Uints tile_list;          // under a mask: the tiles to render
    ListStates masked_tiles;  // likewise: how many
    Uints full_tiles;         // likewise out: those with pairs
    EyeCounterss counters;    // likewise out: how many
    FloatColours colours;     // likewise out, of those without: one of the two
    HalfColours half_colours;
    Floats depths;         // likewise, unless it is null
    Uints moving;          // likewise: infinitely far
    PastTiles past_tiles;  // likewise
    ListStates visible;    // likewise: of whose splats they are
    vec3 background;
    uvec2 size_px;
    uint is_made;  // 1: every tile shows what a past made of it, which stays where lists had no room
};

// rasterize: blending, a workgroup a tile.
struct RasterizePass {
    EyeViews eyes;
    ProjectedSplats splats;
    Uints ranks;
    UVec2s ranges;
    FloatColours colours;  // out: one of the two
    HalfColours half_colours;
    Floats depths;          // out where asked for: D = sum w z
    Vec2s moments;          // out where asked for: I = sum w/z and J = sum w/z^2
    Uints moving;           // out where the picture is going to be moved: lib/moving_pixel.glsl
    Uints arrivals;         // likewise, unless it is null: 0, since nothing has arrived in the other eye yet
    Uints full_tiles;       // under a mask: the tiles to render
    EyeCounterss counters;  // likewise: how many
    vec3 background;
    uint eye;
    uint row_words;        // of `moving` and `arrivals`
    uint is_light;         // 1: colours and background are light, to be encoded once they are blended
    PastTiles past_tiles;  // out where the picture is going to be a past; under a mask in, too
};

// weigh: predicted: which tiles are cheaper to render than to move, and whether anything is worth moving.
struct WeighPass {
    WarpViews warp;
    UVec2s ranges;  // of the source's pairs
    Uints moving;
    Uints tile_kinds;   // out, except where it is kTileHidden
    Uints tile_costs;   // out: in pairs
    Uints tile_errors;  // out: zeros
    Uints tile_depths;  // out: what the source sees in the middle of each, a word of `moving`
    Uints tile_mask;    // out: zeros
    Uints price_bins;   // out: zeros
    Uints shown_mask;   // where the source has hidden tiles: the others
    ListStates visible;
    ListStates masked_tiles;  // counts workgroups; empty as yet
    WarpCounterss counters;
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

// reproject: the source's pixels go to where the target sees them; the nearest stays.
struct ReprojectPass {
    WarpViews warp;
    Uints moving;
    Uints arrivals;    // in: zeros; out: lib/moving_pixel.glsl
    Uints shown_mask;  // where the source has hidden tiles: the others
};

// resample: every pixel that no tile renders gets its colour from its place in the source; tiles their expected error.
struct ResamplePass {
    WarpViews warp;
    FloatColours source;
    HalfColours half_source;
    Uints moving;         // the source's pixels or, where reproject ran, the arrivals that it left
    FloatColours target;  // out; `moving` may lie in the same row
    HalfColours half_target;
    Floats depths;  // out where asked for: D, alpha over the inverse depth that the place was found by
    Uints tile_kinds;
    Uints tile_errors;                 // out, where errors are predicted; of the odd rows null, or where price says kSeenCoarsely
    Uints pixel_classes;               // out where asked for: 2 bits a pixel, kCovered, kGap or kHole
    ComponentPixels component_pixels;  // out where holes are grouped: the same memory as `target`
    WarpCounterss counters;
    Uints shown_mask;  // where the source has hidden tiles: the others; null where it has none
    Uints words;       // out where later pictures are made from the target, otherwise null; arrivals may lie in the same row
    vec3 background;   // of tiles that are hidden
    uint first_row;    // 1: the odd rows, where rows are two apart
};

// warp_past and warp_pixels: an eye's picture from the one that it showed before; what each tile has gone wrong by so far. Of colours that
// are half floats these are the addresses, too.
struct WarpPastPass {
    PastViews view;
    FloatColours source;  // the past
    Uints source_words;   // its pixels' depths: lib/moving_pixel.glsl
    PastTiles source_tiles;
    FloatColours target;  // out
    Uints target_words;   // out
    PastTiles tiles;      // out
    Uints tile_kinds;     // out: 0, or kTileHidden
    Uints tile_mask;      // out: zeros
    Uints price_bins;     // out: zeros
    Uints shown_mask;     // where parts are hidden: the others; otherwise null
    Uints tile_list;      // where only some tiles are made: those; the kinds of all are there then
    ListStates listed_tiles;
    PastBlocks blocks;  // from warp_past to warp_pixels: the blocks whose pixels are made one by one
    PastBlockLists block_list;
};

// newcomers: predicted: splats that only the target sees, by the tiles they stand in.
struct NewcomersPass {
    SceneChunks chunks;
    EyeViews eyes;
    WarpViews warp;
    Uints tile_depths;  // WeighPass
    Uints order;
    ListStates visible;
    Uints source_counts;  // of tiles
    Uints tile_kinds;
    Uints tile_errors;
    WarpCounterss counters;
    uint chunk_bits;
    uint eye;
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
};

// mark_changed: where there is a past, what of it parts of the scene belie that came, went or faded.
struct MarkChangedPass {
    PastTiles tiles;  // in and out, of the picture that is made
    ChangedRects rects;
    uvec2 size_tiles;
    uint count;  // of rects, at least 1
};

// price: predicted: what each tile's error costs to mend, and how much there is of each price.
struct PricePass {
    WarpViews warp;
    Uints tile_kinds;
    Uints tile_costs;
    Uints tile_errors;         // in; out where an eye does not resolve two rows: kSeenCoarsely
    Uints tile_prices;         // out: bin << 22 | cost
    CoherentUints price_bins;  // cost of the tiles in each bin, of errors that are seen whole; greatest error a pair last
    ListStates masked_tiles;   // counts workgroups
    WarpCounterss counters;
    WarpCounterss budget;  // whose budget it is: its own, or one for both eyes
    // Where there is a past, in place of tile_errors and tile_costs, which is then written; where there will be one, out: what it is told
    // by these. Otherwise null.
    PastTiles past_tiles;
    uint is_last;  // 1: no other picture shares the budget after this one
    float area;    // of a pixel, in those of the eye's own picture: what an error in it is worth
    EyeGaze gaze;  // where it is known where the target looks
};

// select: the tiles that are rendered, as a list and as a mask.
struct SelectPass {
    WarpViews warp;
    Uints tile_kinds;  // in and, where errors are predicted, out
    Uints tile_prices;
    Uints tile_list;  // out, in no order
    Uints tile_mask;  // in: zeros; out
    Uints tile_costs;
    ListStates visible;
    ListStates masked_tiles;    // in: a list of none; out
    ListStates masked_visible;  // out: as long as `visible`, or empty if no tile is masked
    WarpCounterss counters;
    WarpCounterss budget;  // as in PricePass
};

// periphery: which tiles of an eye's picture are rendered at half of its size, or which at its own.
struct PeripheryPass {
    FloatColours colours;  // of the half-size picture, once it is there: one of the two
    HalfColours half_colours;
    Uints shown_mask;   // where the eye has hidden tiles: the others; otherwise null
    Uints tile_list;    // out, in no order: of the half-size picture or of the eye's
    Uints tile_mask;    // in: zeros; out
    Uints tile_kinds;   // out where the picture is made from a past: kTileHidden of the tiles that are not needed
    Uints tile_losses;  // out, of the eye's tiles beyond the clear angle: what half the size is expected to lose there, in kErrorSteps
    ListStates chosen_tiles;  // counts workgroups; out
    uvec2 size_px;            // of the eye's picture
    EyeGaze gaze;
};

// fill_periphery: the tiles that are not rendered at the eye's own size, from the half-size picture.
struct FillPeripheryPass {
    FloatColours source;
    HalfColours half_source;
    Floats source_depths;  // D, where it is wanted
    FloatColours target;   // out
    HalfColours half_target;
    Floats depths;     // out where wanted
    Uints tile_mask;   // those that are there
    Uints shown_mask;  // as in PeripheryPass
    // Where later pictures are made from this one: what they must know of it.
    Uints source_words;
    Uints words;  // out
    PastTiles source_tiles;
    PastTiles tiles;  // out
    Uints tile_losses;
    vec3 background;  // of tiles that are hidden
    uvec2 size_px;
};

// A stable radix sort of (key, value), up to 8 bits a round, reduce then scan: needs neither forward progress between workgroups
// nor a subgroup width.
struct SortCountPass {
    Uints keys;
    CoherentUints histograms;  // out: [block][digit], of the run's blocks before
    CoherentUints run_sums;    // out: [run][digit], of the runs before
    Uints digit_begins;        // out
    ListStates list;
    uint shift;
    uint digits;  // a power of two, at most kMaxDigits
};
struct SortScatterPass {
    Uints keys_in, values_in;
    Uints keys_out, values_out;
    Uints histograms;
    Uints run_sums;
    Uints digit_begins;
    ListStates list;
    uint shift;
    uint digits;
};

// present: an eye's picture as the headset takes it.
struct PresentPass {
    FloatColours colours;
    HalfColours half_colours;
    Floats depths;         // D, where its depth is wanted; of a picture that later ones are made from
    Uints words;           // its words instead: lib/moving_pixel.glsl
    Uints tile_kinds;      // where it shows what made it
    Uints pixel_classes;   // likewise
    Uints pixels;          // out: 8 bits a channel
    Floats device_depths;  // out where wanted: near / depth
    uvec2 size_px;
    float near;
};

BINOSPLAT_END_SHARED

#endif
