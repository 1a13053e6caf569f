// Tiles of the target that the source's picture cannot fill, wherever the scene is. `shown_mask` is null if
// nothing is hidden.

#include "lib/address.glsl"

bool isHiddenAt(WarpView warp, Uints shown_mask, vec2 place_px) {
    const uvec2 tile = pixelAt(warp.size_px, place_px) / kTileSize;
    return !isInMask(shown_mask, warp.size_tiles, tile);
}

// True if a corner of the tile is more than a gap outside the source even if everything is infinitely far
// (only rendering can fill so much of a headset's eye, whose view is wider outwards than inwards), or if the
// source's lens hides what the tile would need. The paper's borders cover the first case but not the second:
// then `beyond_counts` is false.
bool isUnseen(WarpView warp, Uints shown_mask, uint tile, bool beyond_counts) {
    const uvec2 first = uvec2(tile % warp.size_tiles.x, tile / warp.size_tiles.x) * kTileSize;
    const uvec2 last = min(first + kTileSize, warp.size_px) - 1;
    const vec2 low = vec2(-float(warp.gap_px)), high = vec2(warp.size_px) - low;
    const bool any_hidden = isThere(uvec2(shown_mask));
    bool unseen = false;
    for (uint corner = 0; corner < 4; ++corner) {
        const vec2 at = vec2((corner & 1) == 0 ? first.x : last.x, corner < 2 ? first.y : last.y) + 0.5;
        const vec3 moved = movePixel(warp.source_from_target, at, 0);
        const bool beyond =
            !(moved.z > 0) || any(lessThan(moved.xy, low)) || any(greaterThan(moved.xy, high));
        unseen = unseen || (beyond_counts && beyond) ||
                 (any_hidden && !beyond && isHiddenAt(warp, shown_mask, moved.xy));
    }
    return unseen;
}
