// Radix sort, first step of a round: how often each digit occurs in each block. The last workgroup sums these up: where each digit
// begins, and how many of it there are in the blocks before each.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/last_group.glsl"
#include "lib/list.glsl"

layout(constant_id = 0) const uint kThreads = 128;
layout(local_size_x_id = 0) in;
layout(push_constant, scalar) uniform Push { SortCountPass pass; };

const uint kBlocksPerStep = 16;  // loaded at a time, since each load takes as long as all of them

shared uint digit_counts[kMaxDigits];

void countDigits(uint block, uint block_keys, uint count) {
    for (uint digit = gl_LocalInvocationIndex; digit < pass.digits; digit += kThreads) { digit_counts[digit] = 0; }
    barrier();
    const uint begin = min(block * block_keys, count), end = begin + min(block_keys, count - begin);
    uint item = begin + gl_LocalInvocationIndex;
    if (item < end) {
        [[dont_unroll]] do {
            atomicAdd(digit_counts[(pass.keys.at[item] >> pass.shift) & (pass.digits - 1)], 1);
            item += kThreads;
        } while (item < end);
    }
    barrier();
    for (uint digit = gl_LocalInvocationIndex; digit < pass.digits; digit += kThreads) {
        pass.histograms.at[block * pass.digits + digit] = digit_counts[digit];
    }
}

// A thread a digit, so that what they read lies side by side.
void sumBlocks(uint blocks) {
    uint before_step = 0;
    for (uint first = 0; first < pass.digits; first += kThreads) {
        const uint digit = first + threadIndex();
        const uint own_blocks = digit < pass.digits ? blocks : 0;
        uint sum = 0;
        for (uint block = 0; block < own_blocks; block += kBlocksPerStep) {
            uint counts[kBlocksPerStep];
            [[unroll]] for (uint b = 0; b < kBlocksPerStep; ++b) {
                counts[b] = block + b < own_blocks ? pass.histograms.at[(block + b) * pass.digits + digit] : 0;
            }
            [[unroll]] for (uint b = 0; b < kBlocksPerStep; ++b) {
                if (block + b < own_blocks) { pass.histograms.at[(block + b) * pass.digits + digit] = sum; }
                sum += counts[b];
            }
        }
        uint of_step;
        const uint before = before_step + scanGroup(sum, of_step);
        if (digit < pass.digits) { pass.digit_begins.at[digit] = before; }
        before_step += of_step;
    }
}

void main() {
    const uint count = pass.list.at[0].count;
    const uint block_keys = sortBlockKeys(count);
    countDigits(gl_WorkGroupID.x, block_keys, count);
    if (isLastGroup(pass.list)) { sumBlocks(groupsOver(count, block_keys)); }
}
