// Radix sort, second step of a round: a workgroup a digit sums that digit's counts along the blocks.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"
#include "lib/group.glsl"

layout(local_size_x = kGroupSize) in;
layout(push_constant, scalar) uniform Push { SortSpinePass pass; };

void main() {
    const uint digit = gl_WorkGroupID.x;
    const uint blocks = (pass.list.at[0].count + kSortBlock - 1) / kSortBlock;
    uint before_step = 0;
    for (uint step_begin = 0; step_begin < blocks; step_begin += kGroupSize) {
        const uint block = step_begin + gl_LocalInvocationIndex;
        const uint value = block < blocks ? pass.histograms.at[digit * blocks + block] : 0;
        uint total;
        const uint before = scanGroup(value, total);
        if (block < blocks) { pass.histograms.at[digit * blocks + block] = before_step + before; }
        before_step += total;
    }
    if (gl_LocalInvocationIndex == 0) { pass.totals.at[digit] = before_step; }
}
