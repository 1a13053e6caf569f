// Structures in device memory, read by C++ and GLSL alike (scalar layout).
#ifndef BINOSPLAT_SHADERS_SHARED_TYPES_H
#define BINOSPLAT_SHADERS_SHARED_TYPES_H

#include "constants.h"

BINOSPLAT_BEGIN_SHARED

BINOSPLAT_ARRAY_OF(uint, Uints);
BINOSPLAT_COHERENT_ARRAY_OF(uint, CoherentUints);
BINOSPLAT_ARRAY_OF(float, Floats);
BINOSPLAT_ALIGNED_ARRAY_OF(uvec2, 8, UVec2s);
BINOSPLAT_ALIGNED_ARRAY_OF(vec2, 8, Vec2s);
BINOSPLAT_ARRAY_OF(vec3, Vec3s);
BINOSPLAT_ALIGNED_ARRAY_OF(vec4, 16, Vec4s);

// A picture, rows top to bottom: rgb = sum w c + T background, a = sum w. As floats or, unless those are
// requested, four half floats.
BINOSPLAT_ALIGNED_ARRAY_OF(vec4, 16, FloatColours);
BINOSPLAT_ALIGNED_ARRAY_OF(uvec2, 8, HalfColours);

// A scene's place among others: scale (x, y, z) p + position, with the columns of a rotation.
struct Placement {
    vec3 x;
    vec3 y;
    vec3 z;
    vec3 position;
    float scale;
};
BINOSPLAT_ARRAY_OF(Placement, Placements);

// A run of splats in one allocation: 48 bytes per disc, 52 per 3D Gaussian, and 20, 48 or 92 for the SH bands
// 1 to 3 if the scene has them.
struct SceneChunk {
    BINOSPLAT_STORED(Vec3s) positions;
    Vec4s rotations;  // x, y, z, w
    Vec2s scales;
    BINOSPLAT_STORED(Floats) thicknesses;  // of 3D Gaussians: the third scale, along t_u x t_v
    BINOSPLAT_STORED(Floats) opacities;
    UVec2s base_colours;  // f_dc: r | g << 16, b, as half floats
    // f_rest, coefficient by coefficient, rgb interleaved, two half floats per word
    BINOSPLAT_STORED(Uints) sh;
    BINOSPLAT_STORED(Placements) placement;  // in a scene of placed scenes; otherwise null
    float fade;                              // 0 to 1, multiplies the opacity of each
    uint sh_degree;                          // of `sh`
};
BINOSPLAT_ALIGNED_ARRAY_OF(SceneChunk, 8, SceneChunks);

// A chunk of kPageSplats in a scene whose chunks come and go; the box, in world space, encloses everything
// visible of it.
struct ScenePage {
    vec3 low;
    float reach;  // how far any of its splats extends from its centre, at most
    vec3 high;
    uint count;  // of its visible splats; 0: none
};
BINOSPLAT_ALIGNED_ARRAY_OF(ScenePage, 16, ScenePages);

// One eye for one frame. Camera axes: x right, y down, z forward.
struct EyeView {
    vec3 camera_from_world_x;  // rows of the rotation
    vec3 camera_from_world_y;
    vec3 camera_from_world_z;
    vec3 position;
    vec2 focal_px;
    vec2 principal_px;
    uvec2 size_px;
    uvec2 size_tiles;
    float near;
    float max_inverse_depth;  // 1 / near
    // The remainders that single precision drops from the fields above: (x + x_low) has 48 bits.
    vec3 camera_from_world_x_low;
    vec3 camera_from_world_y_low;
    vec3 camera_from_world_z_low;
    vec3 position_low;
    vec2 focal_px_low;
    vec2 principal_px_low;
    // kLowPass and kScreenVariance for a pixel of the eye's own picture, which may have more pixels than this
    // one.
    float low_pass;
    float screen_variance;
};
BINOSPLAT_ARRAY_OF(EyeView, EyeViews);

// A place in the world: (x + x_low) has 48 bits.
struct Place {
    vec3 position;
    vec3 position_low;
};

