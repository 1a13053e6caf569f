// Radix sort, first step of a round: how often each digit occurs in each block.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"

layout(constant_id = 0) const uint kThreads = 128;
layout(local_size_x_id = 0) in;
layout(push_constant, scalar) uniform Push { SortCountPass pass; };

shared uint digit_counts[kMaxDigits];

void main() {
    const uint count = pass.list.at[0].count;
    const uint blocks = (count + kSortBlock - 1) / kSortBlock;
    const uint block = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    for (uint digit = gl_LocalInvocationIndex; digit < pass.digits; digit += kThreads) { digit_counts[digit] = 0; }
    barrier();
    const uint first = block * kSortBlock + gl_LocalInvocationIndex;
    const uint end = min(count, (block + 1) * kSortBlock);
    for (uint item = first; item < end; item += kThreads) {
        atomicAdd(digit_counts[(pass.keys.at[item] >> pass.shift) & (pass.digits - 1)], 1);
    }
    barrier();
    if (block < blocks) {
        for (uint digit = gl_LocalInvocationIndex; digit < pass.digits; digit += kThreads) {
            pass.histograms.at[digit * blocks + block] = digit_counts[digit];
        }
    }
}
