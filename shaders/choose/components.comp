// components: turns connected holes inside the picture into boxes of tiles (paper, section 3.5, step 2).
// Union-find with links towards the smaller index (Jaiganesh and Burtscher 2018): whatever the order of the
// threads, a component's root is its first pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"

layout(local_size_x = 16, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { ComponentsPass pass; };

// The steps, each a dispatch over the pixels except the last, which strides over the boxes. resample has made
// every hole its own parent.
const uint kStepUnite = 0, kStepCount = 1, kStepBound = 2, kStepMark = 3;
layout(constant_id = 0) const uint kStep = kStepUnite;

// Where the pixel's colour would be.
uint slotOf(uint pixel) { return pass.slots_apart * pixel; }

bool isHole(WarpView warp, uvec2 at) {
    return ((pass.pixel_classes.at[at.y * warp.size_tiles.x + at.x / kTileSize] >> (2 * (at.x % kTileSize))) &
            3) == kHole;
}

// Other threads change parents at the same time; every value that can be read leads to the same root.
uint parentOf(uint pixel) { return atomicOr(pass.pixels.at[slotOf(pixel)].parent, 0); }

// On the way up, each pixel is linked to its grandparent; otherwise chains would be as long as a hole is wide
// and high.
uint rootOf(uint pixel) {
    uint parent = parentOf(pixel);
    while (parent != pixel) {
        const uint above = parentOf(parent);
        if (above != parent) { atomicMin(pass.pixels.at[slotOf(pixel)].parent, above); }
        pixel = parent;
        parent = above;
    }
    return pixel;
}

void unite(uint a, uint b) {
    a = rootOf(a);
    b = rootOf(b);
    while (a != b) {
        const uint low = min(a, b), high = max(a, b);
        const uint old = atomicMin(pass.pixels.at[slotOf(high)].parent, low);
        if (old == high) { return; }
        a = rootOf(old);
        b = rootOf(low);
    }
}

// If there are more components than boxes, none gets one, since which ones come first depends on the order of
// the threads.
bool haveBoxes() { return pass.counters.at[0].components <= pass.box_capacity; }

// Marks the tiles that [low, high), grown by the margin, touches.
void markTiles(WarpView warp, uvec2 low, uvec2 high, uint first, uint stride) {
    const uvec2 begin = uvec2(max(ivec2(low) - int(warp.margin_px), ivec2(0))) / kTileSize;
    const uvec2 end = min((high + warp.margin_px + kTileSize - 1) / kTileSize, warp.size_tiles);
    const uvec2 size = end - begin;
    for (uint i = first; i < size.x * size.y; i += stride) {
        const uint tile = (begin.y + i / size.x) * warp.size_tiles.x + begin.x + i % size.x;
        if (atomicCompSwap(pass.tile_kinds.at[tile], 0, kTileCenter) == 0) {
            atomicAdd(pass.counters.at[0].center_tiles, 1);
        }
    }
}

void main() {
    const WarpView warp = pass.warp.at[0];
    if (kStep == kStepMark) {
        const uint boxes = haveBoxes() ? pass.counters.at[0].components : 0;
        const uint groups = gl_NumWorkGroups.x * gl_NumWorkGroups.y;
        for (uint b = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; b < boxes; b += groups) {
            const PixelBox box = pass.boxes.at[b];
            markTiles(warp, uvec2(box.x0, box.y0), uvec2(box.x1, box.y1), gl_LocalInvocationIndex,
                      kWarpGroup);
        }
        return;
    }
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, warp.size_px))) { return; }
    const uint pixel = at.y * warp.size_px.x + at.x;
    if (!isHole(warp, at)) { return; }
    if (kStep == kStepUnite) {
        // The four neighbours that come before this pixel; the others will find it.
        for (uint n = 0; n < 4; ++n) {
            const ivec2 other = ivec2(at) + (n == 0 ? ivec2(-1, 0) : ivec2(int(n) - 2, -1));
            if (other.x < 0 || other.y < 0 || other.x >= int(warp.size_px.x)) { continue; }
            if (isHole(warp, uvec2(other))) { unite(pixel, uint(other.y) * warp.size_px.x + uint(other.x)); }
        }
    } else if (kStep == kStepCount) {
        if (parentOf(pixel) == pixel) {
            const uint component = atomicAdd(pass.counters.at[0].components, 1);
            pass.pixels.at[slotOf(pixel)].component = component;
            if (component < pass.box_capacity) {
                pass.boxes.at[component] = PixelBox(0xffffffffu, 0xffffffffu, 0, 0);
            }
        }
    } else {
        if (haveBoxes()) {
            const uint component = pass.pixels.at[slotOf(rootOf(pixel))].component;
            atomicMin(pass.boxes.at[component].x0, at.x);
            atomicMin(pass.boxes.at[component].y0, at.y);
            atomicMax(pass.boxes.at[component].x1, at.x + 1);
            atomicMax(pass.boxes.at[component].y1, at.y + 1);
        } else {  // this pixel is its own root
            markTiles(warp, at, at + 1, 0, 1);
        }
    }
}