// A splat as one eye sees it; 44 bytes. With (dx, dy) the offset of a pixel from `reference_px`, the pixel's
// ray meets the disc's plane where
//   1/z = inverse_depth + perspective.x dx + perspective.y dy
//   u/z = plane_from_pixel.x dx + plane_from_pixel.y dy
//   v/z =                         plane_from_pixel.z dy
// (u, v) are standard deviations, turned within the disc so that v does not depend on dx. All three are
// linear in the pixel.
// For a 3D Gaussian these are u and v themselves instead of u/z and v/z, so that rho = u^2 + v^2 needs no
// depth.
// A disc whose centre is not beyond the near plane has no such reference: then (see `opacity`) reference_px
// holds the constant terms of u/z and v/z instead, and offsets count from the middle of the image.
struct ProjectedSplat {
    vec2 reference_px;
    vec3 plane_from_pixel;
    vec2 perspective;
    float inverse_depth;
    float opacity;  // -log2 of it, not negative; its sign bit is set if there is no reference
    // r | g << 16, b, as half floats; in the last 16 bits the remainder of reference_px, see packRest
    uvec2 colour;
};
BINOSPLAT_ARRAY_OF(ProjectedSplat, ProjectedSplats);

// The size of an indirect dispatch.
struct DispatchSize {
    uint x, y, z;
};

// A list whose length only the GPU knows: what was needed, what fits (0 if it does not fit: the frame is void
// and is done again with more capacity), and the dispatches over it.
struct ListState {
    uint needed;  // 0xffffffff: more than kMaxItems
    uint count;
    uint groups_done;  // during a dispatch, see lib/last_group.glsl; otherwise 0
    // The same for each run of the dispatch: kMaxSortRuns of a sort, one byte each, or kSumRuns.
    uvec4 run_groups_done;
    DispatchSize per_item;        // workgroups of kGroupSize
    DispatchSize per_block;       // workgroups of kListBlock
    DispatchSize per_sort_block;  // workgroups of sortBlockKeys, see lib/list.glsl
};
BINOSPLAT_ARRAY_OF(ListState, ListStates);

// How pixels of one eye move into the other. The other eye sees the pixel (x, y, 1) with inverse depth w at
// ((x, y, 1) + excess (x, y, 1) + shift w), divided by its third component, which is also the ratio of the
// depths.
// `excess` is K' R K^-1 minus the identity, `shift` is K' t: both are exactly 0 for equal eyes, so nothing
// moves.
struct PixelMap {
    vec3 excess_x;  // rows
    vec3 excess_y;
    vec3 excess_z;
    vec3 shift;
};

// Parameters of the reprojection, constant within a frame.
struct WarpView {
    PixelMap target_from_source;
    PixelMap source_from_target;
    uvec2 size_px;  // of both eyes
    uvec2 size_tiles;
    uint row_words;  // from a row of moving pixels or of arrivals to the next
    // 2: resample takes the even rows first, and the odd ones once tiles are chosen; 1: all at once
    uint rows_apart;
    uint gap_px;        // runs of uncovered pixels up to this long are gaps; longer ones are holes
    uint margin_px;     // paper: margin around what needs rendering
    uint edge_samples;  // paper: N, samples along each edge
    uint tight_edges;   // 1: also bounds of what near content uncovers
    // predicted: the cost of reprojecting a tile, in pairs; tiles with at most that many pairs are rendered
    uint move_cost;
    float budget;          // predicted: the share of an eye's work that is spent on tiles with an error
    float hole_error;      // predicted: the weight of a hole's expected error
    float newcomer_error;  // predicted: the weight of full coverage by splats that the source does not see
    // With a history: tiles with a quarter that is expected to be off by a larger amplitude come first; 0:
    // none do.
    float error_bound;
};
BINOSPLAT_ARRAY_OF(WarpView, WarpViews);

// How places in a picture map to the one from which it is made, and back: what the same eye showed before, or
// the other eye's picture.
struct HistoryView {
    PixelMap history_from_now;
    PixelMap now_from_history;
    uvec2 size_px;
    uvec2 size_tiles;
    uvec2 history_size_px;
    uvec2 history_size_tiles;
    float nearest;    // inverse depth of the near plane
    vec3 background;  // of hidden tiles
};
BINOSPLAT_ARRAY_OF(HistoryView, HistoryViews);

