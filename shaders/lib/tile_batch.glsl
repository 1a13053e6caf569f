// For rasterize: a batch of a tile's splats in shared memory, and which cells each of them touches.

// u, v and the low-pass are scaled here so that alpha = exp2(-(what opacity adds) - u^2 - v^2).
shared vec4 batch_reference[kBatchSize + 1];  // reference_px relative to the tile, u/z and v/z there
shared vec4 batch_plane[kBatchSize + 1];      // A, B, D, low-pass or 0
shared vec4 batch_depth[kBatchSize + 1];      // 1/z there, its slopes, -log2(opacity)
shared uvec2 batch_colour[kBatchSize + 1];
shared uint cell_splats[kCellsPerTile][kBatchSize / 32];  // four words: blendBatch holds them in registers

// A 3D Gaussian as pixels twice as wide see it: with four times the variance on the screen.
ProjectedSplat asSeenWider(ProjectedSplat splat, float screen_variance) {
    const vec3 plane = splat.plane_from_pixel;
    const float root_yy = 1 / plane.z, more = 3 * screen_variance;
    const float yy = root_yy * root_yy, xy = -(plane.y / plane.x) * yy, root_det = root_yy / plane.x;
    const float xx = (root_det / root_yy) * (root_det / root_yy) + (xy / root_yy) * (xy / root_yy);
    const float wider_yy = yy + more;
    const float wider_root_det = length(vec2(root_det, sqrt(more * (xx + wider_yy))));
    const float a = sqrt(wider_yy) / wider_root_det;
    splat.plane_from_pixel = vec3(a, -(xy / wider_yy) * a, 1 / sqrt(wider_yy));
    if (pass.is_dimmed != 0) {
        splat.opacity =
            packOpacity(exp2(-negativeLog2Opacity(splat)) * root_det / wider_root_det, hasReference(splat));
    }
    return splat;
}

void loadSplat(uint slot, uint lanes_in_subgroup, uint place, uvec2 tile_px, bool is_coarse) {
    const vec2 middle_px = vec2(pass.eyes.at[gl_WorkGroupID.z].size_px) * 0.5;
    const float low_pass =
        pass.eyes.at[gl_WorkGroupID.z].low_pass * (kMeasures && is_wider ? kWiderLowPass : 1);
    ProjectedSplat splat = pass.splats.at[place];
    if (kMeasures && kSplatKind != kDiscs && is_wider) {
        splat = asSeenWider(splat, pass.eyes.at[gl_WorkGroupID.z].screen_variance);
    }
    const bool has_reference = kSplatKind != kDiscs || hasReference(splat);
    const float scale = sqrt(kLog2PerRho);
    // Relative to the tile, single precision places the centre to 1e-6 px.
    batch_reference[slot] = has_reference
                                ? vec4((splat.reference_px - vec2(tile_px)) + restOfReference(splat), 0, 0)
                                : vec4(middle_px - vec2(tile_px), scale * splat.reference_px);
    batch_plane[slot] = vec4(scale * splat.plane_from_pixel,
                             kSplatKind == kDiscs && has_reference ? kLog2PerRho * low_pass : 0);
    batch_depth[slot] = vec4(splat.inverse_depth, splat.perspective, negativeLog2Opacity(splat));
    batch_colour[slot] = splat.colour;
    if (is_coarse) { return; }  // its cell touches them all
    // A subgroup's slots are consecutive, so that one lane can set the bits of all that are here; either 32
    // divides the slot of lane 0, or the subgroup's width divides 32.
    const uint cells = cellsOf(splat, tile_px, low_pass), first_slot = slot - gl_SubgroupInvocationID;
    for (uint cell = 0; cell < kCellsPerTile; ++cell) {
        const uvec4 lanes = subgroupBallot((cells & (1u << cell)) != 0);
        if (kThreads <= 32 && subgroupElect()) {
            // All lanes are in one word. A loop over words would count: Mesa's software device ends a
            // thread's loops after 65,535 rounds of all of them, in the middle of very full tiles.
            atomicOr(cell_splats[cell][first_slot / 32], lanes.x << (first_slot & 31));
        }
        if (kThreads > 32 && subgroupElect()) {
            uint word = 0;
            [[dont_unroll]] do {
                if (lanes[word] != 0) {
                    atomicOr(cell_splats[cell][first_slot / 32 + word], lanes[word] << (first_slot & 31));
                }
                ++word;
            }
            while (word < (lanes_in_subgroup + 31) / 32)
                ;
        }
    }
}

// The thread's cell, and its place there.
uint cellIndex() { return gl_LocalInvocationIndex / kThreadsPerCell; }
uint indexInCell() { return gl_LocalInvocationIndex % kThreadsPerCell; }

// Loads splats to the slots from first_slot on: all of the workgroup, or each cell those of its coarse tile.
void loadBatch(uint lanes, uint begin, uint first_slot, uint splats, uvec2 tile_px, bool is_coarse) {
    if (is_coarse && indexInCell() == 0) {
        cell_splats[cellIndex()][0] = splats < 32 ? (1u << splats) - 1 : 0xffffffffu;
    }
    uint i = is_coarse ? indexInCell() : gl_SubgroupID * lanes + gl_SubgroupInvocationID;
    if (i >= splats) { return; }
    [[dont_unroll]] do {
        const uint rank = rankOfPair(pass.ranks.at[begin + i], pass.rank_bits);
        loadSplat(first_slot + i, lanes, gl_WorkGroupID.z * pass.splats_apart + rank, tile_px, is_coarse);
        i += is_coarse ? kThreadsPerCell : kThreads;
    }
    while (i < splats)
        ;
}
