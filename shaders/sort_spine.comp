// Radix sort, second step of a round: a workgroup a digit sums that digit's counts along the blocks.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"
#include "lib/group.glsl"

const uint kSpineSize = 64;  // a sort of 100,000 keys has 50 blocks

layout(local_size_x = kSpineSize) in;
layout(push_constant, scalar) uniform Push { SortSpinePass pass; };

void main() {
    const uint digit = gl_WorkGroupID.x;
    const uint blocks = (pass.list.at[0].count + kSortBlock - 1) / kSortBlock;
    const uint thread = threadIndex();
    uint before_step = 0;
    for (uint step_begin = 0; step_begin < blocks; step_begin += kSpineSize) {
        const uint block = step_begin + thread;
        const uint value = block < blocks ? pass.histograms.at[digit * blocks + block] : 0;
        uint total;
        const uint before = scanGroup(value, total);
        if (block < blocks) { pass.histograms.at[digit * blocks + block] = before_step + before; }
        before_step += total;
    }
    if (gl_LocalInvocationIndex == 0) { pass.totals.at[digit] = before_step; }
}