// What later pictures must know about a tile of the picture from which they are made.
struct HistoryTile {
    uint cost;  // in pairs, when it was last rendered
    uint age;   // frames since it was rendered
    // By quarters, row by row:
    vec4 growth;  // of the error's amplitude per frame, as measured then
    vec4 errors;  // the amplitude of the expected error (root of the mean square over pixels and channels)
    // Until tiles are chosen: squared errors that this frame is expected to add to the quarters, summed, in
    // kErrorSteps.
    uvec4 grown;
    float lost;             // for a coarse tile: the amplitude that it lacks, which its eye did not see then
    uint unseen;            // by quarters, eight bits each: pixels that the history did not see
    uint squared_gradient;  // until tiles are chosen: summed over pixels and channels, in kErrorSteps
};
BINOSPLAT_ARRAY_OF(HistoryTile, HistoryTiles);

// Where a changed part of the scene is seen in a picture: pixels from begin to end (exclusive), and the
// amplitude of the expected error if the picture is warped from its history.
struct ChangedRect {
    uvec2 begin_px;
    uvec2 end_px;
    float error;
};
BINOSPLAT_ARRAY_OF(ChangedRect, ChangedRects);

// A block of a picture whose pixels are warped from the history one by one.
struct HistoryBlock {
    uint place;           // row << 16 | column, in blocks
    vec2 inverse_depths;  // the least and the greatest in and around it
};
BINOSPLAT_ARRAY_OF(HistoryBlock, HistoryBlocks);
struct HistoryBlockList {
    DispatchSize per_group;  // workgroups of kGroupSize, one thread per pixel, at most kMaxGroupsX
    uint count;
};
BINOSPLAT_ARRAY_OF(HistoryBlockList, HistoryBlockLists);

// A hole's pixel while holes are grouped, stored in place of its colour (the first half of a float colour),
// since all holes are rendered.
struct ComponentPixel {
    uint parent;     // a pixel of the same component, or the pixel itself: the root
    uint component;  // of a root
};
BINOSPLAT_ARRAY_OF(ComponentPixel, ComponentPixels);

// What the passes find out about the target, for the report and for later passes.
struct WarpCounters {
    uint covered_pixels;
    uint gap_pixels;
    uint hole_pixels;
    uint components;
    uint edge_tiles;
    uint center_tiles;
    uint predicted_tiles;
    uint cheap_tiles;
    uint newcomers;
    uint reprojected_tiles;  // before any is chosen for its error
    uint picture_cost;       // of all visible tiles, in pairs: the work of rendering an eye
    uint shown_tiles;        // tiles that no lens hides
    uint saved_cost;         // by reprojecting tiles, as far as known before the choice
    uint chosen_cost;        // of what is rendered
    uint moves;              // 1: something is warped
    uint pays;               // 1: reprojecting pays, or would have paid in a frame that could not
    uint last_bin;           // of the price list: where the budget ends
    uint left_for_last;      // of the budget; all ones: it does not end there
    uint waiting_tiles;      // above a bound, with too little budget for them
    // With a history, sums of tiles' squared errors in kSquareSteps: as expected for those that are not
    // rendered, as expected for those that are, and as found; and what pixels twice as wide would lose on
    // measured tiles, times the frames that each has waited.
    uint left_squares;
    uint expected_squares;
    uint found_squares;
    uint wider_squares;
    uvec4 borders_px;               // paper: left, top, right, bottom
    DispatchSize per_pixel_block;   // workgroups over the pixels, 16x8 each; none if nothing is warped
    DispatchSize per_row;           // the same over the rows
    DispatchSize per_visible;       // the same over the visible splats
    DispatchSize component_groups;  // paper: workgroups over the pixels, none if there is no hole
};
BINOSPLAT_ARRAY_OF(WarpCounters, WarpCounterss);

