// Radix sort, first step of a round: counts how often each digit occurs in each block. The last workgroup of
// a run of blocks replaces each count by the sum over the run's earlier blocks; the last workgroup of all
// does the same over the runs, and finds where each digit begins.
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

// Loaded at once, since one load takes as long as all of them.
const uint kMaxColumn = max(kSortRun, kMaxSortRuns);

shared uint digit_counts[kMaxDigits];

void countDigits(uint block, uint block_keys, uint count) {
    for (uint digit = gl_LocalInvocationIndex; digit < pass.digits; digit += kThreads) {
        digit_counts[digit] = 0;
    }
    barrier();
    const uint begin = min(block * block_keys, count), end = begin + min(block_keys, count - begin);
    uint item = begin + gl_LocalInvocationIndex;
    if (item < end) {
        [[dont_unroll]] do {
            atomicAdd(digit_counts[(pass.keys.at[item] >> pass.shift) & (pass.digits - 1)], 1);
            item += kThreads;
        }
        while (item < end)
            ;
    }
    barrier();
    for (uint digit = gl_LocalInvocationIndex; digit < pass.digits; digit += kThreads) {
        pass.histograms.at[block * pass.digits + digit] = digit_counts[digit];
    }
}

// Replaces the counts of one digit, in `rows` rows starting at `first`, by the sums of those before them;
// returns the total.
uint sumColumn(CoherentUints counts, uint first, uint rows, uint digit) {
    uint values[kMaxColumn];
    [[unroll]] for (uint row = 0; row < kMaxColumn; ++row) {
        values[row] = row < rows ? counts.at[(first + row) * pass.digits + digit] : 0;
    }
    uint sum = 0;
    [[unroll]] for (uint row = 0; row < kMaxColumn; ++row) {
        if (row < rows) { counts.at[(first + row) * pass.digits + digit] = sum; }
        sum += values[row];
    }
    return sum;
}

// One thread per digit, so that threads read adjacent values.
void sumBlocksOfRun(uint run, uint blocks) {
    for (uint digit = gl_LocalInvocationIndex; digit < pass.digits; digit += kThreads) {
        pass.run_sums.at[run * pass.digits + digit] =
            sumColumn(pass.histograms, run * kSortRun, blocks, digit);
    }
}

void sumRuns(uint runs) {
    const uint thread = threadIndex();
    uint before_step = 0;
    for (uint first = 0; first < pass.digits; first += kThreads) {
        const uint digit = first + thread;
        const uint sum = digit < pass.digits ? sumColumn(pass.run_sums, 0, runs, digit) : 0;
        uint of_step;
        const uint before = before_step + scanGroup(sum, of_step);
        if (digit < pass.digits) { pass.digit_begins.at[digit] = before; }
        before_step += of_step;
    }
}

void main() [[subgroup_uniform_control_flow]] {
    const uint count = pass.list.at[0].count;
    const uint block_keys = sortBlockKeys(count), blocks = groupsOver(count, block_keys);
    countDigits(gl_WorkGroupID.x, block_keys, count);
    const uint run = gl_WorkGroupID.x / kSortRun, run_blocks = min(blocks - run * kSortRun, kSortRun);
    if (isLastOfRun(pass.list, run, run_blocks, 8)) { sumBlocksOfRun(run, run_blocks); }
    if (isLastGroup(pass.list)) { sumRuns(groupsOver(blocks, kSortRun)); }
}
