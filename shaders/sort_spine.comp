// Radix sort, second step of a round: a subgroup a digit sums that digit's counts along the blocks. No barriers: subgroups go on alone.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"
#include "lib/group.glsl"

layout(local_size_x = kSortSpineSize) in;
layout(push_constant, scalar) uniform Push { SortSpinePass pass; };

void main() {
    const uint blocks = (pass.list.at[0].count + kSortBlock - 1) / kSortBlock;
    const uint lanes = laneCount();
    for (uint digit = gl_WorkGroupID.x * gl_NumSubgroups + gl_SubgroupID; digit < pass.digits; digit += gl_NumWorkGroups.x * gl_NumSubgroups) {
        uint before_step = 0;
        for (uint step_begin = 0; step_begin < blocks; step_begin += lanes) {
            const uint block = step_begin + gl_SubgroupInvocationID;
            const uint value = block < blocks ? pass.histograms.at[digit * blocks + block] : 0;
            const uint before = subgroupExclusiveAdd(value);
            if (block < blocks) { pass.histograms.at[digit * blocks + block] = before_step + before; }
            before_step += subgroupAdd(value);
        }
        if (subgroupElect()) { pass.totals.at[digit] = before_step; }
    }
}