// Where an eye looks, and the geometry of its pixels.
struct EyeGaze {
    vec3 direction;     // in the eye's axes, of length 1
    float clear_rad;    // within this angle of it everything is kept
    float pixel_cycle;  // the angle of two pixels, in radians
    vec2 focal_px;
    vec2 principal_px;
};

// A rectangle of pixels, half open; a component of holes.
struct PixelBox {
    uint x0, y0, x1, y1;
};
BINOSPLAT_ARRAY_OF(PixelBox, PixelBoxes);

// Counters that belong to no list: for the report, and for dispatches. Also where the eye looks, if that
// decides on coarse tiles.
struct EyeCounters {
    uint pairs;                  // of tile and splat
    uint full_tiles;             // under a mask: tiles with pairs
    uint coarse_tiles;           // coarse tiles with pairs, including those that are only tried as coarse
    DispatchSize per_full_tile;  // in the first of several targets that are rendered at once: for all
    uint coarse_kept;            // those of them that stay coarse
    uint coarse_pairs;           // pairs that are blended as samples
    uint sharp_pairs;            // where tiles may be coarse: pairs that are blended in full
    uint may_be_coarse;          // 1: what the eye does not see sharply may be coarse
    EyeGaze gaze;
};
BINOSPLAT_ARRAY_OF(EyeCounters, EyeCounterss);

// A picture in progress: its lists, and where it is. A pass over several targets has the first one's address,
// and its z-th workgroups work for the z-th target. Addresses of what does not exist are null.
struct TargetState {
    BINOSPLAT_STORED(FloatColours) colours;  // for half floats this is their address, too
    BINOSPLAT_STORED(Floats) depths;         // D = sum w z
    // Present where meshes cut through the splats: depth_scale / z + depth_offset.
    BINOSPLAT_STORED(Floats) mesh_depths;
    BINOSPLAT_STORED(Vec2s) moments;   // I = sum w/z and J = sum w/z^2
    BINOSPLAT_STORED(Uints) moving;    // if the picture is going to be warped: lib/moving_pixel.glsl
    BINOSPLAT_STORED(Uints) arrivals;  // where these will arrive in the other eye
    BINOSPLAT_STORED(HistoryTiles) history_tiles;  // if it is going to be a history
    BINOSPLAT_STORED(Uints) tile_mask;  // lib/tile_mask.glsl: the tiles that are rendered; null: all
    BINOSPLAT_STORED(Uints) tile_list;  // the same, unordered, if passes chose them
    // If tiles are chosen or may be coarse: those with pairs, coarse ones from the end backwards.
    BINOSPLAT_STORED(Uints) full_tiles;
    // If passes choose tiles, for each tile:
    BINOSPLAT_STORED(Uints) tile_kinds;
    BINOSPLAT_STORED(Uints) tile_costs;   // in pairs
    BINOSPLAT_STORED(Uints) tile_errors;  // expected; if an eye does not resolve two rows: kSeenCoarsely
    BINOSPLAT_STORED(Uints) tile_prices;  // bin << 22 | cost
    // In the first target: those of all targets that are rendered at once.
    ListState pairs;
    EyeCounters counters;
    WarpView warp;  // if it is made from another
    WarpCounters warp_counters;
    HistoryView history;  // if it is made from its own history
    HistoryBlockList history_blocks;
    // If it is made from either: those that are rendered; in the first target, per_item is for all.
    ListState chosen_tiles;
    ListState chosen_visible;  // its visible splats, or none if there is no such tile
    // The number of its first tile; tiles are numbered through all targets that are rendered at once.
    uint first_tile;
    uint row_words;  // of `moving` and `arrivals`
    // Which of every kMeasuredParts tiles is measured for its loss; kMeasuredParts: none.
    uint measured;
    float depth_scale;  // of mesh_depths
    float depth_offset;
    // 1: every tile shows a picture warped from a history, which stays if the lists' capacity does not
    // suffice
    uint is_made;
    float area;  // of a pixel, in pixels of the eye's own picture: the weight of an error in it
};
BINOSPLAT_ALIGNED_ARRAY_OF(TargetState, 8, TargetStates);

BINOSPLAT_END_SHARED

#endif
